// SPDX-License-Identifier: MIT
#pragma once

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "roomscribe/core/random.hpp"
#include "roomscribe/geometry/point_cloud.hpp"

namespace roomscribe::test {

inline void write_bytes(const std::filesystem::path& path, std::string_view bytes) {
    // Some file systems flush a file that is cut to nothing and written again: slow, in a loop.
    std::filesystem::remove(path);
    std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<long>(bytes.size()));
}

inline std::string read_bytes(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

inline const Channel* find_channel(const PointCloud& cloud, std::string_view name) {
    for (const Channel& channel : cloud.channels) {
        if (channel.name == name) return &channel;
    }
    return nullptr;
}

inline float random_float(Random& random) {
    return static_cast<float>(random.uniform(-50.0, 50.0));
}

/// A channel of any bits; of floating types, numbers, because NaN has many bits and one text.
inline Channel random_channel(Random& random, std::string name, ScalarType type, std::size_t count,
                              std::size_t num_points) {
    Channel channel{std::move(name), type, count, {}};
    channel.values.resize(num_points * channel.bytes_per_point());
    std::byte* target = channel.values.data();
    for (std::size_t i = 0; i < num_points * count; ++i, target += size_of(type)) {
        if (type == ScalarType::float32) {
            const float value = random_float(random);
            std::memcpy(target, &value, sizeof(value));
        } else if (type == ScalarType::float64) {
            const double value = random.uniform(-1e9, 1e9);
            std::memcpy(target, &value, sizeof(value));
        } else {
            const std::uint64_t bits = random.next();
            std::memcpy(target, &bits, size_of(type));
        }
    }
    return channel;
}

/// Points with NaN and infinite ones among them.
inline PointCloud random_positions(Random& random, std::size_t num_points) {
    PointCloud cloud;
    for (std::size_t i = 0; i < num_points; ++i) {
        cloud.positions.emplace_back(random_float(random), random_float(random),
                                     random_float(random));
        if (random.below(8) == 0) {
            cloud.positions.back().setConstant(std::numeric_limits<float>::quiet_NaN());
        }
        if (random.below(16) == 0) {
            cloud.positions.back().x() = -std::numeric_limits<float>::infinity();
        }
    }
    return cloud;
}

/// Everything that a cloud can carry; `seed` also decides what it has.
inline PointCloud random_cloud(std::uint64_t seed, std::span<const ScalarType> channel_types) {
    Random random(seed);
    const std::size_t rows = 1 + random.below(6);
    const std::size_t columns = 1 + random.below(40);
    const std::size_t num_points = random.below(10) == 0 ? 0 : rows * columns;
    PointCloud cloud = random_positions(random, num_points);
    if (random.below(2) == 0) {
        for (std::size_t i = 0; i < num_points; ++i) {
            cloud.normals.emplace_back(random_float(random), random_float(random),
                                       random_float(random));
        }
    }
    if (random.below(2) == 0) {
        for (std::size_t i = 0; i < num_points; ++i) {
            const std::uint64_t bits = random.next();
            cloud.colors.push_back({static_cast<std::uint8_t>(bits),
                                    static_cast<std::uint8_t>(bits >> 8U),
                                    static_cast<std::uint8_t>(bits >> 16U)});
        }
    }
    if (random.below(2) == 0) {
        for (std::size_t i = 0; i < num_points; ++i) {
            cloud.intensities.push_back(random_float(random));
        }
    }
    for (std::size_t i = random.below(3); i > 0; --i) {
        const auto pick = random.below(static_cast<std::uint32_t>(channel_types.size()));
        cloud.channels.push_back(random_channel(random, "extra" + std::to_string(i),
                                                channel_types[pick], 1, num_points));
    }
    if (random.below(2) == 0 && num_points > 0 && rows > 1) cloud.grid = ScanGrid{rows, columns};
    if (random.below(2) == 0) {
        cloud.sensor_pose = Transform(
            Eigen::Translation3d(random.uniform(), 2.0, -3.0) *
            Eigen::AngleAxisd(random.uniform(0.1, 3.0), Eigen::Vector3d(1, 2, 3).normalized()));
    }
    return cloud;
}

/// The same bits in two arrays, except that NaN equals NaN.
template <typename Value>
bool same_bits(const std::vector<Value>& a, const std::vector<Value>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Value)) == 0);
}

}  // namespace roomscribe::test
