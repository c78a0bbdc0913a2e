// SPDX-License-Identifier: MIT
#include "roomscribe/io/las_format.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t waveform_bytes = 29;

}  // namespace

std::vector<Field> las_fields(unsigned point_format) {
    using enum ScalarType;
    const auto is_one_of = [&](std::initializer_list<unsigned> formats) {
        for (const unsigned format : formats) {
            if (format == point_format) return true;
        }
        return false;
    };
    std::vector<Field> fields = {{"x", int32, 1}, {"y", int32, 1}, {"z", int32, 1}};
    fields.push_back({"intensity", uint16, 1});
    const bool legacy = point_format < 6;
    if (legacy) {
        fields.push_back({"_", uint8, 1});
        fields.push_back({"classification", uint8, 1});
        fields.push_back({"scan_angle_rank", int8, 1});
        fields.push_back({"user_data", uint8, 1});
    } else {
        fields.push_back({"_", uint8, 2});
        fields.push_back({"classification", uint8, 1});
        fields.push_back({"user_data", uint8, 1});
        fields.push_back({"scan_angle", int16, 1});
    }
    fields.push_back({"point_source_id", uint16, 1});
    if (!legacy || is_one_of({1, 3, 4, 5})) fields.push_back({"gps_time", float64, 1});
    if (is_one_of({2, 3, 5, 7, 8, 10})) {
        for (const char* name : {"red", "green", "blue"})
            fields.push_back({name, uint16, 1});
    }
    if (is_one_of({8, 10})) fields.push_back({"near_infrared", uint16, 1});
    if (is_one_of({4, 5, 9, 10})) fields.push_back({"_", uint8, waveform_bytes});
    return fields;
}

}  // namespace roomscribe
