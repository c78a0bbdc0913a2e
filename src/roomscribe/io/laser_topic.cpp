// SPDX-License-Identifier: MIT
#include "roomscribe/io/laser_topic.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/io/rosbag_records.hpp"

namespace roomscribe {
namespace {

/// Where in its message a LaserScan is.
struct LaserPaths {
    std::string scan;   ///< prefix of its fields: "laserScan.", or nothing
    std::string angle;  ///< of the scanner; empty if the message does not say it
};

std::optional<LaserPaths> find_laser(const RosMessage& message) {
    LaserPaths paths;
    bool found = false;
    for (const RosField& field : message.fields()) {
        if (found || !field.path.ends_with("ranges") || field.type != ScalarType::float32) continue;
        const std::string prefix = field.path.substr(0, field.path.size() - 6);
        if (!prefix.empty() && prefix.back() != '.') continue;
        paths.scan = prefix;
        found = message.number(prefix + "angle_min") && message.number(prefix + "angle_increment");
    }
    if (!found) return std::nullopt;
    for (const RosField& field : message.fields()) {
        if (field.path.starts_with(paths.scan) || field.count != 1) continue;
        std::string name = field.path;
        for (char& c : name)
            c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        const auto has = [&name](const char* word) { return name.find(word) != std::string::npos; };
        if (has("angle") || has("tilt") || has("pitch")) {
            paths.angle = field.path;
            break;
        }
    }
    return paths;
}

std::vector<float> floats(const RosMessage& message, const std::string& path) {
    const std::vector<double> numbers = message.numbers(path);
    return {numbers.begin(), numbers.end()};
}

LaserScan laser_scan(const RosMessage& message, const LaserPaths& paths) {
    const auto number = [&](const char* name) {
        return message.number(paths.scan + name).value_or(0.0);
    };
    LaserScan scan;
    scan.time = message.time(paths.scan + "header.stamp");
    scan.frame = message.frame(paths.scan + "header.frame_id");
    scan.start = number("angle_min");
    scan.step = number("angle_increment");
    scan.ray_time = number("time_increment");
    scan.min_range = number("range_min");
    scan.max_range = number("range_max");
    if (!paths.angle.empty()) scan.angle = message.number(paths.angle).value_or(0.0);
    scan.ranges = floats(message, paths.scan + "ranges");
    scan.intensities = floats(message, paths.scan + "intensities");
    return scan;
}

/// Where the scanner was at the first and at the last ray of a scan.
struct Sweep {
    Transform first;
    Transform last;
};

std::vector<std::optional<Sweep>> sweeps_by_angle(const LaserTopic& laser, FileContents& contents) {
    double largest = 0.0;
    for (const LaserScan& scan : laser.scans)
        largest = std::max(largest, std::abs(scan.angle));
    const bool in_degrees = largest > 2.0 * std::numbers::pi;
    std::vector<std::optional<Sweep>> sweeps;
    for (const LaserScan& scan : laser.scans) {
        const double tilt = in_degrees ? radians(scan.angle) : scan.angle;
        Transform pose = Transform::Identity();
        if (std::isfinite(tilt))
            pose.linear() = Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitY()).toRotationMatrix();
        sweeps.emplace_back(Sweep{pose, pose});
    }
    contents.warnings.push_back(
        fmt::format("{} planar scans are assembled by {}, taken for {} nose down",
                    laser.scans.size(), laser.angle, in_degrees ? "degrees" : "radians"));
    contents.cloud.sensor_pose = Transform::Identity();
    return sweeps;
}

std::vector<std::optional<Sweep>> sweeps_by_transforms(const LaserTopic& laser,
                                                       const TfTree& transforms,
                                                       FileContents& contents) {
    const std::string& frame = laser.scans.front().frame;
    if (!transforms.has(frame)) {
        throw Error(fmt::format("no transform of /tf says how frame '{}' was turned", frame));
    }
    std::vector<std::optional<Sweep>> sweeps;
    std::vector<Eigen::Vector3d> places;
    for (const LaserScan& scan : laser.scans) {
        const double duration = scan.ray_time * static_cast<double>(scan.ranges.size());
        const auto first = transforms.root_from(scan.frame, scan.time);
        const auto last = transforms.root_from(scan.frame, scan.time + duration);
        sweeps.emplace_back();
        if (!first || !last || !transforms.has(scan.frame)) continue;
        sweeps.back() = Sweep{*first, *last};
        places.emplace_back(first->translation());
    }
    const std::string root = transforms.root_of(frame);
    contents.warnings.push_back(
        fmt::format("{} planar scans are assembled by /tf in frame {}", laser.scans.size(), root));
    if (!places.empty()) {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (const Eigen::Vector3d& place : places)
            sum += place;
        contents.cloud.sensor_pose =
            Transform(Eigen::Translation3d(sum / static_cast<double>(places.size())));
    }
    return sweeps;
}

void add_points(const LaserScan& scan, const Sweep& sweep, PointCloud& cloud) {
    const bool is_still = sweep.first.isApprox(sweep.last, 0.0);
    const auto num_rays = static_cast<double>(scan.ranges.size());
    for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
        const double range = static_cast<double>(scan.ranges[i]);
        const bool returned =
            std::isfinite(range) && range >= scan.min_range && range <= scan.max_range;
        if (!returned) {
            cloud.positions.emplace_back(Eigen::Vector3f::Constant(std::nanf("")));
            continue;
        }
        const double bearing = scan.start + static_cast<double>(i) * scan.step;
        const Eigen::Vector3d point =
            range * Eigen::Vector3d(std::cos(bearing), std::sin(bearing), 0.0);
        const Transform pose =
            is_still ? sweep.first
                     : between(sweep.first, sweep.last, static_cast<double>(i) / num_rays);
        cloud.positions.emplace_back((pose * point).cast<float>());
    }
}

}  // namespace

