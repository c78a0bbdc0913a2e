// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/point_fields.hpp"

namespace roomscribe {

struct PlyProperty {
    std::string name;
    ScalarType type = ScalarType::float32;
    std::optional<ScalarType> list_size_type;  ///< of a list: how its length stands in the file
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;

    bool has_lists() const;
    /// The properties that are no lists.
    std::vector<Field> fields() const;
    /// What a row takes in a file at least, lists being empty.
    std::uint64_t min_row_bytes(bool ascii) const;
};

struct PlyHeader {
    std::string encoding;  ///< "ascii", "binary_little_endian" or "binary_big_endian"
    std::vector<PlyElement> elements;
    std::uint64_t grid_rows = 0;  ///< of obj_info num_rows, num_cols; 0 without them
    std::uint64_t grid_columns = 0;
};

/// Reads from "ply" to "end_header". Throws IoError for anything that is not PLY.
PlyHeader read_ply_header(ByteReader& reader);

}  // namespace roomscribe
