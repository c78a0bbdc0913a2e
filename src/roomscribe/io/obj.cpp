// SPDX-License-Identifier: MIT
#include "roomscribe/io/obj.hpp"

#include <array>

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
        count.colored = count.colored && split_words(line).size() == 7;
    }
    return count;
}

using Vertex = std::array<double, 6>;

Vertex parse_vertex(const ByteReader& reader, std::string_view line) {
    const std::vector<std::string_view> words = split_words(line.substr(1));
    if (words.size() != 3 && words.size() != 4 && words.size() != 6) {
        reader.fail_at_line(fmt::format("{} numbers are no vertex", words.size()), cure);
    }
    Vertex vertex{};
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::optional<double> number = parse_real(words[i]);
        if (!number) reader.fail_at_line(quote_text(words[i]) + " is no number", cure);
        vertex[i] = *number;
    }
    return vertex;
}

}  // namespace

FileContents read_obj(const std::filesystem::path& path, const Context& context) {
    const MappedFile file(path, "OBJ");
    ByteReader reader(file, "OBJ");
    const VertexCount count = count_vertices(reader);
    if (count.vertices == 0) reader.fail_at_line("there are no vertices", cure);
    reader.require_backed(count.vertices, std::string_view("v 0 0 0\n").size() - 1, "vertices");

    FileContents contents{{}, "OBJ", "ascii", {}, {}};
    std::vector<std::string> names{"x", "y", "z"};
    if (count.colored) names.insert(names.end(), {"red", "green", "blue"});
    contents.fields = row_fields(names);
    PointDecoder decoder(contents.fields, count.vertices);
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
        colors.push_back({color_byte(255.0 * vertex[3]), color_byte(255.0 * vertex[4]),
                          color_byte(255.0 * vertex[5])});
        if (chunk.size() == vertices_per_chunk) flush();
    }
    if (!chunk.empty()) flush();
    contents.cloud = decoder.finish(std::nullopt, std::nullopt);
    return contents;
}

}  // namespace roomscribe
