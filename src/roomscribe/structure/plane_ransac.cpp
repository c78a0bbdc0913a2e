// SPDX-License-Identifier: MIT
#include "roomscribe/structure/plane_ransac.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "roomscribe/core/parallel.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t chunk = 16384;

/// Three points to the plane through them.
struct PlaneProblem {
    using Model = Plane;

    std::span<const Eigen::Vector3f> positions;
    std::span<const std::uint32_t> points;
    double tolerance;
    const Context& context;

    std::size_t num_data() const { return points.size(); }
    int sample_size() const { return 3; }

    std::optional<Plane> propose(Random& random) const {
        const auto draw = [&] {
            const std::uint32_t i = random.below(static_cast<std::uint32_t>(points.size()));
            return Eigen::Vector3d(positions[points[i]].cast<double>());
        };
        const Eigen::Vector3d a = draw();
        const Eigen::Vector3d b = draw();
        const Eigen::Vector3d c = draw();
        const Eigen::Vector3d cross = (b - a).cross(c - a);
        // The sine of the angle at a: below it, the three lie on one line.
        if (!(cross.norm() > 1e-6 * (b - a).norm() * (c - a).norm())) return std::nullopt;
        const Eigen::Vector3d normal = cross.normalized();
        return Plane{normal, normal.dot(a)};
    }

    bool is_inlier(const Plane& plane, std::uint32_t point) const {
        return std::abs(plane.signed_distance(positions[point].cast<double>())) <= tolerance;
    }

    double score(const Plane& plane) const {
        return parallel_reduce(
            context, points.size(), chunk, 0.0,
            [&](std::size_t begin, std::size_t end) {
                std::size_t count = 0;
                for (std::size_t i = begin; i < end; ++i)
                    count += is_inlier(plane, points[i]);
                return static_cast<double>(count);
            },
            [](double a, double b) { return a + b; });
    }
};

/// All points, or about `count` of them evenly spread over their order.
std::vector<std::uint32_t> even_share(std::span<const std::uint32_t> points, std::size_t count) {
    count = std::min(count, points.size());
    std::vector<std::uint32_t> share(count);
    for (std::size_t i = 0; i < count; ++i)
        share[i] = points[i * points.size() / count];
    return share;
}

}  // namespace

PlaneDetectionResult detect_planes_ransac(const PointCloud& cloud, std::uint64_t seed,
                                          const PlaneRansacSettings& settings,
                                          const Context& context) {
    check_settings(settings);
    std::uint64_t draw = seed;
    const auto find_plane = [&](std::span<const std::uint32_t> left) {
        const std::vector<std::uint32_t> scored =
            even_share(left, static_cast<std::size_t>(settings.max_scored_points));
        const PlaneProblem problem{cloud.positions, scored, settings.detection.distance_tolerance,
                                   context};
        return sample_consensus(problem, draw++, settings.consensus).model;
    };
    return take_out_planes(cloud, find_plane, settings.detection, context);
}

}  // namespace roomscribe
