// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/rooms/room_barriers.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>

namespace roomscribe {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// m, of the slices in which upright surface is counted.
constexpr double slice_height = 0.1;
constexpr int num_slices = 64;
/// m. Widest opening that is closed between two pieces of one line where no lintel shows: a door
/// of 1.1 m and its frame (DIN 18101).
constexpr double max_door_gap = 1.3;
/// m. Doors are lower, and what is higher and no wall stands before one.
constexpr double min_partition_height = 2.0;
/// m. Wardrobes, with the gap behind them.
constexpr double max_wardrobe_depth = 1.0;
/// Of a place on a wall whose top was not seen.
constexpr int min_slices = 3;

std::uint64_t slices_between(double low, double high) {
    const int first = std::clamp(static_cast<int>(std::ceil(low / slice_height)), 0, num_slices);
    const int last = std::clamp(static_cast<int>(std::floor(high / slice_height)), 0, num_slices);
    std::uint64_t mask = 0;
    for (int i = first; i < last; ++i)
        mask |= std::uint64_t{1} << static_cast<unsigned>(i);
    return mask;
}

/// At the height of people.
const std::uint64_t body_slices = slices_between(0.5, 1.8);

double share_of(std::uint64_t slices, std::uint64_t wanted) {
    // The lines of a scanner may lie further apart than a slice is high.
    const std::uint64_t filled = slices | (slices << 1U) | (slices >> 1U);
    return wanted == 0 ? 0.0
                       : static_cast<double>(std::popcount(filled & wanted)) /
                             static_cast<double>(std::popcount(wanted));
}

class BarrierDrawer {
  public:
    BarrierDrawer(const SurfaceSample& sample, std::span<const PlanarPatch> patches,
                  const Eigen::Matrix3d& room_from_map, double floor_height,
                  const RoomSurfacesSettings& settings, FloorPlan& plan,
                  std::vector<PlanCell>& cells)
        : sample_(sample),
          patches_(patches),
          room_from_map_(room_from_map),
          floor_height_(floor_height),
          settings_(settings),
          plan_(plan),
          cells_(cells) {}

    void mark_tops(const UprightSurface& surface);
    void draw(const UprightSurface& surface);

  private:
    Vector3d in_room(const Eigen::Vector3f& position) const {
        return room_from_map_ * position.cast<double>();
    }
    bool has_level_behind(const Vector2d& place, const Vector2d& normal) const;
    bool stands_alone(const Vector2d& place, const Vector2d& normal, double top) const;
    template <typename PlaceOf>
    bool is_beam(std::span<const std::uint64_t> slices, const PlaceOf& place_of) const;

