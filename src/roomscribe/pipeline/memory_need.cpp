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
    // The map holds what the scans held. Beside it there are per point, at most at once, its voxel,
    // label, instance and confidence, 13 bytes, and lists of point numbers, of planes or of the
    // faces that handles are looked for on, 4 bytes an entry. Measured: 28, on 7 to 105 million
    // points.
    constexpr std::size_t bytes_per_point = 30;
    // Program, surface sample, patches and pictures, which do not grow with the points.
    constexpr std::size_t fixed = std::size_t{256} << 20U;
    std::size_t need = fixed;
    for (const Scan& scan : scans) {
        need += memory_of(scan.cloud) + bytes_per_point * scan.cloud.size();
    }
    return need;
}

}  // namespace roomscribe
