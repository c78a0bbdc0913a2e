// SPDX-License-Identifier: MIT
#include "roomscribe/pipeline/result_folder.hpp"

#include <algorithm>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/export/json.hpp"
#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "roomscribe/io/poses_io.hpp"
#include "roomscribe/pipeline/file_coordinates.hpp"

namespace roomscribe {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, std::string_view reason, std::string_view cure) {
    throw IoError(path.string(), "result", {}, reason, cure);
}

template <typename Stored, typename Value>
std::vector<Value> values_as(const Channel& channel) {
    std::vector<Value> values(channel.values.size() / sizeof(Stored));
    for (std::size_t i = 0; i < values.size(); ++i) {
        Stored stored;
        std::memcpy(&stored, channel.values.data() + i * sizeof(Stored), sizeof(Stored));
        values[i] = static_cast<Value>(stored);
    }
    return values;
}

/// A channel of small integers, of any integer type but int8.
std::vector<std::int32_t> integers(const fs::path& path, const Channel& channel) {
    if (channel.count == 1) {
        switch (channel.type) {
            case ScalarType::uint8:
                return values_as<std::uint8_t, std::int32_t>(channel);
            case ScalarType::int16:
                return values_as<std::int16_t, std::int32_t>(channel);
            case ScalarType::uint16:
                return values_as<std::uint16_t, std::int32_t>(channel);
            case ScalarType::int32:
                return values_as<std::int32_t, std::int32_t>(channel);
            case ScalarType::uint32:
                return values_as<std::uint32_t, std::int32_t>(channel);
            default:
                break;
        }
    }
    fail(path,
         fmt::format("the property {} is not one integer of 8 (unsigned), 16 or 32 bits",
                     channel.name),
         "write it as int");
}

const Channel* find_channel(const PointCloud& cloud, std::string_view name) {
    const auto found = std::find_if(cloud.channels.begin(), cloud.channels.end(),
                                    [&](const Channel& channel) { return channel.name == name; });
    return found == cloud.channels.end() ? nullptr : &*found;
}

const Channel& require_channel(const fs::path& path, const PointCloud& cloud,
                               std::string_view name) {
    const Channel* channel = find_channel(cloud, name);
    if (channel == nullptr) {
        fail(path, fmt::format("has no property {}", name), "see docs/formats.md");
    }
    return *channel;
}

/// Registration moves points, so only their number can tell whether they are the same.
void require_points(const fs::path& path, std::size_t num_points, const GroundTruth& truth) {
    if (num_points == truth.map.cloud.size()) return;
    fail(path, fmt::format("has {} points and the truth {}", num_points, truth.map.cloud.size()),
         "give a result of the scans, or of the map, that the truth belongs to");
}

PointLabels labels_of(const fs::path& path, const PointCloud& cloud) {
    PointLabels labels;
    for (const std::int32_t id : integers(path, require_channel(path, cloud, "label"))) {
        if (id < 0 || id >= static_cast<std::int32_t>(num_labels))
            fail(path, fmt::format("{} is not a label", id), "see docs/formats.md");
        labels.labels.push_back(static_cast<Label>(id));
    }
    labels.instances = integers(path, require_channel(path, cloud, "instance"));
    const Channel* confidence = find_channel(cloud, "confidence");
    if (confidence != nullptr && confidence->type == ScalarType::float32 && confidence->count == 1)
        labels.confidences = values_as<float, float>(*confidence);
    return labels;
}

PointLabels read_point_labels(const fs::path& path, const GroundTruth& truth,
                              const Context& context) {
    const PointCloud cloud = read_scan(path, context).cloud;
    require_points(path, cloud.size(), truth);
    return labels_of(path, cloud);
}

