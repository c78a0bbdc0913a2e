// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include "roomscribe/geometry/search_tree.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "roomscribe/preprocessing/normal_estimation.hpp"
#include "roomscribe/preprocessing/voxel_grid.hpp"
#include "support/shapes.hpp"
#include "support/simulated_rooms.hpp"
#include "support/test_data.hpp"

namespace roomscribe::test {

inline pcl::PointCloud<pcl::PointXYZ>::Ptr to_pcl(std::span<const Eigen::Vector3f> positions) {
    auto cloud = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
    for (const Eigen::Vector3f& point : positions) {
        cloud->push_back(pcl::PointXYZ(point.x(), point.y(), point.z()));
    }
    return cloud;
}

inline pcl::PointCloud<pcl::Normal>::Ptr normals_to_pcl(std::span<const Eigen::Vector3f> normals) {
    auto cloud = std::make_shared<pcl::PointCloud<pcl::Normal>>();
    for (const Eigen::Vector3f& normal : normals) {
        cloud->push_back(pcl::Normal(normal.x(), normal.y(), normal.z()));
    }
    return cloud;
}

/// A cloud that both libraries are given.
struct Input {
    std::string name;
    std::vector<Eigen::Vector3f> positions;
    SearchTree tree{{}};
    std::vector<Eigen::Vector3f> normals;  ///< ours, towards the origin

    explicit Input(std::string input_name, const PointCloud& cloud, double voxel_size)
        : name(std::move(input_name)),
          positions(downsample_voxel_grid(cloud, {.voxel_size = voxel_size}).cloud.positions),
          tree(positions),
          normals(estimate_normals(positions, tree, Eigen::Vector3d::Zero()).normals) {}
};

/// Points that returned: PCL takes a cloud at its word that it is dense.
inline PointCloud finite_part(const PointCloud& cloud) {
    return select_points(cloud, finite_points(cloud));
}

/// A simulated room, and a real one where the folder of real scans is present.
inline std::vector<PointCloud> raw_clouds() {
    std::vector<PointCloud> clouds;
    const Transform pose(Eigen::Translation3d(1.5, 1.5, 1.4));
    clouds.push_back(finite_part(simulate_scan(l_shaped_room(), pose, 1).cloud));
    const auto real = real_scan("registration/pcl_room_scan/room_scan1.pcd");
    if (!real.empty()) clouds.push_back(read_scan(real).cloud);
    return clouds;
}

inline std::vector<Input> inputs(double voxel_size) {
    std::vector<Input> all;
    for (const PointCloud& cloud : raw_clouds()) {
        all.emplace_back(all.empty() ? "simulated" : "real", cloud, voxel_size);
    }
    return all;
}

}  // namespace roomscribe::test
