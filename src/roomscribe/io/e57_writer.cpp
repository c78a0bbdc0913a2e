// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "roomscribe/io/atomic_file.hpp"
#include "roomscribe/io/byte_writer.hpp"
#include "roomscribe/io/e57.hpp"
#include "roomscribe/io/e57_pages.hpp"
#include "roomscribe/io/point_encoder.hpp"
#include "roomscribe/io/scalar_dispatch.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t header_bytes = 48;
constexpr std::size_t section_header_bytes = 32;
constexpr std::size_t index_bytes = 32;
constexpr std::size_t packet_header_bytes = 6;
constexpr std::size_t max_packet_bytes = 65536;

/// One property as it is written: bytes of `column`, or of the state that marks missing points.
struct Property {
    std::string name;
    FieldColumn column;
};

/// A scan that is ready to be written.
struct Prepared {
    const StoredScan* stored = nullptr;
    std::vector<std::uint8_t> invalid;  ///< 0, or 2 for points without coordinates
    std::vector<std::uint32_t> rows;
    std::vector<std::uint32_t> columns;
    PointColumns points;
    std::vector<Property> properties;
    std::size_t record_bytes = 0;
    std::size_t records_per_packet = 0;
    std::uint64_t section = 0;  ///< logical place
    std::uint64_t section_bytes = 0;
};

std::string xml_name(const std::string& name) {
    std::string safe;
    for (const char c : name) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                           (c >= '0' && c <= '9') || c == '_' || c == '.' || c == '-';
        safe += plain ? c : '_';
    }
    return safe;
}

std::string xml_text(std::string_view text) {
    std::string safe;
    for (const char c : text) {
        if (c == '<') {
            safe += "&lt;";
        } else if (c == '&') {
            safe += "&amp;";
        } else if (c >= ' ') {
            safe += c;
        }
    }
    return safe;
}

/// The names of the standard, and of the extensions.
std::string property_name(const std::string& field) {
    constexpr std::pair<std::string_view, std::string_view> known[] = {
        {"x", "cartesianX"},           {"y", "cartesianY"},
        {"z", "cartesianZ"},           {"red", "colorRed"},
        {"green", "colorGreen"},       {"blue", "colorBlue"},
        {"intensity", "intensity"},    {"nx", "nor:normalX"},
        {"ny", "nor:normalY"},         {"nz", "nor:normalZ"},
        {"rowIndex", "rowIndex"},      {"columnIndex", "columnIndex"},
        {"timeStamp", "timeStamp"},    {"returnIndex", "returnIndex"},
        {"returnCount", "returnCount"}};
    for (const auto& [name, property] : known) {
        if (field == name) return std::string(property);
    }
    return fmt::format("{}:{}", e57_channel_prefix, xml_name(field));
}

template <typename Value>
FieldColumn column_of(const char* name, ScalarType type, const std::vector<Value>& values) {
    return {{name, type, 1}, reinterpret_cast<const std::byte*>(values.data()), sizeof(Value)};
}

std::uint64_t packet_bytes(const Prepared& scan, std::size_t count) {
    const std::size_t bytes =
        packet_header_bytes + 2 * scan.properties.size() + scan.record_bytes * count;
    return (bytes + 3) / 4 * 4;
}

void add_grid(Prepared& scan, const PointCloud& cloud) {
    const auto has = [&](std::string_view name) {
        return std::any_of(cloud.channels.begin(), cloud.channels.end(),
                           [&](const Channel& channel) { return channel.name == name; });
    };
    if (!cloud.grid || has("rowIndex") || has("columnIndex")) return;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        scan.rows.push_back(static_cast<std::uint32_t>(i / cloud.grid->columns));
        scan.columns.push_back(static_cast<std::uint32_t>(i % cloud.grid->columns));
    }
    scan.properties.push_back({"rowIndex", column_of("rowIndex", ScalarType::uint32, scan.rows)});
    scan.properties.push_back(
        {"columnIndex", column_of("columnIndex", ScalarType::uint32, scan.columns)});
}

Prepared prepare(const StoredScan& stored) {
    const PointCloud& cloud = stored.scan.cloud;
    Prepared scan{&stored, {}, {}, {}, PointColumns(cloud, FieldStyle::las), {}};
    for (const FieldColumn& column : scan.points.columns())
        scan.properties.push_back({property_name(column.field.name), column});
    const bool complete = std::all_of(cloud.positions.begin(), cloud.positions.end(), is_finite);
    if (!complete) {
        for (const Eigen::Vector3f& point : cloud.positions)
            scan.invalid.push_back(is_finite(point) ? 0 : 2);
        scan.properties.push_back(
            {"cartesianInvalidState", column_of("invalid", ScalarType::uint8, scan.invalid)});
    }
    add_grid(scan, cloud);
    for (const Property& property : scan.properties)
        scan.record_bytes += property.column.field.bytes();
    const std::size_t fixed = packet_header_bytes + 2 * scan.properties.size() + 3;
    scan.records_per_packet =
        std::max<std::size_t>(1, (max_packet_bytes - fixed) / scan.record_bytes);
    scan.section_bytes = section_header_bytes;
    const std::size_t count = cloud.size();
    const std::size_t full = count / scan.records_per_packet;
    const std::size_t rest = count % scan.records_per_packet;
    scan.section_bytes += full * packet_bytes(scan, scan.records_per_packet);
    if (rest > 0) scan.section_bytes += packet_bytes(scan, rest);
    if (count > 0) scan.section_bytes += index_bytes;
    return scan;
}

