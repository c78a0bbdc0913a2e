// SPDX-License-Identifier: MIT
#include "roomscribe/io/obj.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/number_text.hpp"
#include "roomscribe/io/point_decoder.hpp"
#include "roomscribe/io/row_fields.hpp"

namespace roomscribe {
namespace {

constexpr std::string_view cure = "write each vertex as v x y z, or v x y z r g b";
constexpr std::size_t vertices_per_chunk = 1U << 12U;

bool is_vertex(std::string_view text) {
    return text.starts_with("v ") || text.starts_with("v\t");
}

/// Takes the next word off the line; empty behind the last. Several times as fast as splitting a
/// line into a vector, in what is most of the time of reading.
std::string_view take_word(std::string_view& line) {
    const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    std::size_t begin = 0;
    while (begin < line.size() && is_blank(line[begin]))
        ++begin;
    std::size_t end = begin;
    while (end < line.size() && !is_blank(line[end]))
        ++end;
    const std::string_view word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
}

std::size_t count_words(std::string_view line) {
    std::size_t count = 0;
    while (!take_word(line).empty())
        ++count;
    return count;
}

struct VertexCount {
    std::size_t vertices = 0;
    bool colored = true;  ///< every one has six numbers
};

VertexCount count_vertices(ByteReader reader) {
    VertexCount count;
    while (!reader.at_end()) {
        const std::string_view line = reader.read_line();
        if (!is_vertex(line)) continue;
        ++count.vertices;
        count.colored = count.colored && count_words(line) == 7;
    }
    return count;
}

using Vertex = std::array<double, 6>;

Vertex parse_vertex(const ByteReader& reader, std::string_view line) {
    line.remove_prefix(1);
    Vertex vertex{};
    std::size_t count = 0;
    for (std::string_view word = take_word(line); !word.empty(); word = take_word(line), ++count) {
        const std::optional<double> number = parse_real(word);
        if (!number) reader.fail_at_line(quote_text(word) + " is no number", cure);
        if (count < vertex.size()) vertex[count] = *number;
    }
    if (count != 3 && count != 4 && count != 6) {
        reader.fail_at_line(fmt::format("{} numbers are no vertex", count), cure);
    }
    return vertex;
}

}  // namespace

FileContents read_obj(const std::filesystem::path& path, PointsAs as, const Context& context) {
    const MappedFile file(path, "OBJ");
    ByteReader reader(file, "OBJ");
    const VertexCount count = count_vertices(reader);
    if (count.vertices == 0) reader.fail_at_line("there are no vertices", cure);
    reader.require_backed(count.vertices, std::string_view("v 0 0 0\n").size() - 1, "vertices");

    FileContents contents{{}, "OBJ", "ascii", {}, {}};
    std::vector<std::string> names{"x", "y", "z"};
    if (count.colored) names.insert(names.end(), {"red", "green", "blue"});
    contents.fields = row_fields(names);
    PointDecoder decoder(contents.fields, count.vertices, as);
    std::vector<Vertex> chunk;
    std::vector<std::array<std::uint8_t, 3>> colors;
    std::size_t first = 0;
    const auto flush = [&] {
        context.throw_if_cancelled();
        std::vector<FieldSource> sources;
        for (std::size_t i = 0; i < 3; ++i)
            sources.push_back({reinterpret_cast<const std::byte*>(&chunk[0][i]), sizeof(Vertex)});
        for (std::size_t i = 0; i < 3 && count.colored; ++i)
            sources.push_back({reinterpret_cast<const std::byte*>(&colors[0][i]), 3});
        decoder.decode(sources, first, chunk.size(), std::endian::native, context);
        first += chunk.size();
        chunk.clear();
        colors.clear();
    };
    while (!reader.at_end()) {
        const std::string_view line = reader.read_line();
        if (!is_vertex(line)) continue;
        const Vertex vertex = parse_vertex(reader, line);
        chunk.push_back(vertex);
        if (count.colored) {
            colors.push_back({color_byte(255.0 * vertex[3]), color_byte(255.0 * vertex[4]),
                              color_byte(255.0 * vertex[5])});
        }
        if (chunk.size() == vertices_per_chunk) flush();
    }
    if (!chunk.empty()) flush();
    decoder.finish(contents, std::nullopt, std::nullopt);
    return contents;
}

}  // namespace roomscribe
