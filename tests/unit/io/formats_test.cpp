// SPDX-License-Identifier: MIT
// What the readers make of files that others wrote.
#include <bit>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io_test_clouds.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "support/test_data.hpp"

namespace roomscribe {
namespace {

using Color = std::array<std::uint8_t, 3>;

PointCloud read_text(const std::string& name, const std::string& text) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / name, text);
    return read_scan(folder / name).cloud;
}

template <typename Value>
std::string bytes_of(std::initializer_list<Value> values) {
    std::string bytes;
    for (const Value value : values) {
        bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
    }
    return bytes;
}

TEST(Pcd, ReadsFieldsOfAnyTypeOrderAndPadding) {
    std::string record = bytes_of<std::int16_t>({3}) + "\x7f" + bytes_of<double>({1.5}) + "pad" +
                         bytes_of<std::uint8_t>({2});
    const PointCloud cloud = read_text(
        "a.pcd",
        "# comment\r\nVERSION .7\r\nCOLUMNS z flag x _ y\r\nSIZE 2 1 8 3 1\r\nTYPE I I F U U\r\n"
        "COUNT 1 1 1 1 1\r\nPOINTS 1\r\nDATA binary\n" +
            record);
    ASSERT_EQ(cloud.size(), 1U);
    EXPECT_EQ(cloud.positions[0], Eigen::Vector3f(1.5F, 2.0F, 3.0F));
    ASSERT_EQ(cloud.channels.size(), 1U);
    EXPECT_EQ(cloud.channels[0].name, "flag");
    EXPECT_EQ(cloud.channels[0].type, ScalarType::int8);
    EXPECT_EQ(cloud.channels[0].values[0], std::byte{0x7f});
}

TEST(Pcd, CompressedBlockWithAndWithoutPadding) {
    const auto header = std::string(
        "FIELDS x y _ z\nSIZE 4 4 1 4\nTYPE F F U F\nCOUNT 1 1 4 1\nWIDTH 1\n"
        "DATA binary_compressed\n");
    // One literal run: LZF's plainest block.
    const auto file = [&](const std::string& block) {
        return header +
               bytes_of<std::uint32_t>({static_cast<std::uint32_t>(block.size() + 1),
                                        static_cast<std::uint32_t>(block.size())}) +
               static_cast<char>(block.size() - 1) + block;
    };
    const PointCloud without = read_text("a.pcd", file(bytes_of<float>({1, 2, 3})));
    EXPECT_EQ(without.positions[0], Eigen::Vector3f(1, 2, 3));
    const PointCloud with = read_text("a.pcd", file(bytes_of<float>({1, 2, 99, 3})));
    EXPECT_EQ(with.positions[0], Eigen::Vector3f(1, 2, 3));
}

TEST(Pcd, PackedColorsAsFloatAndInteger) {
    const std::uint32_t packed = 0x00102030;
    const auto header = [](const char* name, char type) {
        return std::string("FIELDS x y z ") + name + "\nSIZE 4 4 4 4\nTYPE F F F " + type +
               "\nWIDTH 1\nHEIGHT 1\nDATA ";
    };
    char number[64];
    std::snprintf(number, sizeof(number), "%.9g\n",
                  static_cast<double>(std::bit_cast<float>(packed)));
    const Color expected = {0x10, 0x20, 0x30};
    EXPECT_EQ(read_text("a.pcd", header("rgb", 'F') + "ascii\n1 2 3 " + number).colors.at(0),
              expected);
    EXPECT_EQ(read_text("a.pcd", header("rgba", 'U') + "ascii\n1 2 3 4279246896\n").colors.at(0),
              expected);
    EXPECT_EQ(read_text("a.pcd", header("rgb", 'F') + "binary\n" + bytes_of<float>({1, 2, 3}) +
                                     bytes_of<std::uint32_t>({packed}))
                  .colors.at(0),
              expected);
}

TEST(Pcd, DefaultViewpointGivesNoPoseAnyOtherDoes) {
    const auto file = [](const std::string& viewpoint) {
        return "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nVIEWPOINT " + viewpoint +
               "\nDATA ascii\n1 2 3\n";
    };
    EXPECT_FALSE(read_text("a.pcd", file("0 0 0 1 0 0 0")).sensor_pose);
    EXPECT_FALSE(read_text("a.pcd", file("0 0 0 0 0 0 0")).sensor_pose);
    // w comes first: half a turn about x.
    const auto turned = read_text("a.pcd", file("0 0 0 0 1 0 0")).sensor_pose;
    ASSERT_TRUE(turned);
    EXPECT_TRUE((*turned * Eigen::Vector3d(1, 2, 3)).isApprox(Eigen::Vector3d(1, -2, -3)));
    const auto moved = read_text("a.pcd", file("4 5 6 1 0 0 0")).sensor_pose;
    ASSERT_TRUE(moved);
    EXPECT_EQ(moved->translation(), Eigen::Vector3d(4, 5, 6));
}

