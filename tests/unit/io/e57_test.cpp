// SPDX-License-Identifier: MIT
// E57 files put together bit by bit, and round trips.
#include "roomscribe/io/e57.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io_test_clouds.hpp"
#include "roomscribe/core/error.hpp"
#include "roomscribe/io/e57_pages.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "support/matchers.hpp"
#include "support/test_data.hpp"

namespace roomscribe {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::span<const std::byte> bytes_of(const std::string& text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}

template <typename Value>
void add(std::string& bytes, Value value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

template <typename Value>
void put(std::string& bytes, std::size_t offset, Value value) {
    std::memcpy(bytes.data() + offset, &value, sizeof(value));
}

/// The lowest bits first, as the standard packs them.
class BitWriter {
  public:
    BitWriter& add(std::uint64_t value, unsigned bits) {
        for (unsigned i = 0; i < bits; ++i, ++count_) {
            if (count_ % 8 == 0) bytes_ += '\0';
            const auto bit = static_cast<unsigned>(value >> i & 1U) << count_ % 8;
            bytes_.back() = static_cast<char>(static_cast<unsigned char>(bytes_.back()) | bit);
        }
        return *this;
    }
    const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
    unsigned count_ = 0;
};

std::string paged(std::string logical) {
    logical.resize((logical.size() + 1019) / 1020 * 1020, '\0');
    std::string file;
    for (std::size_t page = 0; page < logical.size(); page += 1020) {
        const std::string content = logical.substr(page, 1020);
        const std::uint32_t sum = crc32c(bytes_of(content));
        file += content;
        for (const unsigned shift : {24U, 16U, 8U, 0U})
            file += static_cast<char>(sum >> shift);
    }
    return file;
}

std::string packet_of(const std::vector<std::string>& streams) {
    std::string packet("\1\0\0\0", 4);
    add(packet, static_cast<std::uint16_t>(streams.size()));
    for (const std::string& stream : streams)
        add(packet, static_cast<std::uint16_t>(stream.size()));
    for (const std::string& stream : streams)
        packet += stream;
    packet.resize((packet.size() + 3) / 4 * 4, '\0');
    put(packet, 2, static_cast<std::uint16_t>(packet.size() - 1));
    return packet;
}

/// A file of one scan: its properties, what else the scan says, and the packets.
std::string e57_logical(const std::string& prototype, const std::string& rest, std::size_t count,
                        const std::vector<std::string>& packets) {
    std::string section(32, '\0');
    section[0] = 1;
    for (const std::string& packet : packets)
        section += packet;
    put<std::uint64_t>(section, 8, section.size());
    put<std::uint64_t>(section, 16, e57_physical(48 + 32));
    const std::string xml =
        "<?xml version=\"1.0\"?><e57Root type=\"Structure\"><data3D type=\"Vector\">"
        "<vectorChild type=\"Structure\">" +
        rest + "<points type=\"CompressedVector\" fileOffset=\"48\" recordCount=\"" +
        std::to_string(count) + "\"><prototype type=\"Structure\">" + prototype +
        "</prototype></points></vectorChild></data3D></e57Root>";
    std::string bytes = "ASTM-E57";
    add<std::uint32_t>(bytes, 1);
    add<std::uint32_t>(bytes, 0);
    const std::size_t size = 48 + section.size() + xml.size();
    add<std::uint64_t>(bytes, (size + 1019) / 1020 * 1024);
    add<std::uint64_t>(bytes, e57_physical(48 + section.size()));
    add<std::uint64_t>(bytes, xml.size());
    add<std::uint64_t>(bytes, 1024);
    return bytes + section + xml;
}

const std::string single_xyz =
    "<cartesianX type=\"Float\" precision=\"single\"/><cartesianY type=\"Float\" "
    "precision=\"single\"/><cartesianZ type=\"Float\" precision=\"single\"/>";

template <typename Value>
std::string values(std::initializer_list<Value> list) {
    std::string bytes;
    for (const Value value : list)
        add(bytes, value);
    return bytes;
}

std::vector<StoredScan> read_file(const std::string& bytes) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "a.e57", bytes);
    return read_scans(folder / "a.e57");
}

PointCloud read_one(const std::string& logical) {
    return std::move(read_file(paged(logical)).front().scan.cloud);
}

std::string error_of(const std::string& bytes) {
    try {
        read_file(bytes);
    } catch (const IoError& error) {
        return error.what();
    }
    return "it was read";
}

