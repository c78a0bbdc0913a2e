// SPDX-License-Identifier: MIT
#include "roomscribe/pipeline/labelled_inputs.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "roomscribe/core/error.hpp"
#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/e57.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "roomscribe/pipeline/workspace.hpp"

namespace roomscribe {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 3> channel_names{"label", "instance", "confidence"};

[[noreturn]] void fail(const fs::path& path, std::string_view reason) {
    throw IoError(path.string(), "result", {}, reason,
                  "run roomscribe again on the files as they are now");
}

/// Paths of the scans, in input order, each with the hash that it had.
std::vector<FileRecord> scans_of_run(const fs::path& path) {
    if (!fs::exists(path)) fail(path, "is not there");
    const MappedFile file(path, "run JSON");
    const nlohmann::json json = nlohmann::json::parse(file.text(), nullptr, false);
    std::vector<FileRecord> scans;
    try {
        for (const nlohmann::json& input : json.at("inputs")) {
            if (input.at("role") != file_role_name(FileRole::scan)) continue;
            scans.push_back({input.at("path").get<std::string>(), input.at("size"),
                             std::stoull(input.at("xxh64").get<std::string>(), nullptr, 16)});
        }
    } catch (const std::exception&) {
        fail(path, "does not say which scans were read");
    }
    return scans;
}

/// The labels of all points, as labels.ply has them.
std::vector<Channel> read_label_channels(const fs::path& path, const Context& context) {
    PointCloud map = read_scan(path, context).cloud;
    std::vector<Channel> labels;
    for (const std::string_view name : channel_names) {
        const auto found =
            std::find_if(map.channels.begin(), map.channels.end(),
                         [name](const Channel& channel) { return channel.name == name; });
        if (found == map.channels.end()) fail(path, fmt::format("has no property {}", name));
        labels.push_back(std::move(*found));
    }
    return labels;
}

std::size_t num_values(const Channel& channel) {
    return channel.values.size() / channel.bytes_per_point();
}

std::string free_name(const PointCloud& cloud, std::string_view wanted) {
    std::string name(wanted);
    while (std::any_of(cloud.channels.begin(), cloud.channels.end(),
                       [&name](const Channel& channel) { return channel.name == name; })) {
        name.insert(0, "roomscribe_");
    }
    return name;
}

/// Gives a scan the labels of its points, which begin with the `first`.
void add_labels(PointCloud& cloud, const std::vector<Channel>& labels, std::size_t first) {
    for (const Channel& all : labels) {
        Channel own{free_name(cloud, all.name), all.type, all.count, {}};
        const auto begin =
            all.values.begin() + static_cast<std::ptrdiff_t>(first * all.bytes_per_point());
        own.values.assign(
            begin, begin + static_cast<std::ptrdiff_t>(cloud.size() * all.bytes_per_point()));
        cloud.channels.push_back(std::move(own));
    }
}

std::string lower_extension(const fs::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

/// What the copy is called: as the file, where its format can hold labels.
fs::path name_of_copy(const fs::path& path, std::size_t num_scans) {
    constexpr std::array<std::string_view, 7> of_one_scan{".pcd", ".ply", ".las", ".xyz",
                                                          ".txt", ".asc", ".csv"};
    const fs::path file = path.has_filename() ? path : path.parent_path();
    const std::string extension = lower_extension(file);
    const bool stays =
        std::find(of_one_scan.begin(), of_one_scan.end(), extension) != of_one_scan.end();
    if (extension == ".e57" || (stays && num_scans == 1)) return file.filename();
    return file.stem().string() + (num_scans == 1 ? ".ply" : ".e57");
}

/// Files of one name from several folders are told apart by a number.
fs::path unused_path(const fs::path& path, const std::vector<fs::path>& used) {
    fs::path free = path;
    for (int i = 2; std::find(used.begin(), used.end(), free) != used.end(); ++i) {
        free = path;
        free.replace_filename(
            fmt::format("{}-{}{}", path.stem().string(), i, path.extension().string()));
    }
    return free;
}

}  // namespace

std::vector<fs::path> write_labelled_inputs(const fs::path& result, const fs::path& output,
                                            const Context& context) {
    const std::vector<FileRecord> inputs = scans_of_run(result / "run.json");
    const std::vector<Channel> labels = read_label_channels(result / "labels.ply", context);
    const std::size_t num_labelled = num_values(labels.front());
    std::size_t first = 0;
    std::vector<fs::path> written;
    for (const FileRecord& input : inputs) {
        context.throw_if_cancelled();
        if (describe_input(input.path).xxh64 != input.xxh64)
            fail(input.path, "has changed since it was labelled");
        std::vector<StoredScan> scans = read_scans(input.path, context);
        for (StoredScan& stored : scans) {
            if (stored.scan.cloud.size() > num_labelled - first)
                fail(input.path, "has more points than labels.ply");
            add_labels(stored.scan.cloud, labels, first);
            first += stored.scan.cloud.size();
        }
        const fs::path path = unused_path(output / name_of_copy(input.path, scans.size()), written);
        if (lower_extension(path) == ".e57") {
            write_e57(path, scans, context);
        } else {
            write_point_cloud(path, scans.front().scan.cloud, {}, context);
        }
        written.push_back(path);
    }
    if (first != num_labelled) fail(result / "labels.ply", "has more points than the scans");
    return written;
}

}  // namespace roomscribe
