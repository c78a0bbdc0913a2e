// SPDX-License-Identifier: MIT
#include "roomscribe/report/html_report.hpp"

#include <array>
#include <cctype>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/report/html_text.hpp"
#include "roomscribe/report/viewer_bundle.hpp"
#include "support/test_data.hpp"

namespace roomscribe {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A room of 4 x 3 x 2.5 m as points on a grid, with one doubtful and one rejected component.
Reconstruction small_room() {
    Reconstruction result;
    std::vector<Scan> scans(2);
    for (Scan& scan : scans) {
        for (int i = 0; i <= 80; ++i) {
            for (int k = 0; k <= 60; ++k) {
                const float x = 0.05F * static_cast<float>(i);
                const float y = 0.05F * static_cast<float>(k);
                scan.cloud.positions.insert(scan.cloud.positions.end(),
                                            {{x, y, 0.0F}, {x, y, 2.5F}, {x, 3.0F, y / 1.2F}});
            }
        }
    }
    scans[0].name = "first.ply";
    scans[1].name = "second.ply";
    result.registration.emplace();
    result.registration->map_from_scan = {Transform::Identity(), Transform::Identity()};
    result.registration->residuals = {0.004, std::numeric_limits<double>::quiet_NaN()};
    RegistrationLink link;
    link.source = 1;
    link.verdict = LinkVerdict::ambiguous;
    link.rmse = 0.00731;
    link.inliers = 12345;
    link.covariance.diagonal().setConstant(4e-6);
    link.stop_reason = "small_step";
    result.registration->links = {link};
    result.map = merge_scans(scans, result.registration->map_from_scan);

    constexpr std::array<Label, 3> cycle{Label::floor, Label::ceiling, Label::wall};
    for (std::size_t i = 0; i < result.map.cloud.size(); ++i) {
        result.labels.labels.push_back(cycle[i % 3]);
        result.labels.instances.push_back(static_cast<std::int32_t>(i % 3));
        result.labels.confidences.push_back(0.9F);
    }
    Component wall;
    wall.id = "wall-1";
    wall.label = Label::wall;
    wall.parent = "room-1";
    wall.polygon = {{0, 3, 0}, {4, 3, 0}, {4, 3, 2.5}, {0, 3, 2.5}};
    wall.verdict = Verdict::doubtful;
    wall.evidence = {"upright plane", 4941, 0.83, 0.1, 0.0062, "side of a cupboard"};
    Component box = wall;
    box.id = "furniture-1";
    box.label = Label::furniture;
    box.kind = "cabinet";
    box.polygon.clear();
    box.box = OrientedBox{};
    box.box->center = {1, 1, 0.5};
    box.box->size = {0.6, 0.4, 1.0};
    box.verdict = Verdict::accepted;
    Component ghost = wall;
    ghost.id = "window-9";
    ghost.label = Label::window;
    ghost.verdict = Verdict::rejected;
    result.scene.components = {wall, box, ghost};
    Room room;
    room.id = "room-1";
    room.polygon = {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}};
    room.ceiling_height = 2.5;
    room.area = 12.0;
    room.volume = 30.0;
    result.scene.rooms = {room};
    result.derived_values = {{"voxel_size", 0.0213, "m", "spacing of the sparsest scan"}};
    result.stage_costs = {{"registration", 1.25, 300'000'000}};
    return result;
}

ReportInfo small_info() {
    ReportInfo info;
    info.title = "Office";
    info.picture_width = 300;
    info.run.version = "1.2.3";
    info.run.settings = list_settings(PipelineSettings{});
    info.run.inputs = {{"first.ply", 1'500'000, 0xABCULL}};
    return info;
}

/// Empty if every element is closed in order, else what is wrong. Style and script are skipped.
std::string find_unbalanced_tag(const std::string& html) {
    std::vector<std::string> open;
    std::size_t at = html.find("<html");
    while ((at = html.find('<', at)) != std::string::npos) {
        const std::size_t end = html.find('>', at);
        if (end == std::string::npos) return "a tag without end";
        std::size_t name_end = at + 1;
        while (name_end < end && (std::isalnum(static_cast<unsigned char>(html[name_end])) != 0 ||
                                  html[name_end] == '/')) {
            ++name_end;
        }
        const std::string name = html.substr(at + 1, name_end - at - 1);
        const bool closes_itself = html[end - 1] == '/';
        if (name.empty()) return "a bare < at " + html.substr(at, 20);
        if (name.front() == '/') {
            if (open.empty() || "/" + open.back() != name) return "unexpected <" + name + ">";
            open.pop_back();
        } else if (!closes_itself) {
            open.push_back(name);
            if (name == "style" || name == "script") {
                at = html.find("</" + name, end);
                continue;
            }
        }
        at = end;
    }
    return open.empty() ? "" : "unclosed <" + open.back() + ">";
}

