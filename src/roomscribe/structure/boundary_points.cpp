// SPDX-License-Identifier: MIT
#include "roomscribe/structure/boundary_points.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/parallel.hpp"
#include "roomscribe/geometry/point_cloud.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector2f;

/// Points of the plane by square cells as wide as the radius: neighbours lie in the nine around.
class PlaneGrid {
  public:
    PlaneGrid(std::vector<Vector2f> places, float radius)
        : radius_(radius), places_(std::move(places)) {
        Vector2f high = places_.front();
        low_ = high;
        for (const Vector2f& place : places_) {
            low_ = low_.cwiseMin(place);
            high = high.cwiseMax(place);
        }
        // A plane that is far wider than the radius has cells enough, if larger ones.
        constexpr float max_cells_per_side = 8192.0F;
        cell_size_ = std::max(radius, (high - low_).maxCoeff() / max_cells_per_side);
        columns_ = cell_of(high).first + 1;
        rows_ = cell_of(high).second + 1;
        start_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
        for (const Vector2f& place : places_)
            ++start_[index(cell_of(place)) + 1];
        std::partial_sum(start_.begin(), start_.end(), start_.begin());
        members_.resize(places_.size());
        std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
        for (const Vector2f& place : places_)
            members_[next[index(cell_of(place))]++] = place;
    }

    /// Offsets to the neighbours of a point, other points at its place left out.
    template <typename Visit>
    void for_each_neighbor(std::size_t point, Visit&& visit) const {
        const Vector2f& center = places_[point];
        const auto [column, row] = cell_of(center);
        for (int y = std::max(row - 1, 0); y <= std::min(row + 1, rows_ - 1); ++y) {
            for (int x = std::max(column - 1, 0); x <= std::min(column + 1, columns_ - 1); ++x) {
                const std::size_t cell = index({x, y});
                for (std::uint32_t i = start_[cell]; i < start_[cell + 1]; ++i) {
                    const Vector2f offset = members_[i] - center;
                    const float squared = offset.squaredNorm();
                    if (squared > 0.0F && squared <= radius_ * radius_ && !visit(offset)) return;
                }
            }
        }
    }

  private:
    using Cell = std::pair<int, int>;

    Cell cell_of(const Vector2f& place) const {
        const Vector2f cell = (place - low_) / cell_size_;
        return {static_cast<int>(cell.x()), static_cast<int>(cell.y())};
    }
    std::size_t index(const Cell& cell) const {
        return static_cast<std::size_t>(cell.second) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(cell.first);
    }

    float radius_;
    float cell_size_ = 1.0F;
    Vector2f low_;
    int columns_ = 0;
    int rows_ = 0;
    std::vector<Vector2f> places_;
    std::vector<std::uint32_t> start_;
    std::vector<Vector2f> members_;  ///< cell after cell
};

/// Octant of a direction, without a trigonometric function. Where each of the eight is taken, no
/// gap is wider than a right angle.
unsigned octant(const Vector2f& d) {
    const bool is_below = d.y() < 0.0F;
    const Vector2f up = is_below ? Vector2f(-d) : d;
    const bool is_left = up.x() < 0.0F;
    const Vector2f first = is_left ? Vector2f(up.y(), -up.x()) : up;
    return (is_below ? 4U : 0U) + (is_left ? 2U : 0U) + (first.y() > first.x() ? 1U : 0U);
}

bool has_wide_gap(std::vector<float>& angles, double max_angle) {
    if (angles.size() < 2) return false;
    std::sort(angles.begin(), angles.end());
    double widest = 2.0 * std::numbers::pi - static_cast<double>(angles.back() - angles.front());
    for (std::size_t i = 1; i < angles.size(); ++i)
        widest = std::max(widest, static_cast<double>(angles[i] - angles[i - 1]));
    return widest > max_angle;
}

}  // namespace

std::vector<std::uint32_t> find_boundary_points(std::span<const Eigen::Vector3f> positions,
                                                std::span<const std::uint32_t> points,
                                                const Plane& plane,
                                                const BoundaryPointsSettings& settings,
                                                const Context& context) {
    check_settings(settings);
    if (!std::all_of(points.begin(), points.end(),
                     [&](std::uint32_t point) { return is_finite(positions[point]); })) {
        throw InvalidArgument("points", "one that is not finite", "finite points only");
    }
    if (points.empty()) return {};
    const PlaneAxes axes = plane_axes(plane.normal);
    const Eigen::Vector3d origin = positions[points.front()].cast<double>();
    std::vector<Vector2f> places(points.size());
    parallel_for(context, points.size(), 8192, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Eigen::Vector3d offset = positions[points[i]].cast<double>() - origin;
            places[i] = {static_cast<float>(offset.dot(axes.u)),
                         static_cast<float>(offset.dot(axes.v))};
        }
    });
    const PlaneGrid grid(std::move(places), static_cast<float>(settings.radius));
    const bool octants_tell = settings.max_angle >= 0.5 * std::numbers::pi;
    std::vector<std::uint8_t> is_boundary(points.size(), 0);
    parallel_for(context, points.size(), 1024, [&](std::size_t begin, std::size_t end) {
        std::vector<float> angles;
        for (std::size_t i = begin; i < end; ++i) {
            constexpr unsigned all = 0xFFU;
            unsigned taken = 0;
            if (octants_tell) {
                grid.for_each_neighbor(i, [&](const Vector2f& offset) {
                    taken |= 1U << octant(offset);
                    return taken != all;
                });
                if (taken == all) continue;
            }
            angles.clear();
            grid.for_each_neighbor(i, [&](const Vector2f& offset) {
                angles.push_back(std::atan2(offset.y(), offset.x()));
                return true;
            });
            is_boundary[i] = has_wide_gap(angles, settings.max_angle) ? 1 : 0;
        }
    });
    std::vector<std::uint32_t> boundary;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (is_boundary[i] != 0) boundary.push_back(points[i]);
    }
    return boundary;
}

}  // namespace roomscribe
