// SPDX-License-Identifier: MIT
#include "roomscribe/structure/planar_surfaces.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "flat_clouds.hpp"
#include "roomscribe/preprocessing/scan_statistics.hpp"
#include "support/contexts.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

const Vector3d x = Vector3d::UnitX();
const Vector3d y = Vector3d::UnitY();
const Vector3d z = Vector3d::UnitZ();

bool is_on_door(double along, double up) {
    return test::is_within(along, 1.0, 1.9) && up <= 2.0;
}

/// Floor, and two walls, in one of which a door leaf is recessed by 2 cm. Seen from within.
ScanMap small_room(double noise) {
    Random random(5);
    PointCloud cloud;
    test::add_rectangle(cloud, Vector3d::Zero(), 3.0 * x, 4.0 * y, 0.012, noise, random);
    test::add_rectangle(cloud, Vector3d::Zero(), 4.0 * y, 2.5 * z, 0.012, noise, random);
    test::add_rectangle(cloud, 4.0 * y, 3.0 * x, 2.5 * z, 0.012, noise, random,
                        [](double a, double b) { return is_on_door(a, b) ? 0.02 : 0.0; });
    cloud.normals.clear();
    cloud.sensor_pose = Transform(Eigen::Translation3d(1.5, 2.0, 1.3));
    Scan scan;
    scan.cloud = std::move(cloud);
    return map_of_cloud(std::move(scan));
}

PlanarSurfaces surfaces_of(const ScanMap& map, const Context& context = {}) {
    const SurfaceSample sample =
        sample_surface(map, estimate_scan_statistics(map.cloud, context), {}, context);
    return find_planar_surfaces(
        map, sample, {.distance_tolerance = sample.tolerance, .cell_size = 2.0 * sample.spacing},
        context);
}

TEST(FindPlanarSurfaces, FindsTheLeafOfADoorApartFromItsWall) {
    for (const double noise : {0.0, 0.002, 0.004}) {
        SCOPED_TRACE(noise);
        const ScanMap map = small_room(noise);
        const PlanarSurfaces surfaces = surfaces_of(map);
        ASSERT_GE(surfaces.patches.size(), 4U);
        for (std::size_t i = 4; i < surfaces.patches.size(); ++i)
            EXPECT_LT(surfaces.patches[i].area, 0.15);
        ASSERT_EQ(surfaces.patch_of_point.size(), map.cloud.size());
        const PlanarPatch& leaf = surfaces.patches[3];
        EXPECT_NEAR(std::abs(leaf.plane.normal.dot(y)), 1.0, 1e-4);
        EXPECT_NEAR(leaf.plane.signed_distance(Vector3d(1.5, 3.98, 1.0)), 0.0, 0.002);
        // Squares of 8 cm along a rim of 5.8 m count too much by 0.23 on average.
        EXPECT_NEAR(leaf.area, 1.8 + 0.23, 0.15);
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < map.cloud.size(); ++i) {
            const Vector3d point = map.cloud.positions[i].cast<double>();
            const bool is_leaf =
                point.y() > 3.9 && is_on_door(point.x(), point.z()) && point.z() > 0.05;
            wrong += (surfaces.patch_of_point[i] == 3) != is_leaf && point.z() > 0.05 ? 1 : 0;
        }
        EXPECT_LT(static_cast<double>(wrong), 0.01 * static_cast<double>(map.cloud.size()));
    }
}

TEST(FindPlanarSurfaces, HasTheSameBitsOnAnyThreads) {
    const ScanMap map = small_room(0.003);
    const PlanarSurfaces one = surfaces_of(map, test::with_threads(1));
    const PlanarSurfaces many = surfaces_of(map, test::with_threads(3));
    EXPECT_EQ(one.patch_of_point, many.patch_of_point);
    ASSERT_EQ(one.patches.size(), many.patches.size());
    for (std::size_t i = 0; i < one.patches.size(); ++i) {
        EXPECT_EQ(one.patches[i].plane.normal, many.patches[i].plane.normal);
        EXPECT_EQ(one.patches[i].points, many.patches[i].points);
    }
}

TEST(FindPlanarSurfaces, OutlastsNaNDuplicatesAndNextToNothing) {
    ScanMap map = small_room(0.002);
    const std::size_t count = map.cloud.size();
    for (std::size_t i = 0; i < count; i += 2)
        map.cloud.positions.push_back(map.cloud.positions[i]);
    map.cloud.positions[7].setConstant(std::numeric_limits<float>::quiet_NaN());
    map.sections[0].count = static_cast<std::uint32_t>(map.cloud.size());
    const PlanarSurfaces surfaces = surfaces_of(map);
    EXPECT_EQ(surfaces.patches.size(), 4U);
    EXPECT_EQ(surfaces.patch_of_point[7], no_patch);

    Scan few;
    for (int i = 0; i < 10; ++i)
        few.cloud.positions.emplace_back(static_cast<float>(i), 0.0F, 0.0F);
    const PlanarSurfaces none = surfaces_of(map_of_cloud(std::move(few)));
    EXPECT_TRUE(none.patches.empty());
    EXPECT_EQ(none.patch_of_point, std::vector<std::int32_t>(10, no_patch));
}

TEST(FindPlanarSurfaces, DoesNotTakeFoldsForAPlane) {
    Random random(9);
    Scan curtain;
    test::add_rectangle(curtain.cloud, Vector3d::Zero(), 2.0 * x, 2.0 * z, 0.004, 0.001, random,
                        [](double a, double) { return 0.02 * std::sin(40.0 * a); });
    test::add_rectangle(curtain.cloud, Vector3d::Zero(), 4.0 * x, 4.0 * y, 0.01, 0.001, random);
    curtain.cloud.normals.clear();
    const PlanarSurfaces surfaces = surfaces_of(map_of_cloud(std::move(curtain)));
    ASSERT_GE(surfaces.patches.size(), 1U);
    for (std::size_t i = 1; i < surfaces.patches.size(); ++i)
        EXPECT_LT(surfaces.patches[i].area, 0.5);
}

}  // namespace
}  // namespace roomscribe
