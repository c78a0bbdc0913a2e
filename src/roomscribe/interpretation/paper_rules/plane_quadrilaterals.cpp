// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/paper_rules/plane_quadrilaterals.hpp"

#include "roomscribe/structure/boundary_points.hpp"
#include "roomscribe/structure/line_segments.hpp"
#include "roomscribe/structure/quadrilaterals.hpp"

namespace roomscribe {

SideLengths side_lengths(const Quadrilateral& quadrilateral) {
    const auto& c = quadrilateral.corners;
    return {0.5 * ((c[1] - c[0]).norm() + (c[2] - c[3]).norm()),
            0.5 * ((c[2] - c[1]).norm() + (c[3] - c[0]).norm())};
}

std::vector<PlaneQuadrilateral> find_plane_quadrilaterals(const PointCloud& cloud,
                                                          std::span<const PlanarPatch> planes,
                                                          double point_spacing, std::uint64_t seed,
                                                          const PaperRulesSettings& settings,
                                                          const Context& context) {
    check_settings(settings);
    if (!(point_spacing > 0.0)) return {};
    const BoundaryPointsSettings boundary_settings{
        .radius = settings.boundary_radius.value_or(4.0 * point_spacing)};
    const LineSegmentsSettings line_settings{
        .distance_tolerance = settings.line_tolerance.value_or(point_spacing),
        // Farther apart than neighbours are, points are of two clusters.
        .cluster_gap = boundary_settings.radius,
        .min_inliers = settings.min_line_inliers,
        .consensus = {}};
    std::vector<PlaneQuadrilateral> found;
    for (std::uint32_t number = 0; number < planes.size(); ++number) {
        const Plane& plane = planes[number].plane;
        const std::vector<std::uint32_t> boundary = find_boundary_points(
            cloud.positions, planes[number].points, plane, boundary_settings, context);
        std::vector<LineSegment> lines;
        for (const BoundaryLine& line :
             fit_line_segments(cloud.positions, boundary, seed, line_settings, context).lines) {
            lines.push_back(line.segment);
        }
        for (AssembledQuadrilateral& shape :
             assemble_quadrilaterals(lines, {.end_distance = settings.end_distance,
                                            .angle_tolerance = settings.angle_tolerance})) {
            for (Eigen::Vector3d& corner : shape.quadrilateral.corners)
                corner = plane.project(corner);
            found.push_back({shape.quadrilateral, number});
        }
    }
    return found;
}

}  // namespace roomscribe
