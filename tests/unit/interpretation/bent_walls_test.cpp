// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/bent_walls.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace roomscribe {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr float spacing = 0.04F;

/// A wall in the plane x = 0 up to y = 2 m, which bends out of it to x = `bend` at y = 4 m; on its
/// plane part a picture 3 cm thick. One point a voxel; labelled up to y = 2 m.
struct BentWall {
    SurfaceSample sample;
    RoomSurfaces surfaces;
    PointLabels labels;

    explicit BentWall(float bend) {
        sample.spacing = static_cast<double>(spacing);
        sample.voxel_size = sample.spacing;
        sample.noise = 0.004;
        sample.tolerance = 0.03;
        RoomSurface wall;
        wall.component.label = Label::wall;
        wall.component.instance = 0;
        wall.component.confidence = 0.8;
        wall.plane = {Vector3d::UnitX(), 0.0};
        surfaces.surfaces.push_back(wall);
        for (float y = 0.0F; y < 4.0F; y += spacing) {
            for (float z = 0.0F; z < 2.5F; z += spacing) {
                const float part = std::max(0.0F, y - 2.0F) / 2.0F;
                const bool is_picture = y > 0.5F && y < 1.0F && z > 1.0F && z < 1.6F;
                const float x = is_picture ? 0.03F : bend * part * part;
                add(Vector3f(x, y, z), y < 2.0F && !is_picture);
            }
        }
    }

    void add(const Vector3f& position, bool is_wall) {
        sample.voxel_of_point.push_back(static_cast<std::uint32_t>(sample.cloud.size()));
        sample.cloud.positions.push_back(position);
        const float part = std::max(0.0F, position.y() - 2.0F) / 2.0F;
        sample.cloud.normals.push_back(Vector3f(1.0F, -part * position.x(), 0.0F).normalized());
        labels.labels.push_back(is_wall ? Label::wall : Label::unknown);
        labels.instances.push_back(is_wall ? 0 : -1);
        labels.confidences.push_back(is_wall ? 0.8F : 0.0F);
    }
    void go_on() { continue_bent_walls(sample, surfaces, labels); }
    Label label_near(const Vector3f& place) const {
        const auto& positions = sample.cloud.positions;
        const auto nearest =
            std::min_element(positions.begin(), positions.end(), [&](const auto& a, const auto& b) {
                return (a - place).squaredNorm() < (b - place).squaredNorm();
            });
        return labels.labels[static_cast<std::size_t>(nearest - positions.begin())];
    }
};

TEST(BentWalls, GoOnBesideTheirPlane) {
    BentWall wall(0.08F);
    wall.go_on();
    EXPECT_EQ(wall.label_near({0.02F, 3.0F, 1.2F}), Label::wall);
    EXPECT_EQ(wall.label_near({0.08F, 3.9F, 1.2F}), Label::wall);
    EXPECT_EQ(wall.labels.instances.back(), 0);
    EXPECT_FLOAT_EQ(wall.labels.confidences.back(), 0.4F);
}

TEST(BentWalls, CeilingsGoOnAndFloorsDoNot) {
    for (const Label label : {Label::ceiling, Label::floor}) {
        BentWall wall(0.08F);
        wall.surfaces.surfaces[0].component.label = label;
        std::replace(wall.labels.labels.begin(), wall.labels.labels.end(), Label::wall, label);
        wall.go_on();
        EXPECT_EQ(wall.label_near({0.08F, 3.9F, 1.2F}),
                  label == Label::ceiling ? label : Label::unknown);
    }
}

TEST(BentWalls, DoNotGoOnToWhatWasFoundToHang) {
    BentWall wall(0.08F);
    wall.surfaces.is_hung.assign(wall.sample.cloud.size(), false);
    wall.surfaces.is_hung.back() = true;
    wall.go_on();
    EXPECT_EQ(wall.labels.labels.back(), Label::unknown);
}

TEST(BentWalls, DoNotGoOntoWhatHangsOnThem) {
    BentWall wall(0.08F);
    wall.go_on();
    EXPECT_EQ(wall.label_near({0.03F, 0.75F, 1.3F}), Label::unknown);
}

TEST(BentWalls, EndThreeTolerancesFromTheirPlane) {
    BentWall wall(0.15F);
    wall.go_on();
    EXPECT_EQ(wall.label_near({0.04F, 3.0F, 1.2F}), Label::wall);
    EXPECT_EQ(wall.label_near({0.14F, 3.9F, 1.2F}), Label::unknown);
}

TEST(BentWalls, TakeNothingThatHasALabel) {
    BentWall wall(0.08F);
    const std::size_t last = wall.labels.labels.size() - 1;
    wall.labels.labels[last] = Label::furniture;
    wall.labels.instances[last] = 7;
    wall.go_on();
    EXPECT_EQ(wall.labels.labels[last], Label::furniture);
    EXPECT_EQ(wall.labels.instances[last], 7);
}

TEST(BentWalls, NeedAWall) {
    BentWall wall(0.08F);
    wall.surfaces.surfaces.clear();
    const PointLabels before = wall.labels;
    wall.go_on();
    EXPECT_EQ(wall.labels.labels, before.labels);
}

}  // namespace
}  // namespace roomscribe
