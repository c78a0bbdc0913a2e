// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/rooms/floor_plan_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "roomscribe/core/disjoint_sets.hpp"
#include "roomscribe/core/quantile.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/interpretation/rooms/plan_cell.hpp"
#include "roomscribe/interpretation/rooms/room_barriers.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// m. Half of the thinnest wall: its two faces lie in different cells.
constexpr double min_cell_size = 0.05;
/// m, of a storey's plan to either side. Farther, it was seen through a window.
constexpr double max_reach = 60.0;
/// m. Openings are not wider (a double door, a passage); what parts along a longer line only under
/// the ceiling is a beam.
constexpr double max_opening = 2.2;
/// m2. The smallest room, a WC, has 0.9 x 1.2 m.
constexpr double min_room_area = 0.8;

class PlanDrawer {
  public:
    PlanDrawer(std::span<const Ray> rays, const SurfaceSample& sample,
               std::span<const PlanarPatch> patches, const Eigen::Matrix3d& room_from_map,
               const Storey& storey, const RoomSurfacesSettings& settings)
        : rays_(rays),
          sample_(sample),
          patches_(patches),
          room_from_map_(room_from_map),
          storey_(storey),
          settings_(settings) {}

    FloorPlan run(std::span<const UprightSurface> surfaces);

  private:
    Vector3d in_room(const Eigen::Vector3f& position) const {
        return room_from_map_ * position.cast<double>();
    }
    template <typename Visit>
    void for_each_voxel(std::span<const std::uint32_t> patches, Visit&& visit) const {
        for (const std::uint32_t patch : patches) {
            for (const std::uint32_t voxel : patches_[patch].points)
                visit(in_room(sample_.cloud.positions[voxel]));
        }
    }
    bool lay_out();
    double find_floor() const;
    double top() const;
    void mark_levels();
    void mark_occupied();
    void trace_rays();
    double blind_radius(std::span<const Ray> rays) const;
    void mark_blind();
    std::vector<bool> find_inside() const;
    void flood_rooms(const std::vector<bool>& inside);
    void flood(const std::vector<bool>& is_free);
    void join_under_beams();
    void choose_rooms();
    template <typename MayTake>
    void grow(double reach, MayTake&& may_take);
    void describe_rooms();

    std::span<const Ray> rays_;
    const SurfaceSample& sample_;
    std::span<const PlanarPatch> patches_;
    Eigen::Matrix3d room_from_map_;
    const Storey& storey_;
    const RoomSurfacesSettings& settings_;
    double floor_ = 0.0;
    FloorPlan plan_;
    std::vector<PlanCell> cells_;
};
/// a scanner that saw nothing level. False if there is none of either.
bool PlanDrawer::lay_out() {
    std::vector<double> xs;
    std::vector<double> ys;
    const auto include = [&](const Vector3d& point) {
        xs.push_back(point.x());
        ys.push_back(point.y());
    };
    for (const Level& level : storey_.ceilings)
        for_each_voxel(level.patches, include);
    if (storey_.floor) for_each_voxel(storey_.floor->patches, include);
    for (const Level& level : storey_.other_floors)
        for_each_voxel(level.patches, include);
    for_each_voxel(storey_.sloping_ceilings, include);
    const bool has_level = !xs.empty();
    if (!has_level) {
        if (rays_.empty()) return false;
        for (const Eigen::Vector3f& position : sample_.cloud.positions)
            include(in_room(position));
    }
    floor_ = find_floor();

    const Vector2d middle(median(xs), median(ys));
    for (const Vector3d& sensor : sample_.sensor_positions) {
        const Vector3d place = in_room(sensor.cast<float>());
        if (place.z() > floor_ && place.z() < top()) include(place);
    }
    const Vector2d margin = Vector2d::Constant(0.5);
    const Vector2d low =
        Vector2d(*std::min_element(xs.begin(), xs.end()), *std::min_element(ys.begin(), ys.end()))
            .cwiseMax(middle - Vector2d::Constant(max_reach));
    const Vector2d high =
        Vector2d(*std::max_element(xs.begin(), xs.end()), *std::max_element(ys.begin(), ys.end()))
            .cwiseMin(middle + Vector2d::Constant(max_reach));
    plan_ =
        FloorPlan(low - margin, high + margin, std::max(min_cell_size, 1.25 * sample_.voxel_size));
    cells_.resize(plan_.num_cells());
    return true;
}

