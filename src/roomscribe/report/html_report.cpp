// SPDX-License-Identifier: MIT
#include "roomscribe/report/html_report.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "roomscribe/core/units.hpp"
#include "roomscribe/io/atomic_file.hpp"
#include "roomscribe/report/html_text.hpp"
#include "roomscribe/report/report_drawings.hpp"
#include "roomscribe/report/report_figures.hpp"
#include "roomscribe/report/report_style.hpp"
#include "roomscribe/report/report_tables.hpp"
#include "roomscribe/report/report_views.hpp"
#include "roomscribe/report/schedule_tables.hpp"
#include "roomscribe/report/stage_figures.hpp"
#include "roomscribe/report/viewer_bundle.hpp"
#include "roomscribe/report/viewer_model.hpp"
#include "roomscribe/report/viewer_points.hpp"

namespace roomscribe {
namespace {

/// Names from the folder on that all files lie in: a report is sent on, and where its sender keeps
/// the scans is not for everyone. `run.json` has the whole paths.
std::vector<FileRecord> without_common_folder(std::vector<FileRecord> files) {
    if (files.empty()) return files;
    std::filesystem::path common = std::filesystem::path(files.front().path).parent_path();
    for (const FileRecord& file : files) {
        const std::filesystem::path folder = std::filesystem::path(file.path).parent_path();
        const auto differ =
            std::mismatch(common.begin(), common.end(), folder.begin(), folder.end()).first;
        std::filesystem::path shared;
        for (auto part = common.begin(); part != differ; ++part)
            shared /= *part;
        common = std::move(shared);
    }
    if (common.empty()) return files;
    for (FileRecord& file : files)
        file.path = std::filesystem::path(file.path).lexically_relative(common).generic_string();
    return files;
}

std::size_t num_listed(const Scene& scene) {
    return static_cast<std::size_t>(std::count_if(
        scene.components.begin(), scene.components.end(),
        [](const Component& component) { return component.verdict != Verdict::rejected; }));
}

std::size_t num_placed(const Registration& registration) {
    return static_cast<std::size_t>(
        std::count_if(registration.map_from_scan.begin(), registration.map_from_scan.end(),
                      [](const auto& pose) { return pose.has_value(); }));
}

double total_seconds(const Reconstruction& reconstruction) {
    double sum = 0.0;
    for (const StageCost& cost : reconstruction.stage_costs)
        sum += cost.seconds;
    return sum;
}

/// The result in two sentences.
std::string lead(const Reconstruction& reconstruction) {
    const std::string points = counted(reconstruction.map.cloud.size(), "point");
    std::string text;
    if (reconstruction.registration) {
        const Registration& registration = *reconstruction.registration;
        const std::size_t num_scans = registration.map_from_scan.size();
        const std::size_t placed = num_placed(registration);
        text = placed == num_scans
                   ? fmt::format("{} with {} in one map.", counted(num_scans, "scan"), points)
                   : fmt::format("{} of {} with {} in one map.", placed, counted(num_scans, "scan"),
                                 points);
    } else {
        text = fmt::format("A map of {}.", points);
    }
    if (has_labels(reconstruction)) {
        text +=
            fmt::format(" It shows {}.", counted(num_listed(reconstruction.scene), "component"));
    }
    return text;
}

std::string key_figure(std::string_view name, std::string_view value_html) {
    return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", name, value_html);
}

/// "18.4 m2", "2.71 m": of one room, or from the least to the most of several.
std::string range_of(std::vector<double> values, int decimals, std::string_view unit) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const std::string from = fmt::format("{:.{}f}", *low, decimals);
    const std::string to = fmt::format("{:.{}f}", *high, decimals);
    return from == to ? fmt::format("{} <small>{}</small>", from, unit)
                      : fmt::format("{}&#8211;{} <small>{}</small>", from, to, unit);
}

/// Floor plan extents of the rooms along the room frame's axes.
std::string extent_of_rooms(const Scene& scene) {
    Eigen::AlignedBox3d box;
    for (const Room& room : scene.rooms) {
        for (const Eigen::Vector3d& corner : room.polygon) {
            box.extend(Eigen::Vector3d(scene.room_from_map * corner));
        }
    }
    if (box.isEmpty()) return "&#8211;";
    return fmt::format("{:.1f}&#8239;&#215;&#8239;{:.1f} <small>m</small>", box.sizes().x(),
                       box.sizes().y());
}

std::string key_figures(const Reconstruction& reconstruction) {
    const Scene& scene = reconstruction.scene;
    std::string html = "<dl class=\"figures\">\n";
    if (has_labels(reconstruction)) {
        if (!scene.rooms.empty()) {
            double area = 0.0;
            std::vector<double> heights;
            for (const Room& room : scene.rooms) {
                area += room.area;
                heights.push_back(room.ceiling_height - room.floor_height);
            }
            html += key_figure("Floor area", fmt::format("{:.1f} <small>m&#178;</small>", area));
            html += key_figure("Extent", extent_of_rooms(scene));
            html += key_figure("Room height", range_of(heights, 2, "m"));
        }
        html += key_figure("Components", with_separators(num_listed(scene)));
        // How far the map's z axis leans from the vertical that was found.
        const double up = std::clamp(scene.room_from_map.linear()(2, 2), -1.0, 1.0);
        html += key_figure("Levelled by", fmt::format("{:.1f}&#176;", degrees(std::acos(up))));
    }
    if (reconstruction.registration) {
        const Registration& registration = *reconstruction.registration;
        html += key_figure("Scans placed",
                           fmt::format("{} <small>of {}</small>", num_placed(registration),
                                       registration.map_from_scan.size()));
    }
    if (!reconstruction.stage_costs.empty()) {
        html += key_figure("Computing time",
                           fmt::format("{:.1f} <small>s</small>", total_seconds(reconstruction)));
    }
    return html + "</dl>\n";
}

std::string scan_name(const ScanMap& map, std::size_t scan) {
    return scan < map.sections.size() ? fmt::format("{} {}", scan, map.sections[scan].name)
                                      : fmt::format("{}", scan);
}

/// What somebody should look at before trusting the result.
std::vector<std::string> things_to_check(const Reconstruction& reconstruction) {
    std::vector<std::string> checks;
    if (reconstruction.registration) {
        const Registration& registration = *reconstruction.registration;
        if (registration.components.size() > 1) {
            checks.push_back(fmt::format(
                "The scans fall into {} sets that no link joins: the largest is this map.",
                registration.components.size()));
        }
        for (std::size_t i = 0; i < registration.map_from_scan.size(); ++i) {
            const std::string name = scan_name(reconstruction.map, i);
            if (!registration.map_from_scan[i]) {
                checks.push_back(fmt::format("Scan {} has no place in the map.", name));
            } else if (i < registration.is_doubtful.size() && registration.is_doubtful[i]) {
                checks.push_back(fmt::format(
                    "Scan {} is held by ambiguous links alone: its place is a guess.", name));
            }
        }
        for (const RegistrationLink& link : registration.links) {
            const std::string pair =
                fmt::format("scan {} to scan {}", scan_name(reconstruction.map, link.source),
                            scan_name(reconstruction.map, link.target));
            if (link.verdict == LinkVerdict::ambiguous) {
                checks.push_back(
                    fmt::format("The link from {} is ambiguous: another pose fits as well.", pair));
            } else if (link.verdict == LinkVerdict::accepted && !link.unobservable.empty()) {
                checks.push_back(fmt::format("The link from {} leaves {} free.", pair,
                                             counted(link.unobservable.size(), "direction")));
            }
        }
    }
    std::string doubtful;
    for (const Component& component : reconstruction.scene.components) {
        if (component.verdict != Verdict::doubtful) continue;
        doubtful += (doubtful.empty() ? "" : ", ") + component.id;
    }
    if (!doubtful.empty()) {
        checks.push_back(fmt::format("Doubtful: {}. The table of components says why.", doubtful));
    }
    if (has_labels(reconstruction) && reconstruction.scene.components.empty()) {
        checks.emplace_back("Nothing was recognised in this map.");
    }
    return checks;
}

std::string check_list(const Reconstruction& reconstruction) {
    const std::vector<std::string> checks = things_to_check(reconstruction);
    if (checks.empty()) return {};
    std::string html = "<section class=\"checks\"><h2>To check</h2><ul>\n";
    for (const std::string& check : checks)
        html += "<li>" + escape_html(check) + "</li>\n";
    return html + "</ul></section>\n";
}

/// The reports of the scans that could not be joined to this map.
std::string maps_apart(const Reconstruction& reconstruction) {
    if (reconstruction.apart.empty()) return {};
    std::string html =
        "<p>Scans that could not be joined to this map are maps of their own:</p><ul>\n";
    for (std::size_t i = 0; i < reconstruction.apart.size(); ++i) {
        const std::string folder = folder_of_apart(i);
        const auto& sections = reconstruction.apart[i].map.sections;
        std::string names;
        for (const MapSection& section : sections)
            names += (names.empty() ? "" : ", ") + section.name;
        html += fmt::format("<li><a href=\"{0}/report.html\">{0}</a>: {1}</li>\n", folder,
                            escape_html(names));
    }
    return html + "</ul>\n";
}

/// A headed section, or nothing if its content is empty.
std::string section(std::string_view title, const std::string& content) {
    if (content.empty()) return {};
    return fmt::format("<section>\n<h2>{}</h2>\n{}</section>\n", title, content);
}

std::string pictures(const Reconstruction& reconstruction, std::size_t width,
                     const Context& context) {
    if (reconstruction.map.cloud.empty()) return {};
    std::string html;
    if (has_labels(reconstruction)) {
        html += plan_figure(reconstruction, width, context);
        html += section_figure(reconstruction, width, context);
    }
    return html + scans_figure(reconstruction, width, context);
}

std::string settings_part(const RunRecord& run) {
    if (run.settings.empty()) return {};
    const std::string changed = changed_settings_table(run);
    return changed.empty() ? "<p class=\"note\">All settings have their default values.</p>\n"
                           : changed;
}

/// Where the 3D view goes, and what it shows; the program that draws it comes last on the page.
std::string viewer_part(const Reconstruction& reconstruction, std::size_t budget,
                        const Context& context) {
    if (budget == 0 || reconstruction.map.cloud.empty()) return {};
    if (viewer_script().empty()) {
        return "<p class=\"note\">This roomscribe was built without its 3D view, which needs npm "
               "once: <code>./dev viewer</code>, then <code>./dev build</code>.</p>\n";
    }
    const GriddedPoints points = grid_points(reconstruction, scanned_box(reconstruction), context);
    const std::vector<std::uint32_t> chosen = thin_points(points, budget);
    const std::string packed = pack_points(reconstruction, points, chosen);
    std::string html =
        "<div id=\"viewer\"><p class=\"note\">The 3D view needs JavaScript.</p></div>\n";
    html += fmt::format("<script type=\"application/json\" id=\"viewer-model\">{}</script>\n",
                        viewer_model_json(reconstruction, points, chosen.size()));
    html += fmt::format("<script type=\"text/plain\" id=\"viewer-points\">{}</script>\n",
                        encode_base64(std::as_bytes(std::span(packed))));
    return html;
}

}  // namespace

