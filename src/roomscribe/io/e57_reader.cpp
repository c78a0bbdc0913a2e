// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "roomscribe/core/error.hpp"
#include "roomscribe/io/e57.hpp"
#include "roomscribe/io/e57_pages.hpp"
#include "roomscribe/io/e57_records.hpp"
#include "roomscribe/io/number_text.hpp"
#include "roomscribe/io/point_decoder.hpp"
#include "roomscribe/io/row_fields.hpp"
#include "roomscribe/io/scalar_dispatch.hpp"

namespace roomscribe {
namespace {

constexpr std::string_view magic = "ASTM-E57";
constexpr std::size_t header_bytes = 48;
constexpr std::uint8_t vector_section = 1;
constexpr std::uint8_t data_packet = 1;
/// Values of all properties together that are decoded at once.
constexpr std::size_t values_per_chunk = 1U << 18U;
/// Coordinates and colours grow at most sixfold when they are unpacked, a property that is the same
/// for all points from nothing to 8 bytes. More is no scan, and is not given memory.
constexpr std::uint64_t largest_growth = 32;
constexpr std::uint64_t harmless_bytes = 1U << 20U;
constexpr double rotation_tolerance = 1e-3;
constexpr std::string_view cure = "the file is damaged: copy or export it again";

/// The file, and the errors in its XML.
struct Source {
    const MappedFile& file;
    const E57Pages& pages;

