// SPDX-License-Identifier: MIT
#include "roomscribe/core/error.hpp"

#include <atomic>
#include <numbers>

#include <gtest/gtest.h>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/units.hpp"

namespace roomscribe {
namespace {

TEST(Error, InvalidArgumentNamesParameterValueAndRange) {
    EXPECT_STREQ(InvalidArgument("radius", "-1", "at least 0").what(),
                 "radius = -1: must be at least 0");
}

TEST(Error, IoErrorIsOneLineWithThePlace) {
    EXPECT_STREQ(IoError("a.ply", "PLY", {17, {}}, "cut off", "copy it again").what(),
                 "a.ply (PLY), byte 17: cut off; copy it again");
    EXPECT_STREQ(IoError("a.ply", "PLY", {{}, 3}, "no such type", "use float").what(),
                 "a.ply (PLY), line 3: no such type; use float");
    const IoError whole("b.xyz", "", {}, "missing", "check the path");
    EXPECT_STREQ(whole.what(), "b.xyz: missing; check the path");
    EXPECT_EQ(whole.path(), "b.xyz");
}

TEST(Context, ThrowsOnlyWhenCancelled) {
    std::atomic<bool> cancel = false;
    Context context;
    context.cancel = &cancel;
    EXPECT_NO_THROW(context.throw_if_cancelled());
    EXPECT_NO_THROW(Context{}.throw_if_cancelled());
    cancel = true;
    EXPECT_THROW(context.throw_if_cancelled(), Cancelled);
}

TEST(Context, ReportsToWhoeverListens) {
    EXPECT_NO_THROW(Context{}.report_progress("stage", 0.5));
    std::string heard;
    Context context;
    context.on_progress = [&](std::string_view stage, double) { heard += stage; };
    context.on_message = [&](std::string_view message) { heard += message; };
    context.report_progress("icp ", 0.5);
    context.report_message("slow");
    EXPECT_EQ(heard, "icp slow");
}

TEST(Units, DegreesAndRadiansAreInverse) {
    EXPECT_DOUBLE_EQ(radians(180.0), std::numbers::pi);
    EXPECT_DOUBLE_EQ(degrees(radians(-37.5)), -37.5);
}

}  // namespace
}  // namespace roomscribe
