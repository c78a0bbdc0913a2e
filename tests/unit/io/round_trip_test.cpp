// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "io_test_clouds.hpp"
#include "roomscribe/core/error.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "support/test_data.hpp"

namespace roomscribe {
namespace {

using test::random_cloud;
using test::same_bits;

constexpr std::array<ScalarType, 10> all_types = {
    ScalarType::int8,    ScalarType::uint8,  ScalarType::int16, ScalarType::uint16,
    ScalarType::int32,   ScalarType::uint32, ScalarType::int64, ScalarType::uint64,
    ScalarType::float32, ScalarType::float64};
constexpr std::array<ScalarType, 8> ply_types = {
    ScalarType::int8,  ScalarType::uint8,  ScalarType::int16,   ScalarType::uint16,
    ScalarType::int32, ScalarType::uint32, ScalarType::float32, ScalarType::float64};

constexpr std::uint64_t num_seeds = 60;

void expect_same_floats(float a, float b) {
    if (std::isnan(a)) {
        EXPECT_TRUE(std::isnan(b));
    } else {
        EXPECT_EQ(a, b);
    }
}

void expect_same_channels(const PointCloud& a, const PointCloud& b) {
    ASSERT_EQ(a.channels.size(), b.channels.size());
    for (std::size_t i = 0; i < a.channels.size(); ++i) {
        EXPECT_EQ(a.channels[i].name, b.channels[i].name);
        EXPECT_EQ(a.channels[i].type, b.channels[i].type);
        EXPECT_EQ(a.channels[i].count, b.channels[i].count);
        EXPECT_TRUE(same_bits(a.channels[i].values, b.channels[i].values)) << a.channels[i].name;
    }
}

void expect_same_pose(const std::optional<Transform>& a, const std::optional<Transform>& b,
                      double tolerance) {
    ASSERT_EQ(a.has_value(), b.has_value());
    if (a) {
        EXPECT_TRUE(a->isApprox(*b, tolerance));
    }
}

void expect_same(const PointCloud& a, const PointCloud& b, bool text, double pose_tolerance) {
    if (text) {
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t i = 0; i < a.size(); ++i) {
            for (Eigen::Index k = 0; k < 3; ++k) {
                expect_same_floats(a.positions[i][k], b.positions[i][k]);
            }
        }
    } else {
        EXPECT_TRUE(same_bits(a.positions, b.positions));
    }
    EXPECT_TRUE(same_bits(a.normals, b.normals));
    EXPECT_TRUE(same_bits(a.colors, b.colors));
    EXPECT_TRUE(same_bits(a.intensities, b.intensities));
    expect_same_channels(a, b);
    ASSERT_EQ(a.grid.has_value(), b.grid.has_value());
    if (a.grid) {
        EXPECT_EQ(a.grid->rows, b.grid->rows);
        EXPECT_EQ(a.grid->columns, b.grid->columns);
    }
    EXPECT_EQ(a.global_shift, b.global_shift);
    expect_same_pose(a.sensor_pose, b.sensor_pose, pose_tolerance);
}

struct Case {
    std::string file;
    Encoding encoding;
};

class RoundTrip : public testing::TestWithParam<Case> {};

TEST_P(RoundTrip, KeepsEverything) {
    const test::TemporaryFolder folder;
    const auto path = folder / GetParam().file;
    const bool ply = path.extension() == ".ply";
    const bool text = GetParam().encoding == Encoding::ascii;
    for (std::uint64_t seed = 0; seed < num_seeds; ++seed) {
        SCOPED_TRACE(seed);
        const PointCloud cloud =
            ply ? random_cloud(seed, ply_types) : random_cloud(seed, all_types);
        write_point_cloud(path, cloud, {.encoding = GetParam().encoding});
        const Scan scan = read_scan(path);
        EXPECT_EQ(scan.name, GetParam().file);
        expect_same(cloud, scan.cloud, text, ply ? 1e-6 : 1e-14);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Formats, RoundTrip,
    testing::Values(Case{"a.pcd", Encoding::ascii}, Case{"a.pcd", Encoding::binary},
                    Case{"a.PCD", Encoding::automatic}, Case{"a.pcd", Encoding::binary_compressed},
                    Case{"a.ply", Encoding::ascii}, Case{"a.ply", Encoding::binary},
                    Case{"a.ply", Encoding::binary_big_endian}));

TEST(RoundTripAcrossFormats, PlyAndPcdKeepChannelsBothWays) {
    const test::TemporaryFolder folder;
    for (std::uint64_t seed = 0; seed < num_seeds; ++seed) {
        SCOPED_TRACE(seed);
        const PointCloud cloud = random_cloud(seed, ply_types);
        write_point_cloud(folder / "a.ply", cloud, {.encoding = Encoding::binary_big_endian});
        write_point_cloud(folder / "b.pcd", read_scan(folder / "a.ply").cloud,
                          {.encoding = Encoding::binary_compressed});
        write_point_cloud(folder / "c.ply", read_scan(folder / "b.pcd").cloud);
        expect_same(cloud, read_scan(folder / "c.ply").cloud, false, 1e-6);
    }
}

TEST(RoundTripAcrossFormats, PcdKeepsChannelsOfSeveralValues) {
    const test::TemporaryFolder folder;
    Random random(7);
    PointCloud cloud = test::random_positions(random, 100);
    cloud.channels.push_back(test::random_channel(random, "fpfh", ScalarType::float32, 33, 100));
    cloud.channels.push_back(test::random_channel(random, "flags", ScalarType::uint16, 2, 100));
    for (const Encoding encoding :
         {Encoding::ascii, Encoding::binary, Encoding::binary_compressed}) {
        write_point_cloud(folder / "a.pcd", cloud, {.encoding = encoding});
        expect_same_channels(cloud, read_scan(folder / "a.pcd").cloud);
    }
    // PLY has one value per property: the values stay, each under a name of its own.
    write_point_cloud(folder / "a.ply", cloud);
    const PointCloud split = read_scan(folder / "a.ply").cloud;
    ASSERT_EQ(split.channels.size(), 35U);
    EXPECT_EQ(split.channels[32].name, "fpfh_32");
    EXPECT_EQ(std::memcmp(split.channels[32].values.data() + 4 * 99,
                          cloud.channels[0].values.data() + (99 * 33 + 32) * 4, 4),
              0);
}

TEST(RoundTripAcrossFormats, PlyHoldsLongIntegersAsDoubleOrRefuses) {
    const test::TemporaryFolder folder;
    PointCloud cloud;
    cloud.positions.emplace_back(1.0F, 2.0F, 3.0F);
    std::int64_t value = -(std::int64_t{1} << 53);
    Channel channel{"time", ScalarType::int64, 1, std::vector<std::byte>(8)};
    std::memcpy(channel.values.data(), &value, 8);
    cloud.channels = {channel};
    write_point_cloud(folder / "a.ply", cloud);
    const Channel read = read_scan(folder / "a.ply").cloud.channels.at(0);
    double real = 0.0;
    std::memcpy(&real, read.values.data(), 8);
    EXPECT_EQ(real, -0x1p53);

    value -= 2;
    std::memcpy(cloud.channels[0].values.data(), &value, 8);
    EXPECT_THROW(write_point_cloud(folder / "a.ply", cloud), InvalidArgument);
}

TEST(RoundTripUos, KeepsPositionsAndIntensities) {
    const test::TemporaryFolder folder;
    for (std::uint64_t seed = 0; seed < num_seeds; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        PointCloud cloud = test::random_positions(random, 1 + random.below(200));
        if (seed % 2 == 0) {
            for (std::size_t i = 0; i < cloud.size(); ++i) {
                cloud.intensities.push_back(test::random_float(random));
            }
        }
        write_point_cloud(folder / "a.3d", cloud);
        expect_same(cloud, read_scan(folder / "a.3d").cloud, true, 0.0);
    }
}

class FarCoordinates : public testing::TestWithParam<Case> {};

/// A map grid: float32 alone would hold these to half a metre.
TEST_P(FarCoordinates, AreKeptSmallAndRestored) {
    const test::TemporaryFolder folder;
    const auto path = folder / GetParam().file;
    PointCloud cloud;
    cloud.global_shift = {4365200.0, -5527000.0, 0.0};
    Random random(3);
    for (int i = 0; i < 100; ++i) {
        cloud.positions.emplace_back(test::random_float(random), test::random_float(random),
                                     test::random_float(random));
    }
    cloud.positions[0] = {0.5F, -0.25F, 0.125F};
    const bool has_pose = path.extension() != ".3d";
    if (has_pose) cloud.sensor_pose = Transform(Eigen::Translation3d(1.0, 2.0, 1.5));
    write_point_cloud(path, cloud, {.encoding = GetParam().encoding});
    const PointCloud read = read_scan(path).cloud;
    EXPECT_EQ(read.global_shift, cloud.global_shift);
    ASSERT_EQ(read.size(), cloud.size());
    for (std::size_t i = 0; i < read.size(); ++i) {
        EXPECT_LT((read.positions[i] - cloud.positions[i]).norm(), 1e-5F);
    }
    // PLY's camera is float32 in the format of PCL: far poses are good to half a metre there.
    if (has_pose) {
        EXPECT_LT((read.sensor_pose->translation() - cloud.sensor_pose->translation()).norm(),
                  path.extension() == ".ply" ? 0.6 : 1e-8);
    }
    const FileSummary summary = summarize_file(path).front();
    EXPECT_GT(summary.bounds.min().x(), 4365000.0);
    EXPECT_EQ(summary.warnings.size(), 1U);
}

INSTANTIATE_TEST_SUITE_P(
    Formats, FarCoordinates,
    testing::Values(Case{"a.pcd", Encoding::ascii}, Case{"a.pcd", Encoding::binary},
                    Case{"a.pcd", Encoding::binary_compressed}, Case{"a.ply", Encoding::ascii},
                    Case{"a.ply", Encoding::binary}, Case{"a.ply", Encoding::binary_big_endian},
                    Case{"a.3d", Encoding::automatic}));

TEST(WritePointCloud, RefusesWhatItCannotWrite) {
    const test::TemporaryFolder folder;
    PointCloud cloud;
    cloud.positions.resize(4, Eigen::Vector3f::Zero());
    EXPECT_THROW(write_point_cloud(folder / "a.laz", cloud), InvalidArgument);
    EXPECT_THROW(write_point_cloud(folder / "a.vtk", cloud), InvalidArgument);
    EXPECT_THROW(write_point_cloud(folder / "a.3d", cloud, {Encoding::binary}), InvalidArgument);
    EXPECT_THROW(write_point_cloud(folder / "a.pcd", cloud, {Encoding::binary_big_endian}),
                 InvalidArgument);
    EXPECT_THROW(write_point_cloud(folder / "a.ply", cloud, {Encoding::binary_compressed}),
                 InvalidArgument);
    PointCloud short_normals = cloud;
    short_normals.normals.resize(3);
    EXPECT_THROW(write_point_cloud(folder / "a.ply", short_normals), InvalidArgument);
    PointCloud wrong_grid = cloud;
    wrong_grid.grid = ScanGrid{3, 3};
    EXPECT_THROW(write_point_cloud(folder / "a.ply", wrong_grid), InvalidArgument);
    PointCloud two_words = cloud;
    two_words.channels = {{"two words", ScalarType::uint8, 1, std::vector<std::byte>(4)}};
    EXPECT_THROW(write_point_cloud(folder / "a.ply", two_words), InvalidArgument);
    PointCloud short_channel = cloud;
    short_channel.channels = {{"label", ScalarType::uint8, 1, std::vector<std::byte>(3)}};
    EXPECT_THROW(write_point_cloud(folder / "a.pcd", short_channel), InvalidArgument);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace roomscribe