std::string element_xml(const Property& property) {
    const ScalarType type = property.column.field.type;
    if (type == ScalarType::float32) {
        return fmt::format("<{} type=\"Float\" precision=\"single\"/>", property.name);
    }
    if (type == ScalarType::float64) return fmt::format("<{} type=\"Float\"/>", property.name);
    return with_scalar_type(type, [&]<typename Value>(std::type_identity<Value>) {
        using Limits = std::numeric_limits<Value>;
        // A range of 64 bits has the signed ends; the bits are those of either type.
        if constexpr (sizeof(Value) == 8) {
            return fmt::format("<{} type=\"Integer\"/>", property.name);
        } else {
            return fmt::format("<{} type=\"Integer\" minimum=\"{}\" maximum=\"{}\"/>",
                               property.name, Limits::min(), Limits::max());
        }
    });
}

std::string pose_xml(const StoredScan& stored) {
    if (!stored.map_from_scan) return {};
    const Eigen::Quaterniond q(stored.map_from_scan->linear());
    const Eigen::Vector3d t = stored.map_from_scan->translation() + stored.map_shift;
    const auto number = [](const char* name, double value) {
        return fmt::format("<{0} type=\"Float\">{1}</{0}>", name, value);
    };
    return "<pose type=\"Structure\"><rotation type=\"Structure\">" + number("w", q.w()) +
           number("x", q.x()) + number("y", q.y()) + number("z", q.z()) +
           "</rotation><translation type=\"Structure\">" + number("x", t.x()) + number("y", t.y()) +
           number("z", t.z()) + "</translation></pose>\n";
}

std::string limits_xml(const PointCloud& cloud) {
    std::string xml;
    if (!cloud.colors.empty()) {
        xml += "<colorLimits type=\"Structure\">";
        for (const char* color : {"Red", "Green", "Blue"}) {
            xml += fmt::format(
                "<color{0}Minimum type=\"Integer\">0</color{0}Minimum>"
                "<color{0}Maximum type=\"Integer\">255</color{0}Maximum>",
                color);
        }
        xml += "</colorLimits>\n";
    }
    if (!cloud.intensities.empty()) {
        float low = std::numeric_limits<float>::max();
        float high = std::numeric_limits<float>::lowest();
        for (const float value : cloud.intensities) {
            if (!std::isfinite(value)) continue;
            low = std::min(low, value);
            high = std::max(high, value);
        }
        if (low <= high) {
            xml += fmt::format(
                "<intensityLimits type=\"Structure\"><intensityMinimum type=\"Float\">{}"
                "</intensityMinimum><intensityMaximum type=\"Float\">{}</intensityMaximum>"
                "</intensityLimits>\n",
                low, high);
        }
    }
    if (cloud.grid) {
        xml += fmt::format(
            "<indexBounds type=\"Structure\"><rowMinimum type=\"Integer\">0</rowMinimum>"
            "<rowMaximum type=\"Integer\">{}</rowMaximum><columnMinimum type=\"Integer\">0"
            "</columnMinimum><columnMaximum type=\"Integer\">{}</columnMaximum></indexBounds>\n",
            cloud.grid->rows - 1, cloud.grid->columns - 1);
    }
    return xml;
}

std::string guid(std::uint64_t a, std::uint64_t b) {
    return fmt::format("{{{:08x}-0000-4000-8000-{:012x}}}", a & 0xffffffffU, b & 0xffffffffffffU);
}

std::string scan_xml(const Prepared& scan, std::size_t number) {
    const PointCloud& cloud = scan.stored->scan.cloud;
    std::string xml = fmt::format(
        "<vectorChild type=\"Structure\">\n<guid type=\"String\"><![CDATA[{}]]></guid>\n"
        "<name type=\"String\">{}</name>\n",
        guid(number + 1, cloud.size()), xml_text(scan.stored->scan.name));
    xml += pose_xml(*scan.stored) + limits_xml(cloud);
    xml += fmt::format(
        "<points type=\"CompressedVector\" fileOffset=\"{}\" recordCount=\"{}\">\n"
        "<prototype type=\"Structure\">\n",
        e57_physical(scan.section), cloud.size());
    for (const Property& property : scan.properties)
        xml += element_xml(property) + "\n";
    return xml +
           "</prototype>\n<codecs type=\"Vector\" allowHeterogeneousChildren=\"1\"></codecs>\n"
           "</points>\n</vectorChild>\n";
}

