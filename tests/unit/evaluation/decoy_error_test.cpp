// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/decoy_error.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "block_scene.hpp"
#include "roomscribe/core/random.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/evaluation/evaluate.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

using test::BlockScene;
using test::prediction_of;
using test::upright_rectangle;

constexpr std::size_t kind_id(DecoyKind kind) {
    return static_cast<std::size_t>(kind);
}

/// A wall along x at y = 0, 6 m wide and 3 m high, of which every 10 cm were seen for x < 4 m; what
/// the result finds there is up to the test.
class Decoys : public testing::Test {
  protected:
    Decoys() {
        add("wall-0", Label::wall, upright_rectangle({0, 0, 0}, 6, 3));
        scene_.truth.scene.components[0].instance = 5;
        for (int i = 0; i < 40; ++i) {
            for (int j = 0; j < 30; ++j)
                add_point({0.05 + 0.1 * i, 0.0, 0.05 + 0.1 * j}, Label::wall, 5);
        }
    }

    Component& add(const std::string& id, Label label, std::vector<Eigen::Vector3d> polygon,
                   const std::string& kind = "") {
        Component& component = scene_.add(id, label);
        component.polygon = std::move(polygon);
        component.kind = kind;
        return component;
    }

    /// A thing on the wall as the simulator gives it: a box, 3 cm thick.
    Component& add_box(const std::string& kind, double x, double z, double width, double height) {
        Component& component = add(kind + "-9", Label::unknown, {}, kind);
        component.box = OrientedBox{};
        component.box->center = {x + width / 2.0, 0.015, z + height / 2.0};
        component.box->size = {width, 0.03, height};
        return component;
    }

    void add_point(const Eigen::Vector3d& position, Label label, std::int32_t instance) {
        scene_.truth.map.cloud.positions.push_back(position.cast<float>());
        scene_.truth.labels.push_back(label);
        scene_.truth.instances.push_back(instance);
        scene_.truth.acceptable.push_back(label_bit(label));
    }

    DecoyError found(const std::vector<std::vector<Eigen::Vector3d>>& windows,
                     const Transform& move = Transform::Identity(),
                     Verdict verdict = Verdict::accepted) const {
        Prediction prediction = prediction_of(scene_.truth);
        prediction.scene->components.clear();
        for (const auto& window : windows) {
            Component component;
            component.id = "window-" + std::to_string(prediction.scene->components.size() + 1);
            component.label = Label::window;
            component.verdict = verdict;
            component.polygon = window;
            prediction.scene->components.push_back(component);
        }
        prediction.scene = transformed_scene(*prediction.scene, move);
        for (auto& pose : prediction.map_from_scan)
            pose = move * *pose;
        return evaluate_decoys(scene_.truth, prediction);
    }

    OpeningGround ground(const std::vector<Eigen::Vector3d>& window) const {
        return found({window}).openings.at(0).ground;
    }

    BlockScene scene_;
};

TEST_F(Decoys, ADecoyIsTakenIfHalfOfItIsCovered) {
    add_box("whiteboard", 1.0, 1.0, 2.0, 1.0);
    const auto taken = [&](double x, double width) {
        const DecoyError error = found({upright_rectangle({x, -0.05, 1.0}, width, 1.0)});
        const DecoyCounts& counts = error.per_kind[kind_id(DecoyKind::board)];
        EXPECT_EQ(counts.there, 1U);
        return counts.taken;
    };
    EXPECT_EQ(taken(1.0, 2.0), 1U);
    EXPECT_EQ(taken(0.0, 2.0), 1U);   // 1 of 2 m
    EXPECT_EQ(taken(-0.1, 2.0), 0U);  // 0.9 of 2 m, of either
    EXPECT_EQ(taken(2.5, 0.9), 1U);   // 0.5 of 2 m, but most of what was found
    EXPECT_EQ(taken(2.6, 0.9), 0U);
    EXPECT_EQ(taken(3.2, 1.0), 0U);
}

TEST_F(Decoys, ADecoyNeedsTheWallsPlane) {
    add_box("picture", 1.0, 1.0, 1.0, 1.0);
    const auto taken = [&](const std::vector<Eigen::Vector3d>& window) {
        return found({window}).per_kind[kind_id(DecoyKind::picture)].taken;
    };
    EXPECT_EQ(taken(upright_rectangle({1, -0.28, 1}, 1, 1)), 1U);
    EXPECT_EQ(taken(upright_rectangle({1, -0.29, 1}, 1, 1)), 0U);
    EXPECT_EQ(taken({{1.5, -0.5, 1}, {1.5, 0.5, 1}, {1.5, 0.5, 2}, {1.5, -0.5, 2}}), 0U);
}

TEST_F(Decoys, KindsHaveTheirRowsAndHiddenDecoysDoNotCount) {
    EXPECT_EQ(decoy_kind_from("notice_board"), DecoyKind::board);
    EXPECT_EQ(decoy_kind_from("tv_screen"), DecoyKind::screen);
    EXPECT_FALSE(decoy_kind_from("office_cupboard"));
    EXPECT_FALSE(decoy_kind_from(""));
    add_box("mirror", 1.0, 1.0, 0.5, 1.0);
    add("niche-1", Label::unknown, upright_rectangle({2, -0.2, 1}, 0.5, 1.0), "niche");
    add_box("picture", 3.0, 1.0, 0.5, 1.0).visible = 0.29;
    add_box("radiator", 4.0, 0.2, 1.0, 0.6);
    const DecoyError error =
        found({upright_rectangle({1, 0, 1}, 0.5, 1.0), upright_rectangle({2, -0.1, 1}, 0.5, 1.0),
               upright_rectangle({3, 0, 1}, 0.5, 1.0)});
    const auto counts = [&](DecoyKind kind) {
        const DecoyCounts& of_kind = error.per_kind[kind_id(kind)];
        return std::pair(of_kind.there, of_kind.taken);
    };
    EXPECT_EQ(counts(DecoyKind::mirror), std::pair(1UL, 1UL));
    EXPECT_EQ(counts(DecoyKind::niche), std::pair(1UL, 1UL));
    EXPECT_EQ(counts(DecoyKind::picture), std::pair(0UL, 0UL));
    EXPECT_EQ(counts(DecoyKind::board), std::pair(0UL, 0UL));
    EXPECT_EQ(error.openings.at(2).ground, OpeningGround::decoy);
    EXPECT_EQ(error.openings[2].true_id, "picture-9");
    EXPECT_EQ(error.per_kind[kind_id(DecoyKind::mirror)].share(), 1.0);
    EXPECT_FALSE(DecoyCounts{}.share());
}

