// SPDX-License-Identifier: MIT
#include "roomscribe/structure/line_segments.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace roomscribe {
namespace {

using Eigen::Vector3d;

/// Draws in a row without a line large enough, after which there is none.
constexpr int max_failures = 10;

struct Line {
    Vector3d point = Vector3d::Zero();
    Vector3d direction = Vector3d::UnitX();

    double position_of(const Vector3d& other) const { return direction.dot(other - point); }
    bool is_within(const Vector3d& other, double distance) const {
        return direction.cross(other - point).squaredNorm() <= distance * distance;
    }
};

/// Two points to the line through them.
struct LineProblem {
    using Model = Line;

    std::span<const Eigen::Vector3f> positions;
    std::span<const std::uint32_t> points;
    double tolerance;
    std::vector<Vector3d> places;  ///< of the points, one after another

    LineProblem(std::span<const Eigen::Vector3f> all, std::span<const std::uint32_t> numbers,
                double distance)
        : positions(all), points(numbers), tolerance(distance) {
        places.reserve(points.size());
        for (const std::uint32_t point : points)
            places.push_back(at(point));
    }

    Vector3d at(std::uint32_t point) const { return positions[point].cast<double>(); }
    std::size_t num_data() const { return points.size(); }
    int sample_size() const { return 2; }

    std::optional<Line> propose(Random& random) const {
        const auto draw = [&] {
            return at(points[random.below(static_cast<std::uint32_t>(points.size()))]);
        };
        const Vector3d a = draw();
        const Vector3d b = draw();
        const double length = (b - a).norm();
        if (!(length > tolerance)) return std::nullopt;
        return Line{a, (b - a) / length};
    }

    bool is_inlier(const Line& line, std::uint32_t point) const {
        return line.is_within(at(point), tolerance);
    }

    double score(const Line& line) const {
        return static_cast<double>(
            std::count_if(places.begin(), places.end(),
                          [&](const Vector3d& place) { return line.is_within(place, tolerance); }));
    }
};

/// Points along a line, cut where the gap between neighbours is wide; the largest part.
std::vector<std::uint32_t> largest_cluster(const LineProblem& problem, const Line& line,
                                           double gap) {
    std::vector<std::pair<double, std::uint32_t>> along;
    for (const std::uint32_t point : problem.points) {
        if (problem.is_inlier(line, point))
            along.emplace_back(line.position_of(problem.at(point)), point);
    }
    std::sort(along.begin(), along.end());
    std::size_t best_begin = 0;
    std::size_t best_end = 0;
    for (std::size_t begin = 0; begin < along.size();) {
        std::size_t end = begin + 1;
        while (end < along.size() && along[end].first - along[end - 1].first <= gap)
            ++end;
        if (end - begin > best_end - best_begin) {
            best_begin = begin;
            best_end = end;
        }
        begin = end;
    }
    std::vector<std::uint32_t> cluster;
    for (std::size_t i = best_begin; i < best_end; ++i)
        cluster.push_back(along[i].second);
    std::sort(cluster.begin(), cluster.end());
    return cluster;
}

BoundaryLine fit_line(const LineProblem& problem, std::vector<std::uint32_t> points) {
    Vector3d middle = Vector3d::Zero();
    for (const std::uint32_t point : points)
        middle += problem.at(point);
    middle /= static_cast<double>(points.size());
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const std::uint32_t point : points) {
        const Vector3d offset = problem.at(point) - middle;
        scatter += offset * offset.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
    const Line line{middle, solver.eigenvectors().col(2)};
    double low = 0.0;
    double high = 0.0;
    for (const std::uint32_t point : points) {
        low = std::min(low, line.position_of(problem.at(point)));
        high = std::max(high, line.position_of(problem.at(point)));
    }
    BoundaryLine found;
    found.segment = {middle + low * line.direction, middle + high * line.direction};
    found.rms = std::sqrt(std::max(0.0, solver.eigenvalues()[0] + solver.eigenvalues()[1]) /
                          static_cast<double>(points.size()));
    found.points = std::move(points);
    return found;
}

}  // namespace

LineSegmentsResult fit_line_segments(std::span<const Eigen::Vector3f> positions,
                                     std::span<const std::uint32_t> boundary, std::uint64_t seed,
                                     const LineSegmentsSettings& settings, const Context& context) {
    check_settings(settings);
    LineSegmentsResult result;
    std::vector<std::uint32_t> left(boundary.begin(), boundary.end());
    std::sort(left.begin(), left.end());
    const auto min_inliers = static_cast<std::size_t>(settings.min_inliers);
    int num_failures = 0;
    for (std::uint64_t draw = 0; left.size() >= min_inliers; ++draw) {  // steps 3 and 12
        context.throw_if_cancelled();
        const LineProblem problem{positions, left, settings.distance_tolerance};
        const auto line = sample_consensus(problem, seed + draw, settings.consensus);  // step 4
        std::vector<std::uint32_t> cluster;
        if (line.model)
            cluster = largest_cluster(problem, *line.model, settings.cluster_gap);  // steps 5, 6
        if (cluster.size() < min_inliers) {                                         // step 7
            if (++num_failures < max_failures) continue;
            result.stop = LineSegmentsStop::small_cluster;
            break;
        }
        num_failures = 0;
        std::vector<std::uint32_t> rest;
        std::set_difference(left.begin(), left.end(), cluster.begin(), cluster.end(),
                            std::back_inserter(rest));                  // step 10
        result.lines.push_back(fit_line(problem, std::move(cluster)));  // steps 8, 9
        left = std::move(rest);
    }
    result.remaining_points = std::move(left);
    return result;
}

}  // namespace roomscribe
