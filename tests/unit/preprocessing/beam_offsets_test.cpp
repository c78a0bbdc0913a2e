// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/beam_offsets.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"
#include "roomscribe/core/units.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

/// m, from the middle of a bare room of 6 x 5 x 2.8 m to its surface.
double range_in_room(const Vector3d& direction) {
    const Vector3d half(3.0, 2.5, 1.4);
    double range = std::numeric_limits<double>::infinity();
    for (Eigen::Index axis = 0; axis < 3; ++axis)
        range = std::min(range, half[axis] / std::abs(direction[axis]));
    return range;
}

/// Neighbours differ by 3 cm: what a smooth surface cannot be.
double offset_of(std::size_t beam) {
    return beam % 2 == 0 ? 0.015 : -0.015;
}

struct Rings {
    std::size_t num_beams = 32;
    double step = radians(1.4);
    double offset_scale = 1.0;
    double noise = 0.015;
};

std::vector<Eigen::Vector3f> scan_room(const Rings& rings, const Vector3d& sensor = {0, 0, 0}) {
    Random random(7, 0);
    std::vector<Eigen::Vector3f> points;
    for (std::size_t beam = 0; beam < rings.num_beams; ++beam) {
        const double elevation =
            rings.step * (static_cast<double>(beam) - 0.5 * static_cast<double>(rings.num_beams));
        for (int column = 0; column < 900; ++column) {
            const double azimuth = 2.0 * std::numbers::pi * column / 900.0;
            const Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                     std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
            const double range = range_in_room(direction) + rings.noise * random.normal() +
                                 rings.offset_scale * offset_of(beam);
            points.emplace_back((sensor + range * direction).cast<float>());
        }
    }
    return points;
}

TEST(BeamOffsets, AreFoundAndTakenOut) {
    const Vector3d sensor(0.2, -0.3, 1.1);
    std::vector<Eigen::Vector3f> points = scan_room({}, sensor);
    const auto beams = find_beam_offsets({points, sensor});
    ASSERT_TRUE(beams);
    ASSERT_EQ(beams->offsets.size(), 32U);
    for (std::size_t beam = 0; beam < 32; ++beam)
        EXPECT_NEAR(beams->offsets[beam], offset_of(beam), 0.007) << beam;

    const Eigen::Vector3f before = points[450];
    remove_beam_offsets(points, sensor, *beams);
    EXPECT_NEAR((points[450] - before).norm(), 0.015, 0.007);
    EXPECT_FALSE(find_beam_offsets({points, sensor}));
}

TEST(BeamOffsets, AreNotMadeUp) {
    const std::vector<Eigen::Vector3f> points = scan_room({.offset_scale = 0.0});
    EXPECT_FALSE(find_beam_offsets({points}));
}

TEST(BeamOffsets, NeedRingsAboutTheScanner) {
    // Lines of a single laser that turns, closer than any beams.
    const std::vector<Eigen::Vector3f> lines = scan_room({.num_beams = 400, .step = radians(0.15)});
    EXPECT_FALSE(find_beam_offsets({lines}));
    // Seen from elsewhere, or about another axis, the points lie at all elevations.
    const std::vector<Eigen::Vector3f> rings = scan_room({});
    EXPECT_FALSE(find_beam_offsets({rings, {0.5, 0.0, 0.5}}));
    const Eigen::Matrix3d lying = Eigen::AngleAxisd(1.0, Vector3d::UnitX()).toRotationMatrix();
    EXPECT_FALSE(find_beam_offsets({rings, Vector3d::Zero(), lying}));
    EXPECT_FALSE(find_beam_offsets(ScannedPoints{}));
}

TEST(BeamOffsets, AreSharedByScansOfOneScanner) {
    const std::vector<Eigen::Vector3f> telling = scan_room({});
    // So rough a room tells nothing.
    const std::vector<Eigen::Vector3f> rough = scan_room({.noise = 0.3});
    const std::vector<Eigen::Vector3f> other = scan_room({.num_beams = 16, .noise = 0.3});
    const std::vector<ScannedPoints> scans{{rough}, {telling}, {other}, {telling}};
    const auto found = find_beam_offsets(scans);
    ASSERT_TRUE(found[0]);
    ASSERT_TRUE(found[1]);
    EXPECT_EQ(found[0]->offsets, found[1]->offsets);
    EXPECT_FALSE(found[2]) << "of another scanner";
    EXPECT_FALSE(find_beam_offsets(std::span(scans).first(2))[0]) << "one alone may be wrong";
}

TEST(BeamOffsets, OfAMapCanBePutBack) {
    ScanMap map;
    map.cloud.positions = scan_room({});
    map.cloud.positions[3].setConstant(std::numeric_limits<float>::quiet_NaN());
    const std::vector<Eigen::Vector3f> before = map.cloud.positions;
    MapSection section{"rings", 0, static_cast<std::uint32_t>(before.size()), Vector3d(0, 0, 0)};
    map.sections.push_back(section);
    EXPECT_TRUE(remove_beam_offsets(map).empty()) << "its axes are unknown";

    map.sections[0].sensor_axes = Eigen::Matrix3d::Identity();
    const std::vector<HiddenPoint> moved = remove_beam_offsets(map);
    EXPECT_EQ(moved.size(), before.size() - 1);
    EXPECT_NE(map.cloud.positions[0], before[0]);
    put_back(moved, map);
    EXPECT_EQ(map.cloud.positions[0], before[0]);
    EXPECT_EQ(map.cloud.positions.back(), before.back());
}

}  // namespace
}  // namespace roomscribe