    [[noreturn]] void fail(std::string_view reason) const {
        throw IoError(file.path(), "E57", {}, reason, cure);
    }
};

double number_of(const Source& source, std::string_view text, std::string_view what,
                 double absent) {
    const auto words = split_words(text);
    if (words.empty()) return absent;
    const std::optional<double> value = parse_real(words[0]);
    if (!value || words.size() > 1) {
        source.fail(fmt::format("the XML has {} for {}", quote_text(text), what));
    }
    return *value;
}

double number_in(const Source& source, const pugi::xml_node& parent, const char* name,
                 double absent) {
    return number_of(source, parent.child(name).text().get(), name, absent);
}

std::int64_t integer_attribute(const Source& source, const pugi::xml_node& node, const char* name,
                               std::int64_t absent) {
    const pugi::xml_attribute attribute = node.attribute(name);
    if (attribute.empty()) return absent;
    const std::string_view text = attribute.value();
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) {
        source.fail(fmt::format("the XML has {} for {}", quote_text(text), name));
    }
    return value;
}

std::optional<Transform> read_pose(const Source& source, const pugi::xml_node& scan) {
    const pugi::xml_node node = scan.child("pose");
    if (!node) return std::nullopt;
    const pugi::xml_node turn = node.child("rotation");
    const pugi::xml_node move = node.child("translation");
    const double w = number_in(source, turn, "w", turn ? 0.0 : 1.0);
    const Eigen::Quaterniond rotation(w, number_in(source, turn, "x", 0.0),
                                      number_in(source, turn, "y", 0.0),
                                      number_in(source, turn, "z", 0.0));
    const Eigen::Vector3d translation(number_in(source, move, "x", 0.0),
                                      number_in(source, move, "y", 0.0),
                                      number_in(source, move, "z", 0.0));
    if (!(std::abs(rotation.norm() - 1.0) < rotation_tolerance) || !translation.allFinite()) {
        source.fail("the pose of a scan is no rotation and translation");
    }
    Transform pose = Transform::Identity();
    pose.linear() = rotation.normalized().toRotationMatrix();
    pose.translation() = translation;
    return pose;
}

E57Element read_element(const Source& source, const pugi::xml_node& node) {
    E57Element element;
    element.name = node.name();
    const std::string_view type = node.attribute("type").value();
    if (type == "Float") {
        const bool single = std::string_view(node.attribute("precision").value()) == "single";
        element.kind = single ? E57Element::Kind::float32 : E57Element::Kind::float64;
        return element;
    }
    if (type != "Integer" && type != "ScaledInteger") {
        source.fail(fmt::format("the points have {}, which is {} and no number",
                                quote_text(element.name), quote_text(type)));
    }
    using Limits = std::numeric_limits<std::int64_t>;
    element.kind = E57Element::Kind::integer;
    element.minimum = integer_attribute(source, node, "minimum", Limits::min());
    element.maximum = integer_attribute(source, node, "maximum", Limits::max());
    if (element.maximum < element.minimum) {
        source.fail(fmt::format("the range of {} is empty", quote_text(element.name)));
    }
    if (type == "ScaledInteger") {
        element.kind = E57Element::Kind::scaled_integer;
        element.scale = number_of(source, node.attribute("scale").value(), "scale", 1.0);
        element.offset = number_of(source, node.attribute("offset").value(), "offset", 0.0);
    }
    return element;
}

/// What a property of the points becomes.
enum class Role { keep, color, invalid, drop };

struct Column {
    Role role = Role::keep;
    Field field;              ///< as the decoder takes it
    double color_zero = 0.0;  ///< (value - color_zero) * color_scale is from 0 to 255
    double color_scale = 1.0;
};

/// The type that holds all values of a property.
ScalarType type_of(const E57Element& element) {
    using enum ScalarType;
    if (element.kind == E57Element::Kind::float32) return float32;
    if (element.kind != E57Element::Kind::integer) return float64;
    constexpr ScalarType types[] = {uint8, int8, uint16, int16, uint32, int32};
    for (const ScalarType type : types) {
        const bool holds = with_scalar_type(type, [&]<typename Value>(std::type_identity<Value>) {
            using Limits = std::numeric_limits<Value>;
            if constexpr (std::is_integral_v<Value> && sizeof(Value) < 8) {
                return element.minimum >= static_cast<std::int64_t>(Limits::min()) &&
                       element.maximum <= static_cast<std::int64_t>(Limits::max());
            }
            return false;
        });
        if (holds) return type;
    }
    return float64;
}

/// 0 to 255 from the limits of the scan, else from the range of the integers, else from 0 to 1.
void set_color_range(const Source& source, const pugi::xml_node& scan, const E57Element& element,
                     Column& column) {
    const bool integer = element.kind == E57Element::Kind::integer ||
                         element.kind == E57Element::Kind::scaled_integer;
    const double low =
        integer ? static_cast<double>(element.minimum) * element.scale + element.offset : 0.0;
    const double high =
        integer ? static_cast<double>(element.maximum) * element.scale + element.offset : 1.0;
    const pugi::xml_node limits = scan.child("colorLimits");
    column.color_zero = number_in(source, limits, (element.name + "Minimum").c_str(), low);
    const double top = number_in(source, limits, (element.name + "Maximum").c_str(), high);
    column.color_scale = top > column.color_zero ? 255.0 / (top - column.color_zero) : 1.0;
}

Column make_column(const Source& source, const pugi::xml_node& scan, const E57Element& element,
                   bool cartesian) {
    constexpr std::pair<std::string_view, std::string_view> kept[] = {
        {"cartesianX", "x"},        {"cartesianY", "y"},   {"cartesianZ", "z"},
        {"intensity", "intensity"}, {"nor:normalX", "nx"}, {"nor:normalY", "ny"},
        {"nor:normalZ", "nz"}};
    constexpr std::pair<std::string_view, std::string_view> spherical[] = {
        {"sphericalRange", "x"}, {"sphericalAzimuth", "y"}, {"sphericalElevation", "z"}};
    constexpr std::pair<std::string_view, std::string_view> colors[] = {
        {"colorRed", "red"}, {"colorGreen", "green"}, {"colorBlue", "blue"}};
    Column column;
    const auto find = [&](auto& names) {
        for (const auto& [known, name] : names) {
            if (element.name == known) {
                column.field = {std::string(name), ScalarType::float64, 1};
                return true;
            }
        }
        return false;
    };
    if (find(kept)) return column;
    if (!cartesian && find(spherical)) return column;
    if (find(colors)) {
        column.role = Role::color;
        column.field.type = ScalarType::uint8;
        set_color_range(source, scan, element, column);
        return column;
    }
    column.field = {"_", ScalarType::float64, 1};
    if (element.name == (cartesian ? "cartesianInvalidState" : "sphericalInvalidState")) {
        column.role = Role::invalid;
        return column;
    }
    const bool dropped = element.name.starts_with("spherical") ||
                         element.name.starts_with("cartesian") ||
                         element.name == "isColorInvalid" || element.name == "isIntensityInvalid";
    if (dropped) {
        column.role = Role::drop;
        return column;
    }
    column.field.name = element.name;
    const std::string own = std::string(e57_channel_prefix) + ":";
    if (element.name.starts_with(own)) column.field.name = element.name.substr(own.size());
    std::replace(column.field.name.begin(), column.field.name.end(), ':', '_');
    column.field.type = type_of(element);
    return column;
}

/// Where the records of a scan lie, and what they hold.
struct Records {
    std::uint64_t count = 0;
    std::uint64_t position = 0;  ///< of the next packet, logical
    std::uint64_t end = 0;       ///< of the section, logical
    bool spherical = false;
    std::vector<E57Stream> streams;
    std::vector<Column> columns;
};

/// Of one point, in the cloud.
std::uint64_t bytes_in_memory(const Records& records) {
    std::uint64_t bytes = sizeof(Eigen::Vector3f);
    for (const Column& column : records.columns) {
        const bool kept = column.role == Role::keep || column.role == Role::color;
        if (kept) bytes += column.field.bytes();
    }
    return bytes;
}

void require_backed(const Source& source, const Records& records) {
    std::uint64_t bits = 0;
    for (const E57Stream& stream : records.streams)
        bits += stream.element().bits();
    const std::uint64_t available = (records.end - records.position) * 8;
    if (records.count > std::numeric_limits<std::uint32_t>::max() ||
        records.count > available / std::max<std::uint64_t>(bits, 1)) {
        source.fail(fmt::format("{} points of {} bits do not fit into the {} bytes of their part",
                                records.count, bits, available / 8));
    }
    const std::uint64_t unpacked = records.count * bytes_in_memory(records);
    if (unpacked > harmless_bytes + largest_growth * (available / 8)) {
        source.fail(
            fmt::format("{} points of {} bits would take {} MB, which the {} bytes of "
                        "their part cannot fill",
                        records.count, bits, unpacked >> 20U, available / 8));
    }
}

Records open_records(const Source& source, const pugi::xml_node& scan) {
    const pugi::xml_node points = scan.child("points");
    const pugi::xml_node prototype = points.child("prototype");
    Records records;
    records.count = static_cast<std::uint64_t>(
        std::max<std::int64_t>(0, integer_attribute(source, points, "recordCount", 0)));
    for (const pugi::xml_node node : prototype.children()) {
        if (node.type() == pugi::node_element)
            records.streams.emplace_back(read_element(source, node));
    }
    const auto has = [&](const char* name) { return static_cast<bool>(prototype.child(name)); };
    const bool cartesian = has("cartesianX") && has("cartesianY") && has("cartesianZ");
    const bool spherical =
        has("sphericalRange") && has("sphericalAzimuth") && has("sphericalElevation");
    if (!cartesian && !spherical) source.fail("the points of a scan have no coordinates");
    records.spherical = !cartesian;
    for (const E57Stream& stream : records.streams)
        records.columns.push_back(make_column(source, scan, stream.element(), cartesian));
    if (records.count == 0) return records;

    const std::uint64_t section = source.pages.logical(static_cast<std::uint64_t>(
        std::max<std::int64_t>(0, integer_attribute(source, points, "fileOffset", 0))));
    if (source.pages.read_value<std::uint8_t>(section) != vector_section) {
        source.pages.fail(section, "the points of a scan are said to begin there, and do not");
    }
    const auto length = source.pages.read_value<std::uint64_t>(section + 8);
    records.position = source.pages.logical(source.pages.read_value<std::uint64_t>(section + 16));
    if (length > source.pages.size() - section || records.position < section ||
        records.position > section + length) {
        source.pages.fail(section, fmt::format("{} bytes of points do not fit there", length));
    }
    records.end = section + length;
    require_backed(source, records);
    return records;
}

/// Hands the next packet's bytes to the streams. False behind the last.
bool read_packet(const Source& source, Records& records, std::vector<std::byte>& packet) {
    constexpr std::size_t packet_header = 6;
    if (records.end - records.position < 4) return false;
    const auto type = source.pages.read_value<std::uint8_t>(records.position);
    const std::size_t length =
        std::size_t{source.pages.read_value<std::uint16_t>(records.position + 2)} + 1;
    if (length > records.end - records.position || length < 4) {
        source.pages.fail(records.position, "a packet of points is longer than their part");
    }
    if (type == data_packet) {
        packet.resize(length);
        source.pages.read(records.position, packet);
        const auto load = [&](std::size_t at) {
            return std::size_t{std::to_integer<std::uint8_t>(packet[at])} |
                   std::size_t{std::to_integer<std::uint8_t>(packet[at + 1])} << 8U;
        };
        const std::size_t num_streams = records.streams.size();
        std::size_t place = packet_header + 2 * num_streams;
        if (length < place || load(4) != num_streams) {
            source.pages.fail(records.position, "a packet has not the properties of the points");
        }
        for (std::size_t i = 0; i < num_streams; ++i) {
            const std::size_t size = load(packet_header + 2 * i);
            if (size > length - place) {
                source.pages.fail(records.position, "the parts of a packet are longer than it");
            }
            records.streams[i].append(std::span(packet).subspan(place, size));
            place += size;
        }
    }
    records.position += length;
    return true;
}

/// Finds out whether the indices of row and column count all cells one after another.
class GridFinder {
  public:
    GridFinder(const Source& source, const pugi::xml_node& scan, const Records& records)
        : count_(records.count),
          row_column_(records.streams.size()),
          column_column_(records.streams.size()) {
        const pugi::xml_node bounds = scan.child("indexBounds");
        for (std::size_t i = 0; i < records.streams.size(); ++i) {
            if (records.streams[i].element().name == "rowIndex") row_column_ = i;
            if (records.streams[i].element().name == "columnIndex") column_column_ = i;
        }
        first_row_ = number_in(source, bounds, "rowMinimum", 0.0);
        first_column_ = number_in(source, bounds, "columnMinimum", 0.0);
        rows_ = number_in(source, bounds, "rowMaximum", 0.0) - first_row_ + 1.0;
        columns_ = number_in(source, bounds, "columnMaximum", 0.0) - first_column_ + 1.0;
        const std::size_t none = records.streams.size();
        const bool complete = row_column_ < none && column_column_ < none && rows_ >= 2.0 &&
                              columns_ >= 2.0 && rows_ * columns_ == static_cast<double>(count_);
        by_row_ = by_column_ = complete;
    }
    void look(std::span<const std::vector<double>> values, std::size_t count) {
        for (std::size_t i = 0; i < count && (by_row_ || by_column_); ++i, ++seen_) {
            const double row = values[row_column_][i] - first_row_;
            const double column = values[column_column_][i] - first_column_;
            by_row_ = by_row_ && row * columns_ + column == static_cast<double>(seen_);
            by_column_ = by_column_ && column * rows_ + row == static_cast<double>(seen_);
        }
    }
    std::optional<ScanGrid> grid() const {
        const auto rows = static_cast<std::size_t>(by_row_ || by_column_ ? rows_ : 0.0);
        const auto columns = static_cast<std::size_t>(by_row_ || by_column_ ? columns_ : 0.0);
        if (by_row_) return ScanGrid{rows, columns};
        if (by_column_) return ScanGrid{columns, rows};
        return std::nullopt;
    }

