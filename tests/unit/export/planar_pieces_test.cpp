// SPDX-License-Identifier: MIT
#include "roomscribe/export/planar_pieces.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "roomscribe/geometry/polygon.hpp"

namespace roomscribe {
namespace {

const PlanePolygon l_shape{{0, 0}, {4, 0}, {4, 1}, {2, 1}, {2, 3}, {0, 3}};

TEST(ConvexPieces, KeepAConvexPolygonWholeAndCoverOthersOnce) {
    const PlanePolygon square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    EXPECT_EQ(convex_pieces(square), std::vector<PlanePolygon>{square});
    const auto pieces = convex_pieces(l_shape);
    EXPECT_GT(pieces.size(), 1U);
    EXPECT_NEAR(total_area(pieces), 4 + 4, 1e-12);
    PlanePolygon clockwise(l_shape.rbegin(), l_shape.rend());
    EXPECT_NEAR(total_area(convex_pieces(clockwise)), 8, 1e-12);
    for (const PlanePolygon& piece : pieces)
        EXPECT_GT(signed_area(piece), 0.0);
}

TEST(ConvexPieces, AreNoneWhereNoAreaIsEnclosed) {
    EXPECT_TRUE(convex_pieces(PlanePolygon{}).empty());
    EXPECT_TRUE(convex_pieces(PlanePolygon{{0, 0}, {1, 1}}).empty());
    EXPECT_TRUE(convex_pieces(PlanePolygon{{0, 0}, {1, 1}, {2, 2}}).empty());
}

RC_GTEST_PROP(ConvexPieces, CoverAnyStar, ()) {
    const auto corners = *rc::gen::inRange(3, 30);
    PlanePolygon star;
    for (int i = 0; i < corners; ++i) {
        const double radius = *rc::gen::inRange(100, 1000) / 100.0;
        const double angle = 2.0 * std::numbers::pi * i / corners;
        star.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    RC_ASSERT(std::abs(total_area(convex_pieces(star)) - signed_area(star)) < 1e-9);
}

TEST(WithoutRectangles, CutsHolesAndNotches) {
    const PlanePolygon wall{{0, 0}, {5, 0}, {5, 2.5}, {0, 2.5}};
    const PlaneRectangle door{{1, 0}, {1.9, 2.05}};
    const PlaneRectangle window{{3, 0.9}, {4.2, 2}};
    const auto left = without_rectangles({wall}, std::vector{door, window});
    EXPECT_NEAR(total_area(left), 12.5 - 0.9 * 2.05 - 1.2 * 1.1, 1e-12);
    for (const PlanePolygon& piece : left) {
        Eigen::Vector2d middle = Eigen::Vector2d::Zero();
        for (const Eigen::Vector2d& corner : piece)
            middle += corner / static_cast<double>(piece.size());
        for (const PlaneRectangle& hole : {door, window}) {
            EXPECT_FALSE((middle.array() > hole.low.array()).all() &&
                         (middle.array() < hole.high.array()).all());
        }
    }
}

TEST(WithoutRectangles, CountsWhatHolesShareOnceAndIgnoresWhatLiesOutside) {
    const PlanePolygon square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const PlaneRectangle twice{{0.2, 0.2}, {0.6, 0.6}};
    const PlaneRectangle beyond{{0.9, -3}, {4, 4}};
    const PlaneRectangle apart{{2, 2}, {3, 3}};
    const auto left = without_rectangles({square}, std::vector{twice, twice, beyond, apart});
    EXPECT_NEAR(total_area(left), 1 - 0.16 - 0.1, 1e-12);
    const PlaneRectangle all{{-1, -1}, {2, 2}};
    EXPECT_TRUE(without_rectangles({square}, std::vector{all}).empty());
}

}  // namespace
}  // namespace roomscribe
