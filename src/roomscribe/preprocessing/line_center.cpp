// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/line_center.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Dense>

#include "roomscribe/core/quantile.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

constexpr std::size_t min_lines = 8;
constexpr std::size_t min_line_points = 50;
constexpr std::size_t min_line_steps = 25;
/// Lines that are looked at, and steps of each.
constexpr std::size_t max_lines = 32;
constexpr std::size_t max_line_steps = 200;
/// Of the distances to the line's middle. A ray's error in range stays in the plane of its line;
/// what leaves it are the axes' errors, some hundredths of a degree.
constexpr double max_line_lift = 0.002;
/// Of the planes' normals, whose smaller parts say how much their directions differ.
constexpr double min_turn = 0.05;
/// m, along the axis to either side of the lines' middle.
constexpr double max_reach = 5.0;
/// A step is like the others if it differs from their median by less.
constexpr double max_step_error = 0.1;
constexpr double min_even_share = 0.85;
/// m. Many files hold whole millimetres.
constexpr double rounding = 0.001;
/// Of the lines. People walk through some.
constexpr double min_even_lines = 0.7;
/// m. The laser hangs no farther from its axis of turning.
constexpr double max_arm = 0.5;

bool is_return(const Eigen::Vector3f& point) {
    return is_finite(point) && !point.isZero(0.0F);
}

/// Neighbouring rays of a line, from where they end.
struct Step {
    Vector3d from;
    Vector3d to;
};

/// A row or a column of the grid.
struct Line {
    Vector3d normal;
    double offset = 0.0;
    std::vector<Step> steps;
};

struct LinePlane {
    Vector3d normal;
    double offset = 0.0;
    bool is_flat = false;
};

LinePlane fit_line_plane(const std::vector<Vector3d>& points) {
    Vector3d middle = Vector3d::Zero();
    for (const Vector3d& point : points)
        middle += point / static_cast<double>(points.size());
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const Vector3d& point : points)
        scatter += (point - middle) * (point - middle).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
    const Vector3d spread = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
    LinePlane plane;
    plane.normal = solver.eigenvectors().col(0);
    plane.offset = plane.normal.dot(middle);
    // A line that sees nothing but one straight wall has no plane of its own.
    plane.is_flat = spread[0] <= max_line_lift * spread[2] && spread[1] >= 0.05 * spread[2];
    return plane;
}

std::vector<Line> take_lines(const PointCloud& cloud, bool by_row) {
    const ScanGrid& grid = *cloud.grid;
    const std::size_t num_lines = by_row ? grid.rows : grid.columns;
    const std::size_t length = by_row ? grid.columns : grid.rows;
    const auto point_at = [&](std::size_t line, std::size_t i) -> const Eigen::Vector3f& {
        return cloud.positions[by_row ? line * grid.columns + i : i * grid.columns + line];
    };
    std::vector<Line> lines;
    const std::size_t stride = num_lines / max_lines + 1;
    const std::size_t step_stride = length / max_line_steps + 1;
    for (std::size_t number = 0; number < num_lines; number += stride) {
        std::vector<Vector3d> points;
        for (std::size_t i = 0; i < length; ++i) {
            if (is_return(point_at(number, i)))
                points.emplace_back(point_at(number, i).cast<double>());
        }
        if (points.size() < min_line_points) continue;
        const LinePlane plane = fit_line_plane(points);
        if (!plane.is_flat) continue;
        Line line{plane.normal, plane.offset, {}};
        for (std::size_t i = 0; i + 1 < length; i += step_stride) {
            const Eigen::Vector3f& from = point_at(number, i);
            const Eigen::Vector3f& to = point_at(number, i + 1);
            if (is_return(from) && is_return(to))
                line.steps.push_back({from.cast<double>(), to.cast<double>()});
        }
        if (line.steps.size() >= min_line_steps) lines.push_back(std::move(line));
    }
    return lines;
}

/// Angles between neighbouring rays as seen from a place, in radians.
std::vector<double> angles_from(const Vector3d& place, const std::vector<Step>& steps) {
    std::vector<double> angles;
    angles.reserve(steps.size());
    for (const Step& step : steps) {
        const Vector3d from = step.from - place;
        const Vector3d to = step.to - place;
        angles.push_back(std::atan2(from.cross(to).norm(), from.dot(to)));
    }
    return angles;
}

/// Share of the steps that are like most.
double even_share(const Vector3d& place, const std::vector<Step>& steps) {
    const std::vector<double> angles = angles_from(place, steps);
    std::vector<double> sorted = angles;
    const double usual = median(sorted);
    std::size_t even = 0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const double of_rounding = rounding / (steps[i].from - place).norm();
        even += std::abs(angles[i] - usual) <= max_step_error * usual + of_rounding ? 1 : 0;
    }
    return static_cast<double>(even) / static_cast<double>(angles.size());
}