TEST(E57, ChecksumIsCastagnolis) {
    EXPECT_EQ(crc32c(bytes_of("123456789")), 0xe3069283U);
    EXPECT_EQ(crc32c(bytes_of(std::string(32, '\0'))), 0x8a9136aaU);
}

TEST(E57, ReadsPackedIntegersAcrossPackets) {
    // x: 12 bits in steps of 1 cm from -10 m; y: 3 bits; z: a constant.
    const std::string prototype =
        "<cartesianX type=\"ScaledInteger\" minimum=\"-1000\" maximum=\"3000\" scale=\"0.01\" "
        "offset=\"0.5\"/><cartesianY type=\"Integer\" minimum=\"-3\" maximum=\"4\"/>"
        "<cartesianZ type=\"Integer\" minimum=\"7\" maximum=\"7\"/>"
        "<colorRed type=\"Integer\" minimum=\"0\" maximum=\"255\"/>"
        "<colorGreen type=\"Integer\" minimum=\"0\" maximum=\"65535\"/>"
        "<colorBlue type=\"Float\" precision=\"single\"/>"
        "<intensity type=\"Float\"/><ring type=\"Integer\" minimum=\"0\" maximum=\"300\"/>";
    BitWriter x;
    BitWriter y;
    BitWriter ring;
    for (const unsigned i : {0U, 1U, 2U}) {
        x.add(1000 * i, 12);
        y.add(i + 1, 3);
        ring.add(100 * i, 9);
    }
    const std::string blue = values<float>({0.0F, 1.0F, 0.2F});
    const std::string green = values<std::uint16_t>({0, 65535, 257});
    const std::string light = values<double>({0.25, 1e9, -3.0});
    // The second packet begins within a value of x and of blue.
    const auto logical = e57_logical(
        prototype, "", 3,
        {packet_of({x.bytes().substr(0, 2), y.bytes().substr(0, 1), "", "\1", green.substr(0, 2),
                    blue.substr(0, 5), light, ring.bytes().substr(0, 3)}),
         std::string("\2\0\3\0", 4),
         packet_of({x.bytes().substr(2), y.bytes().substr(1), "", "\x80\xff", green.substr(2),
                    blue.substr(5), "", ring.bytes().substr(3)})});
    const PointCloud cloud = read_one(logical);
    ASSERT_EQ(cloud.size(), 3U);
    EXPECT_EQ(cloud.positions[0], Eigen::Vector3f(-9.5F, -2.0F, 7.0F));
    EXPECT_EQ(cloud.positions[1], Eigen::Vector3f(0.5F, -1.0F, 7.0F));
    EXPECT_EQ(cloud.positions[2], Eigen::Vector3f(10.5F, 0.0F, 7.0F));
    EXPECT_THAT(cloud.colors, ElementsAre(ElementsAre(1, 0, 0), ElementsAre(128, 255, 255),
                                          ElementsAre(255, 1, 51)));
    EXPECT_THAT(cloud.intensities, ElementsAre(0.25F, 1e9F, -3.0F));
    const Channel* channel = test::find_channel(cloud, "ring");
    ASSERT_NE(channel, nullptr);
    EXPECT_EQ(channel->type, ScalarType::uint16);
    EXPECT_EQ(static_cast<int>(channel->values[4]), 200);
}

TEST(E57, IntegersOfEveryWidthComeBack) {
    for (unsigned bits = 1; bits <= 53; ++bits) {
        SCOPED_TRACE(bits);
        const std::uint64_t highest = (std::uint64_t{1} << bits) - 1;
        BitWriter wide;
        std::string floats;
        Random random(bits);
        std::vector<double> expected;
        for (int i = 0; i < 50; ++i) {
            const std::uint64_t value = i == 0 ? highest : random.next() & highest;
            wide.add(value, bits);
            expected.push_back(static_cast<double>(value) - 5.0);
            add(floats, 1.0F);
        }
        const std::string prototype =
            single_xyz + "<wide type=\"ScaledInteger\" minimum=\"-5\" maximum=\"" +
            std::to_string(static_cast<std::int64_t>(highest) - 5) + "\"/>";
        const PointCloud cloud = read_one(
            e57_logical(prototype, "", 50, {packet_of({floats, floats, floats, wide.bytes()})}));
        std::vector<double> found(50);
        ASSERT_EQ(cloud.channels.size(), 1U);
        ASSERT_EQ(cloud.channels[0].type, ScalarType::float64);
        std::memcpy(found.data(), cloud.channels[0].values.data(), 50 * sizeof(double));
        EXPECT_EQ(found, expected);
    }
}

