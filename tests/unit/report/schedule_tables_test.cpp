// SPDX-License-Identifier: MIT
#include "roomscribe/report/schedule_tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/flat_of_two_rooms.hpp"

namespace roomscribe {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

TEST(OpeningsTable, HasLeafGlassAndFrame) {
    const std::string html = openings_table(test::flat_of_two_rooms());
    const std::string cell = "</td><td class=\"number\" data-sort=\"[^\"]*\">";
    EXPECT_THAT(html,
                ContainsRegex("data-sort=\"door-1\".*room-1.*" + cell + "0.800" + cell + "2.000" +
                              cell + "0.000" + cell + "0.900" + cell + "2.050</td><td>hinged"));
    EXPECT_THAT(html, ContainsRegex("data-sort=\"window-1\".*" + cell + "1.200" + cell + "1.000" +
                                    cell + "0.900" + cell + "1.300" + cell + "1.100"));
}

TEST(HandlesTable, SaysWhereAndHowToTakeHold) {
    const std::string html = handles_table(test::flat_of_two_rooms());
    EXPECT_THAT(html, ContainsRegex("handle-1.*bar handle.*furniture-2.*room-1.*>0.600<.*>2.430<.*"
                                    ">0.700<.*0.00 1.00 0.00.*>22<"));
}

TEST(ScheduleTables, LeaveOutWhatIsRejectedOrNotThere) {
    EXPECT_EQ(openings_table({}), "");
    EXPECT_EQ(handles_table({}), "");
    Scene scene = test::flat_of_two_rooms();
    for (Component& component : scene.components)
        if (component.id == "door-1") component.verdict = Verdict::rejected;
    EXPECT_THAT(openings_table(scene), Not(HasSubstr("door-1")));
    EXPECT_THAT(openings_table(scene), HasSubstr("window-1"));
}

}  // namespace
}  // namespace roomscribe
