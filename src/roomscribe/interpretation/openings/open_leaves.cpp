// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/openings/open_leaves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include <Eigen/Geometry>

#include "roomscribe/core/units.hpp"
#include "roomscribe/interpretation/openings/door_sizes.hpp"
#include "roomscribe/interpretation/openings/face_axes.hpp"
#include "roomscribe/interpretation/openings/wall_relief.hpp"

namespace roomscribe {

using Eigen::Vector2d;
using Eigen::Vector3d;

OpenLeafFinder::OpenLeafFinder(const SurfaceSample& sample, std::span<const PlanarPatch> patches,
                               const Vector3d& up)
    : sample_(sample), patches_(patches), up_(up) {
    for (const PlanarPatch& patch : patches_)
        extents_.push_back(is_upright(patch) ? extent_of(patch) : Extent{});
}

/// Leaves hang plumb.
bool OpenLeafFinder::is_upright(const PlanarPatch& patch) const {
    return std::abs(patch.plane.normal.dot(up_)) <= std::sin(radians(8.0));
}

OpenLeafFinder::Extent OpenLeafFinder::extent_of(const PlanarPatch& patch) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Extent extent;
    extent.along = up_.cross(patch.plane.normal).normalized();
    extent.across = patch.plane.normal.dot(patch.centroid);
    extent.start = extent.bottom = infinity;
    extent.end = extent.top = -infinity;
    for (const std::uint32_t voxel : patch.points) {
        const Vector3d point = sample_.cloud.positions[voxel].cast<double>();
        extent.bottom = std::min(extent.bottom, point.dot(up_));
        extent.top = std::max(extent.top, point.dot(up_));
        extent.start = std::min(extent.start, point.dot(extent.along));
        extent.end = std::max(extent.end, point.dot(extent.along));
    }
    return extent;
}

std::vector<OpenLeafSide> OpenLeafFinder::find(const WallFace& face, const WallRectangle& hole,
                                               double thickness) const {
    constexpr double max_hinge_gap = 0.25;
    constexpr double max_above = 0.2;  // m: casings are to 0.1 wide
    constexpr double edge_error = 0.05;
    std::vector<OpenLeafSide> sides;
    // Of two leaves each has half of the hole, and a part of a leaf may be hidden.
    const double widest = std::min(hole.width(), max_leaf_width);
    const double min_width = (hole.width() > widest_usual_leaf ? 0.4 : 0.6) * widest;
    const double max_width = hole.width() + 3.0 * edge_error;
    for (std::uint32_t number = 0; number < patches_.size(); ++number) {
        const PlanarPatch& patch = patches_[number];
        if (!is_upright(patch)) continue;
        const Vector3d middle = face.plane.offset * face.plane.normal +
                                0.5 * (hole.start + hole.end) * face.along +
                                patch.centroid.dot(up_) * up_;
        if ((patch.centroid - middle).norm() > hole.width() + 0.3) continue;
        // What lies across the hole in the depth of the wall, along its rims, would close it.
        constexpr double slack = 0.15;
        const double depth = -face.plane.signed_distance(patch.centroid);
        const double position = patch.centroid.dot(face.along);
        const bool is_across = position > hole.start && position < hole.end;
        if (std::abs(patch.plane.normal.dot(face.plane.normal)) > std::cos(radians(4.0)) &&
            depth > -slack && depth < (is_across ? thickness + slack : slack)) {
            continue;
        }
        const Extent& extent = extents_[number];
        const double width = extent.end - extent.start;
        if (extent.top > hole.top + max_above || extent.top < hole.top - 0.4) continue;
        if (extent.top - extent.bottom < 0.5) continue;
        const auto in_plan = [&](double place) {
            const Vector3d edge = place * extent.along + extent.across * patch.plane.normal;
            return Vector2d(edge.dot(face.along), -face.plane.signed_distance(edge));
        };
        // One end of the leaf is at the hinge.
        double nearest = max_hinge_gap;
        std::optional<OpenLeafSide> leaf;
        for (const bool is_start : {true, false}) {
            const Vector2d edge = in_plan(is_start ? extent.start : extent.end);
            const Vector2d free_edge = in_plan(is_start ? extent.end : extent.start);
            for (const double side : {hole.start, hole.end}) {
                const double gap =
                    (edge - Vector2d(side, std::clamp(edge.y(), 0.0, thickness))).norm();
                // From the hinges where they belong, at the face that the leaf opens to.
                const Vector2d hinge(side, free_edge.y() < 0.5 * thickness ? 0.0 : thickness);
                const double reach = std::min((free_edge - hinge).norm(), width);
                if (gap > nearest || reach < min_width || reach > max_width) continue;
                nearest = gap;
                const double share = std::min(1.0, (hole.width() + edge_error) / width);
                leaf = {number, free_edge + share * (edge - free_edge), free_edge};
            }
        }
        if (leaf) sides.push_back(*leaf);
    }
    // Cupboards beside a door look like leaves.
    const auto misfit = [&](const OpenLeafSide& side) {
        return std::abs((side.free_edge - side.hinge).norm() - widest);
    };
    std::stable_sort(sides.begin(), sides.end(),
                     [&](const auto& a, const auto& b) { return misfit(a) < misfit(b); });
    return sides;
}