std::string render_html_report(const Reconstruction& reconstruction, const ReportInfo& info,
                               const Context& context) {
    const std::string title = escape_html(info.title);
    const RunRecord& run = info.run;
    std::string html = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
        "<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n<header>\n<h1>{}</h1>\n"
        "<p class=\"lead\">{}</p>\n</header>\n<main>\n",
        title, report_style(), title, lead(reconstruction));
    html += key_figures(reconstruction);
    html += check_list(reconstruction);
    html += section("Other maps", maps_apart(reconstruction));
    html += section("3D view", viewer_part(reconstruction, info.viewer_points, context));
    html += section("Pictures", pictures(reconstruction, info.picture_width, context));
    html += section("Drawings", floor_plan_drawing(reconstruction.scene));
    html += section("Elevations", wall_elevations(reconstruction.scene));
    html += section("Furniture", furniture_figures(reconstruction, context));
    html += section("Stages", stage_figures(reconstruction, context));
    html += section("Rooms", rooms_table(reconstruction));
    html += section("Doors and windows", openings_table(reconstruction.scene));
    html += section("Handles", handles_table(reconstruction.scene));
    html += section("Components", components_table(reconstruction));
    html += section("Registration", links_table(reconstruction) + poses_table(reconstruction));
    html += section("Score against truth", info.score ? scores_tables(*info.score) : std::string());
    html += section("Derived values", derived_values_table(reconstruction));
    html += section("Settings", settings_part(run));
    html += section("Cost", stages_table(reconstruction));
    std::vector<FileRecord> files = without_common_folder(run.inputs);
    files.insert(files.end(), run.results.begin(), run.results.end());
    html += section("Files", files_table(files));
    html +=
        fmt::format("</main>\n<footer>roomscribe {}{}</footer>\n<script>{}</script>\n",
                    escape_html(run.version),
                    run.num_threads > 0
                        ? fmt::format(" &#183; {}",
                                      counted(static_cast<std::size_t>(run.num_threads), "thread"))
                        : std::string(),
                    report_script());
    if (html.find("<div id=\"viewer\">") != std::string::npos)
        html += "<script>" + viewer_script() + "</script>\n";
    html += "</body>\n</html>\n";
    return html;
}

void write_html_report(const std::filesystem::path& path, const Reconstruction& reconstruction,
                       const ReportInfo& info, const Context& context) {
    write_file(path, "HTML", render_html_report(reconstruction, info, context));
}

}  // namespace roomscribe
