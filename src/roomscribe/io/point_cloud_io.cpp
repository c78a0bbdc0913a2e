// SPDX-License-Identifier: MIT
#include "roomscribe/io/point_cloud_io.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/depth_images.hpp"
#include "roomscribe/io/e57.hpp"
#include "roomscribe/io/file_contents.hpp"
#include "roomscribe/io/global_shift.hpp"
#include "roomscribe/io/las.hpp"
#include "roomscribe/io/npy.hpp"
#include "roomscribe/io/obj.hpp"
#include "roomscribe/io/pcd.hpp"
#include "roomscribe/io/ply.hpp"
#include "roomscribe/io/ptx.hpp"
#include "roomscribe/io/rosbag.hpp"
#include "roomscribe/io/text_points.hpp"
#include "roomscribe/io/tilted_scans.hpp"
#include "roomscribe/io/uos.hpp"
#include "roomscribe/io/vtk.hpp"

namespace roomscribe {
namespace {

/// Half the points of an indoor place lie nearer to its middle than this, in metres.
constexpr double largest_median_distance = 100.0;

bool is_text_extension(std::string_view extension) {
    return extension == ".xyz" || extension == ".txt" || extension == ".asc" || extension == ".csv";
}

std::string lower_extension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

std::vector<FileContents> read_contents(const std::filesystem::path& path, PointsAs as,
                                        const Context& context) {
    using ReadOne = FileContents (*)(const std::filesystem::path&, PointsAs, const Context&);
    using ReadAll =
        std::vector<FileContents> (*)(const std::filesystem::path&, PointsAs, const Context&);
    constexpr std::pair<std::string_view, ReadOne> single[] = {
        {".pcd", read_pcd},         {".ply", read_ply},         {".3d", read_uos},
        {".vtk", read_vtk},         {".las", read_las},         {".laz", read_las},
        {".pts", read_text_points}, {".xyz", read_text_points}, {".txt", read_text_points},
        {".asc", read_text_points}, {".csv", read_text_points}, {".npy", read_npy_points},
        {".obj", read_obj},         {".png", read_depth_image}, {".tilt", read_tilted_scans}};
    constexpr std::pair<std::string_view, ReadAll> several[] = {
        {".e57", read_e57}, {".ptx", read_ptx}, {".bag", read_rosbag}};
    if (std::filesystem::is_directory(path)) {
        const std::filesystem::path index = index_of_scans(path);
        if (index.filename() == tum_index) return read_tum_folder(path, as, context);
        if (index.filename() == frames_index) return read_frames_folder(path, as, context);
        if (index.filename() == tilted_scans_index) {
            std::vector<FileContents> contents;
            contents.push_back(read_tilted_scans(index, as, context));
            return contents;
        }
    }
    const std::string extension = lower_extension(path);
    for (const auto& [known, read] : several) {
        if (extension == known) return read(path, as, context);
    }
    std::vector<FileContents> contents;
    for (const auto& [known, read] : single) {
        if (extension != known) continue;
        contents.push_back(read(path, as, context));
        return contents;
    }
    // A missing file or a folder is the better message.
    const MappedFile file(path, "");
    throw IoError(file.path(), "", {}, fmt::format("the extension '{}' is unknown", extension),
                  "give a .pcd, .ply, .e57, .las, .ptx, .pts, .xyz, .txt, .asc, .csv, .npy, .obj, "
                  ".png, .tilt, .bag, .3d or .vtk file, or a folder with depth.txt, "
                  "camera-intrinsics.txt or scans.tilt");
}

/// "hall.e57#2", or with the scan's own name.
std::string name_in_file(const std::string& file, std::span<const FileContents> all,
                         std::size_t i) {
    if (all.size() == 1) return file;
    const std::string& own = all[i].name;
    const auto same = std::count_if(all.begin(), all.end(),
                                    [&](const FileContents& other) { return other.name == own; });
    return own.empty() || same > 1 ? fmt::format("{}#{}", file, i + 1)
                                   : fmt::format("{}#{}", file, own);
}

/// Of formats that have one only.
void require_encoding(Encoding encoding, Encoding only, std::string_view allowed) {
    if (encoding == Encoding::automatic || encoding == only) return;
    const std::string_view name = encoding == Encoding::ascii               ? "ascii"
                                  : encoding == Encoding::binary            ? "binary"
                                  : encoding == Encoding::binary_compressed ? "binary_compressed"
                                                                            : "binary_big_endian";
    throw InvalidArgument("encoding", name, allowed);
}

void add_warnings(FileSummary& summary, const PointSummary& points,
                  const Eigen::Vector3d& global_shift) {
    if (points.num_finite == 0) {
        summary.warnings.emplace_back("no point has finite coordinates");
        return;
    }
    const double distance = median_distance(points.sample);
    if (distance > largest_median_distance) {
        summary.warnings.push_back(fmt::format(
            "half of the points are more than {:.0f} from their middle: the coordinates look like "
            "{}, where metres are expected",
            distance, distance > 10.0 * largest_median_distance ? "millimetres" : "centimetres"));
    }
    if (!global_shift.isZero(0.0)) {
        summary.warnings.push_back(
            fmt::format("far coordinates: positions are kept less {:.0f} {:.0f} {:.0f}",
                        global_shift.x(), global_shift.y(), global_shift.z()));
    }
}

FileSummary summarize(FileContents contents) {
    const PointCloud& cloud = contents.cloud;
    FileSummary summary;
    summary.name = std::move(contents.name);
    summary.format = std::move(contents.format);
    summary.encoding = std::move(contents.encoding);
    const PointSummary& points = contents.summary;
    summary.num_points = points.num_points;
    summary.num_non_finite = points.num_points - points.num_finite;
    if (!points.bounds.isEmpty()) {
        summary.bounds = Eigen::AlignedBox3d(points.bounds.cast<double>());
        summary.bounds.translate(cloud.global_shift);
    }
    summary.fields = std::move(contents.fields);
    summary.grid = cloud.grid;
    summary.sensor_pose = cloud.sensor_pose;
    if (summary.sensor_pose) summary.sensor_pose->translation() += cloud.global_shift;
    summary.map_from_scan = contents.map_from_scan;
    summary.warnings = std::move(contents.warnings);
    add_warnings(summary, points, cloud.global_shift);
    return summary;
}

}  // namespace

std::filesystem::path index_of_scans(const std::filesystem::path& path) {
    for (const char* const index : {tum_index, frames_index, tilted_scans_index}) {
        if (std::filesystem::is_directory(path) && std::filesystem::exists(path / index)) {
            return path / index;
        }
    }
    return path;
}

bool may_hold_poses(const std::filesystem::path& path) {
    const std::filesystem::path index = index_of_scans(path).filename();
    if (index == tum_index || index == frames_index) return true;
    const std::string extension = lower_extension(path);
    return extension == ".e57" || extension == ".ptx";
}

std::vector<StoredScan> read_scans(const std::filesystem::path& path, const Context& context) {
    std::vector<FileContents> all = read_contents(path, PointsAs::cloud, context);
    const std::string file = path.filename().string();
    std::vector<StoredScan> scans;
    std::optional<Eigen::Vector3d> shift;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const std::string name = name_in_file(file, all, i);
        StoredScan stored{{name, std::move(all[i].cloud)}, all[i].map_from_scan};
        if (stored.map_from_scan) {
            Transform& pose = *stored.map_from_scan;
            pose.translation() += pose.linear() * stored.scan.cloud.global_shift;
            if (!shift) shift = pose.translation().unaryExpr(&global_shift_of);
            pose.translation() -= *shift;
        }
        scans.push_back(std::move(stored));
    }
    for (StoredScan& stored : scans)
        stored.map_shift = shift.value_or(Eigen::Vector3d::Zero());
    return scans;
}

