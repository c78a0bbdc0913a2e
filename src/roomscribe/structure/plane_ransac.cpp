// SPDX-License-Identifier: MIT
#include "roomscribe/structure/plane_ransac.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

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

    std::vector<std::uint32_t> inliers(const Plane& plane) const {
        std::vector<std::uint32_t> result;
        for (const std::uint32_t point : points) {
            if (is_inlier(plane, point)) result.push_back(point);
        }
        return result;
    }
};

}  // namespace

PlaneRansacResult detect_planes_ransac(const PointCloud& cloud, std::uint64_t seed,
                                       const PlaneRansacSettings& settings,
                                       const Context& context) {
    check_settings(settings);
    PlaneRansacResult result;
    std::vector<std::uint32_t> left = finite_points(cloud);
    const auto min_inliers = static_cast<std::size_t>(settings.min_inliers);
    result.stop = PlaneRansacStop::few_points_left;
    while (left.size() >= min_inliers) {
        if (result.planes.size() == static_cast<std::size_t>(settings.max_planes)) {
            result.stop = PlaneRansacStop::max_planes;
            break;
        }
        const PlaneProblem problem{cloud.positions, left, settings.distance_tolerance, context};
        const auto found =
            sample_consensus(problem, seed + result.planes.size(), settings.consensus);
        std::vector<std::uint32_t> inliers;
        if (found.model) inliers = problem.inliers(*found.model);
        if (inliers.size() < min_inliers) {
            result.stop = PlaneRansacStop::few_inliers_left;
            break;
        }
        std::vector<std::uint32_t> rest;
        rest.reserve(left.size() - inliers.size());
        std::set_difference(left.begin(), left.end(), inliers.begin(), inliers.end(),
                            std::back_inserter(rest));
        result.planes.push_back(make_planar_patch(cloud, *found.model, std::move(inliers)));
        left = std::move(rest);
    }
    result.remaining_points = std::move(left);
    return result;
}

}  // namespace roomscribe
