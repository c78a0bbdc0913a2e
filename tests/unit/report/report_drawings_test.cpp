// SPDX-License-Identifier: MIT
#include "roomscribe/report/report_drawings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/flat_of_two_rooms.hpp"

namespace roomscribe {
namespace {

using testing::HasSubstr;
using testing::Not;

std::size_t count_of(const std::string& text, std::string_view part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++count;
    return count;
}

TEST(WallElevations, ShowEveryWallWithItsOpeningsAndTheirSizes) {
    const Scene scene = test::flat_of_two_rooms();
    const std::string html = wall_elevations(scene);
    std::size_t num_walls = 0;
    for (const Component& component : scene.components) {
        if (component.label != Label::wall) continue;
        ++num_walls;
        EXPECT_THAT(html, HasSubstr("<strong>" + component.id + "</strong>"));
    }
    EXPECT_EQ(count_of(html, "<svg class=\"elevation\""), num_walls);
    // A door between two rooms is in a wall of each.
    EXPECT_EQ(count_of(html, ">door-1</text>"), 2U);
    EXPECT_THAT(html, HasSubstr(">2.50</text>"));
    // Leaf and glass within their frames, with their own sizes.
    EXPECT_EQ(count_of(html, "class=\"opening label-door_frame\""), 2U);
    EXPECT_EQ(count_of(html, ">0.80 \u00d7 2.00</text>"), 2U);
    EXPECT_EQ(count_of(html, ">1.20 \u00d7 1.00</text>"), 1U);
}

TEST(WallElevations, NameNarrowOpeningsUpwards) {
    Scene scene = test::flat_of_two_rooms();
    EXPECT_EQ(count_of(wall_elevations(scene), "rotate(-90"), 0U);
    // At 1:100 a door is narrower than its name.
    for (Component& component : scene.components) {
        if (component.id != "wall-1") continue;
        component.polygon[1] += 6.0 * (component.polygon[1] - component.polygon[0]).normalized();
        component.polygon[2] += 6.0 * (component.polygon[2] - component.polygon[3]).normalized();
    }
    const std::string html = wall_elevations(scene);
    EXPECT_THAT(html, HasSubstr("1:100 on paper"));
    EXPECT_GE(count_of(html, "rotate(-90"), 2U);
}

TEST(WallElevations, AreOfOneScaleThatFitsAPage) {
    Scene scene = test::flat_of_two_rooms();
    EXPECT_THAT(wall_elevations(scene), HasSubstr("1:50 on paper"));
    for (Component& component : scene.components)
        for (Eigen::Vector3d& corner : component.polygon)
            corner.head<2>() *= 4.0;
    EXPECT_THAT(wall_elevations(scene), Not(HasSubstr("1:50 on paper")));
}

TEST(ReportDrawings, AreLeftOutWhereThereIsNothing) {
    EXPECT_EQ(wall_elevations({}), "");
    EXPECT_EQ(floor_plan_drawing({}), "");
    EXPECT_THAT(floor_plan_drawing(test::flat_of_two_rooms()), HasSubstr("image/svg+xml"));
    Scene rejected = test::flat_of_two_rooms();
    for (Component& component : rejected.components)
        component.verdict = Verdict::rejected;
    EXPECT_EQ(wall_elevations(rejected), "");
}

}  // namespace
}  // namespace roomscribe
