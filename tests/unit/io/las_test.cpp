// SPDX-License-Identifier: MIT
// LAS files written byte by byte, and round trips.
#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io_test_clouds.hpp"
#include "roomscribe/core/error.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "support/test_data.hpp"

namespace roomscribe {
namespace {

using testing::HasSubstr;

template <typename Value>
void put(std::string& bytes, std::size_t offset, Value value) {
    if (bytes.size() < offset + sizeof(Value)) bytes.resize(offset + sizeof(Value), '\0');
    std::memcpy(bytes.data() + offset, &value, sizeof(Value));
}

/// Where the colours stand in each point format; 0 where there are none.
constexpr std::array<std::size_t, 11> point_sizes = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
constexpr std::array<std::size_t, 11> color_places = {0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};

std::string las_header(unsigned minor, unsigned format, std::size_t record, std::uint32_t count) {
    const auto size = static_cast<std::uint16_t>(minor == 4 ? 375 : minor == 3 ? 235 : 227);
    std::string bytes = "LASF";
    put<std::uint8_t>(bytes, 24, 1);
    put(bytes, 25, static_cast<std::uint8_t>(minor));
    put(bytes, 94, size);
    put<std::uint32_t>(bytes, 96, size);
    put<std::uint32_t>(bytes, 100, 0);
    put(bytes, 104, static_cast<std::uint8_t>(format));
    put(bytes, 105, static_cast<std::uint16_t>(record));
    put(bytes, 107, format < 6 ? count : 0U);
    for (std::size_t k = 0; k < 3; ++k) {
        put(bytes, 131 + 8 * k, 0.001);
        put(bytes, 155 + 8 * k, k == 0 ? 4000000.0 : 0.0);
    }
    put<std::uint8_t>(bytes, size - 1U, 0);
    if (minor == 4) put<std::uint64_t>(bytes, 247, count);
    return bytes;
}

/// Two points: (4000001.234, -2, 3.5) and (4000000, 0, -0.001).
std::string las_file(unsigned minor, unsigned format, std::uint16_t color_unit = 256) {
    const std::size_t record = point_sizes[format];
    std::string bytes = las_header(minor, format, record, 2);
    const std::size_t first = bytes.size();
    bytes.resize(first + 2 * record, '\0');
    for (const std::size_t i : {0U, 1U}) {
        const std::size_t point = first + i * record;
        put<std::int32_t>(bytes, point, i == 0 ? 1234 : 0);
        put<std::int32_t>(bytes, point + 4, i == 0 ? -2000 : 0);
        put<std::int32_t>(bytes, point + 8, i == 0 ? 3500 : -1);
        put<std::uint16_t>(bytes, point + 12, i == 0 ? 65535 : 7);
        // Formats 0 to 5 have flags above the five bits of the class.
        put<std::uint8_t>(bytes, point + (format < 6 ? 15 : 16), format < 6 ? 0xe6 : 200);
        for (std::size_t k = 0; k < 3 && color_places[format] > 0; ++k) {
            put(bytes, point + color_places[format] + 2 * k,
                static_cast<std::uint16_t>((10 * k + i) * color_unit));
        }
    }
    return bytes;
}

Scan read_las_bytes(const std::string& bytes, const std::string& name = "a.las") {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / name, bytes);
    return read_scan(folder / name);
}

std::string error_of(const std::string& bytes, const std::string& name = "a.las") {
    try {
        read_las_bytes(bytes, name);
    } catch (const IoError& error) {
        return error.what();
    }
    return "it was read";
}

TEST(Las, ReadsEveryPointFormatOfEveryVersion) {
    for (unsigned format = 0; format <= 10; ++format) {
        for (const unsigned minor : {2U, 3U, 4U}) {
            if (format > (minor == 4 ? 10U : minor == 3 ? 5U : 3U)) continue;
            SCOPED_TRACE(testing::Message() << "1." << minor << ", format " << format);
            const PointCloud cloud = read_las_bytes(las_file(minor, format)).cloud;
            ASSERT_EQ(cloud.size(), 2U);
            EXPECT_EQ(cloud.global_shift, Eigen::Vector3d(4000000, 0, 0));
            EXPECT_EQ(cloud.positions[0], Eigen::Vector3f(1.234F, -2.0F, 3.5F));
            EXPECT_EQ(cloud.positions[1], Eigen::Vector3f(0.0F, 0.0F, -0.001F));
            EXPECT_EQ(cloud.intensities, (std::vector<float>{65535.0F, 7.0F}));
            const Channel* classes = test::find_channel(cloud, "classification");
            ASSERT_NE(classes, nullptr);
            EXPECT_EQ(static_cast<int>(classes->values[1]), format < 6 ? 6 : 200);
            ASSERT_EQ(cloud.colors.size(), color_places[format] > 0 ? 2U : 0U);
            if (!cloud.colors.empty()) {
                EXPECT_THAT(cloud.colors[1], testing::ElementsAre(1, 11, 21));
            }
        }
    }
}

TEST(Las, ColoursOfEightBitsStay) {
    const PointCloud cloud = read_las_bytes(las_file(2, 2, 1)).cloud;
    ASSERT_EQ(cloud.colors.size(), 2U);
    EXPECT_THAT(cloud.colors[1], testing::ElementsAre(1, 11, 21));
}

TEST(Las, FarCoordinatesKeepTenthsOfMillimetres) {
    std::string bytes = las_file(4, 6);
    put(bytes, 131, 0.0001);
    put(bytes, 155, 5432100.0);
    put(bytes, 155 + 8, -41234567.0);
    put<std::int32_t>(bytes, 375, 12345);
    const PointCloud cloud = read_las_bytes(bytes).cloud;
    const Eigen::Vector3d point = cloud.positions[0].cast<double>() + cloud.global_shift;
    EXPECT_NEAR(point.x(), 5432101.2345, 1e-6);
    EXPECT_NEAR(point.y(), -41234569.0, 1e-5);
}

TEST(Las, CompressedFilesGetAWordOnHowToOpenThem) {
    const std::string bytes = las_file(2, 0);
    std::string compressed = bytes;
    put<std::uint8_t>(compressed, 104, 0x80);
    EXPECT_THAT(error_of(compressed, "a.laz"), HasSubstr("laszip -i"));
    EXPECT_THAT(error_of(compressed, "a.las"), HasSubstr("LAZ"));
    // A name alone compresses nothing.
    EXPECT_EQ(read_las_bytes(bytes, "a.laz").cloud.size(), 2U);
}

TEST(Las, DamagedHeadersAreRefused) {
    struct Damage {
        std::size_t place;
        std::uint64_t value;
        std::size_t size;
        const char* reason;
    };
    for (const Damage& damage :
         {Damage{0, 0x41, 1, "LASF"}, Damage{24, 9, 1, "LAS 9.4"}, Damage{104, 11, 1, "format 11"},
          Damage{105, 29, 2, "too short"}, Damage{247, 3, 8, "do not fit"},
          Damage{247, 0xffffffffffffffffU, 8, "4294967295"}, Damage{96, 100, 4, "byte 100"},
          Damage{96, 0xffffffffU, 4, "cannot begin"}, Damage{94, 100, 2, "claims 100"},
          Damage{100, 0xffffffffU, 4, "too early"}, Damage{131, 0, 8, "scale"},
          Damage{155, 0x7ff8000000000000U, 8, "offset"}}) {
        std::string bytes = las_file(4, 6);
        std::memcpy(bytes.data() + damage.place, &damage.value, damage.size);
        const std::string message = error_of(bytes);
        EXPECT_THAT(message, HasSubstr(damage.reason));
        EXPECT_THAT(message, HasSubstr("byte"));
    }
}

TEST(Las, EveryCutIsRefused) {
    const std::string bytes = las_file(4, 7);
    for (std::size_t size = 1; size < bytes.size(); ++size) {
        EXPECT_THROW(read_las_bytes(bytes.substr(0, size)), IoError) << size;
    }
}

TEST(Las, ChangedBytesNeverDoHarm) {
    const std::string bytes = las_file(4, 7) + std::string(300, '\x5a');
    for (std::uint64_t seed = 0; seed < 3000; ++seed) {
        Random random(seed);
        std::string changed = bytes;
        for (std::size_t i = 1 + random.below(4); i > 0; --i) {
            changed[random.below(static_cast<std::uint32_t>(bytes.size()))] =
                static_cast<char>(random.next());
        }
        try {
            EXPECT_LE(read_las_bytes(changed).cloud.size(), changed.size() / 20);
        } catch (const IoError&) {
        }
    }
}

constexpr std::array<ScalarType, 10> all_types = {
    ScalarType::int8,    ScalarType::uint8,  ScalarType::int16, ScalarType::uint16,
    ScalarType::int32,   ScalarType::uint32, ScalarType::int64, ScalarType::uint64,
    ScalarType::float32, ScalarType::float64};

TEST(Las, RoundTripKeepsAllThatTheFormatCarries) {
    const test::TemporaryFolder folder;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        SCOPED_TRACE(seed);
        PointCloud cloud = test::random_cloud(seed, all_types);
        for (float& intensity : cloud.intensities)
            intensity = std::round(std::abs(intensity) * 1000.0F);
        if (seed % 3 == 0) cloud.global_shift = Eigen::Vector3d(4.5e6, -1.2e5, 300);
        write_point_cloud(folder / "a.las", cloud);
        const PointCloud back = read_scan(folder / "a.las").cloud;
        const PointCloud kept = select_points(cloud, finite_points(cloud));
        ASSERT_EQ(back.size(), kept.size());
        for (std::size_t i = 0; i < kept.size(); ++i) {
            const Eigen::Vector3d before = kept.positions[i].cast<double>() + kept.global_shift;
            const Eigen::Vector3d after = back.positions[i].cast<double>() + back.global_shift;
            // Half a step, and what float32 rounds off below 1024 m.
            EXPECT_LE((before - after).cwiseAbs().maxCoeff(), 0.5e-4 + 0x1p-15);
        }
        EXPECT_TRUE(test::same_bits(back.colors, kept.colors));
        if (!kept.intensities.empty()) {
            EXPECT_TRUE(test::same_bits(back.intensities, kept.intensities));
        }
        // Normals are three extra bytes by PLY's names, which are normals again.
        EXPECT_TRUE(test::same_bits(back.normals, kept.normals));
        for (const Channel& channel : kept.channels) {
            const Channel* same = test::find_channel(back, channel.name);
            if (same == nullptr) {
                EXPECT_THAT(channel.values, testing::Each(std::byte{0})) << channel.name;
                continue;
            }
            EXPECT_EQ(same->type, channel.type);
            EXPECT_TRUE(test::same_bits(same->values, channel.values)) << channel.name;
        }
    }
}

TEST(Las, ClassificationAndTimeGoWhereTheyBelong) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "a.las", las_file(4, 7));
    write_point_cloud(folder / "b.las", read_scan(folder / "a.las").cloud);
    const std::string bytes = test::read_bytes(folder / "b.las");
    EXPECT_EQ(bytes.size(), 375U + 2 * 36) << "nothing needs extra bytes";
    EXPECT_EQ(static_cast<unsigned char>(bytes[375 + 16]), 200);
    EXPECT_EQ(static_cast<unsigned char>(bytes[375 + 14]), 0x11) << "return 1 of 1";
}

TEST(Las, FractionsAreStretchedOverSixteenBits) {
    const test::TemporaryFolder folder;
    PointCloud cloud;
    cloud.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    cloud.intensities = {-1.0F, 0.0F, 1.0F};
    write_point_cloud(folder / "a.las", cloud);
    EXPECT_EQ(read_scan(folder / "a.las").cloud.intensities,
              (std::vector<float>{0.0F, 32768.0F, 65535.0F}));
}

}  // namespace
}  // namespace roomscribe