TEST(E57, SphericalPointsBecomeCartesianAndInvalidOnesNan) {
    const std::string prototype =
        "<sphericalRange type=\"Float\"/><sphericalAzimuth type=\"Float\"/>"
        "<sphericalElevation type=\"Float\"/>"
        "<sphericalInvalidState type=\"Integer\" minimum=\"0\" maximum=\"2\"/>";
    const double quarter = 3.14159265358979323846 / 2.0;
    const PointCloud cloud = read_one(
        e57_logical(prototype, "", 4,
                    {packet_of({values<double>({2, 2, 2, 9}), values<double>({0, quarter, 0, 0}),
                                values<double>({0, 0, quarter, 0}),
                                BitWriter().add(0, 2).add(0, 2).add(0, 2).add(1, 2).bytes()})}));
    EXPECT_THAT(cloud.positions[0], test::VectorNear(Eigen::Vector3f(2, 0, 0), 1e-6));
    EXPECT_THAT(cloud.positions[1], test::VectorNear(Eigen::Vector3f(0, 2, 0), 1e-6));
    EXPECT_THAT(cloud.positions[2], test::VectorNear(Eigen::Vector3f(0, 0, 2), 1e-6));
    EXPECT_FALSE(is_finite(cloud.positions[3]));
}

TEST(E57, ReadsPoseNameAndColourLimits) {
    const std::string rest =
        "<name type=\"String\">hall</name><pose type=\"Structure\"><rotation type=\"Structure\">"
        "<w type=\"Float\">0.70710678118654757</w><x type=\"Float\">0</x><y type=\"Float\"/>"
        "<z type=\"Float\">0.70710678118654757</z></rotation><translation type=\"Structure\">"
        "<x type=\"Float\">1e1</x><y type=\"Float\">20</y><z type=\"Float\">30</z></translation>"
        "</pose><colorLimits type=\"Structure\"><colorRedMinimum type=\"Integer\">100"
        "</colorRedMinimum><colorRedMaximum type=\"Integer\">200</colorRedMaximum></colorLimits>";
    const std::string prototype = single_xyz +
                                  "<colorRed type=\"Integer\" minimum=\"0\" maximum=\"255\"/>"
                                  "<colorGreen type=\"Integer\" minimum=\"0\" maximum=\"255\"/>"
                                  "<colorBlue type=\"Integer\" minimum=\"0\" maximum=\"255\"/>";
    const test::TemporaryFolder folder;
    const std::string one = values<float>({1.0F});
    test::write_bytes(
        folder / "a.e57",
        paged(e57_logical(prototype, rest, 1, {packet_of({one, one, one, "\xa0", "\7", "\x9"})})));
    const FileSummary summary = summarize_file(folder / "a.e57").front();
    EXPECT_EQ(summary.name, "hall");
    ASSERT_TRUE(summary.map_from_scan);
    const Eigen::Vector3d moved = *summary.map_from_scan * Eigen::Vector3d(1, 0, 0);
    EXPECT_THAT(moved, test::VectorNear(Eigen::Vector3d(10, 21, 30), 1e-12));
    EXPECT_THAT(read_scan(folder / "a.e57").cloud.colors, ElementsAre(ElementsAre(153, 7, 9)));
}

PointCloud small_cloud() {
    PointCloud cloud;
    for (int i = 0; i < 1000; ++i)
        cloud.positions.emplace_back(static_cast<float>(i) * 0.1F, 1.0F, 2.0F);
    return cloud;
}

TEST(E57, DamagedPagesAreNamed) {
    const test::TemporaryFolder folder;
    write_point_cloud(folder / "a.e57", small_cloud());
    const std::string bytes = test::read_bytes(folder / "a.e57");
    for (std::size_t place = 100; place < bytes.size(); place += 997) {
        std::string changed = bytes;
        changed[place] = static_cast<char>(changed[place] ^ 0x10);
        EXPECT_THAT(error_of(changed), HasSubstr(": " + std::to_string(place / 1024)));
    }
    std::string two = bytes;
    two[1024] = static_cast<char>(two[1024] ^ 1);
    two[5 * 1024 + 1023] = static_cast<char>(two[5 * 1024 + 1023] ^ 1);
    EXPECT_THAT(error_of(two),
                HasSubstr("2 of 13 pages are damaged (their checksum is wrong): 1, 5"));
    EXPECT_THAT(error_of(bytes.substr(0, 2000)), HasSubstr("no whole number of pages"));
    EXPECT_THAT(error_of(bytes.substr(0, 2048)), HasSubstr("E57"));
}

