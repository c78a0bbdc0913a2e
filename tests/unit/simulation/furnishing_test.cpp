// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/furnishing/furnishing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/units.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

using Triangle = std::array<Vector3d, 3>;

ItemPlan plan_of(std::string_view kind, std::uint64_t style) {
    ItemPlan item;
    item.kind = kind;
    item.style = style;
    item.at = {1.5, -0.7};
    item.turn = 33.0;
    return item;
}

SimulatedWorld world_of(const ItemPlan& item) {
    SimulatedWorld world;
    add_item(world, item);
    return world;
}

Triangle triangle(const SimulatedWorld& world, std::size_t i) {
    const auto& corners = world.triangles[i];
    return {world.vertices[corners[0]].cast<double>(), world.vertices[corners[1]].cast<double>(),
            world.vertices[corners[2]].cast<double>()};
}

std::vector<Triangle> triangles_of(const SimulatedWorld& world, std::int32_t component) {
    std::vector<Triangle> found;
    for (std::size_t i = 0; i < world.triangles.size(); ++i) {
        if (world.parts[world.part_of_triangle[i]].component == component) {
            found.push_back(triangle(world, i));
        }
    }
    return found;
}

const Component* find_component(const SimulatedWorld& world, const std::string& id) {
    for (const Component& component : world.scene.components) {
        if (component.id == id) return &component;
    }
    return nullptr;
}

/// Unit normal of a polygon, outwards from the piece by the order of its corners.
Vector3d normal_of(const std::vector<Vector3d>& polygon) {
    return (polygon[1] - polygon[0]).cross(polygon[2] - polygon[1]).normalized();
}

