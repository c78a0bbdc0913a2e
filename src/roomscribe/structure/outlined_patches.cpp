// SPDX-License-Identifier: MIT
#include "roomscribe/structure/outlined_patches.hpp"

#include <algorithm>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/structure/outline_lines.hpp"
#include "roomscribe/structure/outline_rectangles.hpp"
#include "roomscribe/structure/patch_outline.hpp"

namespace roomscribe {
namespace {

/// m2, of a patch that can be seen on the picture of a room: a sheet of paper.
constexpr double min_area = 0.06;

OutlinedPatch outline_patch(const SurfaceSample& sample, const PlanarPatch& patch) {
    const Plane& plane = patch.plane;
    const auto [u, v] = plane_axes(plane.normal);
    const Eigen::Vector3d origin = plane.project(Eigen::Vector3d::Zero());
    const auto place = [&, &u = u, &v = v](const Eigen::Vector2d& p) {
        return Eigen::Vector3f((origin + p.x() * u + p.y() * v).cast<float>());
    };
    OutlinedPatch outlined;
    outlined.normal = plane.normal;
    for (const std::uint32_t point : patch.points)
        outlined.points.push_back(sample.cloud.positions[point]);
    const PatchOutline outline =
        trace_outline(sample.cloud.positions, patch.points, plane, sample.spacing);
    for (const OutlineLoop& loop : outline.loops) {
        for (const Eigen::Vector2d& point : loop.points)
            outlined.boundary.push_back(place(point));
    }
    // Rim points lie before the rim by half the spacing in the mean, so they stray by as much.
    OutlineLineSettings line_settings;
    line_settings.tolerance = std::max(line_settings.tolerance, 0.5 * outline.spacing);
    line_settings.min_length = std::max(line_settings.min_length, 4.0 * outline.spacing);
    OutlineRectangleSettings rectangle_settings;
    rectangle_settings.distance_tolerance =
        std::max(rectangle_settings.distance_tolerance, outline.spacing);
    const std::vector<OutlineLine> lines = find_outline_lines(outline, line_settings);
    for (const OutlineLine& line : lines)
        outlined.lines.push_back({place(line.start), place(line.end)});
    for (const OutlineRectangle& rectangle : find_outline_rectangles(lines, rectangle_settings)) {
        auto& corners = outlined.rectangles.emplace_back();
        for (std::size_t i = 0; i < corners.size(); ++i)
            corners[i] = place(rectangle.corners[i]);
    }
    return outlined;
}

}  // namespace

std::vector<OutlinedPatch> outline_patches(const SurfaceSample& sample,
                                           std::span<const PlanarPatch> patches,
                                           const Context& context) {
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < patches.size(); ++i)
        if (patches[i].area >= min_area) chosen.push_back(i);
    std::vector<OutlinedPatch> outlined(chosen.size());
    parallel_for(context, chosen.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            outlined[i] = outline_patch(sample, patches[chosen[i]]);
    });
    return outlined;
}

}  // namespace roomscribe
