// SPDX-License-Identifier: MIT
// XYZ, CSV, PTS and PTX: what is guessed, what is refused, and round trips.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io_test_clouds.hpp"
#include "roomscribe/core/error.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "support/matchers.hpp"
#include "support/test_data.hpp"

namespace roomscribe {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<StoredScan> read_all(const std::string& name, const std::string& text) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / name, text);
    return read_scans(folder / name);
}

PointCloud read_text(const std::string& name, const std::string& text) {
    return std::move(read_all(name, text).front().scan.cloud);
}

std::string error_of(const std::string& name, const std::string& text) {
    try {
        read_all(name, text);
    } catch (const IoError& error) {
        return error.what();
    }
    return "it was read";
}

std::vector<std::string> names_of(const std::string& name, const std::string& text) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / name, text);
    std::vector<std::string> names;
    const FileSummary summary = summarize_file(folder / name).front();
    for (const Field& field : summary.fields)
        names.push_back(field.name);
    return names;
}

TEST(TextPoints, GuessesColumnsByTheirNumbers) {
    EXPECT_THAT(names_of("a.xyz", "1 2 3\n"), ElementsAre("x", "y", "z"));
    EXPECT_THAT(names_of("a.xyz", "1 2 3 0.5\n"), ElementsAre("x", "y", "z", "intensity"));
    EXPECT_THAT(names_of("a.txt", "1 2 3 255 0 7\n"),
                ElementsAre("x", "y", "z", "red", "green", "blue"));
    EXPECT_THAT(names_of("a.asc", "1 2 3 0.6 0 0.8\n1 2 3 0 -1 0\n"),
                ElementsAre("x", "y", "z", "nx", "ny", "nz"));
    // Three whole numbers that could be colours, but for the fourth.
    EXPECT_THAT(names_of("a.pts", "1\n1 2 3 17 255 0 7\n"),
                ElementsAre("x", "y", "z", "intensity", "red", "green", "blue"));
    EXPECT_THAT(names_of("a.txt", "1 2 3 17 255 0 -70\n"),
                ElementsAre("x", "y", "z", "red", "green", "blue", "intensity"));
    EXPECT_THAT(names_of("a.txt", "1 2 3 17 255 0 0 0.6 0.8 5.5 6.5\n"),
                ElementsAre("x", "y", "z", "red", "green", "blue", "nx", "ny", "nz", "intensity",
                            "column_11"));
}

TEST(TextPoints, GuessesSeparatorsAndHeaders) {
    for (const std::string& text :
         {std::string("X, Y, Z, R, G, B, label\n1.5,2,3,10,20,30,4\n"),
          std::string(
              "\"x\";\"y\";\"z\";\"Red\";\"Green\";\"Blue\";\"label\"\r\n1.5;2;3;10;20;30;4"),
          std::string("x\ty\tz\tr\tg\tb\tlabel\n\n1.5\t2\t3\t10\t20\t30\t4\n\n"),
          std::string("# made by hand\n//X Y Z R G B label\n 1.5  2 +3 10 20 30 4 \n"),
          std::string("label r g b x[m] y[m] z[m]\n4 10 20 30 1.5 2 3\n")}) {
        SCOPED_TRACE(text);
        const PointCloud cloud = read_text("a.csv", text);
        ASSERT_EQ(cloud.size(), 1U);
        EXPECT_EQ(cloud.positions[0], Eigen::Vector3f(1.5F, 2.0F, 3.0F));
        EXPECT_THAT(cloud.colors, ElementsAre(ElementsAre(10, 20, 30)));
        ASSERT_EQ(cloud.channels.size(), 1U);
        EXPECT_EQ(cloud.channels[0].name, "label");
    }
}

TEST(TextPoints, ReportsWhatItGuessed) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "a.csv", "1,2,3,0.25,0.5,0\n");
    std::string message;
    Context context;
    context.on_message = [&](std::string_view text) { message = text; };
    read_scan(folder / "a.csv", context);
    for (const char* word : {"a.csv", "x y z red green blue", "','", "0 to 1"})
        EXPECT_THAT(message, HasSubstr(word));
    EXPECT_THAT(summarize_file(folder / "a.csv").front().warnings.at(0),
                HasSubstr("x y z red green blue"));
}

TEST(TextPoints, ColoursOfOtherRangesBecomeBytes) {
    EXPECT_THAT(read_text("a.xyz", "1 2 3 0.2 1 0\n").colors, ElementsAre(ElementsAre(51, 255, 0)));
    EXPECT_THAT(read_text("a.csv", "x,y,z,r,g,b\n1,2,3,65535,257,0\n").colors,
                ElementsAre(ElementsAre(255, 1, 0)));
}

