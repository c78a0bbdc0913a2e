// SPDX-License-Identifier: MIT
#include "roomscribe/geometry/point_cloud.hpp"

#include <algorithm>
#include <cstring>

#include "roomscribe/core/quantile.hpp"

namespace roomscribe {
namespace {

template <typename Value>
std::vector<Value> select(const std::vector<Value>& values,
                          std::span<const std::uint32_t> indices) {
    std::vector<Value> selected;
    if (values.empty()) return selected;
    selected.reserve(indices.size());
    for (const std::uint32_t index : indices)
        selected.push_back(values[index]);
    return selected;
}

}  // namespace

std::size_t size_of(ScalarType type) {
    switch (type) {
        case ScalarType::int8:
        case ScalarType::uint8:
            return 1;
        case ScalarType::int16:
        case ScalarType::uint16:
            return 2;
        case ScalarType::int32:
        case ScalarType::uint32:
        case ScalarType::float32:
            return 4;
        case ScalarType::int64:
        case ScalarType::uint64:
        case ScalarType::float64:
            return 8;
    }
    return 0;
}

std::vector<std::uint32_t> finite_points(const PointCloud& cloud) {
    std::vector<std::uint32_t> indices;
    indices.reserve(cloud.size());
    for (std::uint32_t i = 0; i < cloud.size(); ++i) {
        if (is_finite(cloud.positions[i])) indices.push_back(i);
    }
    return indices;
}

PointCloud select_points(const PointCloud& cloud, std::span<const std::uint32_t> indices) {
    PointCloud selected;
    selected.positions = select(cloud.positions, indices);
    selected.normals = select(cloud.normals, indices);
    selected.colors = select(cloud.colors, indices);
    selected.intensities = select(cloud.intensities, indices);
    for (const Channel& channel : cloud.channels) {
        const std::size_t stride = channel.bytes_per_point();
        Channel copy{channel.name, channel.type, channel.count, {}};
        copy.values.resize(indices.size() * stride);
        for (std::size_t i = 0; i < indices.size(); ++i) {
            std::memcpy(&copy.values[i * stride], &channel.values[indices[i] * stride], stride);
        }
        selected.channels.push_back(std::move(copy));
    }
    selected.sensor_pose = cloud.sensor_pose;
    selected.global_shift = cloud.global_shift;
    return selected;
}

double median_distance(std::span<const Eigen::Vector3f> points) {
    constexpr std::size_t num_samples = 10000;
    const std::size_t step = std::max<std::size_t>(1, points.size() / num_samples);
    std::vector<Eigen::Vector3d> sample;
    for (std::size_t i = 0; i < points.size(); i += step) {
        if (is_finite(points[i])) sample.emplace_back(points[i].cast<double>());
    }
    if (sample.empty()) return 0.0;
    Eigen::Vector3d middle;
    std::vector<double> values(sample.size());
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        std::transform(sample.begin(), sample.end(), values.begin(),
                       [axis](const Eigen::Vector3d& point) { return point[axis]; });
        middle[axis] = median(values);
    }
    std::transform(sample.begin(), sample.end(), values.begin(),
                   [&](const Eigen::Vector3d& point) { return (point - middle).norm(); });
    return median(values);
}

void scale_in_place(PointCloud& cloud, double factor) {
    for (Eigen::Vector3f& point : cloud.positions)
        point = (factor * point.cast<double>()).cast<float>();
    if (cloud.sensor_pose) cloud.sensor_pose->translation() *= factor;
    cloud.global_shift *= factor;
}

void transform_in_place(PointCloud& cloud, const Transform& target_from_source) {
    for (Eigen::Vector3f& point : cloud.positions) {
        point = (target_from_source * point.cast<double>()).cast<float>();
    }
    const Eigen::Matrix3f rotation = target_from_source.linear().cast<float>();
    for (Eigen::Vector3f& normal : cloud.normals)
        normal = rotation * normal;
    if (cloud.sensor_pose) cloud.sensor_pose = target_from_source * *cloud.sensor_pose;
}

}  // namespace roomscribe
