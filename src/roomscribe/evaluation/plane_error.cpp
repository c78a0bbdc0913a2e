// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/plane_error.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "roomscribe/core/error.hpp"

namespace roomscribe {
namespace {

/// How many points each plane has in common with each surface.
struct CommonPoints {
    std::vector<std::uint64_t> of_surface;
    std::vector<std::uint64_t> of_plane;
    std::vector<std::uint64_t> known_of_plane;  ///< on any surface
    std::vector<Eigen::Vector3d> middle_of_plane;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint64_t> of_both;  ///< plane, surface
};

CommonPoints count_common(const SurfaceTruth& truth, std::span<const Eigen::Vector3f> positions,
                          std::size_t num_planes, std::span<const std::int32_t> plane_of_point) {
    CommonPoints common;
    common.of_surface.resize(truth.surfaces.size());
    common.of_plane.resize(num_planes);
    common.known_of_plane.resize(num_planes);
    common.middle_of_plane.assign(num_planes, Eigen::Vector3d::Zero());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const std::int32_t surface = truth.surface_of_point[i];
        if (surface >= 0) ++common.of_surface[static_cast<std::size_t>(surface)];
        if (plane_of_point[i] < 0) continue;
        const auto plane = static_cast<std::size_t>(plane_of_point[i]);
        ++common.of_plane[plane];
        common.middle_of_plane[plane] += positions[i].cast<double>();
        if (surface < 0) continue;
        ++common.known_of_plane[plane];
        ++common.of_both[{static_cast<std::uint32_t>(plane), static_cast<std::uint32_t>(surface)}];
    }
    for (std::size_t plane = 0; plane < num_planes; ++plane) {
        common.middle_of_plane[plane] /=
            static_cast<double>(std::max<std::uint64_t>(common.of_plane[plane], 1));
    }
    return common;
}

}  // namespace

PlaneError evaluate_planes(const SurfaceTruth& truth, std::span<const Eigen::Vector3f> positions,
                           std::span<const FoundPlane> planes,
                           std::span<const std::int32_t> plane_of_point,
                           const PlaneErrorLimits& limits) {
    if (plane_of_point.size() != positions.size() ||
        truth.surface_of_point.size() != positions.size()) {
        throw InvalidArgument("plane_of_point", "another number of points", "one per point");
    }
    const CommonPoints common = count_common(truth, positions, planes.size(), plane_of_point);
    std::vector<std::vector<std::pair<std::uint64_t, std::uint32_t>>> planes_of(
        truth.surfaces.size());
    std::vector<bool> is_true(planes.size(), false);
    for (const auto& [both, count] : common.of_both) {
        const auto& [plane, surface] = both;
        if (2 * count <= common.known_of_plane[plane]) continue;
        is_true[plane] = 2 * count > common.of_plane[plane];
        planes_of[surface].emplace_back(count, plane);
    }
    PlaneError error;
    for (std::uint32_t plane = 0; plane < planes.size(); ++plane) {
        if (!is_true[plane] && common.of_plane[plane] >= limits.min_points &&
            planes[plane].area >= limits.min_area) {
            error.false_planes.push_back(plane);
        }
    }
    for (std::uint32_t s = 0; s < truth.surfaces.size(); ++s) {
        const TrueSurface& surface = truth.surfaces[s];
        if (common.of_surface[s] < limits.min_points || surface.area < limits.min_area) continue;
        SurfaceMatch& match = error.surfaces.emplace_back();
        match.surface = s;
        match.points = common.of_surface[s];
        auto& holders = planes_of[s];
        std::stable_sort(holders.begin(), holders.end(),
                         [](const auto& a, const auto& b) { return a.first > b.first; });
        std::uint64_t held = 0;
        std::uint64_t known = 0;
        for (const auto& [count, plane] : holders) {
            match.planes.push_back(plane);
            held += count;
            known += common.known_of_plane[plane];
        }
        if (match.planes.empty()) {
            ++error.num_missed;
            continue;
        }
        match.recall = static_cast<double>(held) / static_cast<double>(match.points);
        match.precision = static_cast<double>(held) / static_cast<double>(known);
        const Plane& first = planes[match.planes.front()].plane;
        const double cosine = std::abs(first.normal.dot(surface.plane.normal));
        match.normal_error = std::acos(std::min(1.0, cosine));
        const Eigen::Vector3d& middle = common.middle_of_plane[match.planes.front()];
        match.offset_error = std::abs(surface.plane.signed_distance(first.project(middle)));
    }
    return error;
}

}  // namespace roomscribe