std::vector<std::optional<Transform>> read_result_poses(const fs::path& path,
                                                        const GroundTruth& truth,
                                                        const Context& context) {
    std::vector<std::optional<Transform>> poses = read_poses(path, context);
    if (poses.size() != truth.map_from_scan.size()) {
        fail(path,
             fmt::format("has {} poses and the truth {} scans", poses.size(),
                         truth.map_from_scan.size()),
             "give a result of the scans that the truth belongs to");
    }
    for (std::optional<Transform>& pose : poses) {
        if (!pose) continue;
        pose = in_file_coordinates(*pose, -truth.map.cloud.global_shift, Eigen::Vector3d::Zero());
    }
    return poses;
}

std::vector<RegistrationLink> read_links(const fs::path& path, const GroundTruth& truth) {
    const MappedFile file(path, "registration JSON");
    std::vector<RegistrationLink> links = registration_from_json(file.text(), path.string()).links;
    for (const RegistrationLink& link : links) {
        const std::size_t last = std::max(link.source, link.target);
        if (last < truth.map_from_scan.size()) continue;
        fail(path, fmt::format("has a link of scan {}, which the truth does not have", last),
             "give a result of the scans that the truth belongs to");
    }
    return links;
}

}  // namespace

Prediction read_result_folder(const fs::path& folder, const GroundTruth& truth,
                              const Context& context) {
    const auto has = [&](const char* name) { return fs::exists(folder / name); };
    if (!fs::is_directory(folder)) {
        fail(folder, "there is no such folder", "give the output folder of roomscribe");
    }
    if (!has("labels.ply") && !has("scene.json") && !has("poses.txt")) {
        fail(folder, "holds neither labels.ply with scene.json nor poses.txt",
             "give the output folder of roomscribe run, register or interpret");
    }
    Prediction prediction;
    // A cloud that was labelled by hand knows nothing of scans.
    const bool knows_scans = !truth.map_from_scan.empty();
    if (knows_scans && has("poses.txt")) {
        prediction.map_from_scan = read_result_poses(folder / "poses.txt", truth, context);
    }
    if (knows_scans && has("registration.json")) {
        prediction.links = read_links(folder / "registration.json", truth);
    }
    if (has("labels.ply") || has("scene.json")) {
        prediction.labels = read_point_labels(folder / "labels.ply", truth, context);
        const fs::path scene_path = folder / "scene.json";
        const MappedFile file(scene_path, "scene JSON");
        prediction.scene = in_file_coordinates(scene_from_json(file.text(), scene_path.string()),
                                               -truth.map.cloud.global_shift);
    }
    return prediction;
}

Reconstruction read_reconstruction(const fs::path& folder, const Context& context) {
    const bool has_labels = fs::exists(folder / "labels.ply");
    const fs::path points_path = folder / (has_labels ? "labels.ply" : "map.ply");
    if (!fs::exists(points_path)) {
        fail(folder, "holds neither labels.ply nor map.ply",
             "give the output folder of roomscribe run, register or interpret");
    }
    Reconstruction reconstruction;
    reconstruction.map.cloud = read_scan(points_path, context).cloud;
    const PointCloud& cloud = reconstruction.map.cloud;
    if (!has_labels) return reconstruction;
    reconstruction.labels = labels_of(points_path, cloud);
    const fs::path scene_path = folder / "scene.json";
    const MappedFile file(scene_path, "scene JSON");
    reconstruction.scene =
        in_file_coordinates(scene_from_json(file.text(), scene_path.string()), -cloud.global_shift);
    return reconstruction;
}

GroundTruth read_labelled_cloud(const fs::path& path, const LabelConvention& convention,
                                const Context& context) {
    Scan scan = read_scan(path, context);
    const Channel* label = find_channel(scan.cloud, "label");
    if (label == nullptr) label = find_channel(scan.cloud, "class");
    if (label == nullptr) {
        fail(path, "has no property label", "give a cloud that was labelled by hand");
    }
    const Channel* instance = find_channel(scan.cloud, "instance");
    const std::vector<std::int32_t> classes = integers(path, *label);
    const std::vector<std::int32_t> instances =
        instance == nullptr ? std::vector<std::int32_t>() : integers(path, *instance);
    return truth_from_labelled_cloud(map_of_cloud(std::move(scan)), classes, instances, convention);
}

}  // namespace roomscribe
