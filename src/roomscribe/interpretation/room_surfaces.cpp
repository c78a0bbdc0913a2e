// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/room_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "roomscribe/geometry/polygon.hpp"
#include "roomscribe/interpretation/level_surfaces.hpp"
#include "roomscribe/interpretation/outline.hpp"
#include "roomscribe/interpretation/storey_extent.hpp"
#include "roomscribe/interpretation/wall_surfaces.hpp"

namespace roomscribe {
namespace {

/// The largest tables are smaller: of less, a floor and a table top cannot be told apart when
/// nothing else is seen.
constexpr double max_table_area = 2.5;
/// What stands before a wall hides a floor's rim to this depth: the outline does not follow it.
constexpr double max_furniture_depth = 1.0;
/// Deviation of an outline, about the spacing of the sample.
constexpr double outline_tolerance = 0.05;

class SurfaceBuilder {
  public:
    SurfaceBuilder(const SurfaceSample& sample, std::span<const PlanarPatch> patches,
                   const Upright& upright)
        : sample_(sample),
          patches_(patches),
          x_(upright.room_from_map.row(0).transpose()),
          y_(upright.room_from_map.row(1).transpose()),
          up_(upright.up()) {}

    void add_level(const Level& level, Label label, const Storey& storey);
    void add_sloping_ceiling(std::uint32_t patch, const Storey& storey);
    void add_wall(const UprightSurface& surface, const WallJudgement& judgement,
                  std::span<const UprightSurface> others, const Storey& storey);
    std::vector<RoomSurface> take() && { return std::move(surfaces_); }

  private:
    RoomSurface start(Label label, std::span<const std::uint32_t> patches);
    bool looks_outwards(const UprightSurface& surface,
                        std::span<const UprightSurface> others) const;

