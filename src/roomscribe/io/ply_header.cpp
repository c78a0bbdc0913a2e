// SPDX-License-Identifier: MIT
#include "roomscribe/io/ply_header.hpp"

#include <algorithm>
#include <array>
#include <span>

#include <fmt/format.h>

#include "roomscribe/io/number_text.hpp"

namespace roomscribe {
namespace {

constexpr std::string_view cure = "repair the header, or write the file again";

struct TypeName {
    std::string_view name;
    ScalarType type;
};

constexpr std::array<TypeName, 18> type_names = {{{"char", ScalarType::int8},
                                                  {"uchar", ScalarType::uint8},
                                                  {"short", ScalarType::int16},
                                                  {"ushort", ScalarType::uint16},
                                                  {"int", ScalarType::int32},
                                                  {"uint", ScalarType::uint32},
                                                  {"float", ScalarType::float32},
                                                  {"double", ScalarType::float64},
                                                  {"int8", ScalarType::int8},
                                                  {"uint8", ScalarType::uint8},
                                                  {"int16", ScalarType::int16},
                                                  {"uint16", ScalarType::uint16},
                                                  {"int32", ScalarType::int32},
                                                  {"uint32", ScalarType::uint32},
                                                  {"int64", ScalarType::int64},
                                                  {"uint64", ScalarType::uint64},
                                                  {"float32", ScalarType::float32},
                                                  {"float64", ScalarType::float64}}};

ScalarType read_type(const ByteReader& reader, std::string_view word) {
    const auto* found = std::find_if(type_names.begin(), type_names.end(),
                                     [&](const TypeName& type) { return type.name == word; });
    if (found == type_names.end()) {
        reader.fail_at_line(fmt::format("{} is no type", quote_text(word)), cure);
    }
    return found->type;
}

using Words = std::vector<std::string_view>;

void read_element(const ByteReader& reader, const Words& words, PlyHeader& header) {
    const auto count = words.size() == 3 ? parse_count(words[2]) : std::nullopt;
    if (!count) reader.fail_at_line("the element has no name and count", cure);
    header.elements.push_back({std::string(words[1]), *count, {}});
}

void read_property(const ByteReader& reader, const Words& words, PlyHeader& header) {
    if (header.elements.empty()) reader.fail_at_line("a property before any element", cure);
    std::vector<PlyProperty>& properties = header.elements.back().properties;
    if (words.size() == 5 && words[1] == "list") {
        const ScalarType size_type = read_type(reader, words[2]);
        if (size_type == ScalarType::float32 || size_type == ScalarType::float64) {
            reader.fail_at_line("the length of a list is no integer", cure);
        }
        properties.push_back({std::string(words[4]), read_type(reader, words[3]), size_type});
    } else if (words.size() == 3) {
        properties.push_back({std::string(words[2]), read_type(reader, words[1]), std::nullopt});
    } else {
        reader.fail_at_line("the property has no type and name", cure);
    }
}

void read_info(const Words& words, PlyHeader& header) {
    if (words.size() != 3) return;
    if (words[1] == "num_rows") header.grid_rows = parse_count(words[2]).value_or(0);
    if (words[1] == "num_cols") header.grid_columns = parse_count(words[2]).value_or(0);
}

void read_format(const ByteReader& reader, const Words& words, PlyHeader& header) {
    header.encoding = words.size() > 1 ? words[1] : "";
    constexpr std::array<std::string_view, 3> known = {"ascii", "binary_little_endian",
                                                       "binary_big_endian"};
    if (std::find(known.begin(), known.end(), header.encoding) == known.end()) {
        reader.fail_at_line(fmt::format("{} is no PLY format", quote_text(header.encoding)), cure);
    }
}

}  // namespace

bool PlyElement::has_lists() const {
    return std::any_of(properties.begin(), properties.end(),
                       [](const PlyProperty& property) { return property.list_size_type; });
}

std::vector<Field> PlyElement::fields() const {
    std::vector<Field> fields;
    for (const PlyProperty& property : properties) {
        if (!property.list_size_type) fields.push_back({property.name, property.type, 1});
    }
    return fields;
}

std::uint64_t PlyElement::min_row_bytes(bool ascii) const {
    // A value takes a digit and a space or line end, which only the very last may lack.
    if (ascii) return properties.empty() ? 0 : 2 * properties.size() - 1;
    std::uint64_t bytes = 0;
    for (const PlyProperty& property : properties) {
        bytes += size_of(property.list_size_type.value_or(property.type));
    }
    return bytes;
}

PlyHeader read_ply_header(ByteReader& reader) {
    if (reader.read_line() != "ply") {
        reader.fail_at_line("the file does not begin with 'ply'",
                            "if the file is of another format, name it so");
    }
    PlyHeader header;
    while (true) {
        const Words words = split_words(reader.read_line());
        if (words.empty() || words[0] == "comment") continue;
        if (words[0] == "end_header") break;
        if (words[0] == "format") {
            read_format(reader, words, header);
        } else if (words[0] == "element") {
            read_element(reader, words, header);
        } else if (words[0] == "property") {
            read_property(reader, words, header);
        } else if (words[0] == "obj_info") {
            read_info(words, header);
        } else {
            reader.fail_at_line(fmt::format("{} is no line of a PLY header", quote_text(words[0])),
                                cure);
        }
    }
    if (header.encoding.empty()) reader.fail_at_line("there is no format line", cure);
    return header;
}

}  // namespace roomscribe