/// Height of the floor; where none was seen, where it is likely to be.
double PlanDrawer::find_floor() const {
    constexpr double storey_height = 2.5;
    constexpr double scanner_height = 1.5;
    if (storey_.floor) return storey_.floor->height;
    if (storey_.ceiling_height()) return *storey_.ceiling_height() - storey_height;
    std::vector<double> scanners;
    for (const Vector3d& sensor : sample_.sensor_positions)
        scanners.push_back(in_room(sensor.cast<float>()).z());
    std::vector<double> heights;
    for (const Eigen::Vector3f& position : sample_.cloud.positions)
        heights.push_back(in_room(position).z());
    constexpr double stray_share = 0.01;
    return std::min(median(scanners) - scanner_height, quantile(heights, stray_share));
}

/// No ray of the storey goes higher.
double PlanDrawer::top() const {
    return storey_.ceilings.empty() ? std::numeric_limits<double>::infinity()
                                    : storey_.ceilings.back().height;
}

void PlanDrawer::mark_levels() {
    const auto mark_floor = [&](const Vector3d& point) {
        const auto cell = plan_.cell_at(point.head<2>());
        if (!cell) return;
        cells_[*cell].has_floor = true;
        plan_.has_level[*cell] = true;
    };
    if (storey_.floor) for_each_voxel(storey_.floor->patches, mark_floor);
    for (const Level& level : storey_.other_floors)
        for_each_voxel(level.patches, mark_floor);
    const auto mark_ceiling = [&](const Vector3d& point) -> std::optional<std::size_t> {
        const auto cell = plan_.cell_at(point.head<2>());
        if (!cell) return {};
        plan_.has_level[*cell] = true;
        float& ceiling = plan_.ceiling_of_cell[*cell];
        const auto height = static_cast<float>(point.z());
        if (!(ceiling >= height)) ceiling = height;
        return cell;
    };
    for_each_voxel(storey_.sloping_ceilings, [&](const Vector3d& point) {
        if (const auto cell = mark_ceiling(point)) plan_.is_under_slope[*cell] = true;
    });
    for (const Level& level : storey_.ceilings) {
        for_each_voxel(level.patches, [&](const Vector3d& point) {
            if (const auto cell = mark_ceiling(point)) plan_.is_under_slope[*cell] = false;
        });
    }
}

/// Marks where anything stands: also without rays it is known to be within the building.
void PlanDrawer::mark_occupied() {
    for (const Eigen::Vector3f& position : sample_.cloud.positions) {
        const Vector3d point = in_room(position);
        if (point.z() < floor_ || point.z() > top()) continue;
        if (const auto cell = plan_.cell_at(point.head<2>())) cells_[*cell].is_occupied = true;
    }
}

/// Counts in each cell the rays that pass between floor and ceiling.
void PlanDrawer::trace_rays() {
    const double step = 0.5 * plan_.cell_size();
    for (const Ray& traced : rays_) {
        const Vector3d origin = in_room(traced.origin);
        const Vector3d ray = in_room(traced.end) - origin;
        const double length = ray.head<2>().norm();
        // Short of the point by more than its error.
        const double passed = length - 3.0 * plan_.cell_size();
        const double end = std::min(length, 2.0 * max_reach);
        std::size_t last = plan_.num_cells();
        for (double along = 0.0; along < end; along += step) {
            const Vector3d point = origin + (along / length) * ray;
            if (point.z() < floor_ || point.z() > top()) break;
            const auto cell = plan_.cell_at(point.head<2>());
            if (!cell) break;
            if (*cell != last) {
                cells_[*cell].num_rays += along < passed ? 1 : 0;
                cells_[*cell].rays_way += (ray.head<2>() / length).cast<float>();
            }
            last = *cell;
        }
    }
}