TEST(E57, WrongPlacesCountsAndXmlAreRefused) {
    const std::string ones = values<float>({1.0F, 2.0F});
    const auto file = [&](std::size_t count) {
        return e57_logical(single_xyz, "", count, {packet_of({ones, ones, ones})});
    };
    const std::string good = file(2);
    const auto changed = [&](std::size_t place, std::uint64_t value) {
        std::string logical = good;
        put(logical, place, value);
        return paged(logical);
    };
    const auto replaced = [&](const std::string& from, const std::string& to) {
        std::string logical = good;
        logical.replace(logical.find(from), from.size(), to);
        return paged(logical);
    };
    ASSERT_EQ(read_one(good).size(), 2U);
    for (const auto& [bytes, reason] : std::vector<std::pair<std::string, const char*>>{
             {"ASTM-E58" + std::string(1016, '\0'), "does not begin"},
             {changed(24, 1022), "cannot"},
             {changed(24, ~std::uint64_t{0}), "cannot"},
             {changed(32, 1 << 20), "XML"},
             {changed(40, 2048), "page size"},
             {changed(48, 2), "do not"},
             {changed(56, 1 << 20), "do not fit"},
             {changed(64, 1 << 20), "cannot"},
             {paged(file(3)), "2 of 3 points"},
             {paged(file(4294967295)), "do not fit"},
             {replaced("recordCount=\"2", "recordCount=\"x"), "recordCount"},
             {replaced("<cartesianZ", "<cartesianW"), "XML cannot be read|no coordinates"},
             {replaced("</data3D>", "</data3X>"), "XML cannot be read"},
             {replaced("type=\"Float\"", "type=\"Flaot\""), "no number"}}) {
        EXPECT_THAT(error_of(bytes), testing::ContainsRegex(reason));
    }
}

std::string constant(const std::string& name) {
    return "<" + name + R"( type="Integer" minimum="7" maximum="7"/>)";
}

TEST(E57, BytesThatUnpackToAHundredfoldAreRefused) {
    const std::string one_bit = R"(<cartesianX type="Integer" minimum="0" maximum="1"/>)" +
                                constant("cartesianY") + constant("cartesianZ");
    const std::vector<std::string> packets(3, packet_of({std::string(60000, '\1'), "", ""}));
    EXPECT_EQ(read_one(e57_logical(one_bit, "", 60000, packets)).size(), 60000U);
    EXPECT_THAT(error_of(paged(e57_logical(one_bit, "", 1440000, packets))),
                HasSubstr("cannot fill"));
    std::string many = one_bit;
    for (int i = 0; i < 500; ++i)
        many += constant("p" + std::to_string(i));
    EXPECT_THAT(error_of(paged(e57_logical(many, "", 60000, packets))), HasSubstr("cannot fill"));
}

TEST(E57, ScansThatShareTheirBytesAreRefused) {
    const std::string ones = values<float>({1.0F, 2.0F});
    std::vector<std::string> streams(3, ones);
    std::string logical =
        e57_logical(single_xyz, "", 2, {packet_of(streams), std::string(4000, '\0')});
    const std::size_t begin = logical.find("<vectorChild");
    const std::size_t end = logical.find("</data3D>");
    const std::string scan = logical.substr(begin, end - begin);
    logical.insert(end, scan);
    put<std::uint64_t>(logical, 32, logical.size() - logical.find("<?xml"));
    EXPECT_THAT(error_of(paged(logical)), HasSubstr("in one place"));
}

TEST(E57, ChangedBytesUnderRightChecksumsNeverDoHarm) {
    const test::TemporaryFolder folder;
    const std::string ones = values<float>({1.0F, 2.0F});
    const std::string logical = e57_logical(
        single_xyz + "<cartesianInvalidState type=\"Integer\" minimum=\"0\" maximum=\"2\"/>", "", 2,
        {packet_of({ones, ones, ones, "\1"})});
    for (std::uint64_t seed = 0; seed < 3000; ++seed) {
        Random random(seed);
        std::string changed = logical;
        for (std::size_t i = 1 + random.below(4); i > 0; --i) {
            changed[random.below(static_cast<std::uint32_t>(changed.size()))] =
                static_cast<char>(random.next());
        }
        test::write_bytes(folder / "a.e57", paged(changed));
        try {
            EXPECT_LE(read_scan(folder / "a.e57").cloud.size(), 8 * changed.size());
        } catch (const IoError&) {
        }
    }
}