TEST(RenderHtmlReport, ListsEveryComponentAndLink) {
    const std::string html = render_html_report(small_room(), small_info());
    for (const char* id : {"wall-1", "furniture-1", "window-9"}) {
        EXPECT_THAT(html, HasSubstr(fmt::format("<th scope=\"row\" data-sort=\"{0}\">{0} ", id)));
    }
    EXPECT_THAT(html, HasSubstr("<th scope=\"row\">room-1</th>"));
    EXPECT_THAT(html, HasSubstr("cabinet"));
    EXPECT_THAT(html, HasSubstr("Or else: side of a cupboard"));
    EXPECT_THAT(html, HasSubstr(">12,345<"));  // inliers
    EXPECT_THAT(html, HasSubstr(">7.31<"));    // RMSE in mm
    EXPECT_THAT(html, HasSubstr(">2.00<"));    // sigma of the translation in mm
    EXPECT_THAT(html, HasSubstr(">10.00<"));   // area of the wall
    EXPECT_THAT(html, HasSubstr("4.00&#8239;&#215;&#8239;2.50"));
    EXPECT_THAT(html, HasSubstr("small step"));
    EXPECT_THAT(html, HasSubstr("spacing of the sparsest scan"));
    EXPECT_THAT(html, HasSubstr("0000000000000abc"));
    EXPECT_THAT(html, HasSubstr("All settings have their default values"));
    EXPECT_THAT(html, HasSubstr("Doubtful: wall-1."));
    EXPECT_THAT(html, HasSubstr("is ambiguous"));
    EXPECT_THAT(html, HasSubstr("It shows 2 components"));
}

TEST(RenderHtmlReport, IsOneWellFormedFileThatNeedsNoNetwork) {
    std::string html = render_html_report(small_room(), small_info());
    EXPECT_EQ(find_unbalanced_tag(html), "");
    // Three.js names the namespaces of XML and pages of its manual, and asks for none.
    if (const std::string viewer = viewer_script(); !viewer.empty())
        html.erase(html.find(viewer), viewer.size());
    for (const char* link : {"http:", "https:", "//cdn", "url(", "@import", "<link", "src=\"/"}) {
        EXPECT_THAT(html, Not(HasSubstr(link)));
    }
    std::size_t num_pictures = 0;
    for (std::size_t at = 0; (at = html.find("data:image/png;base64,iVBOR", at)) != html.npos;
         ++at) {
        ++num_pictures;
    }
    EXPECT_EQ(num_pictures, 3U);
    EXPECT_LT(html.size(), 3'000'000U);
}

TEST(RenderHtmlReport, EscapesNamesFromFiles) {
    const std::string evil = "<script>alert('1')</script>\"&";
    Reconstruction result = small_room();
    result.scene.components[0].id = evil;
    result.scene.components[0].evidence.rule = evil;
    result.scene.components[0].evidence.alternative = evil;
    result.scene.components[0].kind = evil;
    result.scene.components[0].parent = evil;
    result.scene.rooms[0].id = evil;
    result.scene.rooms[0].neighbors = {{evil, evil}};
    result.map.sections[0].name = evil;
    result.derived_values[0] = {evil, 1.0, evil, evil};
    result.stage_costs[0].stage = evil;
    ReportInfo info = small_info();
    info.title = evil;
    info.run.version = evil;
    info.run.inputs[0].path = evil;
    info.run.settings[0].value = evil;
    info.run.settings[0].doc = evil;
    const std::string html = render_html_report(result, info);
    EXPECT_THAT(html, Not(HasSubstr("<script>alert")));
    EXPECT_EQ(find_unbalanced_tag(html), "");
    EXPECT_THAT(html, HasSubstr("&lt;script&gt;alert(&#39;1&#39;)&lt;/script&gt;&quot;&amp;"));
}

TEST(RenderHtmlReport, NamesFilesFromTheFolderOnThatHoldsAllOfThem) {
    ReportInfo info = small_info();
    info.run.inputs = {{"/surveys/secret/hall/first.ply", 1, 1},
                       {"/surveys/secret/second.ply", 1, 2}};
    info.run.results = {{"scene.json", 1, 3}};
    const std::string html = render_html_report(small_room(), info);
    EXPECT_THAT(html, Not(HasSubstr("secret")));
    for (const char* name : {">hall/first.ply<", ">second.ply<", ">scene.json<"})
        EXPECT_THAT(html, HasSubstr(name));
    info.run.inputs = {{"first.ply", 1, 1}, {"/surveys/second.ply", 1, 2}};
    EXPECT_THAT(render_html_report(small_room(), info), HasSubstr(">/surveys/second.ply<"));
}

TEST(RenderHtmlReport, ShowsSettingsThatDifferFromTheDefault) {
    ReportInfo info = small_info();
    info.run.settings[0].value = "4711";
    const std::string html = render_html_report(small_room(), info);
    EXPECT_THAT(html, HasSubstr("4711"));
    EXPECT_THAT(html, HasSubstr("Settings that differ"));
}

