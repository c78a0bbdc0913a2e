// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/plane_error.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/units.hpp"

namespace roomscribe {
namespace {

/// 1000 points on the floor z = 0, 1000 on the wall x = 0, 100 nowhere.
struct FloorAndWall {
    std::vector<Eigen::Vector3f> positions;
    SurfaceTruth truth;

    FloorAndWall() {
        truth.surfaces = {{Plane{Eigen::Vector3d::UnitZ(), 0.0}, 4.0, {}},
                          {Plane{Eigen::Vector3d::UnitX(), 0.0}, 4.0, {}}};
        for (int i = 0; i < 2100; ++i) {
            const auto along = static_cast<float>(i % 40) / 20.0F;
            const auto across = static_cast<float>(i % 37) / 18.0F;
            positions.push_back(i < 1000 ? Eigen::Vector3f(along, across, 0.0F)
                                         : Eigen::Vector3f(0.0F, along, across));
            truth.surface_of_point.push_back(i < 1000 ? 0 : (i < 2000 ? 1 : -1));
        }
    }
};

TEST(EvaluatePlanes, MeasuresRecallPrecisionAndErrors) {
    const FloorAndWall scene;
    const double tilt = radians(1.0);
    const std::vector<FoundPlane> planes{
        {Plane{Eigen::Vector3d(std::sin(tilt), 0.0, std::cos(tilt)), 0.0}, 4.0}};
    // The plane holds 900 points of the floor and 100 of the wall.
    std::vector<std::int32_t> plane_of_point(scene.positions.size(), -1);
    for (std::size_t i = 0; i < 900; ++i)
        plane_of_point[i] = 0;
    for (std::size_t i = 1000; i < 1100; ++i)
        plane_of_point[i] = 0;
    const PlaneError error = evaluate_planes(scene.truth, scene.positions, planes, plane_of_point);
    ASSERT_EQ(error.surfaces.size(), 2U);
    EXPECT_EQ(error.num_missed, 1U);
    EXPECT_TRUE(error.false_planes.empty());
    EXPECT_EQ(error.surfaces[0].points, 1000U);
    EXPECT_DOUBLE_EQ(error.surfaces[0].recall, 0.9);
    EXPECT_DOUBLE_EQ(error.surfaces[0].precision, 0.9);
    EXPECT_NEAR(error.surfaces[0].normal_error, tilt, 1e-9);
    EXPECT_TRUE(error.surfaces[1].planes.empty());
}

TEST(EvaluatePlanes, NamesPlanesOfNothing) {
    const FloorAndWall scene;
    const std::vector<FoundPlane> planes{{Plane{}, 4.0}, {Plane{}, 0.01}};
    std::vector<std::int32_t> plane_of_point(scene.positions.size(), -1);
    for (std::size_t i = 0; i < 2000; i += 2)
        plane_of_point[i] = 0;
    const PlaneError error = evaluate_planes(scene.truth, scene.positions, planes, plane_of_point);
    EXPECT_EQ(error.false_planes, std::vector<std::uint32_t>{0});
    EXPECT_EQ(error.num_missed, 2U);
}

TEST(EvaluatePlanes, LeavesOutWhatIsTooSmall) {
    FloorAndWall scene;
    scene.truth.surfaces[1].area = 0.05;
    const PlaneError error = evaluate_planes(scene.truth, scene.positions, {},
                                             std::vector<std::int32_t>(scene.positions.size(), -1),
                                             {.min_points = 1000});
    ASSERT_EQ(error.surfaces.size(), 1U);
    EXPECT_EQ(error.surfaces[0].surface, 0U);
}

TEST(EvaluatePlanes, WantsOneNumberPerPoint) {
    const FloorAndWall scene;
    EXPECT_THROW(evaluate_planes(scene.truth, scene.positions, {}, {}), InvalidArgument);
}

}  // namespace
}  // namespace roomscribe
