// SPDX-License-Identifier: MIT
// Scans of the formats that are read but not written, through register as a whole.
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "roomscribe/core/units.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "roomscribe/io/poses_io.hpp"
#include "roomscribe/simulation/building/building.hpp"
#include "roomscribe/simulation/furnishing/furnishing.hpp"
#include "roomscribe/simulation/scanning/ray_caster.hpp"
#include "roomscribe/simulation/simulated_world.hpp"
#include "support/depth_png.hpp"
#include "support/matchers.hpp"
#include "support/odd_scans.hpp"
#include "support/rosbag_bytes.hpp"
#include "support/simulated_rooms.hpp"
#include "system/program.hpp"

namespace roomscribe::test {
namespace {

using Eigen::Vector3d;

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

/// Pose of the second scan in the frame of the first, as register finds it.
std::optional<Transform> pose_of_second(const TemporaryFolder& folder,
                                        const std::vector<std::string>& inputs) {
    std::vector<std::string> arguments{"register"};
    arguments.insert(arguments.end(), inputs.begin(), inputs.end());
    arguments.insert(arguments.end(), {"-o", (folder / "out").string(), "--progress", "none"});
    const ProgramResult result = roomscribe(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    if (result.exit_code != 0) return std::nullopt;
    const auto poses = read_poses(folder / "out" / "poses.txt");
    return poses.size() == 2 ? poses[1] : std::nullopt;
}

void expect_pose(const std::optional<Transform>& found, const Transform& expected) {
    ASSERT_TRUE(found.has_value());
    EXPECT_THAT(*found, TransformNear(expected, 0.03, radians(0.5)));
}

/// Two scans by the terrestrial scanner, of the returns alone.
class TwoScans : public testing::Test {
  protected:
    TwoScans() {
        for (const Scan& scan : scan_l_shaped_room(2)) {
            std::vector<Eigen::Vector3f>& points = points_.emplace_back();
            for (const Eigen::Vector3f& point : scan.cloud.positions) {
                if (is_finite(point)) points.push_back(point);
            }
        }
    }
    /// Each scan in a file of its own, line by line.
    void expect_from_lines(const std::string& extension, const std::string& word, bool counted) {
        std::vector<std::string> inputs;
        for (const auto& points : points_) {
            std::string text = counted ? fmt::format("{}\n", points.size()) : "";
            for (const Eigen::Vector3f& point : points)
                text += fmt::format("{}{} {} {}\n", word, point.x(), point.y(), point.z());
            inputs.push_back((folder_ / fmt::format("{}{}", inputs.size(), extension)).string());
            write_bytes(inputs.back(), text);
        }
        expect_pose(pose_of_second(folder_, inputs), expected_);
    }

    TemporaryFolder folder_;
    std::vector<std::vector<Eigen::Vector3f>> points_;
    Transform expected_ = true_pose(0).inverse() * true_pose(1);
};

TEST_F(TwoScans, OfPts) {
    expect_from_lines(".pts", "", true);
}

TEST_F(TwoScans, OfObj) {
    expect_from_lines(".obj", "v ", false);
}

TEST_F(TwoScans, OfOnePtx) {
    std::string text;
    for (const auto& points : points_) {
        text += fmt::format("{}\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n", points.size());
        text += "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
        for (const Eigen::Vector3f& point : points)
            text += fmt::format("{} {} {} 0.5\n", point.x(), point.y(), point.z());
    }
    write_bytes(folder_ / "both.ptx", text);
    expect_pose(pose_of_second(folder_, {(folder_ / "both.ptx").string()}), expected_);
}

TEST_F(TwoScans, OfNpy) {
    std::vector<std::string> inputs;
    for (const auto& points : points_) {
        std::string header = fmt::format(
            "{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, 3), }}", points.size());
        header.resize(117, ' ');
        header += '\n';
        inputs.push_back((folder_ / fmt::format("{}.npy", inputs.size())).string());
        write_bytes(inputs.back(), std::string("\x93NUMPY\1\0\x76\0", 10) + header +
                                       std::string(reinterpret_cast<const char*>(points.data()),
                                                   points.size() * sizeof(Eigen::Vector3f)));
    }
    expect_pose(pose_of_second(folder_, inputs), expected_);
}

TEST_F(TwoScans, OfLas) {
    std::vector<std::string> inputs;
    for (const auto& points : points_) {
        PointCloud cloud;
        cloud.positions = points;
        inputs.push_back((folder_ / fmt::format("{}.las", inputs.size())).string());
        write_point_cloud(inputs.back(), cloud);
    }
    expect_pose(pose_of_second(folder_, inputs), expected_);
}

TEST_F(TwoScans, OfOneBag) {
    std::vector<std::string> messages;
    for (const auto& points : points_) {
        const auto count = static_cast<std::uint32_t>(points.size());
        RosBytes message;
        message.add_header(1.0, "laser").add(std::uint32_t{1}).add(count).add(std::uint32_t{3});
        std::uint32_t offset = 0;
        for (const char* name : {"x", "y", "z"}) {
            message.add_text(name).add(offset).add(std::uint8_t{7}).add(std::uint32_t{1});
            offset += 4;
        }
        message.add(std::uint8_t{0}).add(std::uint32_t{12}).add(12 * count);
        message.add_text(
            std::string_view(reinterpret_cast<const char*>(points.data()), 12 * points.size()));
        messages.push_back(message.add(std::uint8_t{1}).bytes());
    }
    BagTopic topic = cloud_topic(messages);
    write_bytes(folder_ / "both.bag", bag_of({topic}));
    expect_pose(pose_of_second(folder_, {(folder_ / "both.bag").string()}), expected_);
}

/// The l_shaped_room() as rays meet it.
class Raycast : public testing::Test {
  protected:
    Raycast() {
        add_building(world_, l_shaped_room());
        for (const ItemPlan& item : l_shaped_room().items)
            add_item(world_, item);
    }
    /// m, along a direction of the scanner's frame; 0 if nothing is met.
    double range(const RayCaster& caster, const Transform& room_from_scan,
                 const Vector3d& direction) const {
        const auto hit = caster.cast(room_from_scan.translation(),
                                     room_from_scan.linear() * direction.normalized());
        return hit ? hit->distance : 0.0;
    }
    SimulatedWorld world_;
    TemporaryFolder folder_;
};

TEST_F(Raycast, OfATiltingUnit) {
    const RayCaster caster(world_);
    std::vector<std::string> inputs;
    std::vector<Transform> poses;
    for (const double turn : {0.5, 1.0}) {
        Transform pose = Transform::Identity();
        pose.rotate(Eigen::AngleAxisd(turn, Vector3d::UnitZ()));
        pose.translation() = Vector3d(1.0 + 1.5 * (turn - 0.5), 1.0, 1.2);
        poses.push_back(pose);
        std::string text = "unit m\nstart -90\nstep 1\n";
        for (int tilt = -80; tilt <= 80; ++tilt) {
            text += fmt::format("scan {}", tilt);
            const Eigen::AngleAxisd nod(radians(tilt), Vector3d::UnitY());
            for (int bearing = -90; bearing <= 90; ++bearing) {
                const double b = radians(bearing);
                text += fmt::format(
                    " {:.4f}", range(caster, pose, nod * Vector3d(std::cos(b), std::sin(b), 0.0)));
            }
            text += '\n';
        }
        inputs.push_back((folder_ / fmt::format("{}.tilt", inputs.size())).string());
        write_bytes(inputs.back(), text);
    }
    expect_pose(pose_of_second(folder_, inputs), poses[0].inverse() * poses[1]);
}

TEST_F(Raycast, OfAFolderOfDepthImages) {
    constexpr std::size_t rows = 120;
    constexpr std::size_t columns = 160;
    constexpr double focal = 130.0;
    const RayCaster caster(world_);
    std::vector<Transform> poses;
    std::filesystem::create_directory(folder_ / "depth");
    std::string list;
    for (const double turn : {0.1, 0.4}) {
        // Camera axes: x right, y down, z ahead.
        Transform pose = Transform::Identity();
        pose.linear().col(2) = Vector3d(std::cos(turn), std::sin(turn), -0.25).normalized();
        pose.linear().col(0) = Vector3d(std::sin(turn), -std::cos(turn), 0.0);
        pose.linear().col(1) = pose.linear().col(2).cross(pose.linear().col(0));
        pose.translation() = Vector3d(0.7, 0.9, 1.5);
        poses.push_back(pose);
        std::vector<std::uint16_t> depths;
        for (std::size_t row = 0; row < rows; ++row) {
            for (std::size_t column = 0; column < columns; ++column) {
                const Vector3d ray((static_cast<double>(column) - 79.5) / focal,
                                   (static_cast<double>(row) - 59.5) / focal, 1.0);
                depths.push_back(static_cast<std::uint16_t>(
                    std::lround(1000.0 * range(caster, pose, ray) / ray.norm())));
            }
        }
        const std::string name = fmt::format("depth/{}.png", poses.size());
        write_bytes(folder_ / name, depth_png(rows, columns, depths));
        list += fmt::format("{}.0 {}\n", poses.size(), name);
    }
    write_bytes(folder_ / "depth.txt", list);
    write_bytes(folder_ / "intrinsics.txt", "130 130 79.5 59.5 1000\n");
    expect_pose(pose_of_second(folder_, {folder_.path().string()}), poses[0].inverse() * poses[1]);
}

}  // namespace
}  // namespace roomscribe::test