    const SurfaceSample& sample_;
    std::span<const PlanarPatch> patches_;
    Eigen::Matrix3d room_from_map_;
    double floor_height_;
    const RoomSurfacesSettings& settings_;
    FloorPlan& plan_;
    std::vector<PlanCell>& cells_;
};

/// Whether floor or ceiling was seen behind a place on an upright surface, as it is behind
/// furniture.
bool BarrierDrawer::has_level_behind(const Vector2d& place, const Vector2d& normal) const {
    constexpr double nearest = 0.1;
    constexpr double farthest = 0.4;
    return plan_.any_along(place, -normal, nearest, farthest,
                           [&](const Vector2d& behind) { return plan_.has_level_at(behind); });
}

void BarrierDrawer::mark_tops(const UprightSurface& surface) {
    for (const std::uint32_t patch : surface.patches) {
        for (const std::uint32_t voxel : patches_[patch].points) {
            const Vector3d point = in_room(sample_.cloud.positions[voxel]);
            const auto cell = plan_.cell_at(point.head<2>());
            if (!cell) continue;
            float& top = cells_[*cell].upright_top;
            top = std::max(top, static_cast<float>(point.z()));
        }
    }
}

/// Whether no wall shows above a place's `top` on either side, as one does above a wardrobe.
bool BarrierDrawer::stands_alone(const Vector2d& place, const Vector2d& normal, double top) const {
    constexpr double nearest = 0.15;
    constexpr double clearance = 0.2;
    const auto is_higher = [&](const Vector2d& beside) {
        const auto cell = plan_.cell_at(beside);
        return cell && cells_[*cell].upright_top > top + clearance;
    };
    return !plan_.any_along(place, normal, nearest, max_wardrobe_depth, is_higher) &&
           !plan_.any_along(place, -normal, nearest, max_wardrobe_depth, is_higher);
}

/// Whether a surface, by what slices were seen in each step along it, is the face of a beam: long,
/// nothing at the height of people anywhere, and the room goes on below.
template <typename PlaceOf>
bool BarrierDrawer::is_beam(std::span<const std::uint64_t> slices, const PlaceOf& place_of) const {
    constexpr double min_length = 1.1;  // m, corridors are wider, the lintels of doors are not
    if (static_cast<double>(slices.size()) * plan_.cell_size() < min_length) return false;
    constexpr double stray_share = 0.1;
    constexpr double min_open_share = 0.5;
    std::size_t num_solid = 0;
    std::size_t num_open = 0;
    for (std::size_t i = 0; i < slices.size(); ++i) {
        num_solid += (slices[i] & body_slices) != 0 ? 1 : 0;
        const auto cell = plan_.cell_at(place_of(static_cast<double>(i) + 0.5));
        const bool is_open =
            cell && (cells_[*cell].num_rays >= min_cell_rays || cells_[*cell].has_floor);
        num_open += is_open ? 1 : 0;
    }
    const auto count = static_cast<double>(slices.size());
    return static_cast<double>(num_solid) <= stray_share * count &&
           static_cast<double>(num_open) >= min_open_share * count;
}

/// Marks the cells on the surface's line along which it parts rooms.
void BarrierDrawer::draw(const UprightSurface& surface) {
    const double step = plan_.cell_size();
    const auto count = static_cast<std::size_t>(surface.width() / step) + 1;
    std::vector<std::uint64_t> slices(count, 0);
    for (const std::uint32_t patch : surface.patches) {
        for (const std::uint32_t voxel : patches_[patch].points) {
            const Vector3d position = sample_.cloud.positions[voxel].cast<double>();
            const double along = (position.dot(surface.along) - surface.start) / step;
            const double above =
                (in_room(sample_.cloud.positions[voxel]).z() - floor_height_) / slice_height;
            if (along < 0.0 || along >= static_cast<double>(count)) continue;
            if (above < 0.0 || above >= num_slices) continue;
            slices[static_cast<std::size_t>(along)] |= std::uint64_t{1}
                                                       << static_cast<unsigned>(above);
        }
    }
    const auto place_of = [&](double position) -> Vector2d {
        const Vector3d point = surface.plane.offset * surface.plane.normal +
                               (surface.start + position * step) * surface.along;
        return (room_from_map_ * point).head<2>();
    };
    const Vector2d normal = (room_from_map_ * surface.plane.normal).head<2>();
    const auto closes = [&](double position) {
        const Vector2d place = place_of(position);
        return !has_level_behind(place, normal) ||
               (sample_.sensor_positions.empty() && !has_level_behind(place, -normal));
    };
    if (is_beam(slices, place_of)) return;
    const bool is_high = surface.top >= floor_height_ + settings_.min_closing_top;
    const bool is_tall = surface.height() >= settings_.min_wall_height && is_high;
    std::vector<bool> parts(count, false);
    for (std::size_t i = 0; i < count; ++i) {
        const double middle = static_cast<double>(i) + 0.5;
        const auto ceiling = plan_.ceiling_near(place_of(middle), ceiling_cells);
        const auto slope = plan_.slope_near(place_of(middle), ceiling_cells);
        const auto reaches = [&](std::optional<double> height) {
            const double top = height.value_or(0.0) - floor_height_;
            return height && (slices[i] & slices_between(top - settings_.ceiling_reach,
                                                         top + slice_height)) != 0;
        };
        // A knee wall; under the slope stand cupboards, too.
        const bool has_lintel = reaches(ceiling) || (reaches(slope) && closes(middle));
        // Rays would tell what is behind.
        const double seen_top = slice_height * (num_slices - std::countl_zero(slices[i]));
        const bool is_alone = !sample_.sensor_positions.empty() ||
                              stands_alone(place_of(middle), normal, floor_height_ + seen_top);
        const bool has_body = share_of(slices[i], body_slices) >= 0.6;
        const bool is_body = !ceiling && is_high && has_body && is_alone;
        const bool is_partition = sample_.sensor_positions.empty() && has_body && is_alone &&
                                  seen_top >= min_partition_height;
        const bool is_last =
            is_tall && is_alone && std::popcount(slices[i]) >= min_slices && closes(middle);
        parts[i] = has_lintel || is_body || is_partition || is_last;
    }
    // Gaps between two pieces, each long enough not to be a stray.
    const auto max_gap = static_cast<std::size_t>(max_door_gap / step);
    std::size_t last = count;
    for (std::size_t i = 0; i < count; ++i) {
        if (!parts[i]) continue;
        if (last != count && i - last > 1 && i - last <= max_gap)
            std::fill(parts.begin() + static_cast<std::ptrdiff_t>(last),
                      parts.begin() + static_cast<std::ptrdiff_t>(i), true);
        last = i;
    }
    const auto mark = [&](double position, bool is_solid) {
        const auto cell = plan_.cell_at(place_of(position));
        if (!cell) return;
        plan_.is_barrier[*cell] = true;
        cells_[*cell].is_solid = cells_[*cell].is_solid || is_solid;
    };
    for (std::size_t i = 0; i < count; ++i) {
        if (!parts[i]) continue;
        const bool is_solid = share_of(slices[i], body_slices) >= 0.4;
        for (const double offset : {0.0, 0.25, 0.5, 0.75})
            mark(static_cast<double>(i) + offset, is_solid);
        // Corners are seen badly: an end reaches a little further.
        constexpr double overlap = 2.0;
        const bool is_first = i == 0 || !parts[i - 1];
        const bool is_last = i + 1 == count || !parts[i + 1];
        for (double beyond = 0.5; beyond <= overlap; beyond += 0.5) {
            if (is_first) mark(static_cast<double>(i) - beyond, is_solid);
            if (is_last) mark(static_cast<double>(i) + 1.0 + beyond, is_solid);
        }
    }
}

}  // namespace

void draw_barriers(std::span<const UprightSurface> surfaces, const SurfaceSample& sample,
                   std::span<const PlanarPatch> patches, const Eigen::Matrix3d& room_from_map,
                   double floor_height, const RoomSurfacesSettings& settings, FloorPlan& plan,
                   std::vector<PlanCell>& cells) {
    BarrierDrawer drawer(sample, patches, room_from_map, floor_height, settings, plan, cells);
    for (const UprightSurface& surface : surfaces)
        drawer.mark_tops(surface);
    for (const UprightSurface& surface : surfaces)
        drawer.draw(surface);
}

}  // namespace roomscribe
