// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/openings/wall_relief.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace roomscribe {
namespace {

using Eigen::Vector3f;

/// Points that are looked at.
constexpr std::size_t max_points = 4'000'000;
/// m before the face: casings and levers. What lies farther hides the wall.
constexpr float max_relief = 0.1F;

/// m before the face. Furniture is to 0.9 m deep; where scanners are not known, what stands so near
/// may have hidden the wall.
constexpr float max_cover = 1.0F;
/// Rays that a cell counts for that is open without any being known.
constexpr std::uint32_t assumed_rays = 2;

/// m. A step down at a door is less; the ground floor lies at least so much over the ground.
constexpr float below_floor = 0.15F;
constexpr float farthest_room = 10.0F;

/// The face's coordinates of points, in float: m along the wall, up, and out of it.
struct FaceFrame {
    Vector3f along;
    Vector3f up;
    Vector3f normal;
    Vector3f origin;

    Vector3f operator()(const Vector3f& point) const {
        const Vector3f offset = point - origin;
        return {offset.dot(along), offset.dot(up), offset.dot(normal)};
    }
};

/// `height` is out of the wall.
void count(WallRelief& relief, float along, float above, std::uint32_t ReliefCell::*what,
           float height = 0.0F) {
    const auto size = static_cast<float>(relief.cell_size);
    const float column = along / size;
    const float row = above / size;
    if (!(column >= 0.0F && row >= 0.0F)) return;
    if (column >= static_cast<float>(relief.num_columns) ||
        row >= static_cast<float>(relief.num_rows)) {
        return;
    }
    const auto cell = static_cast<std::size_t>(row) * static_cast<std::size_t>(relief.num_columns) +
                      static_cast<std::size_t>(column);
    ++(relief.cells[cell].*what);
    const bool is_met = what == &ReliefCell::surface || what == &ReliefCell::recess;
    if (is_met && height >= -static_cast<float>(near_depth)) {
        ++relief.cells[cell].near;
        relief.cells[cell].height += height;
    }
    if (what != &ReliefCell::recess) return;
    const auto bin = static_cast<std::size_t>(-height / static_cast<float>(depth_bin));
    std::uint16_t& depth =
        relief.depths[cell * num_depth_bins + std::min<std::size_t>(bin, num_depth_bins - 1)];
    if (depth < std::numeric_limits<std::uint16_t>::max()) ++depth;
}

/// Where the ray from an eye before the face to a point meets its plane: m along and above. Empty
/// for NaN.
std::optional<Eigen::Vector2f> crossing_of(const Vector3f& eye, const Vector3f& point) {
    const float share = eye.z() / (eye.z() - point.z());
    if (!(share > 0.0F)) return std::nullopt;
    return eye.head<2>() + share * (point - eye).head<2>();
}

bool is_before(const Vector3f& point) {
    return point.z() > max_relief;
}
bool is_behind(const Vector3f& point) {
    return point.z() < -static_cast<float>(max_wall_depth);
}

/// A point before the wall hides it, and one behind was seen through it, where the ray crosses.
void count_beyond(WallRelief& relief, const Vector3f& point, const Eigen::Vector2f& crossing) {
    if (is_before(point)) {
        count(relief, crossing.x(), crossing.y(), &ReliefCell::hidden);
        return;
    }
    count(relief, crossing.x(), crossing.y(), &ReliefCell::through);
    // Ground lies lower than floors; rooms are not so deep.
    if (point.y() < -below_floor || point.z() < -farthest_room)
        count(relief, crossing.x(), crossing.y(), &ReliefCell::outdoors);
}

void count_standing(WallRelief& relief, const Vector3f& point) {
    if (is_before(point) && point.z() <= static_cast<float>(furniture_depth))
        count(relief, point.x(), point.y(), &ReliefCell::standing);
}

void keep_near(WallRelief& relief, const Vector3f& point) {
    const auto width = static_cast<float>(relief.num_columns * relief.cell_size);
    const auto height = static_cast<float>(relief.num_rows * relief.cell_size);
    if (!(std::abs(point.z()) <= max_relief) || point.x() < 0.0F || point.x() > width ||
        point.y() < 0.0F || point.y() > height) {
        return;
    }
    relief.near_points.push_back({static_cast<float>(relief.start) + point.x(),
                                  static_cast<float>(relief.bottom) + point.y(), -point.z()});
}

/// The points of one scanner, whose rays come from `sensor` before the face.
void follow_rays(WallRelief& relief, const FaceFrame& frame, std::span<const Vector3f> points,
                 std::size_t stride, const Vector3f& sensor) {
    const Vector3f eye = frame(sensor);
    const auto tolerance = static_cast<float>(relief.tolerance);
    if (eye.z() <= 2.0F * tolerance) return;
    for (std::size_t i = 0; i < points.size(); i += stride) {
        const Vector3f point = frame(points[i]);
        count_standing(relief, point);
        keep_near(relief, point);
        if (std::abs(point.z()) <= tolerance) {
            count(relief, point.x(), point.y(), &ReliefCell::surface, point.z());
            continue;
        }
        const auto crossing = crossing_of(eye, point);
        if (!crossing) continue;
        if (is_before(point) || is_behind(point)) {
            count_beyond(relief, point, *crossing);
        } else if (point.z() > 0.0F) {
            count(relief, point.x(), point.y(), &ReliefCell::surface, point.z());
        } else {
            count(relief, crossing->x(), crossing->y(), &ReliefCell::recess, point.z());
        }
    }
}

/// What an inferred view says of a wall, but for the points on it and in it, which count where
/// they lie.
void follow_view(WallRelief& relief, const FaceFrame& frame, std::span<const Vector3f> points,
                 const InferredView& view, std::size_t stride) {
    const Vector3f eye = frame(view.position.cast<float>());
    if (eye.z() <= 2.0F * static_cast<float>(relief.tolerance)) return;
    for (std::size_t i = 0; i < view.points.size(); i += stride) {
        const Vector3f point = frame(points[view.points[i]]);
        if (!is_before(point) && !is_behind(point)) continue;
        if (const auto crossing = crossing_of(eye, point)) count_beyond(relief, point, *crossing);
    }
}

/// `counts_cover`: what stands before the wall may have hidden it.
void place_points(WallRelief& relief, const FaceFrame& frame, std::span<const Vector3f> points,
                  std::size_t stride, bool counts_cover) {
    const auto tolerance = static_cast<float>(relief.tolerance);
    for (std::size_t i = 0; i < points.size(); i += stride) {
        const Vector3f point = frame(points[i]);
        count_standing(relief, point);
        keep_near(relief, point);
        if (point.z() >= -tolerance && point.z() <= max_relief) {
            count(relief, point.x(), point.y(), &ReliefCell::surface, point.z());
        } else if (point.z() < -tolerance && point.z() >= -static_cast<float>(max_wall_depth)) {
            count(relief, point.x(), point.y(), &ReliefCell::recess, point.z());
        } else if (counts_cover && is_before(point) && point.z() <= max_cover) {
            count(relief, point.x(), point.y(), &ReliefCell::hidden);
        }
    }
}

/// Where nothing was seen on the face, in it or before it, there may be a hole.
void assume_holes(WallRelief& relief) {
    for (ReliefCell& cell : relief.cells) {
        if (cell.surface + cell.recess + cell.hidden == 0)
            cell.through = std::max(cell.through, assumed_rays);
    }
}

}  // namespace