std::optional<double> OpenLeafFinder::closed_leaf_depth(const WallFace& face,
                                                        const WallRectangle& hole) const {
    // The frame of a leaf 0.61 m wide, 60 mm around, is a quarter of its hole.
    constexpr double min_cover = 0.4;
    constexpr double max_turn = radians(8.0);
    constexpr int reach = 3;  // bins: a leaf's panels, and noise
    // Scanners whose lines are far apart sample a leaf thinly.
    const double cell = std::max(0.1, 2.0 * sample_.spacing);
    const int columns = std::max(1, static_cast<int>(std::lround(hole.width() / cell)));
    const int rows = std::max(1, static_cast<int>(std::lround(hole.height() / cell)));
    std::array<std::vector<int>, num_depth_bins> cells;
    const FaceAxes axes(face);
    for (const PlanarPatch& patch : patches_) {
        if (!is_upright(patch)) continue;
        if (std::abs(patch.plane.normal.dot(face.plane.normal)) < std::cos(max_turn)) continue;
        const double middle = -face.plane.signed_distance(patch.centroid);
        if (middle < 0.0 || middle > max_wall_depth) continue;
        for (const std::uint32_t voxel : patch.points) {
            const FacePlace place = axes.place_of(sample_.cloud.positions[voxel]);
            const double across = (place.along - hole.start) / hole.width();
            const double above = (place.above - hole.bottom) / hole.height();
            const double depth = place.depth / depth_bin;
            if (across < 0.0 || across >= 1.0 || above < 0.0 || above >= 1.0) continue;
            if (depth < 0.0 || depth >= static_cast<double>(num_depth_bins)) continue;
            cells[static_cast<std::size_t>(depth)].push_back(
                static_cast<int>(above * rows) * columns + static_cast<int>(across * columns));
        }
    }
    const auto by_count = [](const auto& a, const auto& b) { return a.size() < b.size(); };
    const int most =
        static_cast<int>(std::max_element(cells.begin(), cells.end(), by_count) - cells.begin());
    std::set<int> covered;
    for (int bin = std::max(0, most - reach); bin <= std::min(num_depth_bins - 1, most + reach);
         ++bin) {
        const std::vector<int>& at_depth = cells[static_cast<std::size_t>(bin)];
        covered.insert(at_depth.begin(), at_depth.end());
    }
    if (static_cast<double>(covered.size()) < min_cover * columns * rows) return std::nullopt;
    return (most + 0.5) * depth_bin;
}

std::optional<double> OpenLeafFinder::lining_depth(const WallFace& face, const WallRectangle& hole,
                                                   double max_thickness) const {
    constexpr double min_thickness = 0.1;  // m: inner walls with plaster
    constexpr double width = 0.08;     // m into the hole and out of it, of lining, stop and error
    constexpr double from_rims = 0.2;  // m of the hole's height at its ends
    constexpr double step = 0.02;
    const auto num_steps = static_cast<std::size_t>(max_thickness / step) + 5;
    std::array<std::vector<bool>, 2> is_lined;
    for (std::vector<bool>& side : is_lined)
        side.resize(num_steps);
    const FaceAxes axes(face);
    for (const Eigen::Vector3f& position : sample_.cloud.positions) {
        const FacePlace at = axes.place_of(position);
        if (at.depth < 0.0F || at.above < hole.bottom + from_rims ||
            at.above > hole.top - from_rims)
            continue;
        const auto number = static_cast<std::size_t>(at.depth / step);
        if (number >= num_steps) continue;
        if (std::abs(at.along - hole.start) <= width) is_lined[0][number] = true;
        if (std::abs(at.along - hole.end) <= width) is_lined[1][number] = true;
    }
    const auto max_gap = static_cast<std::size_t>(std::max(0.08, 3.0 * sample_.spacing) / step);
    std::optional<double> depth;
    for (const auto& side : is_lined) {
        std::size_t last = 0;
        for (std::size_t i = 0; i < num_steps && i <= last + max_gap; ++i) {
            if (side[i]) last = i;
        }
        const double end = static_cast<double>(last + 1) * step;
        // Nothing of this side was seen, or a leaf goes on from it.
        if (end < min_thickness || end > max_thickness) continue;
        depth = std::min(depth.value_or(end), end);
    }
    return depth;
}

void OpenLeafFinder::widen_to_hinge(const WallFace& face, WallRectangle& hole) const {
    if (hole.width() >= max_leaf_width || hole.height() < min_door_height - floor_reach) return;
    for (std::size_t number = 0; number < patches_.size(); ++number) {
        const PlanarPatch& patch = patches_[number];
        if (!is_upright(patch)) continue;
        if (std::abs(patch.plane.normal.dot(face.plane.normal)) > std::cos(radians(4.0))) continue;
        const Extent& leaf = extents_[number];
        const double width = leaf.end - leaf.start;
        if (width < min_door_width || width > max_leaf_width) continue;
        // A scanner beside it does not see its top.
        if (leaf.top > hole.top + 0.15 || leaf.top < hole.top - 0.4) continue;
        if (leaf.top - leaf.bottom < 1.2) continue;
        for (const double end : {leaf.start, leaf.end}) {
            const Vector3d hinge = end * leaf.along + leaf.across * patch.plane.normal;
            if (std::abs(face.plane.signed_distance(hinge)) > 0.2) continue;
            const double position = hinge.dot(face.along);
            constexpr double slack = 0.15;
            if (position < hole.start && std::abs(hole.end - position - width) <= slack)
                hole.start = position;
            if (position > hole.end && std::abs(position - hole.start - width) <= slack)
                hole.end = position;
        }
    }
}

bool can_close(std::span<const OpenLeafSide> leaves, const WallRectangle& hole) {
    constexpr double min_share = 0.85;
    bool is_at_start = false;
    bool is_at_end = false;
    for (const OpenLeafSide& leaf : leaves) {
        if ((leaf.free_edge - leaf.hinge).norm() >= min_share * hole.width()) return true;
        const bool is_left = leaf.hinge.x() < 0.5 * (hole.start + hole.end);
        (is_left ? is_at_start : is_at_end) = true;
    }
    return hole.width() <= widest_usual_leaf ? !leaves.empty() : is_at_start && is_at_end;
}

}  // namespace roomscribe
