// SPDX-License-Identifier: MIT
#include "roomscribe/io/point_cloud_io.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/file_contents.hpp"
#include "roomscribe/io/las.hpp"
#include "roomscribe/io/pcd.hpp"
#include "roomscribe/io/ply.hpp"
#include "roomscribe/io/uos.hpp"
#include "roomscribe/io/vtk.hpp"

namespace roomscribe {
namespace {

/// Half the points of an indoor place lie nearer to its middle than this, in metres.
constexpr double largest_median_distance = 100.0;

std::string lower_extension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

FileContents read_contents(const std::filesystem::path& path, const Context& context) {
    const std::string extension = lower_extension(path);
    if (extension == ".pcd") return read_pcd(path, context);
    if (extension == ".ply") return read_ply(path, context);
    if (extension == ".3d") return read_uos(path, context);
    if (extension == ".vtk") return read_vtk(path, context);
    if (extension == ".las" || extension == ".laz") return read_las(path, context);
    // A missing file or a folder is the better message.
    const MappedFile file(path, "");
    throw IoError(file.path(), "", {}, fmt::format("the extension '{}' is unknown", extension),
                  "give a .pcd, .ply, .las, .3d or .vtk file");
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

void add_warnings(FileSummary& summary, const PointCloud& cloud,
                  std::span<const std::uint32_t> finite) {
    if (finite.empty()) {
        summary.warnings.emplace_back("no point has finite coordinates");
        return;
    }
    const double distance = median_distance(cloud.positions);
    if (distance > largest_median_distance) {
        summary.warnings.push_back(fmt::format(
            "half of the points are more than {:.0f} from their middle: the coordinates look like "
            "{}, where metres are expected",
            distance, distance > 10.0 * largest_median_distance ? "millimetres" : "centimetres"));
    }
    if (!cloud.global_shift.isZero(0.0)) {
        summary.warnings.push_back(
            fmt::format("far coordinates: positions are kept less {:.0f} {:.0f} {:.0f}",
                        cloud.global_shift.x(), cloud.global_shift.y(), cloud.global_shift.z()));
    }
}

}  // namespace

Scan read_scan(const std::filesystem::path& path, const Context& context) {
    return {path.filename().string(), read_contents(path, context).cloud};
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
    throw InvalidArgument("path", path.string(), "a .pcd, .ply, .las or .3d file");
}

FileSummary summarize_file(const std::filesystem::path& path, const Context& context) {
    FileContents contents = read_contents(path, context);
    const PointCloud& cloud = contents.cloud;
    FileSummary summary;
    summary.format = std::move(contents.format);
    summary.encoding = std::move(contents.encoding);
    summary.num_points = cloud.size();
    summary.fields = std::move(contents.fields);
    summary.grid = cloud.grid;
    summary.sensor_pose = cloud.sensor_pose;
    if (summary.sensor_pose) summary.sensor_pose->translation() += cloud.global_shift;
    summary.warnings = std::move(contents.warnings);

    const std::vector<std::uint32_t> finite = finite_points(cloud);
    summary.num_non_finite = cloud.size() - finite.size();
    for (const std::uint32_t index : finite) {
        summary.bounds.extend(cloud.positions[index].cast<double>() + cloud.global_shift);
    }
    add_warnings(summary, cloud, finite);
    return summary;
}

}  // namespace roomscribe