/// m around a scanner, up to which it cannot look down on the floor that it stands on. Its rays.
double PlanDrawer::blind_radius(std::span<const Ray> rays) const {
    constexpr double farthest = 10.0;
    constexpr double stray_share = 0.005;
    const Vector3d origin = in_room(rays.front().origin);
    std::vector<double> slopes;
    for (const Ray& ray : rays) {
        const Vector3d way = in_room(ray.end) - origin;
        slopes.push_back(way.z() / std::max(way.head<2>().norm(), 1e-3));
    }
    const double steepest = -quantile(slopes, stray_share);
    const double height = origin.z() - floor_;
    return steepest > 0.0 ? std::min(height / steepest, farthest) : farthest;
}

/// Scanners stand indoors, on a floor: what rays pass through around one is indoors, also where it
/// cannot look down.
void PlanDrawer::mark_blind() {
    for (std::size_t first = 0; first < rays_.size();) {
        std::size_t end = first + 1;
        while (end < rays_.size() && rays_[end].origin == rays_[first].origin)
            ++end;
        const Vector2d origin = in_room(rays_[first].origin).head<2>();
        const double radius = blind_radius(rays_.subspan(first, end - first));
        first = end;
        for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
            if (cells_[cell].num_rays >= min_cell_rays &&
                (plan_.middle_of(cell) - origin).norm() <= radius)
                cells_[cell].is_blind = true;
        }
    }
}

/// Cells with a level surface near them in which something was seen, or that rays passed through.
std::vector<bool> PlanDrawer::find_inside() const {
    // Lamps, tables and what else hides both floor and ceiling.
    const int reach = static_cast<int>(std::lround(0.5 / plan_.cell_size()));
    std::vector<bool> inside(cells_.size(), false);
    for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
        if (plan_.has_level[cell] || cells_[cell].is_blind) {
            inside[cell] = true;
        } else if (cells_[cell].is_occupied || cells_[cell].num_rays >= min_cell_rays) {
            bool is_near = false;
            plan_.for_each_neighbor(cell, reach, [&](std::size_t other) {
                is_near = is_near || plan_.has_level[other];
            });
            inside[cell] = is_near;
        }
    }
    return inside;
}

/// Parts what is inside into rooms. Nobody goes from room to room along the strip that a wall's
/// noise leaves on its far side: what touches a barrier is only taken afterwards, and strips that
/// do so everywhere stay apart.
void PlanDrawer::flood_rooms(const std::vector<bool>& inside) {
    plan_.room_of_cell.assign(cells_.size(), no_room);
    std::vector<bool> is_free = inside;
    std::vector<bool> is_clear = inside;
    for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
        if (!plan_.is_barrier[cell]) continue;
        is_free[cell] = false;
        plan_.for_each_neighbor(cell, 1, [&](std::size_t other) { is_clear[other] = false; });
    }
    flood(is_clear);
    grow(plan_.cell_size(), [&](std::size_t cell) { return is_free[cell]; });
    flood(is_free);
}

/// Makes a room of each connected set of cells that are in no room.
void PlanDrawer::flood(const std::vector<bool>& is_free) {
    const auto width = static_cast<std::size_t>(plan_.width());
    std::vector<std::size_t> stack;
    for (std::size_t seed = 0; seed < cells_.size(); ++seed) {
        const auto room = static_cast<std::int32_t>(plan_.rooms.size());
        const auto take = [&](std::size_t cell) {
            if (!is_free[cell] || plan_.room_of_cell[cell] != no_room) return;
            plan_.room_of_cell[cell] = room;
            stack.push_back(cell);
        };
        take(seed);
        if (stack.empty()) continue;
        plan_.rooms.emplace_back();
        while (!stack.empty()) {
            const std::size_t cell = stack.back();
            stack.pop_back();
            if (cell % width > 0) take(cell - 1);
            if (cell % width + 1 < width) take(cell + 1);
            if (cell >= width) take(cell - width);
            if (cell + width < cells_.size()) take(cell + width);
        }
    }
}

