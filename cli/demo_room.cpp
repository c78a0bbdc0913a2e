// SPDX-License-Identifier: MIT
#include "cli/demo_room.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "roomscribe/core/random.hpp"
#include "roomscribe/core/units.hpp"

namespace roomscribe::cli {
namespace {

using Box = Eigen::AlignedBox3d;
using Eigen::Vector3d;

struct Ray {
    Vector3d origin;
    Vector3d direction;
};

/// The air is a union of boxes that overlap a little; a ray that leaves it has met a wall, or the
/// glass at the end of the last box. Solid boxes stand in the air.
struct Building {
    std::vector<Box> air;
    Box window_air;
    std::vector<Box> solids;
};

Box make_box(double x0, double y0, double z0, double x1, double y1, double z1) {
    return {Vector3d(x0, y0, z0), Vector3d(x1, y1, z1)};
}

void add_table(std::vector<Box>& solids, double x, double y, double width, double depth) {
    constexpr double leg = 0.05;
    solids.push_back(make_box(x, y, 0.71, x + width, y + depth, 0.74));
    for (const double leg_x : {x, x + width - leg}) {
        for (const double leg_y : {y, y + depth - leg}) {
            solids.push_back(make_box(leg_x, leg_y, 0.0, leg_x + leg, leg_y + leg, 0.71));
        }
    }
}

void add_chair(std::vector<Box>& solids, double x, double y) {
    solids.push_back(make_box(x, y, 0.43, x + 0.42, y + 0.42, 0.47));
    solids.push_back(make_box(x, y, 0.47, x + 0.42, y + 0.03, 0.90));
    solids.push_back(make_box(x + 0.18, y + 0.18, 0.0, x + 0.24, y + 0.24, 0.43));
}

Building make_building() {
    Building room;
    room.window_air = make_box(5.59, 1.2, 0.9, 5.78, 2.8, 2.1);
    room.air = {make_box(0.0, 0.0, 0.0, 5.6, 4.2, 2.6),
                make_box(0.7, -0.06, 0.0, 1.6, 0.01, 2.02),  // niche that ends at the door leaf
                room.window_air};
    room.solids = {
        // Door frame and lever.
        make_box(0.62, 0.0, 0.0, 0.70, 0.03, 2.10), make_box(1.60, 0.0, 0.0, 1.68, 0.03, 2.10),
        make_box(0.70, 0.0, 2.02, 1.60, 0.03, 2.10), make_box(0.74, -0.04, 1.04, 0.87, 0.0, 1.06),
        // Window frame with its middle bar.
        make_box(5.70, 1.20, 0.90, 5.76, 2.80, 0.97), make_box(5.70, 1.20, 2.03, 5.76, 2.80, 2.10),
        make_box(5.70, 1.20, 0.97, 5.76, 1.27, 2.03), make_box(5.70, 2.73, 0.97, 5.76, 2.80, 2.03),
        make_box(5.70, 1.97, 0.97, 5.76, 2.03, 2.03),
        // Radiator, wardrobe, shelf, bed, bedside box, lamp.
        make_box(5.50, 1.40, 0.15, 5.59, 2.60, 0.75), make_box(2.6, 3.6, 0.0, 4.4, 4.2, 2.1),
        make_box(0.0, 1.5, 0.0, 0.32, 2.5, 1.8), make_box(0.0, 3.2, 0.0, 2.0, 4.2, 0.5),
        make_box(2.02, 3.8, 0.0, 2.42, 4.2, 0.55), make_box(2.7, 2.0, 2.52, 3.1, 2.4, 2.6)};
    add_table(room.solids, 3.3, 0.05, 1.6, 0.75);
    add_chair(room.solids, 3.8, 1.0);
    return room;
}

/// Lengths of the ray at which it enters and leaves the box; empty if it passes by.
std::optional<std::array<double, 2>> intersect(const Box& box, const Ray& ray) {
    const Eigen::Array3d to_min = (box.min() - ray.origin).array() / ray.direction.array();
    const Eigen::Array3d to_max = (box.max() - ray.origin).array() / ray.direction.array();
    const double enter = to_min.min(to_max).maxCoeff();
    const double leave = to_min.max(to_max).minCoeff();
    if (leave < std::max(enter, 0.0)) return std::nullopt;
    return std::array{enter, leave};
}

/// Length of the ray until something sends it back; empty if nothing does.
std::optional<double> cast_ray(const Building& building, const Ray& ray) {
    double length = 0.0;
    const Box* last_air = nullptr;
    for (bool moved = true; moved;) {
        moved = false;
        for (const Box& air : building.air) {
            const auto span = intersect(air, ray);
            if (span && (*span)[0] <= length && (*span)[1] > length) {
                length = (*span)[1];
                last_air = &air;
                moved = true;
            }
        }
    }
    const double glass = building.window_air.max().x();
    const bool through_glass = last_air == &building.air.back() &&
                               std::abs((ray.origin + length * ray.direction).x() - glass) < 1e-9;
    bool returned = !through_glass;
    for (const Box& solid : building.solids) {
        const auto span = intersect(solid, ray);
        if (span && (*span)[0] > 0.0 && (*span)[0] < length) {
            length = (*span)[0];
            returned = true;
        }
    }
    return returned ? std::optional(length) : std::nullopt;
}

PointCloud scan_from(const Building& building, const Transform& room_from_scan, Random& random) {
    constexpr double noise = 0.005;
    constexpr std::size_t columns = 450;
    constexpr std::size_t rows = 194;
    constexpr double lowest = radians(-65.0);
    constexpr double step = 2.0 * std::numbers::pi / columns;
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();

    PointCloud cloud;
    cloud.grid = ScanGrid{rows, columns};
    cloud.positions.reserve(rows * columns);
    for (std::size_t row = 0; row < rows; ++row) {
        const double elevation = lowest + step * static_cast<double>(row);
        for (std::size_t column = 0; column < columns; ++column) {
            const double azimuth = step * static_cast<double>(column);
            const Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                     std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
            const auto length = cast_ray(
                building, {room_from_scan.translation(), room_from_scan.linear() * direction});
            const double error = noise * random.normal();
            cloud.positions.push_back(
                length ? Eigen::Vector3f(((*length + error) * direction).cast<float>())
                       : Eigen::Vector3f(nan, nan, nan));
        }
    }
    return cloud;
}

}  // namespace

std::vector<Scan> scan_demo_room() {
    const Building building = make_building();
    Random random(2014);
    std::vector<Scan> scans;
    for (const Vector3d& position :
         {Vector3d(1.5, 1.2, 1.35), Vector3d(4.6, 2.9, 1.50), Vector3d(2.6, 2.6, 1.20)}) {
        const double yaw = random.uniform(-std::numbers::pi, std::numbers::pi);
        const double roll = radians(random.uniform(2.0, 5.0));
        const double pitch = radians(random.uniform(-5.0, -2.0));
        Transform room_from_scan = Transform::Identity();
        room_from_scan.translate(position);
        room_from_scan.rotate(Eigen::AngleAxisd(yaw, Vector3d::UnitZ()));
        room_from_scan.rotate(Eigen::AngleAxisd(pitch, Vector3d::UnitY()));
        room_from_scan.rotate(Eigen::AngleAxisd(roll, Vector3d::UnitX()));
        scans.push_back({fmt::format("scan{}.ply", scans.size() + 1),
                         scan_from(building, room_from_scan, random)});
    }
    return scans;
}

}  // namespace roomscribe::cli
