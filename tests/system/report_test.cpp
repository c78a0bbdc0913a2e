// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "roomscribe/core/units.hpp"
#include "system/program.hpp"

namespace roomscribe::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct Cell {
    std::string text;  ///< without tags
    std::string sort;  ///< the value in full, where the page has it
    double number() const { return std::stod(sort); }
};
using Row = std::vector<Cell>;

std::string between(const std::string& text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) return {};
    const std::size_t begin = at + from.size();
    return text.substr(begin, text.find(to, begin) - begin);
}

/// Rows of the table in `html` whose caption begins with these words.
std::vector<Row> read_table(const std::string& html, const std::string& caption) {
    const std::string table = between(html, "<caption>" + caption, "</table>");
    std::vector<Row> rows;
    std::size_t at = table.find("<tbody>");
    while ((at = table.find("<tr", at)) != std::string::npos) {
        const std::size_t end = table.find("</tr>", at);
        const std::string line = table.substr(at, end - at);
        static const std::regex cell("<t[hd]([^>]*)>([^]*?)</t[hd]>");
        static const std::regex tag("<[^>]*>");
        Row row;
        for (std::sregex_iterator i(line.begin(), line.end(), cell), none; i != none; ++i) {
            row.push_back({std::regex_replace((*i)[2].str(), tag, ""),
                           between((*i)[1].str(), "data-sort=\"", "\"")});
        }
        rows.push_back(std::move(row));
        at = end;
    }
    return rows;
}

/// Coordinates in scene.json are rounded to 1e-6 m, shares to as much.
constexpr double rounding = 2e-6;

std::vector<Eigen::Vector3d> corners_of(const Json& polygon) {
    std::vector<Eigen::Vector3d> corners;
    for (const Json& corner : polygon)
        corners.emplace_back(corner[0].get<double>(), corner[1].get<double>(),
                             corner[2].get<double>());
    return corners;
}

Eigen::Vector3d twice_area(const std::vector<Eigen::Vector3d>& corners) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        sum += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
    return sum;
}

double extent_along(const std::vector<Eigen::Vector3d>& corners, const Eigen::Vector3d& way) {
    double low = way.dot(corners[0]);
    double high = low;
    for (const Eigen::Vector3d& corner : corners) {
        low = std::min(low, way.dot(corner));
        high = std::max(high, way.dot(corner));
    }
    return high - low;
}

Eigen::Matrix4d matrix_of(const Json& rows) {
    Eigen::Matrix4d matrix;
    for (const int i : {0, 1, 2, 3})
        for (const int k : {0, 1, 2, 3})
            matrix(i, k) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
    return matrix;
}

Eigen::Vector3d vector_of(const Json& v) {
    return {v[0].get<double>(), v[1].get<double>(), v[2].get<double>()};
}

/// Size of a component as scene.json has it: of what stands or leans, along the horizontal and
/// across it; of what lies, along x and y of the room; of a box its extents.
std::vector<double> size_in(const Json& scene, const Json& component) {
    if (component.contains("box")) {
        const Eigen::Vector3d size = vector_of(component.at("box").at("size"));
        return {size.x(), size.y(), size.z()};
    }
    const Eigen::Matrix4d to_room = matrix_of(scene.at("to_room"));
    std::vector<Eigen::Vector3d> corners = corners_of(component.at("polygon"));
    for (Eigen::Vector3d& corner : corners)
        corner = (to_room * corner.homogeneous()).head<3>();
    const Eigen::Vector3d normal = twice_area(corners).normalized();
    const bool lies = std::abs(normal.z()) > 0.9;
    const Eigen::Vector3d along =
        lies ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ().cross(normal).normalized();
    return {extent_along(corners, along), extent_along(corners, normal.cross(along))};
}

