// SPDX-License-Identifier: MIT
#include "roomscribe/io/depth_images.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io_test_clouds.hpp"
#include "roomscribe/core/error.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "support/depth_png.hpp"
#include "support/test_data.hpp"

namespace roomscribe {
namespace {

using testing::HasSubstr;

const std::vector<std::uint16_t> depths{1000, 0, 2000, 500, 65535, 1};

TEST(DepthImage, PixelsLieWhereTheCameraSaysThem) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "a.png", test::depth_png(2, 3, depths));
    test::write_bytes(folder / "intrinsics.txt", "2 4 1 0.5\n");
    const PointCloud cloud = read_scan(folder / "a.png").cloud;
    ASSERT_EQ(cloud.size(), 6U);
    EXPECT_EQ(cloud.grid->rows, 2U);
    EXPECT_EQ(cloud.grid->columns, 3U);
    EXPECT_EQ(cloud.positions[0], Eigen::Vector3f(-0.5F, -0.125F, 1.0F));
    EXPECT_FALSE(is_finite(cloud.positions[1]));
    EXPECT_EQ(cloud.positions[2], Eigen::Vector3f(1.0F, -0.25F, 2.0F));
    EXPECT_FALSE(is_finite(cloud.positions[4]));
    EXPECT_FLOAT_EQ(cloud.positions[5].z(), 0.001F);
}

TEST(DepthImage, OwnNumbersComeFirst) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "a.png", test::depth_png(2, 3, depths));
    test::write_bytes(folder / "intrinsics.txt", "2 4 1 0.5\n");
    test::write_bytes(folder / "a.intrinsics.txt", "2 4 1 0.5 500 # half millimetres\n");
    EXPECT_FLOAT_EQ(read_scan(folder / "a.png").cloud.positions[0].z(), 2.0F);
}

TEST(DepthImage, RefusesWhatIsNone) {
    const test::TemporaryFolder folder;
    const std::string good = test::depth_png(2, 3, depths);
    const auto error_of = [&](const std::string& bytes) {
        test::write_bytes(folder / "a.png", bytes);
        try {
            read_scan(folder / "a.png");
        } catch (const IoError& error) {
            return std::string(error.what());
        }
        return std::string("it was read");
    };
    EXPECT_THAT(error_of(good), HasSubstr("not known"));
    test::write_bytes(folder / "intrinsics.txt", "525 525 319.5 239.5 5000\n");
    EXPECT_EQ(error_of(good), "it was read");
    EXPECT_THAT(error_of(""), HasSubstr("a.png"));
    EXPECT_THAT(error_of("no image"), HasSubstr("does not begin"));
    EXPECT_THAT(error_of(good.substr(0, good.size() - 20)), HasSubstr("a.png"));
    std::string changed = good;
    changed[45] = static_cast<char>(changed[45] ^ 1);
    EXPECT_THAT(error_of(changed), HasSubstr("a.png"));
    test::write_bytes(folder / "intrinsics.txt", "0 525 1 1\n");
    EXPECT_THAT(error_of(good), HasSubstr("intrinsics"));
}

class TumFolder : public testing::Test {
  protected:
    TumFolder() {
        std::filesystem::create_directory(folder_ / "depth");
        test::write_bytes(folder_ / "depth" / "1.png", test::depth_png(2, 3, depths));
        test::write_bytes(folder_ / "depth" / "2.png", test::depth_png(2, 3, depths));
        test::write_bytes(folder_ / "depth.txt",
                          "# depth maps\n10.00 depth/1.png\n10.05 depth/2.png\n");
    }
    test::TemporaryFolder folder_;
};

TEST_F(TumFolder, WithoutPosesImagesAreScans) {
    const std::vector<StoredScan> scans = read_scans(folder_.path());
    ASSERT_EQ(scans.size(), 2U);
    EXPECT_THAT(scans[0].scan.name, HasSubstr("#1"));
    EXPECT_FALSE(scans[0].map_from_scan);
    EXPECT_FLOAT_EQ(scans[0].scan.cloud.positions[0].z(), 0.2F);
    EXPECT_THAT(summarize_file(folder_.path())[0].warnings,
                testing::Contains(HasSubstr("guessed")));
}

TEST_F(TumFolder, PosesAreTakenByTime) {
    test::write_bytes(
        folder_ / "groundtruth.txt",
        "# time x y z q\n9.99 1 2 3 0 0 0 1\n10.015 4 5 6 0 0 0 1\n11 7 8 9 0 0 0 1\n");
    test::write_bytes(folder_ / "intrinsics.txt", "525 525 319.5 239.5 1000\n");
    const std::vector<StoredScan> scans = read_scans(folder_.path());
    ASSERT_TRUE(scans[0].map_from_scan);
    EXPECT_EQ(scans[0].map_from_scan->translation(), Eigen::Vector3d(1, 2, 3));
    EXPECT_FALSE(scans[1].map_from_scan);
    EXPECT_FLOAT_EQ(scans[0].scan.cloud.positions[0].z(), 1.0F);
    EXPECT_TRUE(may_hold_poses(folder_.path()));
}