TEST(Ply, FindsVerticesBehindFacesInAnyOrderOfProperties) {
    const PointCloud cloud = read_text(
        "a.ply",
        "ply\nformat ascii 1.0\ncomment faces first\nelement face 2\n"
        "property list uchar int vertex_indices\nproperty uchar flags\nelement vertex 2\n"
        "property uchar blue\nproperty uchar green\nproperty uchar red\nproperty double z\n"
        "property list uchar float rest\nproperty int16 y\nproperty float32 x\n"
        "property float nz\nproperty float nx\nproperty float ny\nend_header\n"
        "3 0 1 0 7\n0 8\n30 20 10 3.5 2 9 9 2 1 0.3 0.1 0.2\n3 2 1 -3.5 0 -2 -1 0 1 0\n");
    ASSERT_EQ(cloud.size(), 2U);
    EXPECT_EQ(cloud.positions[0], Eigen::Vector3f(1, 2, 3.5F));
    EXPECT_EQ(cloud.positions[1], Eigen::Vector3f(-1, -2, -3.5F));
    EXPECT_EQ(cloud.colors[0], (Color{10, 20, 30}));
    EXPECT_EQ(cloud.normals[0], Eigen::Vector3f(0.1F, 0.2F, 0.3F));
    EXPECT_TRUE(cloud.channels.empty());
}

TEST(Ply, BinaryListsAreSkippedBothBeforeAndInVertices) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "a.ply",
                      "ply\nformat binary_little_endian 1.0\nelement face 2\n"
                      "property list uchar int i\nelement vertex 2\nproperty float x\n"
                      "property list ushort double l\nproperty float y\nproperty float z\n"
                      "end_header\n\x01" +
                          bytes_of<std::int32_t>({5}) + std::string(1, '\0') +
                          bytes_of<float>({1}) + bytes_of<std::uint16_t>({2}) +
                          bytes_of<double>({7, 8}) + bytes_of<float>({2, 3, 4}) +
                          bytes_of<std::uint16_t>({0}) + bytes_of<float>({5, 6}));
    const PointCloud cloud = read_scan(folder / "a.ply").cloud;
    ASSERT_EQ(cloud.size(), 2U);
    EXPECT_EQ(cloud.positions[0], Eigen::Vector3f(1, 2, 3));
    EXPECT_EQ(cloud.positions[1], Eigen::Vector3f(4, 5, 6));
    EXPECT_THAT(summarize_file(folder / "a.ply").front().warnings.at(0),
                testing::HasSubstr("list"));
}

TEST(Ply, IntensityNamesTypesAndChannels) {
    const std::string start =
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
        "property float y\nproperty float z\n";
    for (const std::string property :
         {"ushort intensity", "float scalar_Intensity", "double intensity"}) {
        const PointCloud cloud =
            read_text("a.ply", start + "property " + property + "\nend_header\n1 2 3 65535\n");
        ASSERT_EQ(cloud.intensities.size(), 1U) << property;
        EXPECT_EQ(cloud.intensities[0], 65535.0F);
        EXPECT_TRUE(cloud.channels.empty());
    }
    // Colours that are no bytes, and half a normal, are carried as they are.
    const PointCloud cloud =
        read_text("a.ply", start +
                               "property float red\nproperty float green\nproperty float blue\n"
                               "property float nx\nend_header\n1 2 3 .1 .2 .3 .4\n");
    EXPECT_EQ(cloud.channels.size(), 4U);
    EXPECT_TRUE(cloud.colors.empty());
    EXPECT_TRUE(cloud.normals.empty());
}

TEST(Ply, DefaultCameraAndRangeImageGiveNoPoseAndNoGrid) {
    std::string header =
        "ply\nformat ascii 1.0\nobj_info num_cols 400\nobj_info num_rows 200\n"
        "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
        "element camera 1\n";
    for (const char* name : {"view_px", "view_py", "view_pz", "x_axisx", "x_axisy", "x_axisz",
                             "y_axisx", "y_axisy", "y_axisz", "z_axisx", "z_axisy", "z_axisz"}) {
        header += std::string("property float ") + name + "\n";
    }
    header += "end_header\n1 2 3\n";
    const PointCloud plain = read_text("a.ply", header + "0 0 0 1 0 0 0 1 0 0 0 1\n");
    EXPECT_FALSE(plain.sensor_pose);
    EXPECT_FALSE(plain.grid);
    const PointCloud moved = read_text("a.ply", header + "4 5 6 1 0 0 0 1 0 0 0 1\n");
    ASSERT_TRUE(moved.sensor_pose);
    EXPECT_EQ(moved.sensor_pose->translation(), Eigen::Vector3d(4, 5, 6));
    EXPECT_FALSE(read_text("a.ply", header + "0 0 0 2 0 0 0 2 0 0 0 2\n").sensor_pose);
}