/// Numbers in "1.20 x 0.80".
std::vector<double> numbers_in(const std::string& text) {
    static const std::regex number("[0-9]+[.][0-9]+");
    std::vector<double> numbers;
    for (std::sregex_iterator i(text.begin(), text.end(), number), none; i != none; ++i)
        numbers.push_back(std::stod(i->str()));
    return numbers;
}

void expect_numbers(const std::string& text, const std::vector<double>& wanted, double printed) {
    const std::vector<double> said = numbers_in(text);
    ASSERT_EQ(said.size(), wanted.size()) << text;
    for (std::size_t i = 0; i < said.size(); ++i)
        EXPECT_NEAR(said[i], wanted[i], printed / 2.0 + rounding) << text;
}

void expect_rooms(const std::string& html, const Json& scene) {
    const std::vector<Row> rows = read_table(html, "Heights are measured");
    const Json& rooms = scene.at("rooms");
    ASSERT_EQ(rows.size(), rooms.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_EQ(rows[i][0].text, rooms[i].at("id"));
        EXPECT_NEAR(rows[i][1].number(), rooms[i].at("area").get<double>(), rounding);
        EXPECT_NEAR(rows[i][2].number(), rooms[i].at("volume").get<double>(), rounding);
        EXPECT_NEAR(rows[i][3].number(), rooms[i].at("floor_height").get<double>(), rounding);
        EXPECT_NEAR(rows[i][4].number(), rooms[i].at("ceiling_height").get<double>(), rounding);
    }
}

void expect_components(const std::string& html, const Json& scene) {
    std::map<std::string, Row> listed;
    for (const Row& row : read_table(html, "Coverage is the share")) {
        if (row[7].text.rfind("rejected", 0) != 0) listed[row[0].sort] = row;
    }
    ASSERT_EQ(listed.size(), scene.at("components").size());
    for (const Json& component : scene.at("components")) {
        SCOPED_TRACE(component.at("id"));
        const Row& row = listed.at(component.at("id"));
        const Json& evidence = component.at("evidence");
        EXPECT_EQ(std::stoull(row[4].sort), evidence.at("points").get<std::uint64_t>());
        if (evidence.contains("rms")) {
            EXPECT_NEAR(row[6].number() / 1e3, evidence.at("rms").get<double>(), rounding);
        }
        EXPECT_EQ(row[7].text.rfind(component.at("verdict").get<std::string>(), 0), 0U);
        const bool has_shape = component.contains("box") || component.contains("polygon");
        if (!has_shape) continue;
        const std::vector<double> size = size_in(scene, component);
        EXPECT_NEAR(row[2].number(), size[0], rounding);
        expect_numbers(row[2].text, size, 0.01);
        if (component.contains("polygon")) {
            const double area = twice_area(corners_of(component.at("polygon"))).norm() / 2.0;
            // Corners are rounded: 1e-6 m along some ten metres of rim.
            EXPECT_NEAR(row[3].number(), area, 20.0 * rounding);
        }
    }
}

/// The table of doors and windows, and the elevations of walls.
void expect_drawings(const std::string& html, const Json& scene) {
    std::map<std::string, Row> listed;
    for (const Row& row : read_table(html, "Width and height are those of the leaf"))
        listed[row[0].sort] = row;
    std::size_t num_openings = 0;
    for (const Json& component : scene.at("components")) {
        const std::string label = component.at("label");
        const std::string id = component.at("id");
        SCOPED_TRACE(id);
        const bool is_opening = label == "door" || label == "window";
        if (!is_opening && label != "wall") continue;
        const std::vector<double> size = size_in(scene, component);
        if (is_opening) {
            ++num_openings;
            ASSERT_TRUE(listed.contains(id));
            EXPECT_NEAR(listed[id][3].number(), size[0], rounding);
            EXPECT_NEAR(listed[id][4].number(), size[1], rounding);
        } else {
            const std::string caption =
                between(html, "<figcaption><strong>" + id + "</strong><span>", "</span>");
            expect_numbers(caption, size, 0.01);
        }
    }
    EXPECT_EQ(listed.size(), num_openings);
}