std::string file_xml(std::span<const Prepared> scans) {
    std::string xml = fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<e57Root type=\"Structure\" xmlns=\"http://www.astm.org/COMMIT/E57/2010-e57-v1.0\" "
        "xmlns:{}=\"http://www.libe57.org/E57_NOR_surface_normals.txt\" xmlns:{}=\"urn:roomscribe:"
        "channels\">\n<formatName type=\"String\">ASTM E57 3D Imaging Data File</formatName>\n"
        "<guid type=\"String\"><![CDATA[{}]]></guid>\n<versionMajor type=\"Integer\">1"
        "</versionMajor>\n<versionMinor type=\"Integer\">0</versionMinor>\n"
        "<data3D type=\"Vector\" allowHeterogeneousChildren=\"1\">\n",
        e57_normal_prefix, e57_channel_prefix, guid(0, scans.size()));
    for (std::size_t i = 0; i < scans.size(); ++i)
        xml += scan_xml(scans[i], i);
    return xml +
           "</data3D>\n<images2D type=\"Vector\" allowHeterogeneousChildren=\"1\"></images2D>\n"
           "</e57Root>\n";
}

std::string packet_text(const Prepared& scan, std::size_t first, std::size_t count) {
    const std::size_t size = packet_bytes(scan, count);
    ByteWriter packet;
    packet.add<std::uint8_t>(1);
    packet.add<std::uint8_t>(0);
    packet.add(static_cast<std::uint16_t>(size - 1));
    packet.add(static_cast<std::uint16_t>(scan.properties.size()));
    for (const Property& property : scan.properties)
        packet.add(static_cast<std::uint16_t>(property.column.field.bytes() * count));
    for (const Property& property : scan.properties) {
        const ScalarType type = property.column.field.type;
        const bool coordinate = property.name.starts_with("cartesian") && !scan.invalid.empty();
        with_scalar_type(type, [&]<typename Value>(std::type_identity<Value>) {
            for (std::size_t i = first; i < first + count; ++i) {
                Value value;
                std::memcpy(&value, property.column.first + i * property.column.stride,
                            sizeof(Value));
                // Missing coordinates are 0 for those who do not look at the mark.
                if constexpr (std::is_floating_point_v<Value>) {
                    if (coordinate && scan.invalid[i] != 0) value = 0;
                } else {
                    // Integers are stored less their minimum.
                    using Unsigned = std::make_unsigned_t<Value>;
                    const auto low =
                        std::is_unsigned_v<Value> && sizeof(Value) < 8
                            ? Unsigned{0}
                            : static_cast<Unsigned>(
                                  std::numeric_limits<std::make_signed_t<Value>>::min());
                    value = static_cast<Value>(
                        static_cast<Unsigned>(static_cast<Unsigned>(value) - low));
                }
                packet.add(value);
            }
        });
    }
    packet.add_text("", size - packet.bytes().size());
    return packet.bytes();
}

void write_section(E57PageWriter& writer, const Prepared& scan, const Context& context) {
    const std::size_t count = scan.stored->scan.cloud.size();
    const std::uint64_t data = scan.section + section_header_bytes;
    ByteWriter header;
    header.add<std::uint64_t>(1);  // the kind of section, and 7 bytes of zeros
    header.add(scan.section_bytes);
    header.add(count > 0 ? e57_physical(data) : std::uint64_t{0});
    header.add(count > 0 ? e57_physical(scan.section + scan.section_bytes - index_bytes)
                         : std::uint64_t{0});
    writer.write(header.bytes());
    for (std::size_t first = 0; first < count; first += scan.records_per_packet) {
        context.throw_if_cancelled();
        writer.write(packet_text(scan, first, std::min(scan.records_per_packet, count - first)));
    }
    if (count == 0) return;
    // An index of one entry: record 0 is in the first packet.
    ByteWriter index;
    index.add<std::uint16_t>(0);
    index.add(static_cast<std::uint16_t>(index_bytes - 1));
    index.add<std::uint16_t>(1);
    index.add_text("", 10);
    index.add<std::uint64_t>(0);
    index.add(e57_physical(data));
    writer.write(index.bytes());
}

}  // namespace

void write_e57(const std::filesystem::path& path, std::span<const StoredScan> stored,
               const Context& context) {
    std::vector<Prepared> scans;
    std::uint64_t place = header_bytes;
    for (const StoredScan& one : stored) {
        scans.push_back(prepare(one));
        scans.back().section = place;
        place += scans.back().section_bytes;
    }
    const std::string xml = file_xml(scans);
    const std::uint64_t pages = (place + xml.size() + e57_page_content - 1) / e57_page_content;
    ByteWriter header;
    header.add_text("ASTM-E57", 8);
    header.add<std::uint32_t>(1);
    header.add<std::uint32_t>(0);
    header.add(pages * e57_page_bytes);
    header.add(e57_physical(place));
    header.add<std::uint64_t>(xml.size());
    header.add<std::uint64_t>(e57_page_bytes);

    AtomicFile file(path, "E57");
    E57PageWriter writer(file);
    writer.write(header.bytes());
    for (const Prepared& scan : scans)
        write_section(writer, scan, context);
    writer.write(xml);
    writer.finish();
    file.commit();
}

}  // namespace roomscribe
