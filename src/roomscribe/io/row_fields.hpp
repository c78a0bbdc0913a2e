// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include "roomscribe/io/number_rows.hpp"
#include "roomscribe/io/point_decoder.hpp"

namespace roomscribe {

/// The fields of columns with these names: float64, but for the colours, which become uint8.
std::vector<Field> row_fields(std::span<const std::string> names);

/// Rounded, and kept within 0 to 255; 0 for NaN.
std::uint8_t color_byte(double value);

/// Reads rows of `contents.fields` into its cloud or summary. Colours are multiplied with
/// `color_factor`, rounded and kept within 0 to 255. `zero_is_missing`: a point 0 0 0 is a ray
/// without return, and becomes NaN.
void decode_rows(const ByteReader& reader, std::span<const RowBlock> blocks,
                 const RowFormat& format, double color_factor, bool zero_is_missing, PointsAs as,
                 FileContents& contents, const Context& context);

}  // namespace roomscribe
