// SPDX-License-Identifier: MIT
#include "roomscribe/io/point_cloud2.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/io/point_decoder.hpp"
#include "roomscribe/io/rosbag_records.hpp"

namespace roomscribe {

FileContents read_point_cloud2(const RosMessage& message, PointsAs as, const Context& context) {
    const auto number = [&](const std::string& path) {
        const double value = message.number(path).value_or(0.0);
        if (!(value >= 0.0 && value <= 4294967295.0)) throw Error(path + " is no number of bytes");
        return static_cast<std::size_t>(value);
    };
    std::vector<Field> fields;
    std::vector<std::size_t> offsets;
    const std::size_t step = number("point_step");
    constexpr std::array types{ScalarType::int8,    ScalarType::uint8,  ScalarType::int16,
                               ScalarType::uint16,  ScalarType::int32,  ScalarType::uint32,
                               ScalarType::float32, ScalarType::float64};
    for (std::size_t i = 0;; ++i) {
        const std::string prefix = fmt::format("fields[{}].", i);
        const std::optional<std::string> name = message.text(prefix + "name");
        if (!name) break;
        const std::size_t type = number(prefix + "datatype");
        // Some drivers leave the count out.
        const std::size_t count = std::max<std::size_t>(1, number(prefix + "count"));
        if (type < 1 || type > types.size()) throw Error("a PointCloud2 has a field of no type");
        const bool is_word = !name->empty() && std::all_of(name->begin(), name->end(),
                                                           [](char c) { return c > ' '; });
        fields.push_back({is_word ? *name : "_", types[type - 1], count});
        offsets.push_back(number(prefix + "offset"));
        if (count > step || offsets.back() + fields.back().bytes() > step) {
            throw Error("a PointCloud2 has a field beyond its points");
        }
    }
    // Else few bytes could make many properties.
    if (record_bytes(fields) > step) throw Error("a PointCloud2 has fields that overlap");
    if (!PointDecoder::has_positions(fields)) throw Error("a PointCloud2 has no fields x, y and z");
    const std::size_t width = number("width");
    const std::size_t height = number("height");
    const std::size_t row_step = number("row_step");
    const RosField* const data = message.find("data");
    const std::size_t size = data == nullptr ? 0 : data->bytes.size();
    if (height > 0 &&
        (width > row_step / std::max<std::size_t>(1, step) ||
         height > size / std::max<std::size_t>(1, row_step)) &&
        width > 0) {
        throw Error("a PointCloud2 has fewer bytes than its points take");
    }
    const std::size_t num_points = width * height;
    PointDecoder decoder(fields, num_points, as);
    const bool is_big = message.number("is_bigendian").value_or(0.0) != 0.0;
    for (std::size_t row = 0; row < height && width > 0; ++row) {
        std::vector<FieldSource> sources;
        sources.reserve(offsets.size());
        for (const std::size_t offset : offsets)
            sources.push_back({data->bytes.data() + row * row_step + offset, step});
        decoder.decode(sources, row * width, width, is_big ? std::endian::big : std::endian::little,
                       context);
    }
    std::optional<ScanGrid> grid;
    if (height > 1 && width > 1) grid = ScanGrid{height, width};
    FileContents contents;
    decoder.finish(contents, std::nullopt, grid);
    contents.format = rosbag_format;
    contents.encoding = "PointCloud2";
    contents.fields = std::move(fields);
    return contents;
}

}  // namespace roomscribe