Scan read_scan(const std::filesystem::path& path, const Context& context) {
    std::vector<StoredScan> stored = read_scans(path, context);
    if (stored.size() == 1) return std::move(stored.front().scan);
    std::vector<Scan> scans;
    std::vector<std::optional<Transform>> poses;
    for (StoredScan& one : stored) {
        if (!one.map_from_scan) {
            throw IoError(
                path.string(), "", {},
                fmt::format("it holds {} scans, and not where all of them stand", stored.size()),
                "register them first: roomscribe register FILE -o OUT");
        }
        scans.push_back(std::move(one.scan));
        poses.push_back(one.map_from_scan);
    }
    PointCloud map = merge_scans(std::move(scans), poses).cloud;
    map.global_shift = stored.front().map_shift;
    return {path.filename().string(), std::move(map)};
}

void write_point_cloud(const std::filesystem::path& path, const PointCloud& cloud,
                       const WriteOptions& options, const Context& context) {
    const std::string extension = lower_extension(path);
    if (extension == ".pcd") return write_pcd(path, cloud, options.encoding, context);
    if (extension == ".ply") return write_ply(path, cloud, options.encoding, context);
    if (extension == ".las") {
        require_encoding(options.encoding, Encoding::binary, "binary for .las");
        return write_las(path, cloud, context);
    }
    if (extension == ".3d") {
        require_encoding(options.encoding, Encoding::ascii, "ascii for .3d");
        return write_uos(path, cloud, context);
    }
    if (extension == ".e57") {
        require_encoding(options.encoding, Encoding::binary, "binary for .e57");
        const StoredScan stored{{path.stem().string(), cloud}, std::nullopt};
        return write_e57(path, {&stored, 1}, context);
    }
    if (is_text_extension(extension)) {
        require_encoding(options.encoding, Encoding::ascii, "ascii for text");
        return write_text_points(path, cloud, context);
    }
    throw InvalidArgument("path", path.string(),
                          "a .pcd, .ply, .e57, .las, .xyz, .txt, .asc, .csv or .3d file");
}

std::vector<FileSummary> summarize_file(const std::filesystem::path& path, const Context& context) {
    std::vector<FileSummary> summaries;
    for (FileContents& contents : read_contents(path, PointsAs::summary, context))
        summaries.push_back(summarize(std::move(contents)));
    return summaries;
}

}  // namespace roomscribe
