// SPDX-License-Identifier: MIT
#include "roomscribe/model/scan.hpp"

#include <algorithm>
#include <limits>

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

}  // namespace

ScanMap merge_scans(std::span<const Scan> scans,
                    std::span<const std::optional<Transform>> map_from_scan) {
    if (scans.size() != map_from_scan.size()) {
        throw InvalidArgument("map_from_scan", std::to_string(map_from_scan.size()) + " poses",
                              "one pose per scan");
    }
    ScanMap map;
    map.cloud.channels = common_channels(scans);
    const bool with_normals = all_have(scans, &PointCloud::normals);
    const bool with_colors = all_have(scans, &PointCloud::colors);
    const bool with_intensities = all_have(scans, &PointCloud::intensities);
    if (!scans.empty()) map.cloud.global_shift = scans.front().cloud.global_shift;

    for (std::size_t i = 0; i < scans.size(); ++i) {
        const Scan& scan = scans[i];
        MapSection section{scan.name, static_cast<std::uint32_t>(map.cloud.size()),
                           static_cast<std::uint32_t>(scan.cloud.size()), std::nullopt,
                           scan.cloud.global_shift};
        PointCloud placed = scan.cloud;
        if (map_from_scan[i]) {
            transform_in_place(placed, *map_from_scan[i]);
            section.sensor_position = *map_from_scan[i] * scan.sensor_position();
            section.sensor_axes = map_from_scan[i]->linear() * scan.sensor_axes();
        } else {
            make_missing(placed);
        }
        append(map.cloud.positions, placed.positions);
        if (with_normals) append(map.cloud.normals, placed.normals);
        if (with_colors) append(map.cloud.colors, placed.colors);
        if (with_intensities) append(map.cloud.intensities, placed.intensities);
        for (Channel& channel : map.cloud.channels) {
            for (const Channel& part : placed.channels) {
                if (same_channel(channel, part)) append(channel.values, part.values);
            }
        }
        map.sections.push_back(std::move(section));
    }
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
