// SPDX-License-Identifier: MIT
#include "roomscribe/pipeline/memory_need.hpp"

namespace roomscribe {
namespace {

template <typename Value>
std::size_t bytes_of(const std::vector<Value>& values) {
    return values.size() * sizeof(Value);
}

}  // namespace

std::size_t memory_of(const PointCloud& cloud) {
    std::size_t bytes = bytes_of(cloud.positions) + bytes_of(cloud.normals) +
                        bytes_of(cloud.colors) + bytes_of(cloud.intensities);
    for (const Channel& channel : cloud.channels)
        bytes += bytes_of(channel.values);
    return bytes;
}

std::size_t memory_need(std::span<const Scan> scans) {
    // The map holds what the scans held. Beside it, planes are the stage that holds most: per point
    // its voxel, nearest patch, and place in a patch, layer and surface, 4 bytes each, once more
    // while one list becomes the next.
    constexpr std::size_t bytes_per_point = 28;
    // Program, surface sample, patches and pictures, which do not grow with the points.
    constexpr std::size_t fixed = std::size_t{400} << 20U;
    std::size_t need = fixed;
    for (const Scan& scan : scans) {
        need += memory_of(scan.cloud) + bytes_per_point * scan.cloud.size();
    }
    return need;
}

}  // namespace roomscribe
