// SPDX-License-Identifier: MIT
#include "roomscribe/pipeline/truth_folder.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <system_error>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/evaluation/protocol.hpp"
#include "roomscribe/export/json.hpp"
#include "roomscribe/io/atomic_file.hpp"
#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/npy.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "roomscribe/io/poses_io.hpp"
#include "roomscribe/pipeline/file_coordinates.hpp"

namespace roomscribe {
namespace {

namespace fs = std::filesystem;

std::string scan_name(std::size_t number) {
    return fmt::format("{:03}", number);
}

std::vector<std::uint8_t> bytes_of(std::span<const Label> labels) {
    std::vector<std::uint8_t> bytes(labels.size());
    std::transform(labels.begin(), labels.end(), bytes.begin(),
                   [](Label label) { return static_cast<std::uint8_t>(label); });
    return bytes;
}

void check_sizes(const GroundTruth& truth, std::span<const Scan> scans) {
    std::size_t num_points = 0;
    for (const Scan& scan : scans)
        num_points += scan.cloud.size();
    const auto require = [](const char* what, std::size_t size, std::size_t expected) {
        if (size == expected) return;
        throw InvalidArgument(what, fmt::format("{} entries", size), fmt::format("{}", expected));
    };
    require("truth.map_from_scan", truth.map_from_scan.size(), scans.size());
    require("truth.map", truth.map.cloud.size(), num_points);
    require("truth.labels", truth.labels.size(), num_points);
    require("truth.instances", truth.instances.size(), num_points);
    require("truth.acceptable", truth.acceptable.size(), num_points);
}

void make_folders(const fs::path& folder) {
    for (const char* name : {"scans", "truth"}) {
        std::error_code error;
        fs::create_directories(folder / name, error);
        if (!error) continue;
        throw IoError((folder / name).string(), "truth folder", {}, error.message(),
                      "choose a folder that you may write to");
    }
}

[[noreturn]] void fail(const fs::path& path, std::string_view reason) {
    throw IoError(path.string(), "truth folder", {}, reason,
                  "see \"Truth folders\" in docs/formats.md");
}

template <typename Value>
std::vector<Value> read_per_point(const fs::path& path, std::size_t num_points) {
    std::vector<Value> values = read_npy<Value>(path);
    if (values.size() != num_points) {
        fail(path, fmt::format("has {} elements for the {} points of map.ply", values.size(),
                               num_points));
    }
    return values;
}

std::vector<Label> read_labels(const fs::path& path, std::size_t num_points) {
    std::vector<Label> labels;
    labels.reserve(num_points);
    for (const std::uint8_t id : read_per_point<std::uint8_t>(path, num_points)) {
        if (id >= num_labels) fail(path, fmt::format("{} is not a label", id));
        labels.push_back(static_cast<Label>(id));
    }
    return labels;
}

std::vector<Transform> read_true_poses(const fs::path& path, const Context& context) {
    std::vector<Transform> poses;
    for (const std::optional<Transform>& pose : read_poses(path, context)) {
        if (!pose) fail(path, fmt::format("scan {} has no pose", poses.size()));
        poses.push_back(*pose);
    }
    return poses;
}

/// A folder that held more scans before would seem to hold them still.
void remove_scans_from(const fs::path& folder, std::size_t first) {
    std::error_code error;
    for (std::size_t i = first; !error; ++i) {
        const fs::path scan = folder / "scans" / (scan_name(i) + ".ply");
        const fs::path labels = folder / "truth" / (scan_name(i) + ".labels.npy");
        if (!fs::exists(scan) && !fs::exists(labels)) return;
        if (fs::remove(scan, error); !error) fs::remove(labels, error);
    }
    throw IoError((folder / "scans").string(), "truth folder", {}, error.message(),
                  "choose a folder that you may write to");
}

/// One section per scan if the sizes of all scans are known, else one for the whole map.
std::vector<MapSection> find_sections(const fs::path& truth_files,
                                      std::span<const Transform> map_from_scan,
                                      std::size_t num_points) {
    std::vector<MapSection> sections;
    std::uint32_t first = 0;
    for (std::size_t i = 0; i < map_from_scan.size(); ++i) {
        const fs::path path = truth_files / (scan_name(i) + ".labels.npy");
        if (!fs::exists(path)) break;
        const auto count = static_cast<std::uint32_t>(read_npy<std::uint8_t>(path).size());
        sections.push_back({.name = scan_name(i),
                            .first = first,
                            .count = count,
                            .sensor_position = map_from_scan[i].translation(),
                            .sensor_axes = map_from_scan[i].linear()});
        first += count;
    }
    if (sections.size() == map_from_scan.size() && first == num_points) return sections;
    if (sections.size() == map_from_scan.size()) {
        fail(truth_files, fmt::format("the labels of the scans are {} and map.ply has {} points",
                                      first, num_points));
    }
    return {{"map", 0, static_cast<std::uint32_t>(num_points), std::nullopt}};
}

std::vector<LabelSet> derive_acceptable(const GroundTruth& truth) {
    std::unordered_map<std::int32_t, std::string_view> kinds;
    for (const Component& component : truth.scene.components) {
        if (!component.kind.empty()) kinds.emplace(component.instance, component.kind);
    }
    std::vector<LabelSet> acceptable(truth.labels.size());
    for (std::size_t i = 0; i < acceptable.size(); ++i) {
        const auto kind = kinds.find(truth.instances[i]);
        acceptable[i] = kind == kinds.end() ? label_bit(truth.labels[i])
                                            : acceptable_labels(truth.labels[i], kind->second);
    }
    return acceptable;
}

std::vector<LabelSet> read_acceptable(const fs::path& path, const GroundTruth& truth) {
    if (!fs::exists(path)) return derive_acceptable(truth);
    std::vector<LabelSet> acceptable = read_per_point<LabelSet>(path, truth.labels.size());
    for (std::size_t i = 0; i < acceptable.size(); ++i)
        acceptable[i] = (acceptable[i] | label_bit(truth.labels[i])) & protocol::every_label;
    return acceptable;
}

}  // namespace

LabelSet acceptable_labels(Label label, std::string_view kind) {
    constexpr LabelSet wall = label_bit(Label::wall);
    constexpr LabelSet unknown = label_bit(Label::unknown);
    constexpr LabelSet ceiling = label_bit(Label::ceiling);
    constexpr LabelSet door_frame = label_bit(Label::door_frame);
    constexpr LabelSet window_frame = label_bit(Label::window_frame);
    constexpr std::array<std::pair<std::string_view, int>, 4> also_right{
        {{"column", wall | unknown},
         {"beam", ceiling | wall | unknown},
         {"lining", door_frame | wall},
         {"reveal", wall | window_frame}}};
    int labels = label_bit(label);
    for (const auto& [word, more] : also_right) {
        if (kind.find(word) != std::string_view::npos) labels |= more;
    }
    return static_cast<LabelSet>(labels);
}

void write_truth_folder(const fs::path& folder, const GroundTruth& truth,
                        std::span<const Scan> scans, const Context& context) {
    check_sizes(truth, scans);
    make_folders(folder);
    const fs::path truth_files = folder / "truth";
    const Eigen::Vector3d& map_shift = truth.map.cloud.global_shift;
    const std::vector<std::uint8_t> labels = bytes_of(truth.labels);
    const std::span<const std::uint8_t> all_labels(labels);

    std::vector<std::optional<Transform>> poses;
    std::size_t first = 0;
    for (std::size_t i = 0; i < scans.size(); ++i) {
        const PointCloud& cloud = scans[i].cloud;
        write_point_cloud(folder / "scans" / (scan_name(i) + ".ply"), cloud, {}, context);
        write_npy(truth_files / (scan_name(i) + ".labels.npy"),
                  all_labels.subspan(first, cloud.size()));
        first += cloud.size();
        poses.emplace_back(
            in_file_coordinates(truth.map_from_scan[i], map_shift, cloud.global_shift));
    }
    remove_scans_from(folder, scans.size());
    write_point_cloud(folder / "map.ply", truth.map.cloud, {}, context);
    write_poses(truth_files / "poses.txt", poses);
    write_npy(truth_files / "map.labels.npy", all_labels);
    write_npy(truth_files / "map.instances.npy", std::span<const std::int32_t>(truth.instances));
    write_npy(truth_files / "map.acceptable.npy", std::span<const LabelSet>(truth.acceptable));
    write_file(truth_files / "scene.json", "JSON",
               scene_to_json(in_file_coordinates(truth.scene, map_shift)));
}

GroundTruth read_truth_folder(const fs::path& folder, const Context& context) {
    const fs::path truth_files = folder / "truth";
    GroundTruth truth;
    truth.map.cloud = read_scan(folder / "map.ply", context).cloud;
    const std::size_t num_points = truth.map.cloud.size();
    truth.labels = read_labels(truth_files / "map.labels.npy", num_points);
    truth.instances = read_per_point<std::int32_t>(truth_files / "map.instances.npy", num_points);

    const Eigen::Vector3d file_to_memory = -truth.map.cloud.global_shift;
    const fs::path scene_path = truth_files / "scene.json";
    const MappedFile scene_file(scene_path, "scene JSON");
    truth.scene = in_file_coordinates(scene_from_json(scene_file.text(), scene_path.string()),
                                      file_to_memory);

    truth.map_from_scan = read_true_poses(truth_files / "poses.txt", context);
    for (Transform& pose : truth.map_from_scan)
        pose = in_file_coordinates(pose, file_to_memory, Eigen::Vector3d::Zero());
    truth.map.sections = find_sections(truth_files, truth.map_from_scan, num_points);
    truth.acceptable = read_acceptable(truth_files / "map.acceptable.npy", truth);
    return truth;
}

}  // namespace roomscribe
