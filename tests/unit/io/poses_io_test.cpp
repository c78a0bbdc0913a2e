// SPDX-License-Identifier: MIT
#include "roomscribe/io/poses_io.hpp"

#include <numbers>

#include <gtest/gtest.h>

#include "io_test_clouds.hpp"
#include "roomscribe/core/error.hpp"
#include "roomscribe/io/uos.hpp"
#include "support/test_data.hpp"

namespace roomscribe {
namespace {

Transform random_pose(Random& random) {
    Transform pose = Transform::Identity();
    pose.linear() =
        Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
            .normalized()
            .toRotationMatrix();
    pose.translation() = Eigen::Vector3d(random.normal(), random.normal(), random.normal());
    return pose;
}

std::vector<std::optional<Transform>> read_text(const std::string& name, const std::string& text) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / name, text);
    return read_poses(folder / name);
}

TEST(Poses, KittiRoundTripWithUnplacedScans) {
    const test::TemporaryFolder folder;
    Random random(1);
    std::vector<std::optional<Transform>> poses;
    for (int i = 0; i < 50; ++i) {
        if (i % 7 == 3) {
            poses.emplace_back();
        } else {
            poses.emplace_back(random_pose(random));
        }
    }
    write_poses(folder / "poses.txt", poses);
    const auto read = read_poses(folder / "poses.txt");
    ASSERT_EQ(read.size(), poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
        ASSERT_EQ(read[i].has_value(), poses[i].has_value());
        if (poses[i]) {
            EXPECT_TRUE(read[i]->isApprox(*poses[i], 1e-14));
        }
    }
}

TEST(Poses, KittiIsRowMajor) {
    const auto poses = read_text("poses.txt", "# a comment\n\n0 -1 0 4  1 0 0 5  0 0 1 6\r\n");
    ASSERT_EQ(poses.size(), 1U);
    EXPECT_TRUE((*poses[0] * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(4, 6, 6)));
}

TEST(Poses, TumHasTheScalarLast) {
    const double half = std::sqrt(0.5);
    const auto poses =
        read_text("tum.txt", "1305031.5 4 5 6 0 0 " + std::to_string(half) + " " +
                                 std::to_string(half) + "\n1305032.5 1 2 3 0 0 0 1\n");
    ASSERT_EQ(poses.size(), 2U);
    // A quarter turn about z.
    EXPECT_TRUE((*poses[0] * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(4, 6, 6), 1e-6));
    EXPECT_TRUE(poses[1]->linear().isIdentity());
}

TEST(Poses, UosAxesAreMappedAndUnitsConverted) {
    // 3DTK: 100 cm to the right, 200 up, 300 ahead.
    const auto poses = read_text("scan000.pose", "100 200 300\n0 0 0\n");
    ASSERT_EQ(poses.size(), 1U);
    EXPECT_TRUE(poses[0]->translation().isApprox(Eigen::Vector3d(3, -1, 2)));
    EXPECT_TRUE(poses[0]->linear().isIdentity(1e-15));
    // A quarter turn about 3DTK's y axis takes its z (ahead) to its x (right).
    const Transform turn = transform_from_uos({0, 0, 0, 0, 90, 0});
    EXPECT_TRUE((turn * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(0, -1, 0)));
}

/// EulerToMatrix4 written out, element by element.
TEST(Poses, UosAnglesAreThoseOf3dtk) {
    const double a = 0.3, b = -0.7, c = 1.1;
    const double sx = std::sin(a), cx = std::cos(a), sy = std::sin(b), cy = std::cos(b);
    const double sz = std::sin(c), cz = std::cos(c);
    Eigen::Matrix3d expected;
    expected << cy * cz, -cy * sz, sy,                              //
        sx * sy * cz + cx * sz, -sx * sy * sz + cx * cz, -sx * cy,  //
        -cx * sy * cz + sx * sz, cx * sy * sz + sx * cz, cx * cy;
    Eigen::Matrix3d axes;
    axes << 0, 0, 1, -1, 0, 0, 0, 1, 0;
    const double to_degrees = 180.0 / std::numbers::pi;
    const Transform pose =
        transform_from_uos({0, 0, 0, a * to_degrees, b * to_degrees, c * to_degrees});
    EXPECT_TRUE(pose.linear().isApprox(axes * expected * axes.inverse(), 1e-14));
}

TEST(Poses, UosRoundTripAlsoWhereTheAnglesAreNotUnique) {
    const test::TemporaryFolder folder;
    Random random(2);
    std::vector<Transform> poses;
    for (int i = 0; i < 50; ++i)
        poses.push_back(random_pose(random));
    for (const double b : {90.0, -90.0}) {
        poses.push_back(transform_from_uos({1, 2, 3, 20, b, 50}));
    }
    for (const Transform& pose : poses) {
        const std::vector<std::optional<Transform>> one = {pose};
        write_poses(folder / "scan000.pose", one);
        EXPECT_TRUE(read_poses(folder / "scan000.pose").at(0)->isApprox(pose, 1e-9));
    }
    const std::vector<std::optional<Transform>> two(2, Transform::Identity());
    EXPECT_THROW(write_poses(folder / "a.pose", two), InvalidArgument);
    const std::vector<std::optional<Transform>> none(1);
    EXPECT_THROW(write_poses(folder / "a.pose", none), InvalidArgument);
}

TEST(Poses, RefusesWhatIsNoPose) {
    EXPECT_THROW(read_text("a.txt", "1 2 3\n"), IoError);
    EXPECT_THROW(read_text("a.txt", "# nothing\n"), IoError);
    EXPECT_THROW(read_text("a.txt", "1 0 0 0 0 1 0 0 0 0 1 x\n"), IoError);
    EXPECT_THROW(read_text("a.txt", "1 0 0 0 0 1 0 0 0 0 1 nan\n"), IoError);
    EXPECT_THROW(read_text("a.txt", "1 0 0 0 0 1 0 0 0 0 -1 0\n"), IoError);
    EXPECT_THROW(read_text("a.txt", "2 0 0 0 0 1 0 0 0 0 1 0\n"), IoError);
    EXPECT_THROW(read_text("a.txt", "0 1 2 3 0 0 0 2\n"), IoError);
    EXPECT_THROW(read_text("a.txt", "0 1 2 3 0 0 0 1\n1 0 0 0 0 1 0 0 0 0 1 0\n"), IoError);
    EXPECT_THROW(read_text("a.pose", "1 2 3\n4 5\n"), IoError);
    EXPECT_THROW(read_text("a.pose", "1 2 3\n4 5 inf\n"), IoError);
    EXPECT_THROW(read_poses("/no/such/poses.txt"), IoError);
}

}  // namespace
}  // namespace roomscribe
