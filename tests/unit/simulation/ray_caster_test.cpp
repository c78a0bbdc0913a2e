// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/scanning/ray_caster.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "roomscribe/simulation/scanning/light_path.hpp"
#include "roomscribe/simulation/scanning/surface_response.hpp"
#include "simple_worlds.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

TEST(RayCaster, FindsDistancePartAndAngle) {
    SimulatedWorld world;
    add_clutter_part(world, Material::paint);
    const std::uint32_t screen = test::add_screen(world, 3.0, Material::paint);
    const RayCaster caster(world);
    const Vector3d direction = Vector3d(1.0, 1.0, 0.0).normalized();
    const auto hit = caster.cast(Vector3d::Zero(), direction);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->distance, 3.0 * std::sqrt(2.0), 1e-6);
    EXPECT_EQ(hit->part, screen);
    EXPECT_NEAR(hit->cosine, std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(hit->normal.x(), -1.0, 1e-6);
}

TEST(RayCaster, FacesTheRayFromEitherSide) {
    SimulatedWorld world;
    test::add_screen(world, 3.0, Material::paint);
    const RayCaster caster(world);
    const auto hit = caster.cast(Vector3d(5.0, 0.0, 0.0), -Vector3d::UnitX());
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->normal.x(), 1.0, 1e-6);
    EXPECT_NEAR(hit->cosine, 1.0, 1e-6);
}

TEST(RayCaster, MissesWhatIsBehindBesideOrTooNear) {
    SimulatedWorld world;
    test::add_screen(world, 3.0, Material::paint, 1.0);
    const RayCaster caster(world);
    EXPECT_FALSE(caster.cast(Vector3d::Zero(), -Vector3d::UnitX()));
    EXPECT_FALSE(caster.cast(Vector3d(0.0, 1.001, 0.0), Vector3d::UnitX()));
    EXPECT_TRUE(caster.cast(Vector3d(0.0, 0.999, 0.0), Vector3d::UnitX()));
    EXPECT_FALSE(caster.cast(Vector3d::Zero(), Vector3d::UnitX(), 3.001));
}

TEST(RayCaster, HitsNothingInAnEmptyWorld) {
    const SimulatedWorld world;
    EXPECT_FALSE(RayCaster(world).cast(Vector3d::Zero(), Vector3d::UnitX()));
}

TEST(RayCaster, LooksPastIgnoredPartsAlsoWhereTheyCoincide) {
    SimulatedWorld world;
    const std::uint32_t near = test::add_screen(world, 2.0, Material::paint);
    const std::uint32_t a = test::add_screen(world, 3.0, Material::paint);
    const std::uint32_t b = test::add_screen(world, 3.0, Material::paint);
    const RayCaster caster(world);
    const auto past = [&](std::uint32_t other) {
        return caster.cast_past([&](std::uint32_t part) { return part == near || part == other; },
                                Vector3d::Zero(), Vector3d::UnitX());
    };
    ASSERT_TRUE(past(a));
    EXPECT_EQ(past(a)->part, b);
    ASSERT_TRUE(past(b));
    EXPECT_EQ(past(b)->part, a);
}

TEST(LightPath, MirrorShowsTheFullWay) {
    SimulatedWorld world;
    add_quad(world, add_clutter_part(world, Material::mirror), {2, -9, -9}, {2, 9, -9}, {2, 9, 9},
             {2, -9, 9});
    const std::uint32_t behind = test::add_screen(world, -1.0, Material::paint);
    const RayCaster caster(world);
    Random random(1);
    const Echo echo = trace_ray(caster, Vector3d::Zero(), Vector3d::UnitX(), random);
    EXPECT_NEAR(echo.range, 2.0 + 3.0, 1e-5);
    EXPECT_EQ(echo.part, behind);
    EXPECT_TRUE(echo.is_ghost);
}

TEST(LightPath, EndsBetweenTwoMirrors) {
    SimulatedWorld world;
    const std::uint32_t mirror = add_clutter_part(world, Material::mirror);
    add_quad(world, mirror, {2, -9, -9}, {2, 9, -9}, {2, 9, 9}, {2, -9, 9});
    add_quad(world, mirror, {-2, -9, -9}, {-2, 9, -9}, {-2, 9, 9}, {-2, -9, 9});
    const RayCaster caster(world);
    Random random(1);
    EXPECT_FALSE(trace_ray(caster, Vector3d::Zero(), Vector3d::UnitX(), random));
}

TEST(SurfaceResponse, IsLambertianWhenMatt) {
    const SurfaceResponse& paint = surface_response(Material::paint);
    EXPECT_NEAR(echo_strength(paint, 0.5), 0.5 * echo_strength(paint, 1.0), 1e-12);
    EXPECT_EQ(glare_loss(paint, 0.3), 0.0);
}

TEST(SurfaceResponse, ShinySurfacesAreSeenSquarelyOnly) {
    const SurfaceResponse& chrome = surface_response(Material::chrome);
    EXPECT_EQ(glare_loss(chrome, 1.0), 0.0);
    EXPECT_GT(glare_loss(chrome, 0.8), 0.7);
    EXPECT_GT(echo_strength(chrome, 1.0), 20.0 * echo_strength(chrome, 0.8));
}

TEST(SurfaceResponse, PanesReturnMoreWhenHitSquarely) {
    const PaneShares square = pane_shares(0.9, 1.0);
    EXPECT_NEAR(square.passed, 0.9, 1e-12);
    EXPECT_GT(square.returned, 4.0 * pane_shares(0.9, 0.7).returned);
    EXPECT_LT(pane_shares(0.9, 0.1).passed, 0.5);
    for (const double cosine : {0.0, 0.2, 0.6, 1.0}) {
        const PaneShares shares = pane_shares(0.9, cosine);
        EXPECT_LE(shares.passed + shares.returned, 1.0);
    }
}

}  // namespace
}  // namespace roomscribe
