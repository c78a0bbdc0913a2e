// SPDX-License-Identifier: MIT
#include "roomscribe/model/label.hpp"

#include <set>

#include <gtest/gtest.h>

#include "roomscribe/model/registration_result.hpp"
#include "roomscribe/model/scene.hpp"

namespace roomscribe {
namespace {

TEST(Label, IdsAndNamesAreFixed) {
    constexpr std::array<std::string_view, num_labels> names{
        "unknown", "floor",        "ceiling", "wall",      "door_frame",
        "door",    "window_frame", "window",  "furniture", "handle"};
    for (std::size_t id = 0; id < num_labels; ++id) {
        EXPECT_EQ(label_name(static_cast<Label>(id)), names[id]);
        EXPECT_EQ(label_from_name(names[id]), static_cast<Label>(id));
    }
    EXPECT_EQ(Label::handle, static_cast<Label>(9));
    EXPECT_EQ(label_from_name("Wall"), std::nullopt);
    EXPECT_EQ(label_from_name(""), std::nullopt);
}

TEST(Label, ColorsDiffer) {
    std::set<std::array<std::uint8_t, 3>> colors;
    for (std::size_t id = 0; id < num_labels; ++id) {
        colors.insert(label_color(static_cast<Label>(id)));
    }
    EXPECT_EQ(colors.size(), num_labels);
}

TEST(Verdict, NamesAreTheFilesWords) {
    EXPECT_EQ(verdict_name(Verdict::accepted), "accepted");
    EXPECT_EQ(verdict_name(Verdict::doubtful), "doubtful");
    EXPECT_EQ(verdict_name(Verdict::rejected), "rejected");
    EXPECT_EQ(link_verdict_name(LinkVerdict::accepted), "accepted");
    EXPECT_EQ(link_verdict_name(LinkVerdict::ambiguous), "ambiguous");
    EXPECT_EQ(link_verdict_name(LinkVerdict::rejected), "rejected");
}

}  // namespace
}  // namespace roomscribe
