// SPDX-License-Identifier: MIT
#include "roomscribe/io/tilted_scans.hpp"

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io_test_clouds.hpp"
#include "roomscribe/core/error.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "support/test_data.hpp"

namespace roomscribe {
namespace {

PointCloud read_tilted(const std::string& text) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "a.tilt", text);
    return read_scan(folder / "a.tilt").cloud;
}

void expect_near(const Eigen::Vector3f& point, float x, float y, float z) {
    EXPECT_LT((point - Eigen::Vector3f(x, y, z)).norm(), 1e-5F) << point.transpose();
}

TEST(TiltedScans, PutsRaysWhereTheGeometrySays) {
    const PointCloud cloud = read_tilted(
        "# a tilting unit\nunit mm\nstep 90\noffset 0.1 0 0.2\nscan 0 1000 2000 3000\n"
        "scan 90 1000 2000 3000 # straight down\n");
    ASSERT_EQ(cloud.size(), 6U);
    EXPECT_EQ(cloud.grid->rows, 2U);
    EXPECT_EQ(cloud.grid->columns, 3U);
    ASSERT_TRUE(cloud.sensor_pose);
    // Three rays 90 degrees apart lie at -90 (right), 0 and 90 (left).
    expect_near(cloud.positions[0], 0.1F, -1.0F, 0.2F);
    expect_near(cloud.positions[1], 2.1F, 0.0F, 0.2F);
    expect_near(cloud.positions[2], 0.1F, 3.0F, 0.2F);
    // Nose down: what was ahead is below, what was above is ahead.
    expect_near(cloud.positions[3], 0.2F, -1.0F, -0.1F);
    expect_near(cloud.positions[4], 0.2F, 0.0F, -2.1F);
}

TEST(TiltedScans, RangesThatAreNoReturnsHaveNoPlace) {
    const PointCloud cloud =
        read_tilted("start 0\nstep 1\nrange 0.5 8\nscan 0 0 0.4 1 8.19 nan inf -1\n");
    ASSERT_EQ(cloud.size(), 7U);
    for (std::size_t i = 0; i < cloud.size(); ++i)
        EXPECT_EQ(is_finite(cloud.positions[i]), i == 2) << i;
}

TEST(TiltedScans, AFolderOfScansIsReadAsOne) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "scans.tilt", "step 10\nfile -5 a.txt\nfile 5 b.txt\n");
    test::write_bytes(folder / "a.txt", "1 2\n3\n");
    test::write_bytes(folder / "b.txt", "1 2 3");
    EXPECT_EQ(read_scan(folder.path()).cloud.size(), 6U);
    test::write_bytes(folder / "b.txt", "1 2");
    EXPECT_THROW(read_scan(folder.path()), IoError);
    std::filesystem::remove(folder / "b.txt");
    EXPECT_THROW(read_scan(folder.path()), IoError);
}

TEST(TiltedScans, AWallIsFlat) {
    // A wall 2 m ahead: every ray ends at x = 2.
    std::string text = "step 1\n";
    for (int tilt = -30; tilt <= 30; tilt += 2) {
        text += fmt::format("scan {}", tilt);
        for (int i = 0; i <= 120; ++i) {
            const double bearing = (i - 60) * M_PI / 180.0;
            text += fmt::format(" {}", 2.0 / (std::cos(bearing) * std::cos(tilt * M_PI / 180.0)));
        }
        text += "\n";
    }
    for (const Eigen::Vector3f& point : read_tilted(text).positions)
        ASSERT_NEAR(point.x(), 2.0F, 1e-5F);
}

TEST(TiltedScans, RefusesWhatIsNotUnderstood) {
    for (const char* text :
         {"", "step 1\n", "scan 0 1 2\n", "step 0\nscan 0 1\n", "step 1\nscan 0\n",
          "step 1\nscan 0 1 2\nscan 1 1\n", "step 1\nscan x 1\n", "step 1\nscan 0 x\n",
          "unit yard\nstep 1\nscan 0 1\n", "step 1\nfile 0 ../a\n", "step 1\nfile 0 /etc/passwd\n",
          "speed 1\nstep 1\nscan 0 1\n"}) {
        EXPECT_THROW(read_tilted(text), IoError) << text;
    }
}

}  // namespace
}  // namespace roomscribe
