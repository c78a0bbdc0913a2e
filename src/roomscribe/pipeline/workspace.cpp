// SPDX-License-Identifier: MIT
#include "roomscribe/pipeline/workspace.hpp"

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "roomscribe/core/error.hpp"
#include "roomscribe/export/json.hpp"
#include "roomscribe/io/atomic_file.hpp"
#include "roomscribe/io/ply.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "roomscribe/io/poses_io.hpp"
#include "roomscribe/pipeline/file_coordinates.hpp"
#include "roomscribe/pipeline/file_hash.hpp"

namespace roomscribe {
namespace {

using Json = nlohmann::ordered_json;

template <typename Value>
ChannelView view_of(std::string_view name, ScalarType type, const std::vector<Value>& values) {
    return {name, type, std::as_bytes(std::span(values))};
}

void write_labelled(const std::filesystem::path& path, const PointCloud& cloud,
                    const PointLabels& labels, const Context& context) {
    const std::size_t size = cloud.size();
    if (labels.labels.size() != size || labels.instances.size() != size ||
        labels.confidences.size() != size) {
        throw InvalidArgument("labels", fmt::format("{} labels", labels.labels.size()),
                              fmt::format("one per point of the map, {}", size));
    }
    // The input may have properties of these names, a truth say: they are carried through renamed.
    const std::array<ChannelView, 3> more{
        view_of("label", ScalarType::uint8, labels.labels),
        view_of("instance", ScalarType::int32, labels.instances),
        view_of("confidence", ScalarType::float32, labels.confidences)};
    write_ply(path, cloud, more, Encoding::binary, context);
}

/// "registration.icp.max_iterations" becomes an object in an object.
Json nested_settings(std::span<const SettingEntry> settings) {
    Json nested = Json::object();
    for (const SettingEntry& setting : settings) {
        std::string pointer = "/" + setting.name;
        std::replace(pointer.begin(), pointer.end(), '.', '/');
        const Json value =
            setting.is_text ? Json(setting.value) : Json::parse(setting.value, nullptr, false);
        nested[Json::json_pointer(pointer)] = value.is_discarded() ? Json(setting.value) : value;
    }
    return nested;
}

Json files_json(std::span<const FileRecord> files) {
    Json json = Json::array();
    for (const FileRecord& file : files) {
        json.push_back({{"path", file.path},
                        {"role", file_role_name(file.role)},
                        {"size", file.size},
                        {"xxh64", fmt::format("{:016x}", file.xxh64)}});
    }
    return json;
}

[[noreturn]] void refuse_folder(const std::filesystem::path& folder, std::string_view reason) {
    throw IoError(folder.string(), "output folder", {}, reason,
                  "choose a folder that you may write to");
}

}  // namespace

std::string_view file_role_name(FileRole role) {
    switch (role) {
        case FileRole::scan:
            return "scan";
        case FileRole::poses:
            return "poses";
        case FileRole::corrections:
            return "corrections";
        case FileRole::result:
            break;
    }
    return "result";
}

FileRecord describe_input(const std::filesystem::path& path, FileRole role) {
    std::error_code error;
    const std::filesystem::path file = index_of_scans(path);
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (error) {
        throw IoError(path.string(), "", {}, error.message(), "check the path and its permissions");
    }
    return {path.string(), size, hash_file(file), role};
}

std::vector<FileRecord> describe_results(const std::filesystem::path& folder) {
    std::vector<FileRecord> results;
    for (const char* name :
         {"poses.txt", "registration.json", "map.ply", "labels.ply", "scene.json"}) {
        if (!std::filesystem::exists(folder / name)) continue;
        results.push_back(describe_input(folder / name, FileRole::result));
        results.back().path = name;
    }
    return results;
}

void prepare_output_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) refuse_folder(folder, error.message());
    if (!std::filesystem::is_directory(folder, error)) refuse_folder(folder, "is not a folder");
    remove_abandoned_files(folder);
    // Never committed: it only shows, before hours of work, that a file can be made here.
    const AtomicFile trial(folder / "run.json", "JSON");
}

std::string folder_of_apart(std::size_t i) {
    return fmt::format("set-{}", i + 2);
}

void remove_apart_from(const std::filesystem::path& folder, std::size_t count) {
    // Whatever else has such a name is not ours.
    for (std::size_t i = count; exists(folder / folder_of_apart(i) / "run.json"); ++i) {
        const std::filesystem::path own = folder / folder_of_apart(i);
        if (!exists(own / "corrections.json")) {
            remove_all(own);
            continue;
        }
        std::vector<std::filesystem::path> ours;
        for (const auto& entry : std::filesystem::directory_iterator(own))
            if (entry.path().filename() != "corrections.json") ours.push_back(entry.path());
        for (const std::filesystem::path& path : ours)
            remove_all(path);
    }
}

void write_registration(const std::filesystem::path& folder, const Reconstruction& reconstruction,
                        const Context& context) {
    const std::vector<MapSection>& sections = reconstruction.map.sections;
    const std::size_t num_poses =
        reconstruction.registration ? reconstruction.registration->map_from_scan.size() : 0;
    if (num_poses != sections.size()) {
        throw InvalidArgument("registration", fmt::format("{} poses", num_poses),
                              fmt::format("one per scan of the map, {}", sections.size()));
    }
    const Registration& registration = *reconstruction.registration;
    const PointCloud& map = reconstruction.map.cloud;
    std::vector<std::string> names;
    std::vector<std::optional<Transform>> poses = registration.map_from_scan;
    for (std::size_t i = 0; i < sections.size(); ++i) {
        names.push_back(sections[i].name);
        if (!poses[i]) continue;
        poses[i] = in_file_coordinates(*poses[i], map.global_shift, sections[i].scan_shift);
    }
    write_poses(folder / "poses.txt", poses);
    write_file(folder / "registration.json", "JSON", registration_to_json(registration, names));
    write_point_cloud(folder / "map.ply", map, {.encoding = Encoding::binary}, context);
}

void write_interpretation(const std::filesystem::path& folder, const Reconstruction& reconstruction,
                          const Context& context) {
    const PointCloud& map = reconstruction.map.cloud;
    write_labelled(folder / "labels.ply", map, reconstruction.labels, context);
    write_file(folder / "scene.json", "JSON",
               scene_to_json(in_file_coordinates(reconstruction.scene, map.global_shift)));
}

std::string run_to_json(const RunRecord& record, const Reconstruction& reconstruction) {
    Json json;
    json["format"] = "roomscribe-run";
    json["version"] = 1;
    json["program_version"] = record.version;
    json["command"] = record.command;
    json["threads"] = record.num_threads;
    json["inputs"] = files_json(record.inputs);
    json["results"] = files_json(record.results);
    json["settings"] = nested_settings(record.settings);
    json["derived_values"] = Json::array();
    for (const DerivedValue& derived : reconstruction.derived_values) {
        json["derived_values"].push_back({{"name", derived.name},
                                          {"value", derived.value},
                                          {"unit", derived.unit},
                                          {"reason", derived.reason}});
    }
    json["stages"] = Json::array();
    for (const StageCost& cost : reconstruction.stage_costs) {
        json["stages"].push_back(
            {{"stage", cost.stage}, {"seconds", cost.seconds}, {"peak_memory", cost.peak_memory}});
    }
    return lay_out_json(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

void write_run_record(const std::filesystem::path& folder, const RunRecord& record,
                      const Reconstruction& reconstruction) {
    write_file(folder / "run.json", "JSON", run_to_json(record, reconstruction));
}

}  // namespace roomscribe
