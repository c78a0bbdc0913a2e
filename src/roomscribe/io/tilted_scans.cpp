// SPDX-License-Identifier: MIT
#include "roomscribe/io/tilted_scans.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "roomscribe/core/length_unit.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/number_text.hpp"

namespace roomscribe {
namespace {

constexpr std::string_view format = "tilted scans";
constexpr std::string_view cure = "docs/formats.md says how ranges and tilts are written";
using Words = std::span<const std::string_view>;

struct PlanarScan {
    double tilt = 0.0;  ///< rad, nose down
    std::vector<double> ranges;
};

struct TiltedScans {
    double metres = 1.0;     ///< per unit of the ranges
    double start = 0.0;      ///< rad
    bool has_start = false;  ///< else the rays lie symmetrically
    double step = 0.0;       ///< rad; 0 until it is read
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();
    double min_range = 0.0;  ///< m, exclusive where it is 0
    double max_range = std::numeric_limits<double>::infinity();
    std::vector<PlanarScan> scans;
};

/// Words up to a comment.
std::vector<std::string_view> words_of(std::string_view line) {
    return split_words(line.substr(0, line.find('#')));
}

double number(const ByteReader& reader, std::string_view word) {
    const std::optional<double> value = parse_real(word);
    if (!value || !std::isfinite(*value)) {
        reader.fail_at_line(quote_text(word) + " is no number", cure);
    }
    return *value;
}

void append_ranges(const ByteReader& reader, Words words, std::vector<double>& ranges) {
    for (const std::string_view word : words) {
        // Drivers write inf and nan for no return.
        const std::optional<double> value = parse_real(word);
        if (!value) reader.fail_at_line(quote_text(word) + " is no range", cure);
        ranges.push_back(*value);
    }
}

std::vector<double> read_ranges(const std::filesystem::path& path) {
    const MappedFile file(path, format);
    ByteReader reader(file, format);
    std::vector<double> ranges;
    while (!reader.at_end())
        append_ranges(reader, words_of(reader.read_line()), ranges);
    return ranges;
}

void read_unit(const ByteReader& reader, std::string_view word, TiltedScans& result) {
    const auto* const known = std::find(length_unit_names.begin(), length_unit_names.end(), word);
    if (known == length_unit_names.end()) {
        reader.fail_at_line(quote_text(word) + " is no unit", cure);
    }
    result.metres = metres_per(static_cast<LengthUnit>(known - length_unit_names.begin()));
}

/// Whether the line is one of the geometry's.
bool read_geometry(const ByteReader& reader, Words words, TiltedScans& result) {
    const std::string_view key = words[0];
    const auto value = [&](std::size_t i) { return number(reader, words[i]); };
    if (key == "unit" && words.size() == 2) {
        read_unit(reader, words[1], result);
    } else if (key == "start" && words.size() == 2) {
        result.start = radians(value(1));
        result.has_start = true;
    } else if (key == "step" && words.size() == 2) {
        result.step = radians(value(1));
        if (result.step == 0.0) reader.fail_at_line("a step of 0 is none", cure);
    } else if (key == "offset" && words.size() == 4) {
        result.offset = Eigen::Vector3d(value(1), value(2), value(3));
    } else if (key == "range" && words.size() == 3) {
        result.min_range = value(1);
        result.max_range = value(2);
    } else {
        return false;
    }
    return true;
}

void read_scan_line(const ByteReader& reader, Words words, const std::filesystem::path& folder,
                    TiltedScans& result) {
    const bool in_file = words[0] == "file" && words.size() == 3;
    if (!in_file && !(words[0] == "scan" && words.size() > 2)) {
        reader.fail_at_line(quote_text(words[0]) + " with what follows is not understood", cure);
    }
    PlanarScan scan;
    scan.tilt = radians(number(reader, words[1]));
    if (in_file) {
        const std::filesystem::path name(words[2]);
        if (name != name.filename()) {
            reader.fail_at_line(quote_text(words[2]) + " does not lie beside this file", cure);
        }
        scan.ranges = read_ranges(folder / name);
    } else {
        append_ranges(reader, words.subspan(2), scan.ranges);
    }
    if (!result.scans.empty() && scan.ranges.size() != result.scans[0].ranges.size()) {
        reader.fail_at_line(fmt::format("this scan has {} ranges, the first has {}",
                                        scan.ranges.size(), result.scans[0].ranges.size()),
                            cure);
    }
    result.scans.push_back(std::move(scan));
}

void place_points(const TiltedScans& input, PointCloud& cloud) {
    const std::size_t num_rays = input.scans[0].ranges.size();
    const double start =
        input.has_start ? input.start : -0.5 * static_cast<double>(num_rays - 1) * input.step;
    const Eigen::Vector3f none = Eigen::Vector3f::Constant(std::nanf(""));
    for (const PlanarScan& scan : input.scans) {
        const Eigen::AngleAxisd turn(scan.tilt, Eigen::Vector3d::UnitY());
        for (std::size_t i = 0; i < num_rays; ++i) {
            const double range = scan.ranges[i] * input.metres;
            const bool returned =
                range > 0.0 && range >= input.min_range && range <= input.max_range;
            const double bearing = start + static_cast<double>(i) * input.step;
            const Eigen::Vector3d in_plane =
                input.offset + range * Eigen::Vector3d(std::cos(bearing), std::sin(bearing), 0.0);
            cloud.positions.push_back(returned && std::isfinite(range)
                                          ? Eigen::Vector3f((turn * in_plane).cast<float>())
                                          : none);
        }
    }
    cloud.grid = ScanGrid{input.scans.size(), num_rays};
    cloud.sensor_pose = Transform::Identity();
}

}  // namespace

FileContents read_tilted_scans(const std::filesystem::path& path, PointsAs as,
                               const Context& context) {
    const MappedFile file(path, format);
    ByteReader reader(file, format);
    TiltedScans input;
    while (!reader.at_end()) {
        context.throw_if_cancelled();
        const std::vector<std::string_view> words = words_of(reader.read_line());
        if (words.empty() || read_geometry(reader, words, input)) continue;
        read_scan_line(reader, words, path.parent_path(), input);
    }
    if (input.step == 0.0) reader.fail_at_line("the step between rays is not said", cure);
    if (input.scans.empty() || input.scans[0].ranges.empty()) {
        reader.fail_at_line("there is no scan with ranges", cure);
    }
    FileContents contents{{}, "tilted scans", "ascii", {{"range", ScalarType::float64, 1}}, {}};
    place_points(input, contents.cloud);
    keep_points(as, contents);
    return contents;
}

}  // namespace roomscribe