TEST(Uos, TurnsCentimetresAheadIntoMetres) {
    // 1 m right, 2 m up, 3 m ahead, with a reflectance.
    const PointCloud cloud = read_text("a.3d", "# header\n100 200 300 0.5\n-100 0 0 0.25");
    ASSERT_EQ(cloud.size(), 2U);
    EXPECT_EQ(cloud.positions[0], Eigen::Vector3f(3, -1, 2));
    EXPECT_EQ(cloud.positions[1], Eigen::Vector3f(0, 1, 0));
    EXPECT_EQ(cloud.intensities, (std::vector<float>{0.5F, 0.25F}));
    const PointCloud more = read_text("a.3d", "1 2 3 4 5\n");
    ASSERT_EQ(more.channels.size(), 2U);
    EXPECT_EQ(more.channels[1].name, "column_5");
}

TEST(Vtk, ReadsBothEncodings) {
    const std::string start = "# vtk DataFile Version 4.2\ntitle\n";
    const PointCloud text = read_text("a.vtk", start +
                                                   "ASCII\n\nDATASET POLYDATA\nPOINTS 3 double\n"
                                                   "1 2 3 4 5\n6 7 8 9\nVERTICES 1 2\n1 0\n");
    ASSERT_EQ(text.size(), 3U);
    EXPECT_EQ(text.positions[1], Eigen::Vector3f(4, 5, 6));
    const PointCloud binary = read_text(
        "a.vtk", start + "BINARY\nDATASET POLYDATA\nPOINTS 1 float\n" +
                     std::string("\x3f\x80\0\0\x40\0\0\0\x40\x40\0\0", 12) + "\nVERTICES 1 2\n");
    ASSERT_EQ(binary.size(), 1U);
    EXPECT_EQ(binary.positions[0], Eigen::Vector3f(1, 2, 3));
}

TEST(GlobalShift, StartsFromTheFirstFinitePointAndLeavesFloatsAlone) {
    const auto file = [](const std::string& type, const std::string& points) {
        return "ply\nformat ascii 1.0\nelement vertex 2\nproperty " + type + " x\nproperty " +
               type + " y\nproperty " + type + " z\nend_header\n" + points;
    };
    const PointCloud far =
        read_text("a.ply", file("double", "nan 0 0\n691234.567 5330049.9 500\n"));
    EXPECT_EQ(far.global_shift, Eigen::Vector3d(691200, 5330000, 0));
    EXPECT_NEAR(far.positions[1].x(), 34.567, 1e-5);
    EXPECT_TRUE(std::isnan(far.positions[0].x()));
    // One stray return far out does not move a scan, and float32 has nothing to lose.
    const PointCloud stray = read_text("a.ply", file("double", "1 2 3\n5000 0 0\n"));
    EXPECT_TRUE(stray.global_shift.isZero());
    const PointCloud floats = read_text("a.ply", file("float", "691234.567 0 0\n1 2 3\n"));
    EXPECT_TRUE(floats.global_shift.isZero());
    EXPECT_EQ(floats.positions[0].x(), 691234.567F);
    const PointCloud rubbish = read_text("a.ply", file("double", "1e300 0 0\n2000 0 0\n"));
    EXPECT_EQ(rubbish.global_shift.x(), 2000.0);
    const PointCloud integers = read_text("a.ply", file("int", "2147483647 0 0\n1 1 1\n"));
    EXPECT_EQ(integers.global_shift.x(), 0.0);
    const PointCloud grid = read_text("a.ply", file("int", "20000001 0 0\n1 1 1\n"));
    EXPECT_EQ(grid.positions[0].x(), 1.0F);
}

TEST(Summary, NamesWhatIsInTheFile) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "a.pcd",
                      "FIELDS x y z label\nSIZE 4 4 4 1\nTYPE F F F U\nCOUNT 1 1 1 3\nWIDTH 2\n"
                      "HEIGHT 2\nVIEWPOINT 0 0 2 1 0 0 0\nDATA ascii\n1000 2000 1 1 2 3\n"
                      "nan 0 0 1 2 3\n9000 8000 1 1 2 3\n1e9 0 inf 1 2 3\n");
    const FileSummary summary = summarize_file(folder / "a.pcd").front();
    EXPECT_EQ(summary.format, "PCD");
    EXPECT_EQ(summary.encoding, "ascii");
    EXPECT_EQ(summary.num_points, 4U);
    EXPECT_EQ(summary.num_non_finite, 2U);
    ASSERT_EQ(summary.fields.size(), 4U);
    EXPECT_EQ(summary.fields[3].name, "label");
    EXPECT_EQ(summary.fields[3].count, 3U);
    EXPECT_EQ(scalar_type_name(summary.fields[3].type), "uint8");
    EXPECT_EQ(summary.grid->rows, 2U);
    EXPECT_EQ(summary.sensor_pose->translation().z(), 2.0);
    EXPECT_EQ(summary.bounds.min(), Eigen::Vector3d(1000, 2000, 1));
    EXPECT_EQ(summary.bounds.max(), Eigen::Vector3d(9000, 8000, 1));
    ASSERT_EQ(summary.warnings.size(), 1U);
    EXPECT_THAT(summary.warnings[0], testing::HasSubstr("millimetres"));
}

}  // namespace
}  // namespace roomscribe