/// Distance of a point to a triangle, by its three edges and, if the foot lies inside, its plane.
double distance(const Vector3d& p, const Triangle& t) {
    double nearest = std::numeric_limits<double>::infinity();
    const Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    bool is_inside = true;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vector3d& a = t[i];
        const Vector3d edge = t[(i + 1) % 3] - a;
        const double share = std::clamp((p - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
        nearest = std::min(nearest, (p - a - share * edge).norm());
        if (edge.cross(p - a).dot(normal) < 0.0) is_inside = false;
    }
    return is_inside ? std::min(nearest, std::abs((p - t[0]).dot(normal))) : nearest;
}

void expect_box_holds(const SimulatedWorld& world, const Component& component) {
    SCOPED_TRACE(component.id);
    ASSERT_TRUE(component.box);
    for (const Vector3d& axis : component.box->axes)
        EXPECT_NEAR(axis.norm(), 1.0, 1e-9);
    double largest_gap = 0.0;
    for (const Triangle& t : triangles_of(world, component.instance)) {
        for (const Vector3d& corner : t) {
            for (int i = 0; i < 3; ++i) {
                const auto axis = static_cast<std::size_t>(i);
                const double out =
                    std::abs((corner - component.box->center).dot(component.box->axes[axis])) -
                    component.box->size[i] / 2.0;
                largest_gap = std::max(largest_gap, out);
            }
        }
    }
    EXPECT_LT(largest_gap, 0.001);
}

void expect_face_on_surface(const SimulatedWorld& world, const Component& face) {
    SCOPED_TRACE(face.id);
    ASSERT_GE(face.polygon.size(), 4U);
    EXPECT_TRUE(face.kind == "top" || face.polygon.size() == 4);
    EXPECT_NE(find_component(world, face.parent), nullptr);
    const Vector3d normal = normal_of(face.polygon);
    const std::vector<Triangle> surface = triangles_of(world, face.instance);
    ASSERT_FALSE(surface.empty());
    for (const Vector3d& corner : face.polygon) {
        EXPECT_NEAR((corner - face.polygon[0]).dot(normal), 0.0, 1e-6);
        double nearest = std::numeric_limits<double>::infinity();
        for (const Triangle& t : surface)
            nearest = std::min(nearest, distance(corner, t));
        EXPECT_LT(nearest, 1e-5);
    }
}

void expect_handle_before_face(const SimulatedWorld& world, const Component& handle) {
    SCOPED_TRACE(handle.id);
    EXPECT_THAT(handle.kind, testing::AnyOf("bar_handle", "knob", "lever_handle"));
    const Component* face = find_component(world, handle.parent);
    ASSERT_NE(face, nullptr);
    ASSERT_EQ(face->polygon.size(), 4U);
    const Vector3d normal = normal_of(face->polygon);
    const auto height = [&](const Vector3d& point) {
        return (point - face->polygon[0]).dot(normal);
    };
    // From the face to the stand-off: 20 to 60 mm.
    const OrientedBox& box = *handle.box;
    double reach = 0.0;
    for (int i = 0; i < 3; ++i)
        reach += std::abs(box.axes[static_cast<std::size_t>(i)].dot(normal)) * box.size[i] / 2.0;
    EXPECT_NEAR(height(box.center) - reach, 0.0, 1e-6);
    EXPECT_GT(height(box.center) + reach, 0.0199);
    EXPECT_LT(height(box.center) + reach, 0.06);
    // Within the outline of the face.
    for (std::size_t i = 0; i < 4; ++i) {
        const Vector3d edge = face->polygon[(i + 1) % 4] - face->polygon[i];
        EXPECT_GT(edge.cross(box.center - face->polygon[i]).dot(normal), 0.0);
    }
    ASSERT_TRUE(handle.grasp);
    EXPECT_GT(height(handle.grasp->position), 0.009);
    EXPECT_NEAR(handle.grasp->approach.dot(normal), -1.0, 1e-9);
    EXPECT_NEAR(handle.grasp->axis.dot(normal), 0.0, 1e-9);
    EXPECT_GE(handle.grasp->opening, 0.006);
    EXPECT_LE(handle.grasp->opening, 0.036);
    EXPECT_FALSE(triangles_of(world, handle.instance).empty());
}

TEST(AddItem, GivesEveryKindTrianglesAndWellFormedTruth) {
    for (const std::string_view kind : item_kinds()) {
        for (std::uint64_t style = 0; style < 12; ++style) {
            SCOPED_TRACE(fmt::format("{} of style {}", kind, style));
            const SimulatedWorld world = world_of(plan_of(kind, style));
            ASSERT_FALSE(world.triangles.empty());
            ASSERT_EQ(world.part_of_triangle.size(), world.triangles.size());
            for (const Eigen::Vector3f& vertex : world.vertices)
                ASSERT_TRUE(vertex.allFinite());
            for (const Component& component : world.scene.components) {
                if (component.box) expect_box_holds(world, component);
                if (!component.polygon.empty()) expect_face_on_surface(world, component);
                if (component.label == Label::handle) expect_handle_before_face(world, component);
                EXPECT_TRUE(component.box || !component.polygon.empty());
                EXPECT_TRUE(component.parent.empty() || find_component(world, component.parent));
            }
        }
    }
}

TEST(AddItem, MakesFurnitureOnePieceWithFacesAndHandles) {
    std::map<std::string, int> kinds;
    int num_pieces = 0;
    for (std::uint64_t style = 0; style < 20; ++style) {
        for (const Component& component :
             world_of(plan_of("kitchen_base", style)).scene.components) {
            if (component.label == Label::furniture && component.parent.empty()) ++num_pieces;
            ++kinds[component.kind];
        }
    }
    EXPECT_EQ(num_pieces, 20);
    EXPECT_EQ(kinds["top"], 20);
    EXPECT_GT(kinds["door"], 20);
    EXPECT_GT(kinds["drawer"], 20);
    EXPECT_GT(kinds["bar_handle"], 20);
    EXPECT_GT(kinds["knob"], 0);
}

TEST(AddItem, LeavesAGapOf3To5MillimetresBetweenFronts) {
    for (std::uint64_t style = 0; style < 30; ++style) {
        ItemPlan item = plan_of("wall_unit", style);
        item.at.setZero();
        item.turn = 0.0;
        const SimulatedWorld world = world_of(item);
        std::vector<Eigen::AlignedBox3d> fronts;
        double plane = -1.0;
        for (const Component& component : world.scene.components) {
            if (component.kind != "door") continue;
            Eigen::AlignedBox3d extent;
            for (const Vector3d& corner : component.polygon)
                extent.extend(corner);
            if (extent.sizes().x() > 1e-6) continue;  // stands open
            plane = extent.min().x();
            fronts.push_back(extent);
        }
        std::sort(fronts.begin(), fronts.end(),
                  [](const auto& a, const auto& b) { return a.min().y() < b.min().y(); });
        for (std::size_t i = 1; i < fronts.size(); ++i) {
            EXPECT_NEAR(fronts[i].min().x(), plane, 1e-9);
            const double gap = fronts[i].min().y() - fronts[i - 1].max().y();
            if (gap > 0.25) continue;  // an open door was between the two
            EXPECT_GE(gap, 0.003 - 1e-6);
            EXPECT_LE(gap, 0.005 + 1e-6);
        }
    }
}

TEST(AddItem, OpensOneDoorInTen) {
    int num_open = 0;
    int num_doors = 0;
    for (std::uint64_t style = 0; style < 200; ++style) {
        ItemPlan item = plan_of("wardrobe", style);
        item.turn = 0.0;
        for (const Component& component : world_of(item).scene.components) {
            if (component.kind != "door") continue;
            ++num_doors;
            if (normal_of(component.polygon).x() < 0.9999) ++num_open;
        }
    }
    EXPECT_GT(num_doors, 400);
    EXPECT_NEAR(static_cast<double>(num_open) / num_doors, 0.1, 0.03);
}

TEST(AddItem, KeepsTheSizesThatAreGiven) {
    ItemPlan item = plan_of("table", 4);
    item.size = {0.8, 1.6, 0.75};
    const SimulatedWorld world = world_of(item);
    const OrientedBox& box = *world.scene.components[0].box;
    EXPECT_TRUE(box.size.isApprox(item.size, 1e-5));
    EXPECT_NEAR(box.axes[0].dot(Vector3d(std::cos(radians(33.0)), std::sin(radians(33.0)), 0.0)),
                1.0, 1e-9);
    EXPECT_TRUE(box.center.isApprox(Vector3d(1.5, -0.7, 0.375), 1e-5));
}

TEST(AddItem, GivesBuildingPartsTheLabelsThatAreRightForThem) {
    const auto acceptable = [](std::string_view kind) {
        const SimulatedWorld world = world_of(plan_of(kind, 1));
        EXPECT_EQ(world.parts[0].label, Label::unknown);
        return world.parts[0].acceptable;
    };
    const LabelSet unknown = label_bit(Label::unknown);
    EXPECT_EQ(acceptable("picture"), unknown);
    EXPECT_EQ(acceptable("radiator"), unknown);
    EXPECT_EQ(acceptable("column"), unknown | label_bit(Label::wall));
    EXPECT_EQ(acceptable("beam"), unknown | label_bit(Label::wall) | label_bit(Label::ceiling));
    EXPECT_EQ(acceptable("soffit"), unknown | label_bit(Label::ceiling));
}

TEST(AddItem, LeavesClutterWithoutComponent) {
    for (const std::string_view kind : {"box", "bag", "papers", "monitor", "kettle"}) {
        const SimulatedWorld world = world_of(plan_of(kind, 3));
        EXPECT_TRUE(world.scene.components.empty()) << kind;
        EXPECT_EQ(world.parts.at(0).component, -1) << kind;
    }
}

TEST(AddItem, IsTheSameForAStyle) {
    for (const std::string_view kind : item_kinds()) {
        const SimulatedWorld a = world_of(plan_of(kind, 7));
        const SimulatedWorld b = world_of(plan_of(kind, 7));
        EXPECT_EQ(a.vertices, b.vertices) << kind;
        EXPECT_EQ(a.triangles, b.triangles) << kind;
    }
    EXPECT_NE(world_of(plan_of("cabinet", 7)).vertices, world_of(plan_of("cabinet", 8)).vertices);
}

TEST(AddItem, RefusesWhatItCannotBuild) {
    EXPECT_THROW(world_of(plan_of("grand_piano", 1)), InvalidArgument);
    ItemPlan item = plan_of("table", 1);
    item.size.y() = -1.0;
    EXPECT_THROW(world_of(item), InvalidArgument);
    item = plan_of("table", 1);
    item.turn = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(world_of(item), InvalidArgument);
}

}  // namespace
}  // namespace roomscribe