/// The figures at the top.
void expect_key_figures(const std::string& html, const Json& scene) {
    const auto figure = [&](const std::string& name) {
        return between(html, "<dt>" + name + "</dt><dd>", "</dd>");
    };
    double area = 0.0;
    for (const Json& room : scene.at("rooms"))
        area += room.at("area").get<double>();
    expect_numbers(figure("Floor area"), {area}, 0.1);
    EXPECT_EQ(std::stoull(figure("Components")), scene.at("components").size());
    const double up = matrix_of(scene.at("to_room"))(2, 2);
    expect_numbers(figure("Levelled by"), {degrees(std::acos(std::clamp(up, -1.0, 1.0)))}, 0.1);
}

double worst_deviation(const Json& covariance, std::size_t first) {
    Eigen::Matrix3d block;
    for (const int i : {0, 1, 2})
        for (const int k : {0, 1, 2})
            block(i, k) = covariance[first + static_cast<std::size_t>(i)]
                                    [first + static_cast<std::size_t>(k)];
    return std::sqrt(
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(block).eigenvalues().maxCoeff());
}

/// Poses in the table against poses.txt: places, and turns by yaw, pitch and roll.
void expect_poses(const std::vector<Row>& rows, const std::string& poses) {
    std::istringstream lines(poses);
    std::size_t scan = 0;
    for (std::string line; std::getline(lines, line); ++scan) {
        SCOPED_TRACE(scan);
        std::istringstream words(line);
        std::array<double, 12> pose{};
        for (double& number : pose)
            words >> number;
        ASSERT_FALSE(words.fail());
        ASSERT_LT(scan, rows.size());
        const Row& row = rows[scan];
        Eigen::Matrix3d rotation;
        for (const std::size_t i : {0U, 1U, 2U}) {
            EXPECT_NEAR(row[2 + i].number(), pose[4 * i + 3], rounding);
            for (const std::size_t k : {0U, 1U, 2U})
                rotation(static_cast<int>(i), static_cast<int>(k)) = pose[4 * i + k];
        }
        const auto turn = [&](std::size_t column, const Eigen::Vector3d& axis) {
            return Eigen::AngleAxisd(radians(row[column].number()), axis);
        };
        const Eigen::Matrix3d said =
            (turn(5, Eigen::Vector3d::UnitZ()) * turn(6, Eigen::Vector3d::UnitY()) *
             turn(7, Eigen::Vector3d::UnitX()))
                .toRotationMatrix();
        EXPECT_LT((said - rotation).norm(), rounding);
    }
    EXPECT_EQ(scan, rows.size());
}

