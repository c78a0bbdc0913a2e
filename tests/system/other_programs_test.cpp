// SPDX-License-Identifier: MIT
// Files of points go through programs that are not ours and come back as they were. Each test is
// skipped where its program is absent.
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "system/program.hpp"

namespace roomscribe::test {
namespace {

namespace fs = std::filesystem;

constexpr int not_installed = 77;

PointCloud colored_cloud() {
    PointCloud cloud;
    Random random(11, 0);
    for (int i = 0; i < 500; ++i) {
        const auto next = [&] { return static_cast<float>(random.uniform(-4.0, 4.0)); };
        const auto color = [&] { return static_cast<std::uint8_t>(random.next() % 256); };
        cloud.positions.emplace_back(next(), next(), next());
        cloud.colors.push_back({color(), color(), color()});
    }
    // Whole numbers are not taken for something else.
    cloud.positions.front() = {1.0F, 2.0F, 3.0F};
    return cloud;
}

void expect_same(const PointCloud& found, const PointCloud& expected, float tolerance,
                 bool with_colors) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
        ASSERT_LE((found.positions[i] - expected.positions[i]).norm(), tolerance) << i;
    if (with_colors) {
        EXPECT_EQ(found.colors, expected.colors);
    }
}

/// What a program that prints "x y z red green blue" has read.
PointCloud parse_points(const std::string& text, int color_step) {
    PointCloud cloud;
    std::istringstream stream(text);
    Eigen::Vector3f position;
    int red = 0;
    int green = 0;
    int blue = 0;
    while (stream >> position.x() >> position.y() >> position.z() >> red >> green >> blue) {
        cloud.positions.push_back(position);
        cloud.colors.push_back({static_cast<std::uint8_t>(red / color_step),
                                static_cast<std::uint8_t>(green / color_step),
                                static_cast<std::uint8_t>(blue / color_step)});
    }
    return cloud;
}

/// A file that we write, and what another program makes of it.
struct Journey {
    const char* name;
    const char* saved_as;
    Encoding encoding = Encoding::automatic;
    float tolerance = 0.0F;
    bool with_colors = true;
};

TEST(CloudCompare, ReadsWhatWeWriteAndIsRead) {
    const fs::path program = ROOMSCRIBE_CLOUDCOMPARE;
    if (!fs::exists(program)) GTEST_SKIP() << "CloudCompare is not installed";
    const TemporaryFolder folder;
    const PointCloud cloud = colored_cloud();
    const Journey journeys[] = {
        {"a.ply", "PLY", Encoding::ascii},
        {"b.ply", "PLY", Encoding::binary},
        {"c.ply", "PLY", Encoding::binary_big_endian},
        {"d.txt", "PLY"},
        {"e.csv", "PLY"},
        // Text has eight digits behind the point there; VTK leaves colours to what is not read.
        {"f.ply", "ASC", Encoding::binary, 1e-6F},
        {"g.ply", "VTK", Encoding::binary, 1e-6F, false}};
    for (const auto& [name, saved_as, encoding, tolerance, with_colors] : journeys) {
        SCOPED_TRACE(std::string(name) + " as " + saved_as);
        write_point_cloud(folder / name, cloud, {.encoding = encoding});
        const fs::path saved = folder / (std::string("saved-") + name[0] + "." + saved_as);
        run_program("/usr/bin/env", {"QT_QPA_PLATFORM=offscreen", program.string(), "-SILENT", "-O",
                                     (folder / name).string(), "-C_EXPORT_FMT", saved_as,
                                     "-NO_TIMESTAMP", "-SAVE_CLOUDS", "FILE", saved.string()});
        ASSERT_TRUE(fs::exists(saved));
        expect_same(read_scan(saved).cloud, cloud, tolerance, with_colors);
    }
}

TEST(Open3d, ReadsWhatWeWriteAndIsRead) {
    const fs::path python = ROOMSCRIBE_PYTHON;
    if (!fs::exists(python) || run_program(python, {"-c", "import open3d"}).exit_code != 0)
        GTEST_SKIP() << "Open3D is not installed";
    const TemporaryFolder folder;
    const PointCloud cloud = colored_cloud();
    const std::string script =
        "import sys, open3d\n"
        "for i in range(1, len(sys.argv), 3):\n"
        "    cloud = open3d.io.read_point_cloud(sys.argv[i])\n"
        "    open3d.io.write_point_cloud(sys.argv[i + 1], cloud,\n"
        "                        write_ascii='ascii' in sys.argv[i + 2],\n"
        "                        compressed='compressed' in sys.argv[i + 2])\n";
    // Open3D writes text with six digits in PLY and ten behind the point elsewhere.
    const std::pair<Journey, const char*> journeys[] = {
        {{"a.ply", "ply", Encoding::ascii}, "binary"},
        {{"b.ply", "ply", Encoding::binary_big_endian}, "binary"},
        {{"c.ply", "ply", Encoding::binary, 1e-5F}, "ascii"},
        {{"d.pcd", "pcd", Encoding::ascii}, "binary"},
        {{"e.pcd", "pcd", Encoding::binary_compressed}, "compressed"},
        {{"f.pcd", "pcd", Encoding::binary, 1e-6F}, "ascii"},
        {{"g.ply", "pts", Encoding::binary, 1e-6F}, "ascii"},
        {{"h.ply", "xyz", Encoding::binary, 1e-6F, false}, "ascii"}};
    const auto saved_path = [&](const Journey& journey) {
        return folder / (std::string("saved-") + journey.name[0] + "." + journey.saved_as);
    };
    std::vector<std::string> arguments{"-c", script};
    for (const auto& [journey, mode] : journeys) {
        write_point_cloud(folder / journey.name, cloud, {.encoding = journey.encoding});
        arguments.insert(arguments.end(),
                         {(folder / journey.name).string(), saved_path(journey).string(), mode});
    }
    const ProgramResult result = run_program(python, arguments);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    for (const auto& [journey, mode] : journeys) {
        SCOPED_TRACE(std::string(journey.name) + " as " + mode + " " + journey.saved_as);
        expect_same(read_scan(saved_path(journey)).cloud, cloud, journey.tolerance,
                    journey.with_colors);
    }
}

TEST(OtherReaders, ReadTheE57AndLasThatWeWrite) {
    const fs::path node = ROOMSCRIBE_NODE;
    if (!fs::exists(node)) GTEST_SKIP() << "node is not installed";
    const TemporaryFolder folder;
    const PointCloud cloud = colored_cloud();
    // LAS has steps of 0.1 mm, and colours of 16 bits.
    for (const auto& [name, tolerance, color_step] :
         {std::tuple{"a.e57", 0.0F, 1}, std::tuple{"a.las", 1e-4F, 257}}) {
        SCOPED_TRACE(name);
        write_point_cloud(folder / name, cloud);
        const ProgramResult read =
            run_program(node, {"--experimental-wasm-modules",
                               ROOMSCRIBE_READERS "/print_points.mjs", (folder / name).string()});
        if (read.exit_code == not_installed) GTEST_SKIP() << read.out;
        ASSERT_EQ(read.exit_code, 0) << read.err;
        expect_same(parse_points(read.out, color_step), cloud, tolerance, true);
    }
}

}  // namespace
}  // namespace roomscribe::test
