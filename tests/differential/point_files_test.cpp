// SPDX-License-Identifier: MIT
// What is written is read by PCL as it was, and the other way round.
#include <cstdint>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>

#include "roomscribe/core/random.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "support/shapes.hpp"
#include "support/test_data.hpp"

namespace roomscribe {
namespace {

using PclCloud = pcl::PointCloud<pcl::PointXYZRGBNormal>;

PointCloud colored_cloud() {
    Random random(3);
    PointCloud cloud;
    for (int i = 0; i < 1000; ++i) {
        cloud.positions.emplace_back(
            (8.0 * test::random_direction(random) + Eigen::Vector3d(1.0, 2.0, 3.0)).cast<float>());
        cloud.normals.emplace_back(test::random_direction(random).cast<float>());
        cloud.colors.push_back({static_cast<std::uint8_t>(random.next() % 256),
                                static_cast<std::uint8_t>(random.next() % 256),
                                static_cast<std::uint8_t>(random.next() % 256)});
    }
    return cloud;
}

void expect_same(const PclCloud& found, const PointCloud& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(found[i].getVector3fMap(), expected.positions[i]) << i;
        EXPECT_EQ(found[i].getNormalVector3fMap(), expected.normals[i]) << i;
        EXPECT_EQ(found[i].r, expected.colors[i][0]) << i;
        EXPECT_EQ(found[i].g, expected.colors[i][1]) << i;
        EXPECT_EQ(found[i].b, expected.colors[i][2]) << i;
    }
}

void expect_same(const PointCloud& found, const PclCloud& expected) {
    ASSERT_EQ(found.size(), expected.size());
    ASSERT_EQ(found.normals.size(), expected.size());
    ASSERT_EQ(found.colors.size(), expected.size());
    expect_same(expected, found);
}

TEST(PclReads, PcdOfEveryEncoding) {
    const test::TemporaryFolder folder;
    const PointCloud cloud = colored_cloud();
    const std::string path = (folder / "a.pcd").string();
    for (const Encoding encoding :
         {Encoding::ascii, Encoding::binary, Encoding::binary_compressed}) {
        write_point_cloud(path, cloud, {.encoding = encoding});
        PclCloud found;
        ASSERT_EQ(pcl::io::loadPCDFile(path, found), 0);
        expect_same(found, cloud);
    }
}

TEST(PclReads, PlyOfEveryEncoding) {
    const test::TemporaryFolder folder;
    const PointCloud cloud = colored_cloud();
    const std::string path = (folder / "a.ply").string();
    for (const Encoding encoding :
         {Encoding::ascii, Encoding::binary, Encoding::binary_big_endian}) {
        write_point_cloud(path, cloud, {.encoding = encoding});
        PclCloud found;
        ASSERT_EQ(pcl::io::loadPLYFile(path, found), 0);
        expect_same(found, cloud);
    }
}

TEST(PclWrites, WhatIsRead) {
    const test::TemporaryFolder folder;
    PclCloud cloud;
    for (int i = 0; i < 1000; ++i) {
        pcl::PointXYZRGBNormal point;
        const auto x = static_cast<float>(i);
        point.getVector3fMap() = Eigen::Vector3f(0.37F * x, -1.0F / (1.0F + x), 3.0F);
        point.getNormalVector3fMap() = Eigen::Vector3f(0.6F, 0.0F, -0.8F);
        point.r = static_cast<std::uint8_t>(i % 256);
        point.g = 7;
        point.b = static_cast<std::uint8_t>(255 - i % 256);
        cloud.push_back(point);
    }
    const auto path = [&](const char* name) { return (folder / name).string(); };
    ASSERT_EQ(pcl::io::savePCDFileBinary(path("b.pcd"), cloud), 0);
    ASSERT_EQ(pcl::io::savePCDFileBinaryCompressed(path("c.pcd"), cloud), 0);
    ASSERT_EQ(pcl::io::savePLYFileBinary(path("b.ply"), cloud), 0);
    for (const char* name : {"b.pcd", "c.pcd", "b.ply"}) {
        SCOPED_TRACE(name);
        expect_same(read_scan(path(name)).cloud, cloud);
    }
}

}  // namespace
}  // namespace roomscribe