    const SurfaceSample& sample_;
    std::span<const PlanarPatch> patches_;
    Eigen::Vector3d x_;
    Eigen::Vector3d y_;
    Eigen::Vector3d up_;
    std::array<int, num_labels> counts_{};
    std::int32_t next_instance_ = 0;
    std::vector<RoomSurface> surfaces_;
};

RoomSurface SurfaceBuilder::start(Label label, std::span<const std::uint32_t> patches) {
    RoomSurface surface;
    Component& component = surface.component;
    component.label = label;
    component.id =
        fmt::format("{}-{}", label_name(label), ++counts_[static_cast<std::size_t>(label)]);
    component.instance = next_instance_++;
    surface.patches.assign(patches.begin(), patches.end());
    for (const std::uint32_t patch : patches)
        component.evidence.points += patches_[patch].points.size();
    return surface;
}

void SurfaceBuilder::add_level(const Level& level, Label label, const Storey& storey) {
    RoomSurface surface = start(label, level.patches);
    PlaneMoments moments;
    std::vector<Eigen::Vector2d> corners;
    for (const std::uint32_t patch : level.patches) {
        for (const std::uint32_t point : patches_[patch].points) {
            const Eigen::Vector3d position = sample_.cloud.positions[point].cast<double>();
            moments.add(position);
            corners.emplace_back(position.dot(x_), position.dot(y_));
        }
    }
    const double sign = label == Label::floor ? 1.0 : -1.0;
    const auto fit = moments.fit();
    surface.plane = {sign * up_, sign * level.height};
    if (fit) {
        surface.plane = fit->plane.normal.dot(sign * up_) < 0.0 ? fit->plane.flipped() : fit->plane;
    }

    Component& component = surface.component;
    const std::vector<Eigen::Vector2d> outline =
        concave_outline(corners, max_furniture_depth, outline_tolerance);
    for (const Eigen::Vector2d& corner : outline) {
        // Straight up or down onto the plane.
        const Eigen::Vector3d level_corner = corner.x() * x_ + corner.y() * y_;
        const double height =
            -surface.plane.signed_distance(level_corner) / surface.plane.normal.dot(up_);
        component.polygon.emplace_back(level_corner + height * up_);
    }
    component.evidence.rms = fit ? fit->rms : 0.0;
    component.evidence.coverage = std::min(1.0, level.area / std::max(signed_area(outline), 1e-12));
    const bool is_paired = storey.floor && !storey.ceilings.empty();
    component.confidence = is_paired ? 0.95 : 0.75;
    component.verdict = Verdict::accepted;
    component.evidence.rule = label == Label::floor
                                  ? "lowest large level surface that looks up"
                                  : "large level surface at least a room's height above the floor";
    if (label == Label::floor && !is_paired && level.area < max_table_area) {
        component.verdict = Verdict::doubtful;
        component.confidence = 0.5;
        component.evidence.alternative = "table top";
    }
    if (label == Label::ceiling && !storey.floor) {
        component.evidence.rule = "large level surface that looks down; no floor seen";
    }
    surfaces_.push_back(std::move(surface));
}

void SurfaceBuilder::add_sloping_ceiling(std::uint32_t patch, const Storey& storey) {
    Level level;
    level.height = patches_[patch].centroid.dot(up_);
    level.area = patches_[patch].area;
    level.patches = {patch};
    add_level(level, Label::ceiling, storey);
    Component& component = surfaces_.back().component;
    component.evidence.rule =
        "sloping surface at least a room's height above the floor, "
        "nothing above it";
    component.evidence.alternative = "underside of something that leans";
    component.confidence = 0.6;
    component.verdict = Verdict::doubtful;
}

/// Whether the room lies behind the plane. A face with its other face close behind looks away from
/// it; else the room is where most of the surface lies.
bool SurfaceBuilder::looks_outwards(const UprightSurface& surface,
                                    std::span<const UprightSurface> others) const {
    constexpr double max_wall_thickness = 0.5;
    constexpr double nearby = 3.0;
    for (const UprightSurface& other : others) {
        if (&other == &surface || std::abs(other.plane.normal.dot(surface.plane.normal)) < 0.98)
            continue;
        const Eigen::Vector3d middle =
            0.5 * (other.start + other.end) * other.along + other.plane.offset * other.plane.normal;
        const double along = middle.dot(surface.along);
        const double distance = surface.plane.signed_distance(middle);
        if (along < surface.start || along > surface.end) continue;
        if (std::abs(distance) > 2.0 * sample_.tolerance &&
            std::abs(distance) < max_wall_thickness && other.area > 0.25 * surface.area) {
            return distance > 0.0;
        }
    }
    std::ptrdiff_t in_front = 0;
    for (const Eigen::Vector3f& position : sample_.cloud.positions) {
        const Eigen::Vector3d point = position.cast<double>();
        const double distance = surface.plane.signed_distance(point);
        if (std::abs(distance) < 2.0 * sample_.tolerance || std::abs(distance) > nearby) continue;
        const double along = point.dot(surface.along);
        if (along < surface.start || along > surface.end) continue;
        in_front += distance > 0.0 ? 1 : -1;
    }
    return in_front < 0;
}

void SurfaceBuilder::add_wall(const UprightSurface& wall, const WallJudgement& judgement,
                              std::span<const UprightSurface> others, const Storey& storey) {
    RoomSurface surface = start(Label::wall, wall.patches);
    const bool flip = !sample_.normals_face_scanner && looks_outwards(wall, others);
    surface.plane = flip ? wall.plane.flipped() : wall.plane;
    const double bottom = storey.floor ? storey.floor->height : wall.bottom;
    double top = wall.top;
    if (judgement.reaches_ceiling) {
        // Of several ceilings, the one that the wall ends at.
        double nearest = std::numeric_limits<double>::infinity();
        for (const Level& ceiling : storey.ceilings) {
            if (std::abs(ceiling.height - wall.top) >= nearest) continue;
            nearest = std::abs(ceiling.height - wall.top);
            top = ceiling.height;
        }
    }
    const Eigen::Vector3d on_plane = wall.plane.offset * wall.plane.normal;
    Component& component = surface.component;
    const double first = flip ? wall.end : wall.start;
    const double last = flip ? wall.start : wall.end;
    component.polygon = {
        on_plane + first * wall.along + bottom * up_, on_plane + last * wall.along + bottom * up_,
        on_plane + last * wall.along + top * up_, on_plane + first * wall.along + top * up_};
    component.confidence = judgement.confidence;
    component.verdict = judgement.alternative.empty() ? Verdict::accepted : Verdict::doubtful;
    component.evidence.rule = judgement.rule;
    component.evidence.alternative = judgement.alternative;
    component.evidence.rms = wall.rms;
    component.evidence.coverage =
        std::min(1.0, wall.area / std::max(wall.width() * (top - bottom), 1e-12));
    surfaces_.push_back(std::move(surface));
}

/// What is said of floors and walls is no surer than which way is up.
void doubt_all(std::vector<RoomSurface>& surfaces) {
    for (RoomSurface& surface : surfaces) {
        Component& component = surface.component;
        component.confidence = std::min(component.confidence, 0.5);
        component.verdict = Verdict::doubtful;
        if (!component.evidence.alternative.empty()) component.evidence.alternative += "; or ";
        component.evidence.alternative += "another direction is up";
    }
}

/// Rotation from `upright`; the translation puts the lowest floor at z = 0 and the surfaces'
/// bounding box at x = y = 0.
Transform place_room(const SurfaceSample& sample, std::span<const PlanarPatch> patches,
                     std::span<const RoomSurface> surfaces, const Upright& upright,
                     std::optional<double> floor_height) {
    Transform room_from_map = Transform::Identity();
    room_from_map.linear() = upright.room_from_map;
    Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
    const auto include = [&](const Eigen::Vector3d& point) {
        low = low.cwiseMin(upright.room_from_map * point);
    };
    for (const RoomSurface& surface : surfaces) {
        for (const Eigen::Vector3d& corner : surface.component.polygon)
            include(corner);
    }
    if (surfaces.empty()) {
        for (const PlanarPatch& patch : patches) {
            for (const std::uint32_t point : patch.points) {
                include(sample.cloud.positions[point].cast<double>());
            }
        }
    }
    if (!low.allFinite()) return room_from_map;
    if (floor_height) low.z() = *floor_height;
    room_from_map.translation() = -low;
    return room_from_map;
}

}  // namespace

RoomSurfaces find_room_surfaces(const SurfaceSample& sample, std::span<const PlanarPatch> patches,
                                const Upright& upright, const RoomSurfacesSettings& settings,
                                const Context& context) {
    check_settings(settings);
    RoomSurfaces result;
    const Eigen::Vector3d up = upright.up();
    const StoreyExtent extent(sample, patches, upright.room_from_map.row(0).transpose(),
                              upright.room_from_map.row(1).transpose(), settings.max_gap);
    std::vector<Storey> storeys = find_storeys(patches, up, upright.facing_is_known, settings);
    for (Storey& storey : storeys) {
        storey = extent.without_outside(storey);
    }
    SurfaceBuilder builder(sample, patches, upright);
    for (const Storey& storey : storeys) {
        if (storey.floor) builder.add_level(*storey.floor, Label::floor, storey);
        for (const Level& floor : storey.other_floors)
            builder.add_level(floor, Label::floor, storey);
    }
    for (const Storey& storey : storeys) {
        for (const Level& ceiling : storey.ceilings)
            builder.add_level(ceiling, Label::ceiling, storey);
        for (const std::uint32_t patch : storey.sloping_ceilings)
            builder.add_sloping_ceiling(patch, storey);
    }
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < storeys.size(); ++i) {
        context.throw_if_cancelled();
        const double from = i == 0 ? -infinity : storeys[i].floor->height;
        const double to = i + 1 == storeys.size() ? infinity : storeys[i + 1].floor->height;
        const auto surfaces = find_upright_surfaces(sample, patches, up, from, to, settings);
        const StoreyExtent::Points footprint = extent.footprint(storeys[i]);
        for (const UprightSurface& surface : surfaces) {
            const WallJudgement judgement = judge_wall(surface, surfaces, storeys[i], settings);
            if (judgement.is_wall && extent.is_beside(surface, footprint))
                builder.add_wall(surface, judgement, surfaces, storeys[i]);
        }
    }
    result.surfaces = std::move(builder).take();
    if (upright.stop == UprightStop::ambiguous) doubt_all(result.surfaces);
    const auto& floor = storeys.front().floor;
    result.room_from_map = place_room(sample, patches, result.surfaces, upright,
                                      floor ? std::optional(floor->height) : std::nullopt);
    return result;
}

}  // namespace roomscribe
