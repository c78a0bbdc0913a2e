// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "roomscribe/io/point_fields.hpp"

namespace roomscribe {

// What the LAS reader and writer both know of the format.
// Source: ASPRS, "LAS Specification 1.4 - R15" (2019), tables 3 to 18 and 24.

inline constexpr std::string_view las_magic = "LASF";
inline constexpr unsigned num_las_point_formats = 11;
inline constexpr std::string_view las_spec_user = "LASF_Spec";
inline constexpr std::uint16_t extra_bytes_record = 4;
/// Of one description in the record of extra bytes.
inline constexpr std::size_t extra_bytes_size = 192;

/// The fields of a point of this format (0 to 10), one behind another. Return counts, flags and
/// waveforms, which are not read, are "_". The colours are uint16.
std::vector<Field> las_fields(unsigned point_format);

/// The types of extra bytes, 1 to 10 in the file.
inline constexpr ScalarType extra_bytes_types[] = {
    ScalarType::uint8,   ScalarType::int8,   ScalarType::uint16, ScalarType::int16,
    ScalarType::uint32,  ScalarType::int32,  ScalarType::uint64, ScalarType::int64,
    ScalarType::float32, ScalarType::float64};

}  // namespace roomscribe