/// Makes one of rooms that are parted under the ceiling alone, along more than an opening's width.
void PlanDrawer::join_under_beams() {
    struct Border {
        int length = 0;
        int open = 0;
    };
    std::map<std::pair<std::int32_t, std::int32_t>, Border> borders;
    const int reach = static_cast<int>(std::lround(0.15 / plan_.cell_size()));
    for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
        if (!plan_.is_barrier[cell]) continue;
        std::int32_t first = no_room;
        std::int32_t second = no_room;
        plan_.for_each_neighbor(cell, reach, [&](std::size_t other) {
            const std::int32_t room = plan_.room_of_cell[other];
            if (room == no_room || room == first) return;
            (first == no_room ? first : second) = room;
        });
        if (second == no_room) continue;
        Border& border = borders[std::minmax(first, second)];
        ++border.length;
        border.open += cells_[cell].is_solid ? 0 : 1;
    }
    DisjointSets sets(plan_.rooms.size());
    for (const auto& [pair, border] : borders) {
        // Either face of a beam is a line of cells.
        const double open_length = 0.5 * border.open * plan_.cell_size();
        if (open_length >= max_opening && border.open >= 0.6 * border.length) {
            sets.join(static_cast<std::uint32_t>(pair.first),
                      static_cast<std::uint32_t>(pair.second));
        }
    }
    for (std::int32_t& room : plan_.room_of_cell) {
        if (room != no_room)
            room = static_cast<std::int32_t>(sets.find(static_cast<std::uint32_t>(room)));
    }
}

/// Leaves out what is too small, and what lies outdoors: without a ceiling, and not between walls.
void PlanDrawer::choose_rooms() {
    struct Count {
        int cells = 0;
        int ceiling = 0;
        int floor = 0;
        int level = 0;       ///< floor or ceiling
        int rim = 0;         ///< cells beside others than the room's, where rays leave it
        int closed_rim = 0;  ///< of these, beside a barrier
        bool holds_scanner = false;
    };
    // Between where a view ends and where it only passes by.
    const double min_end_cosine = std::cos(radians(60.0));
    std::vector<Count> counts(plan_.rooms.size());
    for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
        const std::int32_t room = plan_.room_of_cell[cell];
        if (room == no_room) continue;
        Count& count = counts[static_cast<std::size_t>(room)];
        ++count.cells;
        count.ceiling += std::isnan(plan_.ceiling_of_cell[cell]) ? 0 : 1;
        count.floor += cells_[cell].has_floor ? 1 : 0;
        count.level += plan_.has_level[cell] ? 1 : 0;
        // Of a room that was seen through a door the sides end where the door's jambs hide the
        // rest; where it was looked into its depth tells what it is.
        Vector2d outwards = Vector2d::Zero();
        bool is_closed = false;
        plan_.for_each_neighbor(cell, 1, [&](std::size_t other) {
            if (plan_.room_of_cell[other] != room)
                outwards += plan_.middle_of(other) - plan_.middle_of(cell);
            is_closed = is_closed || plan_.is_barrier[other];
        });
        const Vector2d way = cells_[cell].rays_way.cast<double>();
        const bool is_end = rays_.empty()
                                ? !outwards.isZero()
                                : outwards.dot(way) > min_end_cosine * outwards.norm() * way.norm();
        count.rim += is_end ? 1 : 0;
        count.closed_rim += is_end && is_closed ? 1 : 0;
    }
    for (const Vector3d& sensor : sample_.sensor_positions) {
        const std::int32_t room = plan_.room_at((room_from_map_ * sensor).head<2>());
        if (room != no_room) counts[static_cast<std::size_t>(room)].holds_scanner = true;
    }
    const double cell_area = plan_.cell_size() * plan_.cell_size();
    constexpr double min_level_share = 0.3;
    constexpr double min_floor_share = 0.1;  // under furniture a floor shows as much
    // Outdoors next to nothing ends a view; furniture and other doors leave gaps in a room's walls.
    constexpr double min_closed_share = 1.0 / 3.0;
    const bool knows_scanners = !sample_.sensor_positions.empty();
    int most_ceiling = 0;
    for (const Count& count : counts)
        most_ceiling = std::max(most_ceiling, count.ceiling);
    const auto is_room = [&](const Count& count) {
        if (count.cells * cell_area < min_room_area) return false;
        // Furniture may hide nearly all of the floor of the one room that was scanned.
        const bool is_over_floor = !storey_.floor || count.ceiling == most_ceiling ||
                                   count.floor >= min_floor_share * count.cells;
        const bool has_ceiling = count.ceiling >= min_level_share * count.cells && is_over_floor;
        // Where it is not known how a view ends, a roof's underside is no ceiling of a room.
        const int level = knows_scanners ? count.level : count.floor;
        const bool is_walled =
            level >= min_level_share * count.cells &&
            (!knows_scanners || count.closed_rim >= min_closed_share * count.rim);
        return count.holds_scanner || has_ceiling || is_walled;
    };
    // Of the room of a camera before a wall it may be that next to nothing is seen.
    const bool is_any = std::any_of(counts.begin(), counts.end(), is_room);
    std::vector<std::int32_t> number(counts.size(), no_room);
    plan_.rooms.clear();
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (is_any ? !is_room(counts[i]) : !counts[i].holds_scanner) continue;
        number[i] = static_cast<std::int32_t>(plan_.rooms.size());
        plan_.rooms.emplace_back();
    }
    for (std::int32_t& room : plan_.room_of_cell) {
        if (room != no_room) room = number[static_cast<std::size_t>(room)];
    }
}