/// Median departure of the steps from the usual one, in parts of it.
double unevenness(const Vector3d& place, const std::vector<Step>& steps) {
    std::vector<double> angles = angles_from(place, steps);
    const double usual = median(angles);
    for (double& angle : angles)
        angle = std::abs(angle - usual) / usual;
    return median(angles);
}

/// The place on the axis from which the steps of all lines are most alike.
Vector3d find_on_axis(const Vector3d& foot, const Vector3d& axis, const std::vector<Step>& steps) {
    constexpr double stride = 0.05;
    double least = std::numeric_limits<double>::infinity();
    Vector3d best = foot;
    for (double along = -max_reach; along <= max_reach; along += stride) {
        const Vector3d place = foot + along * axis;
        const double value = unevenness(place, steps);
        if (value >= least) continue;
        least = value;
        best = place;
    }
    return best;
}

/// The place in the line's plane from which its steps are most alike, near `start`: sought in ever
/// smaller strides.
Vector3d find_in_plane(const Vector3d& start, const Line& line) {
    const Vector3d first = line.normal.unitOrthogonal();
    const Vector3d second = line.normal.cross(first);
    Vector3d best = start - (line.normal.dot(start) - line.offset) * line.normal;
    double least = unevenness(best, line.steps);
    for (double stride = 0.1; stride > 1e-3; stride *= 0.25) {
        const Vector3d middle = best;
        for (int i = -4; i <= 4; ++i) {
            for (int j = -4; j <= 4; ++j) {
                const Vector3d place = middle + stride * (i * first + j * second);
                const double value = unevenness(place, line.steps);
                if (value >= least) continue;
                least = value;
                best = place;
            }
        }
    }
    return best;
}

/// Where the planes meet: a place, or the place on their axis from which the steps are most alike.
/// Empty for planes that are parallel.
std::optional<Vector3d> meet(const std::vector<Line>& lines) {
    Eigen::MatrixXd normals(lines.size(), 3);
    Eigen::VectorXd offsets(lines.size());
    std::vector<Step> steps;
    Vector3d middle = Vector3d::Zero();
    for (std::size_t i = 0; i < lines.size(); ++i) {
        normals.row(static_cast<Eigen::Index>(i)) = lines[i].normal.transpose();
        offsets[static_cast<Eigen::Index>(i)] = lines[i].offset;
        // Every fourth is enough to start from.
        for (std::size_t j = i % 4; j < lines[i].steps.size(); j += 4)
            steps.push_back(lines[i].steps[j]);
    }
    if (steps.empty()) return std::nullopt;
    for (const Step& step : steps)
        middle += step.from / static_cast<double>(steps.size());
    Eigen::JacobiSVD<Eigen::MatrixXd> solver(normals, Eigen::ComputeThinU | Eigen::ComputeThinV);
    const Vector3d spread = solver.singularValues();
    if (spread[1] < min_turn * spread[0]) return std::nullopt;
    solver.setThreshold(min_turn);
    const Vector3d place = solver.solve(offsets);
    if (spread[2] >= min_turn * spread[0]) return place;
    const Vector3d axis = solver.matrixV().col(2);
    return find_on_axis(place + (middle - place).dot(axis) * axis, axis, steps);
}

/// The middle of the places from which the lines were seen: a laser beside its axis of turning
/// moves a little from line to line.
std::optional<Vector3d> center_of(const std::vector<Line>& lines) {
    if (lines.size() < min_lines) return std::nullopt;
    const std::optional<Vector3d> start = meet(lines);
    if (!start) return std::nullopt;
    std::vector<Vector3d> centers;
    for (const Line& line : lines) {
        const Vector3d place = find_in_plane(*start, line);
        const bool is_near = (place - *start).norm() <= max_arm;
        if (is_near && even_share(place, line.steps) >= min_even_share) centers.push_back(place);
    }
    if (static_cast<double>(centers.size()) < min_even_lines * static_cast<double>(lines.size()))
        return std::nullopt;
    Vector3d sum = Vector3d::Zero();
    for (const Vector3d& center : centers)
        sum += center;
    return sum / static_cast<double>(centers.size());
}

}  // namespace

std::optional<Eigen::Vector3d> find_line_center(const PointCloud& cloud) {
    if (!cloud.grid || cloud.grid->rows * cloud.grid->columns != cloud.size()) return std::nullopt;
    for (const bool by_row : {true, false}) {
        auto center = center_of(take_lines(cloud, by_row));
        if (center) return center;
    }
    return std::nullopt;
}

bool locate_scanner(Scan& scan) {
    if (scan.cloud.sensor_pose) return false;
    const std::optional<Vector3d> center = find_line_center(scan.cloud);
    if (!center) return false;
    scan.cloud.sensor_pose = Transform(Eigen::Translation3d(*center));
    return true;
}

}  // namespace roomscribe