  private:
    std::uint64_t count_;
    std::size_t row_column_;
    std::size_t column_column_;
    double first_row_ = 0.0;
    double first_column_ = 0.0;
    double rows_ = 0.0;
    double columns_ = 0.0;
    bool by_row_ = false;
    bool by_column_ = false;
    std::size_t seen_ = 0;
};

/// Puts the value of a field, in its own type, into the first bytes of the double. Packed bits may
/// hold more than the range that the file declares, and so more than its type.
void store_as(double& slot, ScalarType type) {
    with_scalar_type(type, [&]<typename Value>(std::type_identity<Value>) {
        if constexpr (std::is_integral_v<Value>) {
            using Limits = std::numeric_limits<Value>;
            const auto value = static_cast<Value>(std::clamp(
                slot, static_cast<double>(Limits::min()), static_cast<double>(Limits::max())));
            std::memcpy(&slot, &value, sizeof(value));
        } else if constexpr (!std::is_same_v<Value, double>) {
            const auto value = static_cast<Value>(slot);
            std::memcpy(&slot, &value, sizeof(value));
        }
    });
}

std::size_t index_of(std::span<const Column> columns, std::string_view name) {
    std::size_t i = 0;
    while (columns[i].field.name != name)
        ++i;
    return i;
}

/// Changes decoded values, one vector per column, into what the decoder takes.
void convert_values(std::span<const Column> columns, std::vector<std::vector<double>>& values,
                    std::size_t count, bool spherical) {
    const std::array<std::size_t, 3> xyz = {index_of(columns, "x"), index_of(columns, "y"),
                                            index_of(columns, "z")};
    for (std::size_t i = 0; i < count && spherical; ++i) {
        const double range = values[xyz[0]][i];
        const double azimuth = values[xyz[1]][i];
        const double elevation = values[xyz[2]][i];
        values[xyz[0]][i] = range * std::cos(elevation) * std::cos(azimuth);
        values[xyz[1]][i] = range * std::cos(elevation) * std::sin(azimuth);
        values[xyz[2]][i] = range * std::sin(elevation);
    }
    for (std::size_t c = 0; c < columns.size(); ++c) {
        const Column& column = columns[c];
        for (std::size_t i = 0; i < count; ++i) {
            double& slot = values[c][i];
            if (column.role == Role::invalid && slot != 0.0) {
                for (const std::size_t axis : xyz)
                    values[axis][i] = std::numeric_limits<double>::quiet_NaN();
            } else if (column.role == Role::color) {
                slot = color_byte((slot - column.color_zero) * column.color_scale);
            }
            if (column.role == Role::color || column.role == Role::keep) {
                store_as(slot, column.field.type);
            }
        }
    }
}

void decode_points(const Source& source, const pugi::xml_node& scan, Records& records, PointsAs as,
                   FileContents& contents, const Context& context) {
    std::vector<Field> fields;
    for (const Column& column : records.columns)
        fields.push_back(column.field);
    PointDecoder decoder(fields, static_cast<std::size_t>(records.count), as);
    GridFinder grid(source, scan, records);
    std::vector<std::vector<double>> values(fields.size());
    const std::size_t points_per_chunk = 1 + values_per_chunk / fields.size();
    std::vector<std::byte> packet;
    std::size_t done = 0;
    std::uint64_t held = records.position;
    while (done < records.count) {
        context.throw_if_cancelled();
        if (records.position - held >= bytes_let_go_at_once) {
            source.pages.let_go(held, records.position);
            held = records.position;
        }
        const bool more = read_packet(source, records, packet);
        const std::size_t left = static_cast<std::size_t>(records.count) - done;
        std::size_t count = left;
        for (std::size_t i = 0; i < values.size(); ++i) {
            const std::size_t wanted = std::min(left, points_per_chunk);
            records.streams[i].decode(values[i], wanted - std::min(wanted, values[i].size()));
            count = std::min(count, values[i].size());
        }
        if (count == 0 && !more) {
            source.pages.fail(records.position,
                              fmt::format("there are {} of {} points", done, records.count));
        }
        grid.look(values, count);
        convert_values(records.columns, values, count, records.spherical);
        std::vector<FieldSource> sources;
        sources.reserve(values.size());
        for (const std::vector<double>& column : values) {
            sources.push_back({reinterpret_cast<const std::byte*>(column.data()), sizeof(double)});
        }
        decoder.decode(sources, done, count, std::endian::native, context);
        for (std::vector<double>& column : values) {
            column.erase(column.begin(), column.begin() + static_cast<std::ptrdiff_t>(count));
        }
        done += count;
    }
    decoder.finish(contents, std::nullopt, grid.grid());
}

/// `unclaimed`: bytes of the file that no scan before took for its points. Without it, many scans
/// could name the same bytes.
FileContents read_one(const Source& source, const pugi::xml_node& scan, std::uint64_t& unclaimed,
                      PointsAs as, const Context& context) {
    FileContents contents;
    contents.format = "E57";
    contents.name = scan.child("name").text().get();
    contents.map_from_scan = read_pose(source, scan);
    Records records = open_records(source, scan);
    if (records.end - records.position > unclaimed) {
        source.fail("the points of several scans are said to stand in one place");
    }
    unclaimed -= records.end - records.position;
    for (const E57Stream& stream : records.streams)
        contents.fields.push_back({stream.element().name, type_of(stream.element()), 1});
    contents.encoding = fmt::format("{} properties", records.streams.size());
    decode_points(source, scan, records, as, contents, context);
    return contents;
}

std::string read_xml(const MappedFile& file, const E57Pages& pages) {
    const std::uint64_t xml_begin = pages.logical(pages.read_value<std::uint64_t>(24));
    const auto length = pages.read_value<std::uint64_t>(32);
    const auto page_size = pages.read_value<std::uint64_t>(40);
    if (page_size != e57_page_bytes || length > pages.size() - xml_begin) {
        throw IoError(file.path(), "E57", {.byte = 24, .line = {}},
                      "the header's place of the XML, its length or the page size is wrong", cure);
    }
    std::string xml(static_cast<std::size_t>(length), '\0');
    pages.read(xml_begin, std::as_writable_bytes(std::span(xml.data(), xml.size())));
    return xml;
}

}  // namespace

std::vector<FileContents> read_e57(const std::filesystem::path& path, PointsAs as,
                                   const Context& context) {
    const MappedFile file(path, "E57");
    if (!file.text().starts_with(magic) || file.bytes().size() < header_bytes) {
        throw IoError(file.path(), "E57", {.byte = 0, .line = {}},
                      "it does not begin as an E57 file does",
                      "if the file is of another format, name it so");
    }
    const E57Pages pages(file, context);
    const Source source{file, pages};
    const std::string xml = read_xml(file, pages);
    pugi::xml_document document;
    const pugi::xml_parse_result result = document.load_buffer(xml.data(), xml.size());
    if (!result) {
        source.fail(fmt::format("its XML cannot be read at byte {}: {}", result.offset,
                                result.description()));
    }
    std::vector<FileContents> scans;
    std::uint64_t unclaimed = pages.size();
    for (const pugi::xml_node scan : document.child("e57Root").child("data3D").children()) {
        if (scan.type() != pugi::node_element) continue;
        scans.push_back(read_one(source, scan, unclaimed, as, context));
    }
    if (scans.empty()) source.fail("there is no scan in it");
    return scans;
}

}  // namespace roomscribe
