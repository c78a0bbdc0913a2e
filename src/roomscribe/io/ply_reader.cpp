// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cstring>

#include <fmt/format.h>

#include "roomscribe/io/number_text.hpp"
#include "roomscribe/io/ply.hpp"
#include "roomscribe/io/ply_header.hpp"
#include "roomscribe/io/point_decoder.hpp"
#include "roomscribe/io/scalar_dispatch.hpp"

namespace roomscribe {
namespace {

constexpr std::string_view damage_cure = "the file is damaged or cut off: copy it again";
constexpr std::size_t records_per_chunk = 1U << 14U;

/// A PLY file whose header was read, at the element that comes next.
struct Body {
    ByteReader& reader;
    bool ascii;
    std::endian order;
};

std::vector<TextColumn> text_columns(const PlyElement& element) {
    std::vector<TextColumn> columns;
    for (const PlyProperty& property : element.properties) {
        columns.push_back({property.type, property.list_size_type.has_value()});
    }
    return columns;
}

void skip_list(Body& body, ScalarType size_type, ScalarType value_type) {
    const auto length = with_scalar_type(size_type, [&]<typename Value>(std::type_identity<Value>) {
        const auto value = body.reader.read<Value>(body.order);
        if (!(value >= Value{0}))
            body.reader.fail_at_byte("a list of negative length", damage_cure);
        return static_cast<std::uint64_t>(value);
    });
    // Dividing, not multiplying: the length is the file's word.
    if (length > body.reader.remaining() / size_of(value_type)) {
        body.reader.fail_at_byte(
            fmt::format("a list of {} values does not fit into the file", length), damage_cure);
    }
    body.reader.skip(length * size_of(value_type));
}

/// Reads one binary row that has lists; its other values go to `record` as they stand.
void read_row_with_lists(Body& body, const PlyElement& element, std::byte* record) {
    for (const PlyProperty& property : element.properties) {
        if (property.list_size_type) {
            skip_list(body, *property.list_size_type, property.type);
        } else {
            const auto value = body.reader.take(size_of(property.type));
            std::memcpy(record, value.data(), value.size());
            record += value.size();
        }
    }
}

/// Calls `use(records, order, first, count)` for runs of the element's rows, lists left out.
template <typename Use>
void read_element(Body& body, const PlyElement& element, const Context& context, Use&& use) {
    const std::vector<Field> fields = element.fields();
    const std::size_t record = record_bytes(fields);
    body.reader.require_backed(element.count, element.min_row_bytes(body.ascii),
                               "rows of element " + quote_text(element.name));
    if (!body.ascii && !element.has_lists()) {
        const std::size_t rows =
            std::max<std::size_t>(1, bytes_let_go_at_once / std::max<std::size_t>(1, record));
        for (std::size_t first = 0; first < element.count; first += rows) {
            const std::size_t count = std::min<std::size_t>(rows, element.count - first);
            const auto records = body.reader.take(count * record);
            use(records.data(), body.order, first, count);
        }
        return;
    }
    if (element.properties.empty()) return;
    const std::vector<TextColumn> columns = text_columns(element);
    TextTable table(body.reader, columns);
    const std::uint64_t rows = std::min<std::uint64_t>(records_per_chunk, element.count);
    std::vector<std::byte> records(rows * record);
    for (std::size_t first = 0; first < element.count; first += rows) {
        context.throw_if_cancelled();
        const std::size_t count = std::min<std::size_t>(rows, element.count - first);
        for (std::size_t i = 0; i < count; ++i) {
            std::byte* target = records.data() + i * record;
            if (body.ascii) {
                table.read_row(target);
            } else {
                read_row_with_lists(body, element, target);
            }
        }
        use(records.data(), body.ascii ? std::endian::native : body.order, first, count);
    }
    if (body.ascii) table.finish();
}

/// The pose of PCL's camera element, if it is one and not the identity.
std::optional<Transform> read_camera(Body& body, const PlyElement& element,
                                     const Context& context) {
    const std::array<std::string_view, 12> names = {"view_px", "view_py", "view_pz", "x_axisx",
                                                    "x_axisy", "x_axisz", "y_axisx", "y_axisy",
                                                    "y_axisz", "z_axisx", "z_axisy", "z_axisz"};
    const std::vector<Field> fields = element.fields();
    std::array<double, 12> values{};
    std::size_t num_found = 0;
    read_element(body, element, context,
                 [&](const std::byte* records, std::endian order, std::size_t first, std::size_t) {
                     if (first > 0) return;
                     for (const Field& field : fields) {
                         const auto* name = std::find(names.begin(), names.end(), field.name);
                         if (name != names.end()) {
                             const bool swap = order != std::endian::native;
                             values[static_cast<std::size_t>(name - names.begin())] =
                                 load_as_double(records, field.type, swap);
                             ++num_found;
                         }
                         records += field.bytes();
                     }
                 });
    if (num_found != names.size()) return std::nullopt;
    const Eigen::Map<const Eigen::Vector3d> position(values.data());
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> axes(values.data() + 3);
    const bool rotation = (axes * axes.transpose()).isIdentity(1e-3) && axes.determinant() > 0.0;
    if (!position.allFinite() || !rotation) return std::nullopt;
    Transform pose = Transform::Identity();
    pose.linear() = nearest_rotation(axes);
    pose.translation() = position;
    if (position.isZero(0.0) && axes.isIdentity(0.0)) return std::nullopt;
    return pose;
}

std::optional<ScanGrid> header_grid(const PlyHeader& header, std::uint64_t num_points) {
    const std::uint64_t rows = header.grid_rows;
    // Range images list only the rays that returned, under the same words: that is no grid.
    if (rows <= 1 || num_points % rows != 0 || num_points / rows != header.grid_columns) {
        return std::nullopt;
    }
    return ScanGrid{rows, header.grid_columns};
}

void warn_of_lists(const PlyElement& vertex, std::vector<std::string>& warnings) {
    for (const PlyProperty& property : vertex.properties) {
        if (property.list_size_type) {
            warnings.push_back(fmt::format("the list property {} is not read", property.name));
        }
    }
}

}  // namespace

FileContents read_ply(const std::filesystem::path& path, PointsAs as, const Context& context) {
    const MappedFile file(path, "PLY");
    ByteReader reader(file, "PLY");
    const PlyHeader header = read_ply_header(reader);
    const auto is_named = [](std::string_view name) {
        return [name](const PlyElement& element) { return element.name == name; };
    };
    const auto vertex =
        std::find_if(header.elements.begin(), header.elements.end(), is_named("vertex"));
    if (vertex == header.elements.end() || !PointDecoder::has_positions(vertex->fields())) {
        reader.fail_at_line("there is no element 'vertex' with properties x, y and z",
                            "give the file positions");
    }
    const auto camera =
        std::find_if(header.elements.begin(), header.elements.end(), is_named("camera"));
    const auto end = camera == header.elements.end() ? vertex + 1 : std::max(vertex, camera) + 1;

    Body body{reader, header.encoding == "ascii",
              header.encoding == "binary_big_endian" ? std::endian::big : std::endian::little};
    FileContents contents{{}, "PLY", header.encoding, vertex->fields(), {}};
    warn_of_lists(*vertex, contents.warnings);
    std::optional<PointDecoder> decoder;
    std::optional<Transform> sensor_pose;
    for (auto element = header.elements.begin(); element != end; ++element) {
        if (element == camera) {
            sensor_pose = read_camera(body, *element, context);
            continue;
        }
        read_element(
            body, *element, context,
            [&](const std::byte* records, std::endian order, std::size_t first, std::size_t count) {
                if (element != vertex) return;
                // Only here is it known that the file backs its word.
                if (!decoder) decoder.emplace(contents.fields, element->count, as);
                decoder->decode(record_sources(contents.fields, records), first, count, order,
                                context);
            });
    }
    if (!decoder) decoder.emplace(contents.fields, 0, as);
    decoder->finish(contents, sensor_pose, header_grid(header, vertex->count));
    return contents;
}

}  // namespace roomscribe