void add_laser_scan(const RosMessage& message, LaserTopic& laser) {
    const std::optional<LaserPaths> paths = find_laser(message);
    if (!paths) return;
    laser.angle = paths->angle;
    laser.scans.push_back(laser_scan(message, *paths));
}

FileContents assemble_laser_scans(const LaserTopic& laser, const TfTree& transforms) {
    FileContents contents;
    contents.name = laser.topic;
    contents.format = rosbag_format;
    contents.encoding = "LaserScan";
    contents.fields = {{"range", ScalarType::float32, 1}};
    const std::vector<std::optional<Sweep>> sweeps =
        laser.angle.empty() ? sweeps_by_transforms(laser, transforms, contents)
                            : sweeps_by_angle(laser, contents);
    PointCloud& cloud = contents.cloud;
    const std::size_t num_rays = laser.scans.front().ranges.size();
    bool is_grid = true;
    bool has_intensities = true;
    std::size_t num_used = 0;
    for (std::size_t i = 0; i < sweeps.size(); ++i) {
        if (!sweeps[i]) continue;
        const LaserScan& scan = laser.scans[i];
        add_points(scan, *sweeps[i], cloud);
        cloud.intensities.insert(cloud.intensities.end(), scan.intensities.begin(),
                                 scan.intensities.end());
        is_grid = is_grid && scan.ranges.size() == num_rays;
        has_intensities = has_intensities && scan.intensities.size() == scan.ranges.size();
        ++num_used;
    }
    if (num_used == 0) throw Error("no transform says how the scanner was turned");
    if (num_used < sweeps.size()) {
        contents.warnings.push_back(fmt::format("{} of {} planar scans have no transform",
                                                sweeps.size() - num_used, sweeps.size()));
    }
    if (is_grid && num_rays > 1 && num_used > 1) cloud.grid = ScanGrid{num_used, num_rays};
    if (has_intensities) {
        contents.fields.push_back({"intensity", ScalarType::float32, 1});
    } else {
        cloud.intensities.clear();
    }
    return contents;
}

}  // namespace roomscribe
