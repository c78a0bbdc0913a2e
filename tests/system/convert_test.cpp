// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstring>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/io/point_cloud_io.hpp"
#include "system/program.hpp"

namespace roomscribe::test {
namespace {

/// Organised, with a viewpoint, a NaN point, and two fields that mean nothing to roomscribe.
constexpr const char* foreign_pcd =
    "VERSION .7\nFIELDS x y z ring echo_time\nSIZE 4 4 4 2 8\nTYPE F F F U F\nCOUNT 1 1 1 1 2\n"
    "WIDTH 2\nHEIGHT 2\nVIEWPOINT 1 2 3 1 0 0 0\nPOINTS 4\nDATA ascii\n"
    "0.1 0 0 7 0.25 0.5\n1 0.2 0 65535 1e-9 -3\nnan nan nan 1 2 4\n1 1 0.3 9 8 16\n";

TEST(Convert, KeepsUnknownChannelsThereAndBack) {
    const TemporaryFolder folder;
    const std::string original = (folder / "a.pcd").string();
    const std::string ply = (folder / "b.ply").string();
    const std::string back = (folder / "c.pcd").string();
    std::ofstream(original) << foreign_pcd;
    for (const char* encoding : {"ascii", "binary", "auto", "binary_big_endian"}) {
        ASSERT_EQ(roomscribe({"convert", original, ply, "--encoding", encoding}).exit_code, 0);
        ASSERT_EQ(roomscribe({"convert", ply, back, "--encoding", "binary_compressed"}).exit_code,
                  0);
        const PointCloud before = read_scan(original).cloud;
        const PointCloud after = read_scan(back).cloud;
        ASSERT_EQ(after.size(), before.size());
        for (std::size_t i = 0; i < before.size(); ++i) {
            if (is_finite(before.positions[i])) {
                EXPECT_EQ(after.positions[i], before.positions[i]);
            } else {
                EXPECT_TRUE(after.positions[i].array().isNaN().all());
            }
        }
        // PLY knows no arrays of fixed length: echo_time comes back as two channels.
        const auto values_of = [](const PointCloud& cloud, std::size_t channel) {
            std::vector<double> values(cloud.channels.at(channel).values.size() / sizeof(double));
            std::memcpy(values.data(), cloud.channels[channel].values.data(),
                        values.size() * sizeof(double));
            return values;
        };
        ASSERT_EQ(after.channels.size(), 3U);
        EXPECT_EQ(after.channels[0].name, "ring");
        EXPECT_EQ(after.channels[0].type, ScalarType::uint16);
        EXPECT_EQ(after.channels[0].values, before.channels[0].values);
        EXPECT_EQ(values_of(after, 1), (std::vector<double>{0.25, 1e-9, 2, 8}));
        EXPECT_EQ(values_of(after, 2), (std::vector<double>{0.5, -3, 4, 16}));
        ASSERT_TRUE(after.sensor_pose);
        EXPECT_EQ(after.sensor_pose->translation(), Eigen::Vector3d(1, 2, 3));
        ASSERT_TRUE(after.grid);
        EXPECT_EQ(after.grid->columns, 2U);
    }
}

TEST(Convert, RefusesAFormatThatCannotBeWritten) {
    const TemporaryFolder folder;
    const std::string original = (folder / "a.pcd").string();
    std::ofstream(original) << foreign_pcd;
    const std::string target = (folder / "b.docx").string();
    expect_error(roomscribe({"convert", original, target}), 2, {".docx"});
    EXPECT_FALSE(std::filesystem::exists(target));
}

TEST(Info, TellsCountsFieldsAndExtent) {
    const TemporaryFolder folder;
    const std::string path = (folder / "a.pcd").string();
    std::ofstream(path) << foreign_pcd;
    const std::string text = roomscribe({"info", path}).out;
    for (const char* word : {"a.pcd", "PCD, ascii", "ring uint16", "echo_time float64[2]",
                             "2 rows x 2 columns", "1.000 2.000 3.000"}) {
        EXPECT_THAT(text, testing::HasSubstr(word));
    }
    const auto json = nlohmann::json::parse(roomscribe({"info", path, path, "--json"}).out);
    ASSERT_EQ(json.size(), 2U);
    EXPECT_EQ(json[1].at("points"), 4);
    EXPECT_EQ(json[1].at("non_finite"), 1);
    EXPECT_NEAR(json[1].at("bounds").at("max").at(2).get<double>(), 0.3, 1e-6);
}

}  // namespace
}  // namespace roomscribe::test
