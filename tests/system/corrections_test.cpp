// SPDX-License-Identifier: MIT
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "roomscribe/io/point_cloud_io.hpp"
#include "support/simulated_rooms.hpp"
#include "system/program.hpp"

namespace roomscribe::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using testing::HasSubstr;

Json read_json(const fs::path& path) {
    return Json::parse(read_bytes(path));
}

std::size_t num_with_label(const Json& scene, std::string_view label) {
    const Json& components = scene.at("components");
    return static_cast<std::size_t>(
        std::count_if(components.begin(), components.end(),
                      [&](const Json& component) { return component.at("label") == label; }));
}

void write_corrections(const fs::path& path, const Json& corrections) {
    std::ofstream(path) << Json({{"format", "roomscribe-corrections"},
                                 {"version", 1},
                                 {"corrections", corrections}})
                               .dump();
}

TEST(Corrections, AreHonouredByEachRunAndSurviveIt) {
    const TemporaryFolder folder;
    const std::string scan = write_room_scans(folder.path(), 1).front();
    const fs::path out = folder / "out";
    const std::vector<std::string> interpret{"interpret", scan, "-o", out.string()};
    ASSERT_EQ(roomscribe(interpret).exit_code, 0);
    const Json before = read_json(out / "scene.json");
    const std::size_t num_walls = num_with_label(before, "wall");
    ASSERT_GT(num_walls, 1U);
    const auto& components = before.at("components");
    const Json wall = *std::find_if(components.begin(), components.end(),
                                    [](const Json& one) { return one.at("label") == "wall"; });

    write_corrections(out / "corrections.json",
                      {{{"action", "reject"}, {"element", wall}},
                       {{"action", "relabel"}, {"element", wall}, {"label", "door"}}});
    const std::string file = read_bytes(out / "corrections.json");
    for (int i = 0; i < 2; ++i) {
        const ProgramResult result = roomscribe(interpret);
        ASSERT_EQ(result.exit_code, 0) << result.err;
        EXPECT_THAT(result.out, HasSubstr("1 of 2 corrections are applied"));
        EXPECT_THAT(result.out, HasSubstr("corrections[1]: no wall lies around"));
        EXPECT_EQ(num_with_label(read_json(out / "scene.json"), "wall"), num_walls - 1);
        EXPECT_EQ(read_bytes(out / "corrections.json"), file);
    }
    EXPECT_THAT(read_bytes(out / "run.json"), HasSubstr("corrections.json"));

    fs::rename(out / "corrections.json", folder / "mine.json");
    ASSERT_EQ(roomscribe(interpret).exit_code, 0);
    EXPECT_EQ(num_with_label(read_json(out / "scene.json"), "wall"), num_walls);
    const ProgramResult result = roomscribe(
        {"interpret", scan, "-o", out.string(), "--corrections", (folder / "mine.json").string()});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(num_with_label(read_json(out / "scene.json"), "wall"), num_walls - 1);
}

TEST(Corrections, AreReadBeforeTheWorkAndNamedWhereWrong) {
    const TemporaryFolder folder;
    const std::string scan = write_room_scans(folder.path(), 1).front();
    const fs::path file = folder / "mine.json";
    const std::vector<std::string> interpret{"interpret",     scan, "-o", folder / "out",
                                             "--corrections", file};
    expect_error(roomscribe(interpret), 3, {"mine.json"});
    write_corrections(file, {{{"action", "erase"}, {"element", {{"label", "wall"}}}}});
    expect_error(roomscribe(interpret), 3, {"mine.json", "corrections[0].action", "erase"});
}

TEST(Corrections, OfAMapApartLieInItsFolder) {
    const TemporaryFolder folder;
    std::vector<Scan> scans = scan_furnished_room(1, 20.0);
    const Transform in_room(Eigen::Translation3d(2.0, 1.5, 1.4));
    scans.at(2).cloud = simulate_scan(other_room(), in_room, 1, 20.0).cloud;
    const fs::path out = folder / "out";
    std::vector<std::string> run{"run", "-o", out.string()};
    for (const Scan& scan : scans) {
        run.push_back((folder / scan.name).string());
        write_point_cloud(run.back(), scan.cloud);
    }
    ASSERT_EQ(roomscribe(run).exit_code, 0);
    const fs::path own = out / "set-2";
    const Json before = read_json(own / "scene.json");
    ASSERT_FALSE(before.at("components").empty());
    const Json element = before.at("components").front();
    write_corrections(own / "corrections.json", {{{"action", "reject"}, {"element", element}}});
    const ProgramResult result = roomscribe(run);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("set-2: 1 of 1 corrections are applied"));
    const std::string label = element.at("label");
    EXPECT_EQ(num_with_label(read_json(own / "scene.json"), label),
              num_with_label(before, label) - 1);
    EXPECT_TRUE(fs::exists(own / "corrections.json"));
}

}  // namespace
}  // namespace roomscribe::test