TEST_F(TumFolder, OfManyImagesAHundredAreTaken) {
    std::string list;
    for (int i = 0; i < 250; ++i)
        list += std::to_string(i) + " depth/1.png\n";
    test::write_bytes(folder_ / "depth.txt", list);
    EXPECT_EQ(read_scans(folder_.path()).size(), 100U);
}

TEST_F(TumFolder, ListsThatLeaveTheFolderAreRefused) {
    for (const char* list :
         {"1 ../a.png\n", "1 /tmp/a.png\n", "1\n", "x depth/1.png\n", "# no\n"}) {
        test::write_bytes(folder_ / "depth.txt", list);
        EXPECT_THROW(read_scans(folder_.path()), IoError) << list;
    }
}

/// As 7-Scenes has its frames, in the folder of a sequence.
class FramesFolder : public testing::Test {
  protected:
    FramesFolder() {
        test::write_bytes(folder_ / "camera-intrinsics.txt", "2e0 0 1\n0 4 0.5\n0 0 1\n");
        std::filesystem::create_directory(folder_ / "seq-01");
        for (const char* name : {"frame-2", "frame-0"}) {
            test::write_bytes(folder_ / "seq-01" / (std::string(name) + ".depth.png"),
                              test::depth_png(2, 3, depths));
        }
        test::write_bytes(folder_ / "seq-01" / "frame-0.color.png", "no depth");
    }
    void write_pose(const std::string& frame, const std::string& text) {
        test::write_bytes(folder_ / "seq-01" / (frame + ".pose.txt"), text);
    }
    test::TemporaryFolder folder_;
};

TEST_F(FramesFolder, FramesComeInTheOrderOfTheirNamesWithTheirPoses) {
    write_pose("frame-2", "0 -1 0 1\n1 0 0 2\n0 0 1 3\n0 0 0 1\n");
    const std::vector<StoredScan> scans = read_scans(folder_.path());
    ASSERT_EQ(scans.size(), 2U);
    EXPECT_THAT(scans[0].scan.name, HasSubstr("#seq-01/frame-0"));
    EXPECT_THAT(scans[1].scan.name, HasSubstr("#seq-01/frame-2"));
    EXPECT_EQ(scans[0].scan.cloud.positions[0], Eigen::Vector3f(-0.5F, -0.125F, 1.0F));
    EXPECT_FALSE(scans[0].map_from_scan);
    ASSERT_TRUE(scans[1].map_from_scan);
    EXPECT_EQ(*scans[1].map_from_scan * Eigen::Vector3d::UnitX(), Eigen::Vector3d(1, 3, 3));
    EXPECT_TRUE(may_hold_poses(folder_.path()));
}

TEST_F(FramesFolder, AFrameWhoseTrackWasLostHasNoPose) {
    write_pose("frame-0",
               "-inf -inf -inf -inf\n-inf -inf -inf -inf\n"
               "-inf -inf -inf -inf\n-inf -inf -inf -inf\n");
    EXPECT_FALSE(read_scans(folder_.path())[0].map_from_scan);
}

TEST_F(FramesFolder, AMatrixOnItsOwnServesOneImage) {
    std::filesystem::copy(folder_ / "camera-intrinsics.txt", folder_ / "seq-01");
    EXPECT_EQ(read_scan(folder_ / "seq-01" / "frame-2.depth.png").cloud.positions[2],
              Eigen::Vector3f(1.0F, -0.25F, 2.0F));
}

TEST_F(FramesFolder, WhatIsNoneIsRefused) {
    for (const char* pose : {"1 0 0 0\n0 1 0 0\n0 0 1 0\n", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 1 1\n",
                             "1 0 0 0\n0 1 0 0\n0 0 -1 0\n0 0 0 1\n", ""}) {
        write_pose("frame-0", pose);
        EXPECT_THROW(read_scans(folder_.path()), IoError) << pose;
    }
    write_pose("frame-0", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    EXPECT_EQ(read_scans(folder_.path()).size(), 2U);
    test::write_bytes(folder_ / "camera-intrinsics.txt", "2 1 1\n0 4 0.5\n0 0 1\n");
    EXPECT_THROW(read_scans(folder_.path()), IoError);
    const test::TemporaryFolder empty;
    test::write_bytes(empty / "camera-intrinsics.txt", "2 0 1\n0 4 0.5\n0 0 1\n");
    EXPECT_THROW(read_scans(empty.path()), IoError);
}

}  // namespace
}  // namespace roomscribe
