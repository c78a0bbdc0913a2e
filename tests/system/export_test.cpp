// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "roomscribe/export/json.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "support/flat_of_two_rooms.hpp"
#include "system/program.hpp"

namespace roomscribe::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Export : public testing::Test {
  protected:
    Export() { std::ofstream(folder_ / "scene.json") << scene_to_json(flat_of_two_rooms()); }
    ProgramResult run_export(std::vector<std::string> options) const {
        options.insert(options.begin(), {"export", folder_.path().string()});
        return roomscribe(options);
    }

    TemporaryFolder folder_;
};

TEST_F(Export, WritesEveryFormatBesideTheResult) {
    const ProgramResult result =
        run_export({"--to", "glb,svg,dxf", "--to", "ifc", "--to", "csv", "--to", "graph"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    for (const char* name :
         {"model.glb", "plan.svg", "plan.dxf", "model.ifc", "graph.json", "schedules/rooms.csv",
          "schedules/walls.csv", "schedules/doors.csv", "schedules/windows.csv",
          "schedules/furniture.csv", "schedules/handles.csv"}) {
        EXPECT_GT(fs::file_size(folder_ / name), 0U) << name;
    }
    EXPECT_THAT(result.out, HasSubstr((folder_ / "model.ifc").string() + "\n"));
    // The same result gives the same files.
    const std::string ifc = read_bytes(folder_ / "model.ifc");
    EXPECT_EQ(run_export({"--to", "ifc"}).exit_code, 0);
    EXPECT_EQ(read_bytes(folder_ / "model.ifc"), ifc);
    EXPECT_THAT(ifc, HasSubstr("FILE_NAME('model.ifc','20"));
}

TEST_F(Export, WritesWhereItIsTold) {
    const std::string file = (folder_ / "flat.svg").string();
    EXPECT_EQ(run_export({"--to", "svg", "-o", file}).exit_code, 0);
    EXPECT_TRUE(fs::exists(file));
    const fs::path other = folder_ / "a" / "b";
    EXPECT_EQ(run_export({"--to", "svg,csv", "-o", other.string()}).exit_code, 0);
    EXPECT_TRUE(fs::exists(other / "plan.svg"));
    EXPECT_TRUE(fs::exists(other / "schedules" / "doors.csv"));
    const fs::path tables = folder_ / "tables";
    EXPECT_EQ(run_export({"--to", "csv", "-o", tables.string()}).exit_code, 0);
    EXPECT_TRUE(fs::exists(tables / "doors.csv"));
}

TEST_F(Export, SaysWhatIsWrong) {
    expect_error(run_export({"--to", "step"}), 2, {"--to", "step"});
    expect_error(run_export({}), 2, {"--to"});
    std::ofstream(folder_ / "scene.json") << "{";
    expect_error(run_export({"--to", "ifc"}), 3, {"scene.json"});
    fs::remove(folder_ / "scene.json");
    expect_error(run_export({"--to", "ifc"}), 3, {"holds no scene.json"});
    EXPECT_FALSE(fs::exists(folder_ / "model.ifc"));
}

/// Reads what was exported with programs that are not ours; empty where they are not installed.
std::optional<ProgramResult> read_with_others(const fs::path& folder) {
    const fs::path node = ROOMSCRIBE_NODE;
    if (!fs::exists(node)) return std::nullopt;
    ProgramResult read =
        run_program(node, {ROOMSCRIBE_READERS "/read_exports.mjs", folder.string()});
    constexpr int not_installed = 77;
    if (read.exit_code == not_installed) return std::nullopt;
    return read;
}

void export_all(const fs::path& folder) {
    const ProgramResult written =
        roomscribe({"export", folder.string(), "--to", "ifc,glb,svg,dxf,csv,graph"});
    ASSERT_EQ(written.exit_code, 0) << written.err;
}

constexpr const char* no_readers = "node or the readers are not installed: ./dev readers";

TEST_F(Export, IsReadByOthersAsTheSceneSays) {
    export_all(folder_.path());
    const auto read = read_with_others(folder_.path());
    if (!read) GTEST_SKIP() << no_readers;
    EXPECT_EQ(read->exit_code, 0) << read->out << read->err;
}

/// A simulated flat as its truth has it, exported.
class ExportOfASimulatedFlat : public testing::Test {
  protected:
    ExportOfASimulatedFlat() {
        EXPECT_EQ(
            roomscribe({"simulate", "flat", "--coarseness", "12", "-o", folder_.path().string()})
                .exit_code,
            0);
        export_all(truth());
    }
    fs::path truth() const { return folder_ / "truth"; }

    TemporaryFolder folder_;
};

TEST_F(ExportOfASimulatedFlat, IsReadByOthersAsTheSceneSays) {
    const auto read = read_with_others(truth());
    if (!read) GTEST_SKIP() << no_readers;
    EXPECT_EQ(read->exit_code, 0) << read->out << read->err;
}

/// Moves the side between the two middle corners of the first component of a label outwards along
/// the first edge by 2 mm.
void widen_first(const fs::path& folder, const std::string& label) {
    nlohmann::ordered_json scene = nlohmann::ordered_json::parse(read_bytes(folder / "scene.json"));
    for (auto& component : scene.at("components")) {
        if (component.at("label") != label) continue;
        auto corners = component.at("polygon").get<std::vector<std::array<double, 3>>>();
        ASSERT_EQ(corners.size(), 4U);
        const Eigen::Vector3d along = (Eigen::Map<Eigen::Vector3d>(corners[1].data()) -
                                       Eigen::Map<Eigen::Vector3d>(corners[0].data()))
                                          .normalized();
        for (const std::size_t i : {1U, 2U})
            Eigen::Map<Eigen::Vector3d>(corners[i].data()) += 0.002 * along;
        component.at("polygon") = corners;
        break;
    }
    std::ofstream(folder / "scene.json") << scene;
}

TEST_F(ExportOfASimulatedFlat, IsSeenToBeOffByTwoMillimetres) {
    const std::string scene = read_bytes(truth() / "scene.json");
    for (const auto& [label, files] :
         {std::pair{"door", std::vector<std::string>{"model.ifc", "model.glb", "plan.svg",
                                                     "plan.dxf", "doors.csv", "graph.json"}},
          std::pair{"window", std::vector<std::string>{"model.ifc", "model.glb", "plan.svg",
                                                       "plan.dxf", "windows.csv", "graph.json"}},
          std::pair{"wall", std::vector<std::string>{"model.ifc", "model.glb", "plan.svg",
                                                     "plan.dxf", "walls.csv", "graph.json"}}}) {
        std::ofstream(truth() / "scene.json") << scene;
        widen_first(truth(), label);
        const auto read = read_with_others(truth());
        if (!read) GTEST_SKIP() << no_readers;
        EXPECT_EQ(read->exit_code, 1);
        for (const std::string& file : files) {
            EXPECT_THAT(read->err,
                        testing::ContainsRegex(file + ": " + label + "-[0-9]+: .*[Ww]idth"));
        }
    }
}

TEST_F(ExportOfASimulatedFlat, IsSeenToLackARoom) {
    nlohmann::ordered_json scene =
        nlohmann::ordered_json::parse(read_bytes(truth() / "scene.json"));
    scene.at("rooms").erase(0);
    std::ofstream(truth() / "scene.json") << scene;
    const auto read = read_with_others(truth());
    if (!read) GTEST_SKIP() << no_readers;
    EXPECT_EQ(read->exit_code, 1);
    for (const char* file :
         {"model.ifc", "model.glb", "plan.svg", "plan.dxf", "rooms.csv", "graph.json"}) {
        EXPECT_THAT(read->err, testing::ContainsRegex(std::string(file) + ": (rooms|rows): "));
    }
}

TEST(ExportOfPoints, GivesEveryPointOnce) {
    const TemporaryFolder folder;
    const std::string scan = write_room_scans(folder.path(), 1).front();
    const fs::path out = folder / "out";
    ASSERT_EQ(roomscribe({"interpret", scan, "-o", out.string()}).exit_code, 0);
    const ProgramResult result = roomscribe({"export", out.string(), "--to", "s3dis,scannet"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const std::size_t num_points = finite_points(read_scan(out / "labels.ply").cloud).size();
    EXPECT_EQ(read_scan(out / "scannet.ply").cloud.size(), num_points);
    std::size_t in_rooms = 0;
    std::size_t in_things = 0;
    for (const auto& entry : fs::recursive_directory_iterator(out / "s3dis")) {
        if (!entry.is_regular_file()) continue;
        const std::string text = read_bytes(entry.path());
        const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
        const bool is_thing = entry.path().parent_path().filename() == "Annotations";
        (is_thing ? in_things : in_rooms) += lines;
    }
    EXPECT_EQ(in_rooms, num_points);
    EXPECT_EQ(in_things, num_points);
}

const Channel* find_channel_of(const PointCloud& cloud, const std::string& name) {
    const auto found =
        std::find_if(cloud.channels.begin(), cloud.channels.end(),
                     [&name](const Channel& channel) { return channel.name == name; });
    return found == cloud.channels.end() ? nullptr : &*found;
}

/// One scan in many formats, with a column of the user's own and one that is called as ours.
std::vector<std::string> write_in_formats(const fs::path& folder) {
    PointCloud cloud = read_scan(write_room_scans(folder, 1).front()).cloud;
    cloud = select_points(cloud, finite_points(cloud));
    Channel own{"wetness", ScalarType::uint16, 1, {}};
    Channel label{"label", ScalarType::uint8, 1, {}};
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        own.values.push_back(static_cast<std::byte>(i % 251));
        own.values.push_back(static_cast<std::byte>(i % 7));
        label.values.push_back(static_cast<std::byte>(i % 5));
    }
    cloud.channels = {own, label};
    std::vector<std::string> paths;
    for (const char* name : {"a.ply", "b.pcd", "c.las", "d.e57", "e.xyz", "f.E57"}) {
        paths.push_back((folder / name).string());
        write_point_cloud(paths.back(), cloud);
    }
    std::ofstream poses(folder / "poses.txt");
    for (std::size_t i = 0; i < paths.size(); ++i)
        poses << "1 0 0 0 0 1 0 0 0 0 1 0\n";
    return paths;
}

TEST(ExportOfLabels, GoesIntoCopiesOfTheUsersFiles) {
    const TemporaryFolder folder;
    const std::vector<std::string> paths = write_in_formats(folder.path());
    const fs::path out = folder / "out";
    std::vector<std::string> arguments{"interpret"};
    arguments.insert(arguments.end(), paths.begin(), paths.end());
    for (const std::string& more :
         {std::string("--poses"), (folder / "poses.txt").string(), std::string("-o"), out.string()})
        arguments.push_back(more);
    ASSERT_EQ(roomscribe(arguments).exit_code, 0);
    const ProgramResult result = roomscribe({"export", out.string(), "--to", "labelled"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const PointCloud map = read_scan(out / "labels.ply").cloud;
    const Channel* all = find_channel_of(map, "label");
    ASSERT_NE(all, nullptr);
    std::size_t first = 0;
    for (const std::string& path : paths) {
        SCOPED_TRACE(path);
        const PointCloud before = read_scan(path).cloud;
        const PointCloud after = read_scan(out / "labelled" / fs::path(path).filename()).cloud;
        ASSERT_EQ(after.size(), before.size());
        EXPECT_EQ(after.positions, before.positions);
        for (const Channel& channel : before.channels) {
            const Channel* kept = find_channel_of(after, channel.name);
            ASSERT_NE(kept, nullptr) << channel.name;
            EXPECT_EQ(kept->values, channel.values) << channel.name;
        }
        const Channel* label = find_channel_of(after, "roomscribe_label");
        ASSERT_NE(label, nullptr);
        EXPECT_NE(find_channel_of(after, "instance"), nullptr);
        EXPECT_NE(find_channel_of(after, "confidence"), nullptr);
        if (label->type == ScalarType::uint8) {
            EXPECT_TRUE(std::equal(label->values.begin(), label->values.end(),
                                   all->values.begin() + static_cast<std::ptrdiff_t>(first)));
        }
        first += before.size();
    }
    EXPECT_EQ(first, map.size());
    std::ofstream(paths.front(), std::ios::app) << '\n';
    expect_error(roomscribe({"export", out.string(), "--to", "labelled"}), 3,
                 {"a.ply", "has changed"});
}

}  // namespace
}  // namespace roomscribe::test
