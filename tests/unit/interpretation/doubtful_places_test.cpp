// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/doubtful_places.hpp"

#include <gtest/gtest.h>

namespace roomscribe {
namespace {

Scene scene_of(std::initializer_list<Label> labels) {
    Scene scene;
    for (const Label label : labels) {
        Component component;
        component.label = label;
        component.confidence = 0.9;
        component.verdict = Verdict::accepted;
        scene.components.push_back(component);
    }
    scene.rooms.emplace_back();
    return scene;
}

PointLabels one_point(Label label) {
    return {.labels = {label}, .instances = {0}, .confidences = {0.9F}};
}

void expect_doubt(const Scene& scene, const PointLabels& labels) {
    for (const Component& component : scene.components) {
        EXPECT_EQ(component.verdict, Verdict::doubtful);
        EXPECT_LE(component.confidence, 0.5);
        EXPECT_FALSE(component.evidence.alternative.empty());
    }
    EXPECT_LE(labels.confidences[0], 0.5F);
}

TEST(OpenPlaces, ARoomStaysAsItIs) {
    Scene scene = scene_of({Label::wall, Label::floor, Label::furniture});
    PointLabels labels = one_point(Label::wall);
    doubt_open_places(scene, labels);
    for (const Component& component : scene.components)
        EXPECT_EQ(component.verdict, Verdict::accepted);
    EXPECT_EQ(labels.confidences[0], 0.9F);
    EXPECT_EQ(scene.rooms.size(), 1U);
}

TEST(OpenPlaces, FloorWithoutWallIsInDoubtWithWhatStandsOnIt) {
    Scene scene = scene_of({Label::floor, Label::furniture});
    PointLabels labels = one_point(Label::floor);
    doubt_open_places(scene, labels);
    expect_doubt(scene, labels);
    EXPECT_EQ(scene.rooms.size(), 1U);
}

TEST(OpenPlaces, FurnitureWithoutSurfacesIsInDoubtAndInNoRoom) {
    Scene scene = scene_of({Label::furniture});
    PointLabels labels = one_point(Label::furniture);
    doubt_open_places(scene, labels);
    expect_doubt(scene, labels);
    EXPECT_TRUE(scene.rooms.empty());
}

TEST(OpenPlaces, DoubtKeepsItsOwnReason) {
    Scene scene = scene_of({Label::wall});
    scene.components[0].verdict = Verdict::doubtful;
    scene.components[0].evidence.alternative = "a leaning board";
    PointLabels labels = one_point(Label::wall);
    doubt_open_places(scene, labels);
    EXPECT_EQ(scene.components[0].evidence.alternative, "a leaning board");
}

void set_scatter(Scene& scene, double rms) {
    for (Component& component : scene.components) {
        if (component.label == Label::furniture) continue;
        component.evidence.rms = rms;
        component.evidence.points = 100;
    }
}

TEST(BlurredPlaces, ScatterThatHidesABookcasePutsAllInDoubt) {
    Scene scene = scene_of({Label::wall, Label::floor, Label::furniture});
    set_scatter(scene, 0.05);
    PointLabels labels = one_point(Label::wall);
    doubt_blurred_places(scene, labels);
    expect_doubt(scene, labels);
    EXPECT_EQ(scene.rooms.size(), 1U);
}

TEST(BlurredPlaces, ScatterOfAnyScannerLeavesARoomAsItIs) {
    for (const double rms : {0.0, 0.04}) {
        Scene scene = scene_of({Label::wall, Label::floor, Label::furniture});
        if (rms > 0.0) set_scatter(scene, rms);
        PointLabels labels = one_point(Label::wall);
        doubt_blurred_places(scene, labels);
        for (const Component& component : scene.components)
            EXPECT_EQ(component.verdict, Verdict::accepted);
        EXPECT_EQ(labels.confidences[0], 0.9F);
    }
}

}  // namespace
}  // namespace roomscribe
