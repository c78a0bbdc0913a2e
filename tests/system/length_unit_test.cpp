// SPDX-License-Identifier: MIT
#include "roomscribe/core/length_unit.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/io/point_cloud_io.hpp"
#include "support/shapes.hpp"
#include "system/program.hpp"

namespace roomscribe::test {
namespace {

using testing::HasSubstr;

/// The same scan with its coordinates in another unit.
std::string write_in(LengthUnit unit, const std::string& path) {
    PointCloud cloud = read_scan(path).cloud;
    scale_in_place(cloud, 1.0 / metres_per(unit));
    std::string copy = path + "." + std::string(length_unit_name(unit)) + ".ply";
    write_point_cloud(copy, cloud);
    return copy;
}

void expect_same_scene(const nlohmann::json& a, const nlohmann::json& b) {
    ASSERT_EQ(a.at("components").size(), b.at("components").size());
    for (std::size_t i = 0; i < a["components"].size(); ++i) {
        const auto& one = a["components"][i];
        const auto& other = b["components"][i];
        EXPECT_EQ(one.at("id"), other.at("id"));
        if (!one.contains("polygon")) continue;
        ASSERT_EQ(one["polygon"].size(), other.at("polygon").size()) << one["id"];
        for (std::size_t corner = 0; corner < one["polygon"].size(); ++corner) {
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_NEAR(one["polygon"][corner][axis].get<double>(),
                            other["polygon"][corner][axis].get<double>(), 0.01)
                    << one["id"];
            }
        }
    }
}

TEST(LengthUnitOfScans, AScanInAnotherUnitGivesTheSceneInMetres) {
    const TemporaryFolder folder;
    const std::string scan = write_room_scans(folder.path(), 1).front();
    const std::string metres = (folder / "metres").string();
    ASSERT_EQ(roomscribe({"interpret", scan, "-o", metres}).exit_code, 0);
    const nlohmann::json expected = read_json(folder / "metres" / "scene.json");
    for (const LengthUnit unit :
         {LengthUnit::millimetre, LengthUnit::centimetre, LengthUnit::inch, LengthUnit::foot}) {
        SCOPED_TRACE(length_unit_word(unit));
        const std::string name(length_unit_name(unit));
        std::vector<std::string> arguments{"interpret", write_in(unit, scan), "-o",
                                           (folder / name).string()};
        // A hall in metres looks like a room in feet: they must be given.
        if (unit == LengthUnit::foot) arguments.insert(arguments.end(), {"--unit", "ft"});
        const ProgramResult result = roomscribe(arguments);
        ASSERT_EQ(result.exit_code, 0) << result.err;
        EXPECT_THAT(result.out, HasSubstr(std::string(length_unit_word(unit))));
        expect_same_scene(expected, read_json(folder / name / "scene.json"));
        const std::string run = read_json(folder / name / "run.json").dump();
        EXPECT_THAT(run, HasSubstr("input.length_unit"));
    }
}

TEST(LengthUnitOfScans, ConvertWritesMetres) {
    const TemporaryFolder folder;
    const std::string scan = write_room_scans(folder.path(), 1).front();
    const std::string back = (folder / "back.ply").string();
    ASSERT_EQ(
        roomscribe({"convert", write_in(LengthUnit::inch, scan), back, "--unit", "in"}).exit_code,
        0);
    const PointCloud before = read_scan(scan).cloud;
    const PointCloud after = read_scan(back).cloud;
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
        if (!is_finite(before.positions[i])) continue;
        EXPECT_LT((after.positions[i] - before.positions[i]).norm(), 1e-5F);
    }
}

TEST(LengthUnitOfScans, WhatFitsNoUnitIsRefusedWithTheCure) {
    const TemporaryFolder folder;
    Random random(4);
    PointCloud cloud;
    cloud.positions = random_points(random, 5000, 1e5);
    const std::string path = (folder / "far.ply").string();
    write_point_cloud(path, cloud);
    const std::string out = (folder / "out").string();
    expect_error(roomscribe({"interpret", path, "-o", out}), 3, {"far.ply", "--unit"});
    EXPECT_FALSE(std::filesystem::exists(out));
    expect_error(roomscribe({"interpret", path, "-o", out, "--unit", "yard"}), 2, {"--unit"});
}

}  // namespace
}  // namespace roomscribe::test