TEST(Report, SaysWhatSceneAndRegistrationSay) {
    const TemporaryFolder folder;
    const fs::path out = folder / "out";
    std::vector<std::string> arguments = write_room_scans(folder.path(), 3);
    arguments.insert(arguments.begin(), "run");
    arguments.insert(arguments.end(), {"-o", out.string()});
    ASSERT_EQ(roomscribe(arguments).exit_code, 0);
    const std::string html = read_bytes(out / "report.html");
    expect_rooms(html, read_json(out / "scene.json"));
    expect_components(html, read_json(out / "scene.json"));
    expect_drawings(html, read_json(out / "scene.json"));
    expect_key_figures(html, read_json(out / "scene.json"));

    const Json registration = read_json(out / "registration.json");
    const std::vector<Row> links = read_table(html, "Sigma is one standard deviation");
    ASSERT_EQ(links.size(), registration.at("links").size());
    ASSERT_FALSE(links.empty());
    for (std::size_t i = 0; i < links.size(); ++i) {
        const Json& link = registration.at("links")[i];
        EXPECT_EQ(std::stoull(links[i][0].sort), link.at("source").get<std::uint64_t>());
        EXPECT_EQ(std::stoull(links[i][1].sort), link.at("target").get<std::uint64_t>());
        EXPECT_EQ(links[i][2].text, link.at("verdict"));
        EXPECT_NEAR(links[i][3].number() / 100, link.at("probability").get<double>(), rounding);
        EXPECT_NEAR(links[i][5].number() / 100, link.at("overlap").get<double>(), rounding);
        EXPECT_NEAR(links[i][7].number() / 1e3, link.at("rmse").get<double>(), rounding);
        EXPECT_EQ(std::stoull(links[i][8].sort), link.at("inliers").get<std::uint64_t>());
        EXPECT_EQ(links[i][4].text, link.at("loops"));
        EXPECT_NEAR(links[i][6].number() / 100, link.at("agreement").get<double>(), rounding);
        // Covariances have six digits.
        const Json& covariance = link.at("covariance");
        const double shift = worst_deviation(covariance, 3);
        const double turn = worst_deviation(covariance, 0);
        EXPECT_NEAR(links[i][9].number() / 1e3, shift, 1e-4 * shift);
        EXPECT_NEAR(radians(links[i][10].number()), turn, 1e-4 * turn);
        EXPECT_EQ(std::stoull(links[i][11].sort), link.at("unobservable").size());
        std::string reason = link.at("stop_reason");
        std::replace(reason.begin(), reason.end(), '_', ' ');
        EXPECT_EQ(links[i][12].text, reason);
    }
    const std::vector<Row> poses = read_table(html, "Each scan");
    ASSERT_EQ(poses.size(), registration.at("scans").size());
    expect_poses(poses, read_bytes(out / "poses.txt"));
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const Json& scan = registration.at("scans")[i];
        EXPECT_NE(poses[i][0].text.find(scan.at("name").get<std::string>()), std::string::npos);
        if (scan.at("residual").is_number()) {
            EXPECT_NEAR(poses[i][8].number() / 1e3, scan.at("residual").get<double>(), rounding);
            EXPECT_NEAR(poses[i][9].number() / 100, scan.at("overlap").get<double>(), rounding);
        }
    }
    const Json run = read_json(out / "run.json");
    const std::vector<Row> files = read_table(html, "xxh64sum gives");
    ASSERT_EQ(files.size(), run.at("inputs").size() + run.at("results").size());
    EXPECT_EQ(files.back()[0].text, "scene.json");
    EXPECT_EQ(files.back()[3].text, run.at("results").back().at("xxh64"));
}

TEST(Report, OfAFloorOfTwentyScansCanBeMailed) {
    const TemporaryFolder folder;
    const fs::path floor = folder / "floor";
    const fs::path out = folder / "out";
    ASSERT_EQ(
        roomscribe({"simulate", "floor", "--coarseness", "12", "-o", floor.string()}).exit_code, 0);
    std::vector<std::string> arguments{"interpret"};
    for (const auto& entry : fs::directory_iterator(floor / "scans"))
        arguments.push_back(entry.path().string());
    std::sort(arguments.begin() + 1, arguments.end());
    EXPECT_GE(arguments.size(), 21U);
    for (const std::string& more :
         {std::string("--poses"), (floor / "truth" / "poses.txt").string(), std::string("-o"),
          out.string()})
        arguments.push_back(more);
    ASSERT_EQ(roomscribe(arguments).exit_code, 0);
    const std::string html = read_bytes(out / "report.html");
    EXPECT_LT(html.size(), 60'000'000U);
    expect_rooms(html, read_json(out / "scene.json"));
    expect_components(html, read_json(out / "scene.json"));
    expect_drawings(html, read_json(out / "scene.json"));
    expect_key_figures(html, read_json(out / "scene.json"));
    // run.json is written right before the report.
    const auto writing =
        fs::last_write_time(out / "report.html") - fs::last_write_time(out / "run.json");
    EXPECT_LT(std::chrono::duration<double>(writing).count(), 10.0);
}

}  // namespace
}  // namespace roomscribe::test
