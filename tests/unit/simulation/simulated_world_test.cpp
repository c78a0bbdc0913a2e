// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/simulated_world.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/random.hpp"
#include "roomscribe/geometry/polygon.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double surface_area(const SimulatedWorld& world) {
    double area = 0.0;
    for (const auto& [a, b, c] : world.triangles) {
        const Vector3d u = (world.vertices[b] - world.vertices[a]).cast<double>();
        const Vector3d v = (world.vertices[c] - world.vertices[a]).cast<double>();
        area += u.cross(v).norm() / 2.0;
    }
    return area;
}

/// A star-shaped polygon with corners at random distances: as concave as they come.
std::vector<Vector2d> random_star(Random& random, int num_corners) {
    std::vector<Vector2d> corners;
    for (int i = 0; i < num_corners; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / num_corners;
        const double radius = random.uniform(0.3, 4.0);
        corners.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    return corners;
}

TEST(SimulatedWorld, PolygonsKeepTheirAreaHoweverConcave) {
    Random random(5);
    for (int i = 0; i < 200; ++i) {
        const std::vector<Vector2d> flat = random_star(random, 4 + i % 12);
        std::vector<Vector3d> corners;
        for (const Vector2d& corner : flat)
            corners.emplace_back(corner.x(), 1.0, corner.y());
        SimulatedWorld world;
        add_polygon(world, add_clutter_part(world, Material::paint), corners);
        EXPECT_EQ(world.triangles.size(), corners.size() - 2);
        EXPECT_NEAR(surface_area(world), std::abs(signed_area(flat)), 1e-4);
    }
}

TEST(SimulatedWorld, RefusesAPolygonThatCrossesItself) {
    SimulatedWorld world;
    const std::uint32_t part = add_clutter_part(world, Material::paint);
    const std::vector<Vector3d> bow_tie{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
    EXPECT_THROW(add_polygon(world, part, bow_tie), InvalidArgument);
}

TEST(SimulatedWorld, SolidsHaveTheirSurface) {
    SimulatedWorld box;
    add_box(box, add_clutter_part(box, Material::wood), Transform::Identity(), {0, 0, 0},
            {1, 2, 3});
    EXPECT_NEAR(surface_area(box), 22.0, 1e-6);

    SimulatedWorld cylinder;
    add_cylinder(cylinder, add_clutter_part(cylinder, Material::metal), {0, 0, 0}, {1, 1, 1}, 0.1,
                 256);
    EXPECT_NEAR(surface_area(cylinder), 2.0 * std::numbers::pi * 0.1 * (std::sqrt(3.0) + 0.1),
                1e-3);

    SimulatedWorld ball;
    add_ellipsoid(ball, add_clutter_part(ball, Material::fabric), Transform::Identity(),
                  Vector3d::Constant(0.5), 128);
    EXPECT_NEAR(surface_area(ball), std::numbers::pi, 5e-3);
}

TEST(SimulatedWorld, NumbersComponentsAndNamesThemByLabelOrKind) {
    SimulatedWorld world;
    Component wall;
    wall.label = Label::wall;
    Component picture;
    picture.kind = "picture";
    EXPECT_EQ(add_component(world, wall), 0);
    EXPECT_EQ(add_component(world, picture), 1);
    EXPECT_EQ(world.scene.components[0].id, "wall-0");
    EXPECT_EQ(world.scene.components[1].id, "picture-1");
    EXPECT_EQ(world.scene.components[1].instance, 1);

    const std::uint32_t part = add_part(world, 0, Material::paint, label_bit(Label::unknown));
    EXPECT_EQ(world.parts[part].label, Label::wall);
    EXPECT_EQ(world.parts[part].acceptable, label_bit(Label::wall) | label_bit(Label::unknown));
}

}  // namespace
}  // namespace roomscribe