/// Rooms take what lies beside them, a cell's width at a time, where `may_take` allows.
template <typename MayTake>
void PlanDrawer::grow(double reach, MayTake&& may_take) {
    const int steps = static_cast<int>(std::lround(reach / plan_.cell_size()));
    const auto width = static_cast<std::size_t>(plan_.width());
    for (int step = 0; step < steps; ++step) {
        const std::vector<std::int32_t> before = plan_.room_of_cell;
        for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
            if (before[cell] != no_room || !may_take(cell)) continue;
            std::int32_t& room = plan_.room_of_cell[cell];
            const auto take = [&](std::size_t other) { room = std::max(room, before[other]); };
            if (cell % width > 0) take(cell - 1);
            if (cell % width + 1 < width) take(cell + 1);
            if (cell >= width) take(cell - width);
            if (cell + width < cells_.size()) take(cell + width);
        }
    }
}

/// Under a roof the level part of the ceiling is the room's height, or else where the slopes end.
void PlanDrawer::describe_rooms() {
    std::vector<std::vector<float>> ceilings(plan_.rooms.size());
    std::vector<std::vector<float>> slopes(plan_.rooms.size());
    for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
        if (plan_.room_of_cell[cell] == no_room || std::isnan(plan_.ceiling_of_cell[cell]))
            continue;
        const auto room = static_cast<std::size_t>(plan_.room_of_cell[cell]);
        (plan_.is_under_slope[cell] ? slopes : ceilings)[room].push_back(
            plan_.ceiling_of_cell[cell]);
    }
    constexpr double stray_share = 0.03;
    for (std::size_t i = 0; i < plan_.rooms.size(); ++i) {
        PlanRoom& room = plan_.rooms[i];
        room.floor_height = floor_;
        if (!ceilings[i].empty()) {
            room.ceiling_height = static_cast<double>(median(ceilings[i]));
            room.lowest_ceiling = static_cast<double>(quantile(ceilings[i], stray_share));
        } else if (!slopes[i].empty()) {
            room.ceiling_height = static_cast<double>(quantile(slopes[i], 1.0 - stray_share));
            room.lowest_ceiling = room.ceiling_height;
        }
    }
}

FloorPlan PlanDrawer::run(std::span<const UprightSurface> surfaces) {
    if (!lay_out()) return {};
    mark_levels();
    mark_occupied();
    trace_rays();
    mark_blind();
    draw_barriers(surfaces, sample_, patches_, room_from_map_, floor_, settings_, plan_, cells_);
    flood_rooms(find_inside());
    join_under_beams();
    choose_rooms();
    // Up to what parts the rooms, also where the strip along it was not seen; and the floors and
    // ceilings of doorways and niches, which are in no room of their own.
    grow(0.3, [&](std::size_t cell) { return !plan_.is_barrier[cell]; });
    grow(0.5, [&](std::size_t cell) { return plan_.has_level[cell]; });
    describe_rooms();
    return std::move(plan_);
}

}  // namespace

FloorPlan draw_floor_plan(std::span<const Ray> rays, const SurfaceSample& sample,
                          std::span<const PlanarPatch> patches,
                          const Eigen::Matrix3d& room_from_map, const Storey& storey,
                          std::span<const UprightSurface> surfaces,
                          const RoomSurfacesSettings& settings) {
    return PlanDrawer(rays, sample, patches, room_from_map, storey, settings).run(surfaces);
}

}  // namespace roomscribe