WallRelief measure_wall_relief(const ScanMap& map, const WallFace& face, const Eigen::Vector3d& up,
                               double bottom, double top, double tolerance, double cell_size) {
    WallRelief relief;
    relief.cell_size = cell_size;
    relief.start = face.start;
    relief.bottom = bottom;
    relief.tolerance = tolerance;
    relief.num_columns = std::max(1, static_cast<int>(std::ceil(face.width() / cell_size)));
    relief.num_rows = std::max(1, static_cast<int>(std::ceil((top - bottom) / cell_size)));
    relief.cells.resize(static_cast<std::size_t>(relief.num_columns) *
                        static_cast<std::size_t>(relief.num_rows));
    relief.depths.resize(relief.cells.size() * num_depth_bins);
    const Eigen::Vector3d corner =
        face.plane.offset * face.plane.normal + face.start * face.along + bottom * up;
    const FaceFrame frame{face.along.cast<float>(), up.cast<float>(),
                          face.plane.normal.cast<float>(), corner.cast<float>()};
    const std::size_t stride = map.cloud.size() / max_points + 1;
    const std::span<const Vector3f> points = map.cloud.positions;
    for (const MapSection& section : map.sections) {
        const auto seen = points.subspan(section.first, section.count);
        if (section.sensor_position) {
            relief.has_rays = true;
            follow_rays(relief, frame, seen, stride, section.sensor_position->cast<float>());
        } else {
            place_points(relief, frame, seen, stride, map.inferred_views.empty());
        }
    }
    for (const InferredView& view : map.inferred_views)
        follow_view(relief, frame, points, view, stride);
    relief.looks_beyond = relief.has_rays || !map.inferred_views.empty();
    if (!relief.has_rays) assume_holes(relief);
    return relief;
}

WallRelief columns_of(const WallRelief& relief, int first, int count) {
    WallRelief part;
    part.cell_size = relief.cell_size;
    part.start = relief.start + first * relief.cell_size;
    part.bottom = relief.bottom;
    part.tolerance = relief.tolerance;
    part.num_columns = count;
    part.num_rows = relief.num_rows;
    part.has_rays = relief.has_rays;
    part.looks_beyond = relief.looks_beyond;
    for (int row = 0; row < relief.num_rows; ++row) {
        for (int column = first; column < first + count; ++column) {
            const std::size_t cell = relief.index(column, row);
            part.cells.push_back(relief.cells[cell]);
            const auto depths =
                relief.depths.begin() + static_cast<std::ptrdiff_t>(cell * num_depth_bins);
            part.depths.insert(part.depths.end(), depths, depths + num_depth_bins);
        }
    }
    return part;
}

std::optional<double> hidden_share(const WallRelief& relief) {
    if (!relief.has_rays || relief.cells.empty()) return std::nullopt;
    const auto hidden =
        std::count_if(relief.cells.begin(), relief.cells.end(), [](const ReliefCell& cell) {
            return cell.hidden > 0 && cell.near == 0 && cell.surface == 0 && cell.open() == 0;
        });
    return static_cast<double>(hidden) / static_cast<double>(relief.cells.size());
}

}  // namespace roomscribe
