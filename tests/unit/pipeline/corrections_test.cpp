// SPDX-License-Identifier: MIT
#include "roomscribe/pipeline/corrections.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/export/json.hpp"
#include "support/flat_of_two_rooms.hpp"

namespace roomscribe {
namespace {

using testing::HasSubstr;

/// Two rooms, the door between them with two points.
Reconstruction flat() {
    Reconstruction result;
    result.scene = test::flat_of_two_rooms();
    std::int32_t instance = 0;
    for (Component& component : result.scene.components)
        component.instance = instance++;
    return result;
}

Component& component(Reconstruction& result, std::string_view id) {
    return *std::find_if(result.scene.components.begin(), result.scene.components.end(),
                         [&](const Component& one) { return one.id == id; });
}

bool has(Reconstruction& result, std::string_view id) {
    return std::any_of(result.scene.components.begin(), result.scene.components.end(),
                       [&](const Component& one) { return one.id == id; });
}

/// The element as another run would have it: another id, a few centimetres off.
Component seen_again(const Component& element) {
    Component again = element;
    again.id = "another";
    for (Eigen::Vector3d& corner : again.polygon)
        corner += Eigen::Vector3d(0.02, -0.01, 0.015);
    return again;
}

TEST(ApplyCorrections, RejectsAnElementWithItsPointsAndWhatHangsOnIt) {
    Reconstruction result = flat();
    const std::int32_t door = component(result, "door-1").instance;
    result.labels = {{Label::door, Label::wall, Label::door}, {door, 1, door}, {0.9F, 0.9F, 0.9F}};
    Component handle;
    handle.id = "handle-77";
    handle.label = Label::handle;
    handle.parent = "door-1";
    handle.box.emplace();
    result.scene.components.push_back(handle);
    const Correction correction{.action = CorrectionAction::reject,
                                .element = seen_again(component(result, "door-1"))};
    EXPECT_EQ(apply_corrections(result, {&correction, 1}).num_applied, 1U);
    EXPECT_EQ(component(result, "door-1").verdict, Verdict::rejected);
    EXPECT_EQ(component(result, "handle-77").verdict, Verdict::rejected);
    EXPECT_EQ(result.labels.labels, (std::vector{Label::unknown, Label::wall, Label::unknown}));
    EXPECT_EQ(result.labels.instances, (std::vector<std::int32_t>{-1, 1, -1}));
    EXPECT_TRUE(result.scene.rooms[0].neighbors.empty());
}

TEST(ApplyCorrections, PinsWhatIsFoundAndAddsWhatIsNot) {
    Reconstruction result = flat();
    component(result, "door-1").verdict = Verdict::doubtful;
    component(result, "door-1").confidence = 0.4;
    const Correction correction{.action = CorrectionAction::pin,
                                .element = seen_again(component(result, "door-1"))};
    const std::size_t num_before = result.scene.components.size();
    apply_corrections(result, {&correction, 1});
    EXPECT_EQ(result.scene.components.size(), num_before);
    EXPECT_EQ(component(result, "door-1").verdict, Verdict::accepted);
    EXPECT_EQ(component(result, "door-1").confidence, 1.0);
    EXPECT_THAT(component(result, "door-1").evidence.rule, HasSubstr("pinned by hand"));

    Reconstruction without = flat();
    std::erase_if(without.scene.components,
                  [](const Component& one) { return one.id == "door-1"; });
    apply_corrections(without, {&correction, 1});
    ASSERT_TRUE(has(without, "door-1"));
    EXPECT_EQ(component(without, "door-1").polygon, correction.element.polygon);
    EXPECT_THAT(component(without, "door-1").evidence.rule, HasSubstr("not found"));
}

TEST(ApplyCorrections, RelabelsWithIdPointsAndReferences) {
    Reconstruction result = flat();
    const std::int32_t door = component(result, "door-1").instance;
    result.labels = {{Label::door}, {door}, {0.5F}};
    const Correction correction{.action = CorrectionAction::relabel,
                                .element = seen_again(component(result, "door-1")),
                                .label = Label::window,
                                .kind = "french_window"};
    apply_corrections(result, {&correction, 1});
    EXPECT_FALSE(has(result, "door-1"));
    const auto& components = result.scene.components;
    const auto window =
        std::find_if(components.begin(), components.end(),
                     [](const Component& one) { return one.kind == "french_window"; });
    ASSERT_NE(window, components.end());
    EXPECT_EQ(window->label, Label::window);
    EXPECT_THAT(window->id, HasSubstr("window-"));
    EXPECT_EQ(result.labels.labels.front(), Label::window);
    EXPECT_EQ(result.scene.rooms[0].neighbors[0].through, window->id);
}

TEST(ApplyCorrections, SetsSizesFromTheFoot) {
    Reconstruction result = flat();
    const Component before = component(result, "door-1");
    const Correction correction{.action = CorrectionAction::set_size,
                                .element = seen_again(before),
                                .label = Label::unknown,
                                .kind = "",
                                .size = {0.7, 1.9}};
    apply_corrections(result, {&correction, 1});
    // The map is not level: sizes show in the room frame.
    Eigen::AlignedBox3d box;
    Eigen::AlignedBox3d box_before;
    for (const Eigen::Vector3d& corner : component(result, "door-1").polygon)
        box.extend(result.scene.room_from_map * corner);
    for (const Eigen::Vector3d& corner : before.polygon)
        box_before.extend(result.scene.room_from_map * corner);
    EXPECT_NEAR(box.sizes().z(), 1.9, 1e-9);
    EXPECT_NEAR(box.sizes().head<2>().norm(), 0.7, 1e-9);
    EXPECT_NEAR(box.min().z(), box_before.min().z(), 1e-9);
    EXPECT_NEAR((box.center() - box_before.center()).head<2>().norm(), 0.0, 1e-9);
}

TEST(ApplyCorrections, NamesWhatAnswersToNothing) {
    Reconstruction result = flat();
    const std::size_t num_before = result.scene.components.size();
    Component far = component(result, "door-1");
    for (Eigen::Vector3d& corner : far.polygon)
        corner.x() += 0.3;  // off its plane
    Component other = component(result, "door-1");
    other.label = Label::window;
    const std::vector<Correction> corrections{
        {.action = CorrectionAction::reject, .element = far},
        {.action = CorrectionAction::reject, .element = other}};
    const CorrectionOutcome outcome = apply_corrections(result, corrections);
    EXPECT_EQ(outcome.num_applied, 0U);
    ASSERT_EQ(outcome.unmatched.size(), 2U);
    EXPECT_THAT(outcome.unmatched[0], HasSubstr("corrections[0]: no door lies around"));
    EXPECT_EQ(result.scene.components.size(), num_before);
}

TEST(CorrectionsFromJson, NameWhatIsWrong) {
    const auto error_of = [](const std::string& corrections) -> std::string {
        try {
            corrections_from_json(
                R"({"format":"roomscribe-corrections","version":1,"corrections":)" + corrections +
                "}");
        } catch (const IoError& error) {
            return error.what();
        }
        return "";
    };
    const std::string door =
        R"("element":{"label":"door","polygon":[[0,0,0],[1,0,0],[1,0,2],[0,0,2]]})";
    EXPECT_EQ(error_of(R"([{"action":"reject",)" + door + "}]"), "");
    EXPECT_EQ(error_of(R"([{"action":"set_size","size":[1,2],)" + door + "}]"), "");
    EXPECT_THAT(error_of(R"([{"action":"remove",)" + door + "}]"),
                HasSubstr("corrections[0].action"));
    EXPECT_THAT(error_of(R"([{"action":"relabel",)" + door + "}]"),
                HasSubstr("\"label\" is missing"));
    EXPECT_THAT(error_of(R"([{"action":"set_size","size":[1,2,3],)" + door + "}]"),
                HasSubstr("corrections[0].size"));
    EXPECT_THAT(error_of(R"([{"action":"set_size","size":[1,-2],)" + door + "}]"),
                HasSubstr("corrections[0].size[1]"));
    EXPECT_THAT(error_of(R"([{"action":"pin","element":{"label":"door"}}])"),
                HasSubstr("neither a polygon nor a box"));
    EXPECT_THAT(error_of("{}"), HasSubstr("must be an array"));
}

}  // namespace
}  // namespace roomscribe
