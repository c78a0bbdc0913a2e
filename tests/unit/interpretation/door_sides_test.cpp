// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/openings/door_sides.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"

namespace roomscribe {
namespace {

constexpr double noise = 0.01;
/// m. Edges are read off to a bin, and half a bin of what lies in it.
constexpr double one_bin = 0.0151;

/// Points beside the edge of a door, 40 to a centimetre.
class Edge {
  public:
    Edge& add(double from, double to, double depth) {
        const auto count = static_cast<std::size_t>((to - from) * 4000.0);
        for (std::size_t i = 0; i < count; ++i) {
            points_.push_back({static_cast<float>(random_.uniform(from, to)),
                               static_cast<float>(depth + noise * random_.normal())});
        }
        return *this;
    }
    std::optional<DoorSide> read(std::optional<double> leaf_depth) const {
        return read_door_side(points_, leaf_depth, noise);
    }

  private:
    Random random_{3};
    std::vector<EdgePoint> points_;
};

class DoorEdgeAt : public ::testing::TestWithParam<double> {};

TEST_P(DoorEdgeAt, LeafCasingAndWallAreToldBelowTheNoise) {
    const double edge = GetParam();
    const auto side = Edge()
                          .add(-0.3, edge, 0.005)
                          .add(edge, edge + 0.07, -0.012)
                          .add(edge + 0.07, 0.5, 0.0)
                          .read(0.005);
    ASSERT_TRUE(side && side->outer);
    EXPECT_NEAR(side->inner, edge, one_bin);
    EXPECT_NEAR(*side->outer, edge + 0.07, one_bin);
}

TEST_P(DoorEdgeAt, ALeafBehindItsWallHasNoCasing) {
    const double edge = GetParam();
    const auto side = Edge().add(-0.3, edge, 0.05).add(edge, 0.5, 0.0).read(0.05);
    ASSERT_TRUE(side);
    EXPECT_NEAR(side->inner, edge, one_bin);
    EXPECT_FALSE(side->outer);
}

TEST_P(DoorEdgeAt, AnOpenDoorEndsWhereNextToNothingIsSeen) {
    const double edge = std::clamp(GetParam(), -0.03, 0.03);
    const auto side =
        Edge().add(edge, edge + 0.06, -0.015).add(edge + 0.06, 0.5, 0.0).read(std::nullopt);
    ASSERT_TRUE(side && side->outer);
    EXPECT_NEAR(side->inner, edge, one_bin);
    EXPECT_NEAR(*side->outer, edge + 0.06, one_bin);
}
INSTANTIATE_TEST_SUITE_P(Edges, DoorEdgeAt, ::testing::Values(-0.06, 0.0, 0.023, 0.1));

TEST(ReadDoorSide, AFrameInThePlaneOfItsWallShowsNothing) {
    EXPECT_FALSE(Edge().add(-0.3, 0.5, 0.0).read(0.0));
}

TEST(ReadDoorSide, TheLiningIsNoCasing) {
    const auto side =
        Edge().add(-0.3, 0.0, 0.05).add(0.0, 0.05, 0.025).add(0.05, 0.5, 0.0).read(0.05);
    EXPECT_FALSE(side && side->outer);
}

TEST(ReadDoorSide, WhatIsNarrowerThanTheHoleSeenThroughIsALeafAjar) {
    EXPECT_FALSE(Edge().add(-0.12, 0.06, -0.015).add(0.06, 0.5, 0.0).read(std::nullopt));
}

TEST(ReadDoorSide, NoPointsAreNoSide) {
    EXPECT_FALSE(read_door_side({}, std::nullopt, noise));
    EXPECT_FALSE(read_door_side({}, 0.02, noise));
}

}  // namespace
}  // namespace roomscribe