constexpr std::array<ScalarType, 8> kept_types = {
    ScalarType::int8,  ScalarType::uint8,  ScalarType::int16,   ScalarType::uint16,
    ScalarType::int32, ScalarType::uint32, ScalarType::float32, ScalarType::float64};

TEST(E57, RoundTripKeepsAllBits) {
    const test::TemporaryFolder folder;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        SCOPED_TRACE(seed);
        PointCloud cloud = test::random_cloud(seed, kept_types);
        if (seed % 3 == 0) cloud.global_shift = Eigen::Vector3d(4.5e6, -1.2e5, 300);
        write_point_cloud(folder / "a.e57", cloud);
        const PointCloud back = read_scan(folder / "a.e57").cloud;
        ASSERT_EQ(back.size(), cloud.size());
        for (std::size_t i = 0; i < cloud.size(); ++i) {
            ASSERT_EQ(is_finite(back.positions[i]), is_finite(cloud.positions[i]));
            if (!is_finite(cloud.positions[i])) continue;
            const Eigen::Vector3d before = cloud.positions[i].cast<double>() + cloud.global_shift;
            const Eigen::Vector3d after = back.positions[i].cast<double>() + back.global_shift;
            if (seed % 3 == 0) {
                EXPECT_THAT(after, test::VectorNear(before, 0x1p-15));
            } else {
                EXPECT_EQ(after, before);
            }
        }
        EXPECT_TRUE(test::same_bits(back.normals, cloud.normals));
        EXPECT_TRUE(test::same_bits(back.colors, cloud.colors));
        EXPECT_TRUE(test::same_bits(back.intensities, cloud.intensities));
        for (const Channel& channel : cloud.channels) {
            const Channel* same = test::find_channel(back, channel.name);
            ASSERT_NE(same, nullptr) << channel.name;
            EXPECT_EQ(same->type, channel.type);
            EXPECT_TRUE(test::same_bits(same->values, channel.values)) << channel.name;
        }
        const bool has_grid = cloud.grid && cloud.grid->rows > 1 && cloud.grid->columns > 1;
        ASSERT_EQ(back.grid.has_value(), has_grid);
        if (has_grid) {
            EXPECT_EQ(back.grid->columns, cloud.grid->columns);
        }
    }
}

TEST(E57, SeveralScansComeBackWithPosesFarAway) {
    const test::TemporaryFolder folder;
    std::vector<StoredScan> scans(3);
    for (std::size_t i = 0; i < scans.size(); ++i) {
        scans[i].scan = {i == 2 ? "hall" : "stair", small_cloud()};
        scans[i].map_from_scan =
            Eigen::Translation3d(1.25 * static_cast<double>(i), 2, 3) *
            Eigen::AngleAxisd(static_cast<double>(i), Eigen::Vector3d(1, 2, 3).normalized());
        scans[i].map_shift = Eigen::Vector3d(4.5e6, 5.4e6, 0);
    }
    write_e57(folder / "b.e57", scans, {});
    const std::vector<StoredScan> back = read_scans(folder / "b.e57");
    ASSERT_EQ(back.size(), 3U);
    EXPECT_EQ(back[0].scan.name, "b.e57#1");
    EXPECT_EQ(back[2].scan.name, "b.e57#hall");
    for (std::size_t i = 0; i < scans.size(); ++i) {
        EXPECT_TRUE(test::same_bits(back[i].scan.cloud.positions, scans[i].scan.cloud.positions));
        EXPECT_EQ(back[i].map_shift, scans[i].map_shift);
        ASSERT_TRUE(back[i].map_from_scan);
        EXPECT_THAT(*back[i].map_from_scan,
                    test::TransformNear(*scans[i].map_from_scan, 1e-8, 1e-9));
    }
}

/// As many as fill several packets, the last of them not whole.
TEST(E57, ManyPointsKeepTheirOrder) {
    const test::TemporaryFolder folder;
    PointCloud cloud;
    for (int i = 0; i < 200001; ++i) {
        cloud.positions.emplace_back(static_cast<float>(i), 1.0F, 2.0F);
        cloud.intensities.push_back(static_cast<float>(i % 31));
    }
    write_point_cloud(folder / "a.e57", cloud);
    const PointCloud back = read_scan(folder / "a.e57").cloud;
    EXPECT_TRUE(test::same_bits(back.positions, cloud.positions));
    EXPECT_TRUE(test::same_bits(back.intensities, cloud.intensities));
}

}  // namespace
}  // namespace roomscribe