TEST(TextPoints, NothingBetweenSeparatorsIsNan) {
    const PointCloud cloud = read_text("a.csv", "1,,3\n1,2,3\nnan,1,2\n");
    ASSERT_EQ(cloud.size(), 3U);
    EXPECT_FALSE(is_finite(cloud.positions[0]));
    EXPECT_TRUE(is_finite(cloud.positions[1]));
    EXPECT_FALSE(is_finite(cloud.positions[2]));
}

TEST(TextPoints, FarCoordinatesKeepMillimetres) {
    const PointCloud cloud = read_text("a.xyz", "4321000.001 5432100.002 3\n4321001 5432100 4\n");
    const Eigen::Vector3d point = cloud.positions[0].cast<double>() + cloud.global_shift;
    EXPECT_THAT(point, test::VectorNear(Eigen::Vector3d(4321000.001, 5432100.002, 3), 1e-5));
}

TEST(TextPoints, PtsMayHaveParts) {
    const PointCloud cloud =
        read_text("a.pts", "2\n1 2 3 -5 1 2 3\n4 5 6 -6 1 2 3\n1\n7 8 9 0 0 0 0\n");
    ASSERT_EQ(cloud.size(), 3U);
    EXPECT_EQ(cloud.positions[2], Eigen::Vector3f(7, 8, 9));
    EXPECT_EQ(cloud.intensities[1], -6.0F);
}

TEST(TextPoints, RefusesWhatDoesNotFit) {
    struct Bad {
        std::string text;
        const char* place;
        const char* reason;
    };
    for (const Bad& bad :
         {Bad{"1 2\n", "line 1", "2 columns"}, Bad{"# only words\n\n", "byte", "no point"},
          Bad{"a b c\n1 2 3\n", "line 1", "names"},
          Bad{"1 2 3\n4 5\n", "line 2", "'4 5' is not 3 numbers"},
          Bad{"1 2 3\n\n4 5 6 7\n", "line 3", "not 3 numbers"},
          Bad{"1 2 3\n4 5 six\n", "line 2", "six"}, Bad{"1,5;2,5;3,5\n", "line 1", "neither"},
          Bad{"2\n1.00000 2 3\n", "byte", "1 of 2"},
          Bad{"99999999999\n1 2 3\n", "line 1", "99999999999"},
          Bad{"4000000000\n1 2 3\n", "line 1", "do not fit"},
          Bad{"1\n1 2 3\n4 5 6\n", "line 3", "more lines"}}) {
        const std::string message = error_of("a.xyz", bad.text);
        EXPECT_THAT(message, HasSubstr(bad.place)) << bad.text;
        EXPECT_THAT(message, HasSubstr(bad.reason)) << bad.text;
    }
}

/// As many lines as make several blocks on several threads.
TEST(TextPoints, ManyLinesComeInOrder) {
    std::string text;
    constexpr int count = 700000;
    for (int i = 0; i < count; ++i)
        text += std::to_string(i % 997) + " 1 0\n";
    const PointCloud cloud = read_text("a.xyz", text);
    ASSERT_EQ(cloud.size(), static_cast<std::size_t>(count));
    for (int i = 0; i < count; i += 13) {
        ASSERT_EQ(cloud.positions[static_cast<std::size_t>(i)].x(), static_cast<float>(i % 997));
    }
    text += "1 2\n";
    EXPECT_THAT(error_of("a.xyz", text), HasSubstr("line 700001"));
}

constexpr std::array<ScalarType, 3> small_types = {ScalarType::uint8, ScalarType::float32,
                                                   ScalarType::float64};

TEST(TextPoints, RoundTripKeepsAllButTypes) {
    const test::TemporaryFolder folder;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        SCOPED_TRACE(seed);
        PointCloud cloud = test::random_cloud(seed, small_types);
        if (cloud.empty()) continue;
        // Colours whose range is beyond doubt.
        if (!cloud.colors.empty()) cloud.colors[0] = {200, 3, 4};
        for (const char* name : {"a.xyz", "a.csv"}) {
            write_point_cloud(folder / name, cloud);
            const PointCloud back = read_scan(folder / name).cloud;
            ASSERT_EQ(back.size(), cloud.size());
            for (std::size_t i = 0; i < cloud.size(); ++i) {
                for (Eigen::Index k = 0; k < 3; ++k) {
                    const float before = cloud.positions[i][k];
                    const float after = back.positions[i][k];
                    EXPECT_TRUE(before == after || (std::isnan(before) && std::isnan(after)));
                }
            }
            EXPECT_TRUE(test::same_bits(back.colors, cloud.colors));
            EXPECT_TRUE(test::same_bits(back.normals, cloud.normals));
            EXPECT_TRUE(test::same_bits(back.intensities, cloud.intensities));
            ASSERT_EQ(back.channels.size(), cloud.channels.size());
        }
    }
}