TEST(RenderHtmlReport, LeavesOutWhatIsNotThere) {
    Reconstruction result = small_room();
    result.registration.reset();
    result.map.sections.resize(1);
    const std::string interpreted = render_html_report(result, small_info());
    EXPECT_THAT(interpreted, Not(HasSubstr("<h2>Registration</h2>")));
    EXPECT_THAT(interpreted, HasSubstr("<strong>Plan</strong>"));

    Reconstruction registered = small_room();
    registered.labels = {};
    registered.scene = {};
    const std::string only_map = render_html_report(registered, small_info());
    EXPECT_THAT(only_map, Not(HasSubstr("<strong>Plan</strong>")));
    EXPECT_THAT(only_map, HasSubstr("<strong>Scans</strong>"));
    EXPECT_THAT(only_map, HasSubstr("<h2>Registration</h2>"));

    const std::string nothing = render_html_report({}, small_info());
    EXPECT_EQ(find_unbalanced_tag(nothing), "");
}

TEST(RenderHtmlReport, ShowsPiecesOfFurnitureThatHaveFrontsFromTheFront) {
    Reconstruction result = small_room();
    Component piece;
    piece.id = "furniture-1";
    piece.label = Label::furniture;
    piece.kind = "base_unit";
    piece.box =
        OrientedBox{{1.0, 1.0, 0.45},
                    {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()},
                    {1.2, 0.6, 0.9}};
    Component front;
    front.id = "furniture-2";
    front.label = Label::furniture;
    front.parent = piece.id;
    front.polygon = {{0.4, 0.7, 0.1}, {1.6, 0.7, 0.1}, {1.6, 0.7, 0.9}, {0.4, 0.7, 0.9}};
    Component handle;
    handle.id = "handle-1";
    handle.label = Label::handle;
    handle.parent = front.id;
    handle.box = OrientedBox{{1.0, 0.67, 0.8}, piece.box->axes, {0.2, 0.02, 0.02}};
    result.scene.components.push_back(piece);
    EXPECT_THAT(render_html_report(result, small_info()), Not(HasSubstr("<h2>Furniture</h2>")));
    result.scene.components.push_back(front);
    result.scene.components.push_back(handle);
    const std::string html = render_html_report(result, small_info());
    EXPECT_THAT(html, HasSubstr("<h2>Furniture</h2>"));
    EXPECT_THAT(html, HasSubstr("base unit, 1.20 &#215; 0.90 m, 1 handle"));
    EXPECT_EQ(find_unbalanced_tag(html), "");
}

TEST(RenderHtmlReport, LeadsToMapsThatCouldNotBeJoined) {
    Reconstruction result = small_room();
    result.registration->components = {{0}, {1}};
    result.apart.emplace_back().map.sections.push_back({"<second>.ply", 0, 0, std::nullopt});
    const std::string html = render_html_report(result, small_info());
    EXPECT_THAT(html, HasSubstr("<a href=\"set-2/report.html\">set-2</a>: &lt;second&gt;.ply"));
    EXPECT_THAT(html, HasSubstr("2 sets that no link joins"));
}

TEST(RenderHtmlReport, NamesAScanWithoutAPlace) {
    Reconstruction result = small_room();
    result.registration->map_from_scan[1].reset();
    for (std::size_t i = result.map.sections[1].first; i < result.map.cloud.size(); ++i) {
        result.map.cloud.positions[i].setConstant(std::nanf(""));
    }
    const std::string html = render_html_report(result, small_info());
    EXPECT_THAT(html, HasSubstr("Scan 1 second.ply has no place in the map."));
    EXPECT_THAT(html, HasSubstr("1 of 2 scans"));
}

TEST(RenderHtmlReport, BearsAMapOfNaNOnly) {
    Reconstruction result = small_room();
    result.scene = {};
    for (Eigen::Vector3f& point : result.map.cloud.positions)
        point.setConstant(std::nanf(""));
    EXPECT_EQ(find_unbalanced_tag(render_html_report(result, small_info())), "");
}

TEST(WriteHtmlReport, WritesTheFileOrThrows) {
    const test::TemporaryFolder folder;
    write_html_report(folder / "report.html", small_room(), small_info());
    EXPECT_EQ(std::filesystem::file_size(folder / "report.html"),
              render_html_report(small_room(), small_info()).size());
    EXPECT_THROW(write_html_report(folder / "absent/report.html", {}, {}), IoError);
}

TEST(EncodeBase64, GivesTheVectorsOfRfc4648) {
    const auto encode = [](std::string_view text) {
        return encode_base64(std::as_bytes(std::span(text)));
    };
    EXPECT_EQ(encode(""), "");
    EXPECT_EQ(encode("f"), "Zg==");
    EXPECT_EQ(encode("fo"), "Zm8=");
    EXPECT_EQ(encode("foo"), "Zm9v");
    EXPECT_EQ(encode("foobar"), "Zm9vYmFy");
}

TEST(HtmlText, FormatsNumbersForReading) {
    EXPECT_EQ(with_separators(0), "0");
    EXPECT_EQ(with_separators(999), "999");
    EXPECT_EQ(with_separators(1'234'567), "1,234,567");
    EXPECT_EQ(decimal(-0.001, 2), "0.00");
    EXPECT_EQ(decimal(-1.5, 1), "\u22121.5");
    EXPECT_EQ(escape_html("a\nb\x01"),
              "a\xEF\xBF\xBD"
              "b\xEF\xBF\xBD");
}

}  // namespace
}  // namespace roomscribe