TEST_F(Decoys, WhatLiesOnAnOpeningIsNoDecoy) {
    add_box("picture", 1.0, 1.0, 0.4, 0.4);
    add("window-3", Label::window, upright_rectangle({1.3, -0.1, 1}, 1.0, 1.0));
    const DecoyError error = found({upright_rectangle({1, 0, 1}, 1.3, 1.0)});
    EXPECT_EQ(error.openings.at(0).ground, OpeningGround::opening);
    EXPECT_EQ(error.openings[0].true_id, "window-3");
    EXPECT_EQ(error.per_kind[kind_id(DecoyKind::picture)].taken, 0U);
    add("opening-4", Label::unknown, upright_rectangle({3, -0.1, 0}, 1.0, 2.1), "opening");
    EXPECT_EQ(ground(upright_rectangle({3, 0, 0}, 1.0, 2.0)), OpeningGround::opening);
}

TEST_F(Decoys, HiddenWallIsWhereNoPointsAre) {
    // Seen to x = 4 m: a window of 2 m is hidden if more than half of it lies beyond.
    EXPECT_EQ(ground(upright_rectangle({1, 0, 1}, 2, 1)), OpeningGround::seen_wall);
    EXPECT_EQ(ground(upright_rectangle({3, 0, 1}, 2, 1)), OpeningGround::seen_wall);
    EXPECT_EQ(ground(upright_rectangle({3.4, 0, 1}, 2, 1)), OpeningGround::hidden_wall);
    EXPECT_EQ(ground(upright_rectangle({4, -0.1, 1}, 2, 1)), OpeningGround::hidden_wall);
    // Half of it has no wall behind.
    EXPECT_EQ(ground(upright_rectangle({5.1, 0, 1}, 2, 1)), OpeningGround::elsewhere);
    EXPECT_EQ(ground(upright_rectangle({4.5, 0.5, 1}, 1, 1)), OpeningGround::elsewhere);
}

TEST_F(Decoys, WhatStandsBeforeAWallHidesItAndWhatHangsOnItDoesNot) {
    const std::vector<Eigen::Vector3d> window = upright_rectangle({4.5, 0, 1}, 1, 1);
    for (int i = 0; i < 10; ++i) {
        for (int j = 0; j < 10; ++j) {
            const Eigen::Vector3d place(4.55 + 0.1 * i, 0.05, 1.05 + 0.1 * j);
            add_point(place, Label::furniture, 99);
            add_point(place + Eigen::Vector3d(0, 0.5, 0), Label::unknown, -1);
        }
    }
    EXPECT_EQ(ground(window), OpeningGround::hidden_wall);
    for (int i = 0; i < 10; ++i) {
        for (int j = 0; j < 5; ++j)
            add_point({4.55 + 0.1 * i, 0.05, 1.05 + 0.1 * j}, Label::unknown, -1);
    }
    EXPECT_EQ(ground(window), OpeningGround::seen_wall);
    // The other side of the wall is another wall.
    for (std::size_t i = scene_.truth.labels.size() - 50; i < scene_.truth.labels.size(); ++i) {
        scene_.truth.labels[i] = Label::wall;
        scene_.truth.instances[i] = 6;
    }
    EXPECT_EQ(ground(window), OpeningGround::hidden_wall);
}

TEST_F(Decoys, IsTheSameInAnyFrame) {
    add_box("mirror", 1.0, 1.0, 0.5, 1.0);
    const std::vector<std::vector<Eigen::Vector3d>> windows{upright_rectangle({1, 0, 1}, 0.6, 1.0),
                                                            upright_rectangle({2, 0, 1}, 1, 1.0),
                                                            upright_rectangle({4.5, 0, 1}, 1, 1)};
    Random random(7);
    for (int i = 0; i < 10; ++i) {
        const DecoyError error = found(windows, test::random_transform(random, 20.0));
        EXPECT_EQ(error.openings.at(0).ground, OpeningGround::decoy);
        EXPECT_EQ(error.openings.at(1).ground, OpeningGround::seen_wall);
        EXPECT_EQ(error.openings.at(2).ground, OpeningGround::hidden_wall);
    }
    EXPECT_TRUE(found(windows, Transform::Identity(), Verdict::rejected).openings.empty());
    EXPECT_EQ(found(windows, Transform::Identity(), Verdict::doubtful).openings.size(), 3U);
}

TEST_F(Decoys, IsEvaluatedWhereTruthTellsOfOpenings) {
    const Prediction prediction = prediction_of(scene_.truth);
    EXPECT_TRUE(evaluate_result(scene_.truth, prediction).decoys);
    EXPECT_FALSE(evaluate_result(scene_.truth, prediction, protocol::instance_labels).decoys);
}

}  // namespace
}  // namespace roomscribe
