// SPDX-License-Identifier: MIT
#include "roomscribe/io/obj.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io_test_clouds.hpp"
#include "roomscribe/core/error.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "support/test_data.hpp"

namespace roomscribe {
namespace {

PointCloud read_obj_of(const std::string& text) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "a.obj", text);
    return read_scan(folder / "a.obj").cloud;
}

TEST(Obj, ReadsVerticesAndNothingElse) {
    const PointCloud cloud = read_obj_of(
        "# made by hand\nmtllib a.mtl\no thing\nv 1 2 3\nvn 0 0 1\nvt 0 0\nv\t-4.5 5e-1 6 1.0\r\n"
        "f 1//1 2//1 1//1\nv 7 8 9");
    ASSERT_EQ(cloud.size(), 3U);
    EXPECT_EQ(cloud.positions[0], Eigen::Vector3f(1, 2, 3));
    EXPECT_EQ(cloud.positions[1], Eigen::Vector3f(-4.5F, 0.5F, 6));
    EXPECT_EQ(cloud.positions[2], Eigen::Vector3f(7, 8, 9));
    EXPECT_TRUE(cloud.colors.empty());
}

TEST(Obj, TakesColoursThatEveryVertexHas) {
    const PointCloud cloud = read_obj_of("v 1 2 3 1 0 0.5\nv 1 2 4 0 1 2\n");
    ASSERT_EQ(cloud.colors.size(), 2U);
    EXPECT_EQ(cloud.colors[0], (std::array<std::uint8_t, 3>{255, 0, 128}));
    EXPECT_EQ(cloud.colors[1], (std::array<std::uint8_t, 3>{0, 255, 255}));
    EXPECT_TRUE(read_obj_of("v 1 2 3 1 0 0.5\nv 1 2 4\n").colors.empty());
}

TEST(Obj, FarVerticesKeepMillimetres) {
    const PointCloud cloud =
        read_obj_of("v 4500000.001 5400000.002 100.003\nv 4500001 5400000 9\n");
    const Eigen::Vector3d first = cloud.positions[0].cast<double>() + cloud.global_shift;
    EXPECT_LT((first - Eigen::Vector3d(4500000.001, 5400000.002, 100.003)).norm(), 1e-4);
}

TEST(Obj, ManyVerticesKeepTheirOrder) {
    std::string text;
    for (int i = 0; i < 10000; ++i)
        text += "v " + std::to_string(i) + " 0 1\n";
    const PointCloud cloud = read_obj_of(text);
    ASSERT_EQ(cloud.size(), 10000U);
    for (std::size_t i = 0; i < cloud.size(); ++i)
        ASSERT_NEAR(cloud.positions[i].x() + cloud.global_shift.x(), static_cast<double>(i), 1e-3);
}

TEST(Obj, RefusesWhatIsNoVertex) {
    for (const char* text : {"", "f 1 2 3\n", "v 1 2\n", "v 1 2 x\n", "v 1 2 3 4 5\n"})
        EXPECT_THROW(read_obj_of(text), IoError) << text;
}

}  // namespace
}  // namespace roomscribe