TEST(TextPoints, ChangedBytesNeverDoHarm) {
    const std::string text = "2\n# x y z r g b\n1.5,2,3,4,5,6\n-7e3,8,9,10,11,12\n";
    const test::TemporaryFolder folder;
    for (std::uint64_t seed = 0; seed < 2000; ++seed) {
        Random random(seed);
        std::string changed = text.substr(0, 1 + random.below(static_cast<unsigned>(text.size())));
        for (std::size_t i = random.below(4); i > 0; --i) {
            changed[random.below(static_cast<unsigned>(changed.size()))] =
                static_cast<char>(random.next());
        }
        const char* name = seed % 2 == 0 ? "a.csv" : "a.ptx";
        test::write_bytes(folder / name, changed);
        try {
            EXPECT_LE(read_scan(folder / name).cloud.size(), changed.size() / 5 + 1);
        } catch (const IoError&) {
        }
    }
}

/// A scan of 2 columns and 3 rows that is turned by 90 degrees about z and moved to (10, 20, 30).
const std::string turned_ptx =
    "2\n3\n10 20 30\n0 1 0\n-1 0 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n10 20 30 1\n"
    "1 0 0 0.5 1 2 3\n0 0 0 0.5 0 0 0\n1 0 1 0.75 7 8 9\n"
    "0 2 0 0.25 1 2 3\n0 2 1 0.25 1 2 3\n0 0 0 0.500000 0 0 0\n";
const std::string plain_ptx =
    "1\n2\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"
    "4000000 0 0 1\n5 6 7 0.1\n8 9 10 0.2\n";

TEST(Ptx, ReadsAllScansWithPosesAndGrids) {
    const auto scans = read_all("hall.ptx", turned_ptx + "\r\n" + plain_ptx);
    ASSERT_EQ(scans.size(), 2U);
    EXPECT_EQ(scans[0].scan.name, "hall.ptx#1");
    EXPECT_EQ(scans[1].scan.name, "hall.ptx#2");
    const PointCloud& cloud = scans[0].scan.cloud;
    ASSERT_EQ(cloud.size(), 6U);
    ASSERT_TRUE(cloud.grid);
    EXPECT_EQ(cloud.grid->rows, 2U) << "a sweep of the scanner is a row";
    EXPECT_EQ(cloud.grid->columns, 3U);
    EXPECT_FALSE(is_finite(cloud.positions[1]));
    EXPECT_FALSE(is_finite(cloud.positions[5]));
    EXPECT_EQ(cloud.positions[2], Eigen::Vector3f(1, 0, 1));
    EXPECT_EQ(cloud.intensities[2], 0.75F);
    EXPECT_THAT(cloud.colors[2], ElementsAre(7, 8, 9));
    ASSERT_TRUE(scans[0].map_from_scan);
    const Eigen::Vector3d moved = *scans[0].map_from_scan * Eigen::Vector3d(1, 0, 0);
    EXPECT_THAT(moved, test::VectorNear(Eigen::Vector3d(10, 21, 30), 1e-12));
    EXPECT_EQ(scans[1].map_from_scan->translation().x(), 4000000.0);
    EXPECT_FALSE(scans[1].scan.cloud.grid);
    EXPECT_TRUE(scans[1].scan.cloud.colors.empty());
}

TEST(Ptx, ScansAsOneAreTheMapInFarCoordinates) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "a.ptx", plain_ptx + plain_ptx);
    const Scan map = read_scan(folder / "a.ptx");
    EXPECT_EQ(map.name, "a.ptx");
    ASSERT_EQ(map.cloud.size(), 4U);
    EXPECT_EQ(map.cloud.global_shift, Eigen::Vector3d(4000000, 0, 0));
    EXPECT_EQ(map.cloud.positions[3], Eigen::Vector3f(8, 9, 10));
}

TEST(Ptx, DamagedFilesAreRefused) {
    const auto replaced = [](const std::string& from, const std::string& to) {
        std::string text = turned_ptx;
        return text.replace(text.find(from), from.size(), to);
    };
    for (const auto& [text, reason] : std::vector<std::pair<std::string, const char*>>{
             {"x\n", "number of columns"},
             {replaced("3\n10", "4000000000\n10"), "do not fit"},
             {replaced("2\n3\n", "20\n3\n"), "do not fit"},
             {replaced("2\n3\n", "3\n3\n"), "6 of 9"},
             {replaced("0 1 0 0\n", "0 2 0 0\n"), "no rotation"},
             {replaced("0 1 0 0\n", "0 nan 0 0\n"), "4 numbers"},
             {replaced("1 0 0 0.5 1", "1 0 0 1"), "6 columns"},
             {turned_ptx + "7\n", "ends in its header"},
             {turned_ptx.substr(0, turned_ptx.size() - 38), "of 6 points"}}) {
        EXPECT_THAT(error_of("a.ptx", text), HasSubstr(reason)) << text;
    }
}

}  // namespace
}  // namespace roomscribe
