// SPDX-License-Identifier: MIT
#include "support/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace roomscribe::test {
namespace {

using Box = Eigen::AlignedBox3d;
using Eigen::Vector3d;

Box box(double x0, double y0, double z0, double x1, double y1, double z1) {
    return {Vector3d(x0, y0, z0), Vector3d(x1, y1, z1)};
}

/// Lengths at which a ray enters and leaves a box; enter > leave if it passes by.
struct Passage {
    double enter;
    double leave;
};

Passage pass(const Box& box, const Vector3d& origin, const Vector3d& direction) {
    const Eigen::Array3d to_min = (box.min() - origin).array() / direction.array();
    const Eigen::Array3d to_max = (box.max() - origin).array() / direction.array();
    return {to_min.min(to_max).maxCoeff(), to_min.max(to_max).minCoeff()};
}

double cast_ray(const SimulatedRoom& room, const Vector3d& origin, const Vector3d& direction) {
    double length = 0.0;
    for (bool is_further = true; is_further;) {
        is_further = false;
        for (const Box& air : room.air) {
            const Passage passage = pass(air, origin, direction);
            if (passage.enter > length + 1e-9 || passage.leave <= length + 1e-9) continue;
            length = passage.leave;
            is_further = true;
        }
    }
    for (const Box& solid : room.solids) {
        const Passage passage = pass(solid, origin, direction);
        if (passage.enter > 0.0 && passage.enter <= passage.leave) {
            length = std::min(length, passage.enter);
        }
    }
    return length;
}

}  // namespace

Vector3d random_direction(Random& random) {
    const Vector3d direction(random.normal(), random.normal(), random.normal());
    return direction.normalized();
}

Transform random_transform(Random& random, double max_shift) {
    Transform transform = Transform::Identity();
    const Eigen::Quaterniond turn(random.normal(), random.normal(), random.normal(),
                                  random.normal());
    transform.linear() = turn.normalized().toRotationMatrix();
    for (double& coordinate : transform.translation()) {
        coordinate = random.uniform(-max_shift, max_shift);
    }
    return transform;
}

Transform small_transform(Random& random, double angle, double shift) {
    Transform transform = Transform::Identity();
    transform.linear() = Eigen::AngleAxisd(angle, random_direction(random)).toRotationMatrix();
    transform.translation() = shift * random_direction(random);
    return transform;
}

std::vector<Eigen::Vector3f> random_points(Random& random, std::size_t count, double half_size) {
    std::vector<Eigen::Vector3f> points(count);
    for (Eigen::Vector3f& point : points) {
        for (float& coordinate : point) {
            coordinate = static_cast<float>(random.uniform(-half_size, half_size));
        }
    }
    return points;
}

std::vector<Eigen::Vector3f> grid_points(std::size_t rows, std::size_t columns, double spacing) {
    std::vector<Eigen::Vector3f> points;
    for (std::size_t row = 0; row < rows; ++row) {
        for (std::size_t column = 0; column < columns; ++column) {
            points.emplace_back(static_cast<float>(spacing * static_cast<double>(column)),
                                static_cast<float>(spacing * static_cast<double>(row)), 0.0F);
        }
    }
    return points;
}

void add_noise(std::vector<Eigen::Vector3f>& points, double deviation, Random& random) {
    for (Eigen::Vector3f& point : points) {
        for (float& coordinate : point) {
            coordinate += static_cast<float>(deviation * random.normal());
        }
    }
}

std::vector<Eigen::Vector3f> transformed(const std::vector<Eigen::Vector3f>& points,
                                         const Transform& target_from_source) {
    std::vector<Eigen::Vector3f> moved;
    moved.reserve(points.size());
    for (const Eigen::Vector3f& point : points) {
        moved.emplace_back((target_from_source * point.cast<double>()).cast<float>());
    }
    return moved;
}

SimulatedRoom l_shaped_room() {
    return {.air = {box(0.0, 0.0, 0.0, 6.0, 3.0, 2.6), box(0.0, 2.9, 0.0, 2.5, 5.0, 2.6),
                    box(4.2, -0.2, 0.0, 5.1, 0.1, 2.0), box(-0.15, 1.0, 0.9, 0.1, 2.2, 2.1)},
            .solids = {box(2.4, 0.7, 0.71, 3.8, 1.5, 0.75), box(2.4, 0.7, 0.0, 2.46, 1.5, 0.71),
                       box(3.74, 0.7, 0.0, 3.8, 1.5, 0.71), box(5.4, 1.6, 0.0, 6.0, 3.0, 2.1),
                       box(0.0, 4.65, 0.0, 1.2, 5.0, 1.7), box(1.6, 3.6, 0.0, 2.5, 4.6, 0.5),
                       box(0.1, 0.3, 0.0, 0.5, 0.8, 0.9), box(3.0, 2.6, 0.0, 3.4, 3.0, 1.2),
                       box(2.9, 1.7, 0.42, 3.3, 2.1, 0.46), box(2.9, 2.06, 0.46, 3.3, 2.1, 0.9)}};
}

SimulatedRoom other_room() {
    return {.air = {box(0.0, 0.0, 0.0, 4.1, 3.2, 2.9), box(1.5, 3.1, 0.0, 3.5, 3.4, 2.3)},
            .solids = {box(0.0, 0.0, 0.0, 0.4, 2.0, 2.4), box(3.2, 0.0, 0.0, 4.1, 1.2, 0.8),
                       box(1.4, 0.5, 1.0, 2.2, 0.9, 1.1), box(3.6, 2.2, 0.0, 4.1, 2.5, 2.9),
                       box(0.6, 2.6, 0.0, 1.3, 3.2, 0.35)}};
}

Scan simulate_scan(const SimulatedRoom& room, const Transform& room_from_scan, std::uint64_t seed,
                   const ScannerPattern& pattern) {
    constexpr double lowest = radians(-85.0);
    constexpr double highest = radians(85.0);
    Random random(seed);
    Scan scan;
    scan.cloud.positions.reserve(pattern.rows * pattern.columns);
    for (std::size_t row = 0; row < pattern.rows; ++row) {
        const double elevation = lowest + (highest - lowest) * static_cast<double>(row) /
                                              static_cast<double>(pattern.rows - 1);
        for (std::size_t column = 0; column < pattern.columns; ++column) {
            const double azimuth = 2.0 * std::numbers::pi * static_cast<double>(column) /
                                   static_cast<double>(pattern.columns);
            const Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                     std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
            const double length =
                cast_ray(room, room_from_scan.translation(), room_from_scan.linear() * direction) +
                pattern.noise * random.normal();
            scan.cloud.positions.emplace_back((length * direction).cast<float>());
        }
    }
    return scan;
}

}  // namespace roomscribe::test
