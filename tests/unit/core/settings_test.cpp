// SPDX-License-Identifier: MIT
#include "roomscribe/core/settings.hpp"

#include <array>
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"

namespace roomscribe {
namespace {

using testing::AllOf;
using testing::HasSubstr;

enum class Color : std::uint8_t { red, green, blue };

std::span<const std::string_view> enumerator_names(Color) {
    static constexpr std::array<std::string_view, 3> names{"red", "green", "blue"};
    return names;
}

struct InnerSettings {
    double radius = 0.5;

    void visit(SettingVisitor& visitor) {
        visitor(radius,
                {.name = "radius", .unit = "m", .min = 0.0, .max = 10.0, .doc = "How far."});
    }
};

struct OuterSettings {
    bool is_on = true;
    int count = 3;
    double angle = -0.25;
    std::optional<double> size = std::nullopt;
    Color color = Color::green;
    InnerSettings inner = {};

    void visit(SettingVisitor& visitor) {
        visitor(is_on, {.name = "is_on", .unit = "", .doc = "Switch."});
        visitor(count, {.name = "count", .unit = "", .min = 1, .max = 10, .doc = "How many."});
        visitor(angle, {.name = "angle", .unit = "rad", .doc = "Any."});
        visitor(size, {.name = "size", .unit = "m", .min = 1e-3, .doc = "How large."});
        visitor(color, {.name = "color", .unit = "", .doc = "Which."});
        visitor.group("inner", inner);
    }
};

std::string refusal_of(std::string_view name, std::string_view value) {
    OuterSettings settings;
    try {
        set_setting(settings, name, value);
    } catch (const InvalidArgument& error) {
        return error.what();
    }
    return "was taken";
}

TEST(Settings, ListsEveryFieldInOrder) {
    const std::vector<SettingEntry> entries = list_settings(OuterSettings{});
    ASSERT_EQ(entries.size(), 6U);
    const auto row = [&](std::size_t i) {
        const SettingEntry& entry = entries[i];
        return entry.name + "|" + entry.unit + "|" + entry.range + "|" + entry.value + "|" +
               entry.doc + "|" + (entry.is_text ? "text" : "number");
    };
    EXPECT_EQ(row(0), "is_on||true | false|true|Switch.|number");
    EXPECT_EQ(row(1), "count||1 to 10|3|How many.|number");
    EXPECT_EQ(row(2), "angle|rad|any number|-0.25|Any.|number");
    EXPECT_EQ(row(3), "size|m|auto | at least 0.001|auto|How large.|text");
    EXPECT_EQ(row(4), "color||red | green | blue|green|Which.|text");
    EXPECT_EQ(row(5), "inner.radius|m|0 to 10|0.5|How far.|number");
}

TEST(Settings, SetsEveryKind) {
    OuterSettings settings;
    set_setting(settings, "is_on", "false");
    set_setting(settings, "count", "10");
    set_setting(settings, "angle", "1.5e-3");
    set_setting(settings, "size", "0.25");
    set_setting(settings, "color", "blue");
    set_setting(settings, "inner.radius", "0");
    EXPECT_FALSE(settings.is_on);
    EXPECT_EQ(settings.count, 10);
    EXPECT_EQ(settings.angle, 1.5e-3);
    EXPECT_EQ(settings.size, 0.25);
    EXPECT_EQ(settings.color, Color::blue);
    EXPECT_EQ(settings.inner.radius, 0.0);
    set_setting(settings, "size", "auto");
    EXPECT_EQ(settings.size, std::nullopt);
}

TEST(Settings, WhatIsListedCanBeSetAgain) {
    OuterSettings settings{.is_on = false,
                           .count = 7,
                           .angle = 0.1,
                           .size = 1.0 / 3.0,
                           .color = Color::red,
                           .inner = {.radius = 0.7}};
    OuterSettings copy;
    for (const SettingEntry& entry : list_settings(settings)) {
        set_setting(copy, entry.name, entry.value);
    }
    EXPECT_EQ(copy.is_on, settings.is_on);
    EXPECT_EQ(copy.count, settings.count);
    EXPECT_EQ(copy.angle, settings.angle);
    EXPECT_EQ(copy.size, settings.size);
    EXPECT_EQ(copy.color, settings.color);
    EXPECT_EQ(copy.inner.radius, settings.inner.radius);
}

TEST(Settings, RefusesWhatDoesNotParse) {
    for (const char* name : {"is_on", "count", "angle", "size", "color", "inner.radius"}) {
        for (const char* value : {"", " 1", "1 ", "1x", "yellow", "True", "1e999"}) {
            EXPECT_THAT(refusal_of(name, value),
                        AllOf(HasSubstr(name), HasSubstr(value), HasSubstr("must be")));
        }
    }
    EXPECT_THAT(refusal_of("count", "2.5"), HasSubstr("a whole number"));
    EXPECT_THAT(refusal_of("count", "99999999999"), HasSubstr("a whole number"));
    EXPECT_THAT(refusal_of("color", "grey"), HasSubstr("red | green | blue"));
}

TEST(Settings, RefusesWhatIsOutOfRange) {
    EXPECT_EQ(refusal_of("count", "0"), "count = 0: must be 1 to 10");
    EXPECT_EQ(refusal_of("count", "11"), "count = 11: must be 1 to 10");
    EXPECT_EQ(refusal_of("inner.radius", "10.5"), "inner.radius = 10.5: must be 0 to 10");
    EXPECT_EQ(refusal_of("size", "0"), "size = 0: must be at least 0.001");
    EXPECT_THAT(refusal_of("angle", "nan"), HasSubstr("angle = nan"));
    EXPECT_THAT(refusal_of("angle", "inf"), HasSubstr("angle = inf"));
}

TEST(Settings, ARefusedValueLeavesTheOldOne) {
    OuterSettings settings{.size = 0.5};
    EXPECT_THROW(set_setting(settings, "count", "11"), InvalidArgument);
    EXPECT_THROW(set_setting(settings, "size", "wide"), InvalidArgument);
    EXPECT_EQ(settings.count, 3);
    EXPECT_EQ(settings.size, 0.5);
}

TEST(Settings, SuggestsTheNearestName) {
    EXPECT_THAT(refusal_of("cuont", "1"), HasSubstr("did you mean count?"));
    EXPECT_THAT(refusal_of("radius", "1"), HasSubstr("did you mean inner.radius?"));
    EXPECT_THAT(refusal_of("colour", "red"), HasSubstr("did you mean color?"));
}

TEST(Settings, ChecksEveryField) {
    EXPECT_NO_THROW(check_settings(OuterSettings{}));
    EXPECT_NO_THROW(check_settings(OuterSettings{.count = 1}));
    EXPECT_THROW(check_settings(OuterSettings{.count = 0}), InvalidArgument);
    EXPECT_THROW(check_settings(OuterSettings{.angle = std::nan("")}), InvalidArgument);
    EXPECT_THROW(check_settings(OuterSettings{.size = 0.0}), InvalidArgument);
    EXPECT_THROW(check_settings(OuterSettings{.color = static_cast<Color>(3)}), InvalidArgument);
    EXPECT_THROW(check_settings(OuterSettings{.inner = {.radius = -0.1}}), InvalidArgument);
}

}  // namespace
}  // namespace roomscribe
