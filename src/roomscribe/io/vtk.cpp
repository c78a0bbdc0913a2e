// SPDX-License-Identifier: MIT
#include "roomscribe/io/vtk.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include <fmt/format.h>

#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/number_text.hpp"
#include "roomscribe/io/point_decoder.hpp"

namespace roomscribe {
namespace {

constexpr std::string_view cure = "write it as legacy VTK polydata";

struct TypeName {
    std::string_view name;
    ScalarType type;
};

// Not "long": its size is the writing machine's.
constexpr std::array<TypeName, 8> type_names = {{{"float", ScalarType::float32},
                                                 {"double", ScalarType::float64},
                                                 {"int", ScalarType::int32},
                                                 {"unsigned_int", ScalarType::uint32},
                                                 {"short", ScalarType::int16},
                                                 {"unsigned_short", ScalarType::uint16},
                                                 {"char", ScalarType::int8},
                                                 {"unsigned_char", ScalarType::uint8}}};

std::vector<std::string_view> next_words(ByteReader& reader) {
    std::vector<std::string_view> words;
    while (words.empty())
        words = split_words(reader.read_line());
    return words;
}

struct Header {
    std::string encoding;
    ScalarType type = ScalarType::float32;
    std::uint64_t num_points = 0;
};

Header read_header(ByteReader& reader) {
    if (!reader.read_line().starts_with("# vtk DataFile Version")) {
        reader.fail_at_line("the file does not begin with '# vtk DataFile Version'",
                            "if the file is of another format, name it so");
    }
    reader.read_line();
    Header header;
    const auto encoding = next_words(reader);
    if (encoding[0] != "ASCII" && encoding[0] != "BINARY") {
        reader.fail_at_line(fmt::format("{} is neither ASCII nor BINARY", quote_text(encoding[0])),
                            cure);
    }
    header.encoding = encoding[0] == "ASCII" ? "ascii" : "binary";
    const auto dataset = next_words(reader);
    if (dataset.size() != 2 || dataset[0] != "DATASET" ||
        (dataset[1] != "POLYDATA" && dataset[1] != "UNSTRUCTURED_GRID")) {
        reader.fail_at_line("the data set is neither POLYDATA nor UNSTRUCTURED_GRID", cure);
    }
    const auto points = next_words(reader);
    const auto count = points.size() == 3 ? parse_count(points[1]) : std::nullopt;
    if (points[0] != "POINTS" || !count) {
        reader.fail_at_line("there is no line 'POINTS count type'", cure);
    }
    const auto* type = std::find_if(type_names.begin(), type_names.end(),
                                    [&](const TypeName& name) { return name.name == points[2]; });
    if (type == type_names.end()) {
        reader.fail_at_line(fmt::format("{} is no type of points", quote_text(points[2])), cure);
    }
    header.type = type->type;
    header.num_points = *count;
    return header;
}

}  // namespace

FileContents read_vtk(const std::filesystem::path& path, PointsAs as, const Context& context) {
    const MappedFile file(path, "VTK");
    ByteReader reader(file, "VTK");
    const Header header = read_header(reader);
    const std::vector<Field> fields = {
        {"x", header.type, 1}, {"y", header.type, 1}, {"z", header.type, 1}};
    const bool ascii = header.encoding == "ascii";
    // Three values of a digit and a space or line end each, but for the very last.
    reader.require_backed(header.num_points, ascii ? 5 : record_bytes(fields), "points");
    PointDecoder decoder(fields, header.num_points, as);
    if (ascii) {
        decode_text(reader, fields, header.num_points, true, decoder, context);
    } else {
        decoder.decode_mapped(reader.take(header.num_points * record_bytes(fields)),
                              std::endian::big, context);
    }
    FileContents contents{{}, "VTK", header.encoding, fields, {}};
    decoder.finish(contents, std::nullopt, std::nullopt);
    return contents;
}

}  // namespace roomscribe
