// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/scenario_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/simulation/simulated_scene.hpp"

namespace roomscribe {
namespace {

using testing::HasSubstr;

std::string complaint_about(const std::string& text) {
    try {
        scenario_from_json(text, "mine.json");
    } catch (const IoError& error) {
        return error.what();
    }
    return "no complaint";
}

TEST(ScenarioJson, ComesBackAsItWent) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const Scenario scenario = plan_scene(static_cast<SceneKind>(seed - 1), seed);
        const std::string text = scenario_to_json(scenario);
        EXPECT_EQ(scenario_to_json(scenario_from_json(text)), text);
    }
}

TEST(ScenarioJson, LeavesDefaultsOutAndTakesThemBack) {
    const Scenario scenario = scenario_from_json(
        R"({"rooms": [{"name": "a", "outline": [[0, 0], [4, 0], [4, 3], [0, 3]]}],
            "openings": [{"kind": "window", "room": "a", "at": [2, 0], "sill": 0.9}],
            "scanner": "sick_lms200", "stations": [{"at": [2, 1, 1], "heading": 90}]})");
    ASSERT_EQ(scenario.rooms.size(), 1U);
    EXPECT_EQ(scenario.rooms[0].outline.size(), 4U);
    EXPECT_EQ(scenario.rooms[0].ceiling_height, RoomPlan{}.ceiling_height);
    EXPECT_EQ(scenario.openings.at(0).kind, OpeningKind::window);
    EXPECT_EQ(scenario.openings.at(0).sill, 0.9);
    EXPECT_EQ(scenario.scanner, ScannerKind::sick_lms200);
    EXPECT_THAT(scenario_to_json(scenario), testing::Not(HasSubstr("ceiling_height")));
}

TEST(ScenarioJson, NamesThePlaceOfAMistake) {
    EXPECT_THAT(complaint_about("{"), HasSubstr("mine.json"));
    EXPECT_THAT(complaint_about(R"({"romms": []})"), HasSubstr("\"romms\" is none of"));
    EXPECT_THAT(complaint_about(R"({"openings": [{}, {"width": "wide"}]})"),
                HasSubstr("openings[1].width: must be a number"));
    EXPECT_THAT(complaint_about(R"({"openings": [{"kind": "hatch"}]})"),
                HasSubstr("door, passage, window, niche"));
    EXPECT_THAT(complaint_about(R"({"rooms": [{"outline": [[1, 2, 3]]}]})"),
                HasSubstr("rooms[0].outline[0]: must be 2 numbers"));
    EXPECT_THAT(complaint_about(R"({"seed": -1})"), HasSubstr("seed"));
    EXPECT_THAT(complaint_about(R"({"openings": [{"mullions": 5000000000}]})"),
                HasSubstr("too large"));
}

}  // namespace
}  // namespace roomscribe
