// SPDX-License-Identifier: MIT
#include "roomscribe/model/scan.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "roomscribe/core/error.hpp"

namespace roomscribe {
namespace {

template <typename Value>
void append(std::vector<Value>& all, const std::vector<Value>& part) {
    all.insert(all.end(), part.begin(), part.end());
}

template <typename Member>
bool all_have(std::span<const Scan> scans, Member member) {
    return std::all_of(scans.begin(), scans.end(), [member](const Scan& scan) {
        return (scan.cloud.*member).size() == scan.cloud.size();
    });
}

bool same_channel(const Channel& a, const Channel& b) {
    return a.name == b.name && a.type == b.type && a.count == b.count;
}

/// The channels that every scan has, still without values.
std::vector<Channel> common_channels(std::span<const Scan> scans) {
    std::vector<Channel> common;
    if (scans.empty()) return common;
    for (const Channel& channel : scans.front().cloud.channels) {
        const bool everywhere =
            std::all_of(scans.begin(), scans.end(), [&channel](const Scan& scan) {
                const auto& channels = scan.cloud.channels;
                return std::any_of(channels.begin(), channels.end(), [&](const Channel& other) {
                    return same_channel(channel, other);
                });
            });
        if (everywhere) common.push_back({channel.name, channel.type, channel.count, {}});
    }
    return common;
}

void make_missing(PointCloud& cloud) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    std::fill(cloud.positions.begin(), cloud.positions.end(), Eigen::Vector3f(nan, nan, nan));
}

void check_poses(std::span<const Scan> scans,
                 std::span<const std::optional<Transform>> map_from_scan) {
    if (scans.size() == map_from_scan.size()) return;
    throw InvalidArgument("map_from_scan", std::to_string(map_from_scan.size()) + " poses",
                          "one pose per scan");
}

/// A map with room for the scans and with the properties that all of them have.
ScanMap empty_map(std::span<const Scan> scans) {
    std::size_t size = 0;
    for (const Scan& scan : scans)
        size += scan.cloud.size();
    ScanMap map;
    map.cloud.positions.reserve(size);
    if (all_have(scans, &PointCloud::normals)) map.cloud.normals.reserve(size);
    if (all_have(scans, &PointCloud::colors)) map.cloud.colors.reserve(size);
    if (all_have(scans, &PointCloud::intensities)) map.cloud.intensities.reserve(size);
    map.cloud.channels = common_channels(scans);
    for (Channel& channel : map.cloud.channels)
        channel.values.reserve(size * channel.bytes_per_point());
    if (!scans.empty()) map.cloud.global_shift = scans.front().cloud.global_shift;
    return map;
}

/// Takes from a scan what the map has room for.
void append_scan(Scan scan, const std::optional<Transform>& map_from_scan, ScanMap& map) {
    PointCloud& cloud = scan.cloud;
    MapSection section{scan.name, static_cast<std::uint32_t>(map.cloud.size()),
                       static_cast<std::uint32_t>(cloud.size()), std::nullopt, cloud.global_shift};
    if (map_from_scan) {
        section.sensor_position = *map_from_scan * scan.sensor_position();
        section.sensor_axes = map_from_scan->linear() * scan.sensor_axes();
        section.sensor_is_assumed = !cloud.sensor_pose;
        transform_in_place(cloud, *map_from_scan);
    } else {
        make_missing(cloud);
    }
    append(map.cloud.positions, cloud.positions);
    if (map.cloud.normals.capacity() > 0) append(map.cloud.normals, cloud.normals);
    if (map.cloud.colors.capacity() > 0) append(map.cloud.colors, cloud.colors);
    if (map.cloud.intensities.capacity() > 0) append(map.cloud.intensities, cloud.intensities);
    for (Channel& channel : map.cloud.channels) {
        for (const Channel& part : cloud.channels) {
            if (same_channel(channel, part)) append(channel.values, part.values);
        }
    }
    map.sections.push_back(std::move(section));
}

}  // namespace

ScanMap merge_scans(std::span<const Scan> scans,
                    std::span<const std::optional<Transform>> map_from_scan) {
    check_poses(scans, map_from_scan);
    ScanMap map = empty_map(scans);
    for (std::size_t i = 0; i < scans.size(); ++i)
        append_scan(scans[i], map_from_scan[i], map);
    return map;
}

ScanMap merge_scans(std::vector<Scan>&& scans,
                    std::span<const std::optional<Transform>> map_from_scan) {
    check_poses(scans, map_from_scan);
    ScanMap map = empty_map(scans);
    for (std::size_t i = 0; i < scans.size(); ++i)
        append_scan(std::exchange(scans[i], {}), map_from_scan[i], map);
    return map;
}

ScanMap map_of_cloud(Scan scan) {
    ScanMap map;
    MapSection section{std::move(scan.name), 0, static_cast<std::uint32_t>(scan.cloud.size()),
                       std::nullopt, scan.cloud.global_shift};
    if (scan.cloud.sensor_pose) {
        section.sensor_position = scan.sensor_position();
        section.sensor_axes = scan.sensor_axes();
    }
    map.cloud = std::move(scan.cloud);
    map.sections.push_back(std::move(section));
    return map;
}

}  // namespace roomscribe
