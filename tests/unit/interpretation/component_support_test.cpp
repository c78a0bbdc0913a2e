// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/component_support.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "support/contexts.hpp"

namespace roomscribe {
namespace {

/// A map of scans, points of which get labels one by one.
struct LabelledMap {
    ScanMap map;
    PointLabels labels;
    std::vector<Component> components;

    void start_scan() {
        map.sections.push_back({"scan", static_cast<std::uint32_t>(labels.labels.size()), 0, {}});
    }
    void add_point(const Eigen::Vector3f& position, Label label, std::int32_t instance) {
        map.cloud.positions.push_back(position);
        labels.labels.push_back(label);
        labels.instances.push_back(instance);
        labels.confidences.push_back(1.0F);
        ++map.sections.back().count;
    }
    Component& add(const std::string& id, Label label, std::int32_t instance,
                   const std::string& parent = "") {
        Component& component = components.emplace_back();
        component.id = id;
        component.label = label;
        component.instance = instance;
        component.parent = parent;
        component.polygon = {{0, 0, 0}, {1, 0, 0}, {1, 0, 2}, {0, 0, 2}};
        component.evidence.points = 999;
        return component;
    }
    void measure(int num_threads = 1) {
        measure_support(map, labels, components, test::with_threads(num_threads));
    }
};

TEST(MeasureSupport, CountsPointsAndTheScansThatTheyAreFrom) {
    LabelledMap scene;
    scene.add("wall-1", Label::wall, 7);
    scene.add("wall-2", Label::wall, 8);
    scene.add("wall-3", Label::wall, 9);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (int scan = 0; scan < 3; ++scan) {
        scene.start_scan();
        for (int i = 0; i < 10; ++i)
            scene.add_point({0.1F * static_cast<float>(i), 0, 0}, Label::wall, 7);
        if (scan == 1) scene.add_point({1, 1, 1}, Label::wall, 8);
        scene.add_point({nan, nan, nan}, Label::unknown, -1);
    }
    scene.measure();
    EXPECT_EQ(scene.components[0].evidence.points, 30U);
    EXPECT_EQ(scene.components[0].evidence.scans, 3U);
    EXPECT_EQ(scene.components[1].evidence.points, 1U);
    EXPECT_EQ(scene.components[1].evidence.scans, 1U);
    EXPECT_EQ(scene.components[2].evidence.points, 0U);
    EXPECT_EQ(scene.components[2].evidence.scans, 0U);
    EXPECT_FALSE(scene.components[0].evidence.rms);
}

TEST(MeasureSupport, APieceHasThePointsOfItsFacesAndHandles) {
    LabelledMap scene;
    scene.add("furniture-1", Label::furniture, 1).polygon.clear();
    scene.add("furniture-2", Label::furniture, 2, "furniture-1");
    scene.add("handle-1", Label::handle, 3, "furniture-2");
    scene.add("door-1", Label::door, 4);
    scene.add("handle-2", Label::handle, 5, "door-1");
    scene.start_scan();
    scene.add_point({0, 0, 0}, Label::furniture, 1);
    scene.start_scan();
    for (const std::int32_t instance : {2, 2, 3, 3, 3, 4, 5})
        scene.add_point({0, 0, 0}, Label::furniture, instance);
    scene.measure();
    EXPECT_EQ(scene.components[0].evidence.points, 6U);
    EXPECT_EQ(scene.components[0].evidence.scans, 2U);
    EXPECT_EQ(scene.components[1].evidence.points, 5U);
    EXPECT_EQ(scene.components[1].evidence.scans, 1U);
    EXPECT_EQ(scene.components[2].evidence.points, 3U);
    EXPECT_EQ(scene.components[3].evidence.points, 1U);
}

TEST(MeasureSupport, EndsWhereParentsGoInCircles) {
    LabelledMap scene;
    scene.add("a", Label::furniture, 1, "b");
    scene.add("b", Label::furniture, 2, "a");
    scene.start_scan();
    scene.add_point({0, 0, 0}, Label::furniture, 1);
    scene.measure();
    EXPECT_EQ(scene.components[0].evidence.points, 1U);
    EXPECT_EQ(scene.components[1].evidence.points, 1U);
}

TEST(MeasureSupport, LeavesHaveTheResidualToTheirOwnPlane) {
    LabelledMap scene;
    scene.add("door-1", Label::door, 1);
    scene.add("door_frame-1", Label::door_frame, 2);
    scene.add("furniture-1", Label::furniture, 3).evidence.rms = 0.5;
    scene.start_scan();
    // A leaf that stands open at 45 degrees, its points 2 mm before and behind its plane by turns.
    const Eigen::Vector3f along = Eigen::Vector3f(1, 1, 0).normalized();
    const Eigen::Vector3f normal = Eigen::Vector3f(1, -1, 0).normalized();
    for (int i = 0; i < 40; ++i) {
        for (int j = 0; j < 40; ++j) {
            const float side = (i + j) % 2 == 0 ? 0.002F : -0.002F;
            const Eigen::Vector3f position =
                0.02F * static_cast<float>(i) * along +
                0.05F * static_cast<float>(j) * Eigen::Vector3f::UnitZ() + side * normal;
            for (const auto& [label, instance] :
                 {std::pair(Label::door, 1), std::pair(Label::door_frame, 2),
                  std::pair(Label::furniture, 3)}) {
                scene.add_point(position, label, instance);
            }
        }
    }
    scene.measure();
    ASSERT_TRUE(scene.components[0].evidence.rms);
    EXPECT_NEAR(*scene.components[0].evidence.rms, 0.002, 1e-4);
    EXPECT_FALSE(scene.components[1].evidence.rms);
    EXPECT_EQ(scene.components[2].evidence.rms, 0.5);  // a rule measured it
}

TEST(MeasureSupport, GivesTheSameBitsOnAnyNumberOfThreads) {
    const auto rms = [](int num_threads) {
        LabelledMap scene;
        scene.add("door-1", Label::door, 1);
        for (int scan = 0; scan < 2; ++scan) {
            scene.start_scan();
            for (int i = 0; i < 200000; ++i) {
                const auto x = static_cast<float>(i % 997) * 0.001F;
                const auto z = static_cast<float>(i % 1009) * 0.002F;
                const auto y = static_cast<float>(i % 13) * 0.0007F;
                scene.add_point({x, y, z}, Label::door, 1);
            }
        }
        scene.measure(num_threads);
        return scene.components[0].evidence.rms.value();
    };
    EXPECT_EQ(rms(1), rms(4));
    EXPECT_GT(rms(1), 0.0);
}

}  // namespace
}  // namespace roomscribe
