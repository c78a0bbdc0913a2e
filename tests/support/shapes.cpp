// SPDX-License-Identifier: MIT
#include "support/shapes.hpp"

namespace roomscribe::test {

using Eigen::Vector3d;

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

}  // namespace roomscribe::test
