// SPDX-License-Identifier: MIT
#include "roomscribe/report/report_tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "roomscribe/core/units.hpp"
#include "roomscribe/evaluation/results_table.hpp"
#include "roomscribe/pipeline/pipeline_settings.hpp"
#include "roomscribe/report/html_text.hpp"

namespace roomscribe {
namespace {

constexpr std::string_view times = "&#8239;&#215;&#8239;";
constexpr std::string_view dash = "&#8211;";

/// Normal of a polygon, as long as twice its area (Newell's method).
Eigen::Vector3d newell_normal(const std::vector<Eigen::Vector3d>& polygon) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        // Relative to a corner: far coordinates would cost digits.
        const Eigen::Vector3d a = polygon[i] - polygon[0];
        const Eigen::Vector3d b = polygon[(i + 1) % polygon.size()] - polygon[0];
        sum += a.cross(b);
    }
    return sum;
}

std::optional<double> area_of(const Component& component) {
    if (component.polygon.size() < 3) return std::nullopt;
    return newell_normal(component.polygon).norm() / 2.0;
}

/// Width by height in metres: of an upright polygon along and across the horizontal, of a level one
/// along x and y of the room; of a box its three extents. Empty where there is none.
std::vector<double> size_of(const Component& component, const Transform& room_from_map) {
    if (component.box) {
        const Eigen::Vector3d& size = component.box->size;
        return {size.x(), size.y(), size.z()};
    }
    if (component.polygon.size() < 3) return {};
    const Eigen::Vector3d normal =
        (room_from_map.linear() * newell_normal(component.polygon)).normalized();
    const bool is_level = std::abs(normal.z()) > 0.9;
    const Eigen::Vector3d across =
        is_level ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ().cross(normal).normalized();
    const Eigen::Vector3d up = normal.cross(across);
    Eigen::AlignedBox2d extent;
    for (const Eigen::Vector3d& corner : component.polygon) {
        const Eigen::Vector3d p = room_from_map.linear() * (corner - component.polygon[0]);
        extent.extend(Eigen::Vector2d(across.dot(p), up.dot(p)));
    }
    return {extent.sizes().x(), extent.sizes().y()};
}

/// In order of the first extent, the width.
void put_size(HtmlTable& table, const std::vector<double>& size) {
    if (size.empty()) return table.html(dash);
    std::string words;
    for (const double extent : size)
        words += fmt::format("{}{:.2f}", words.empty() ? "" : times, extent);
    table.html(words, fmt::format("{}", size.front()));
}

std::optional<double> times_thousand(const std::optional<double>& value) {
    return value ? std::optional(1000.0 * *value) : std::nullopt;
}
std::optional<double> in_percent(const std::optional<double>& value) {
    return value ? std::optional(100.0 * *value) : std::nullopt;
}

/// Standard deviation along the worst direction of a 3x3 block of a covariance.
double worst_deviation(const Eigen::Matrix3d& covariance) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
    return std::sqrt(std::max(solver.eigenvalues().maxCoeff(), 0.0));
}

std::string css_class_of(Verdict verdict) {
    return verdict == Verdict::rejected ? "muted" : "";
}

std::string megabytes(std::size_t bytes) {
    return fmt::format("{:.0f}", static_cast<double>(bytes) / 1e6);
}

}  // namespace

std::string rooms_table(const Reconstruction& reconstruction) {
    HtmlTable table("Heights are measured from the floor of the room frame.",
                    {{"Room", false},
                     {"Area (m\u00b2)", true},
                     {"Volume (m\u00b3)", true},
                     {"Floor (m)", true},
                     {"Ceiling (m)", true},
                     {"Walls", true},
                     {"Leads to", false}});
    for (const Room& room : reconstruction.scene.rooms) {
        table.begin_row();
        table.text(room.id);
        table.number(room.area, 2);
        table.number(room.volume, 2);
        table.number(room.floor_height, 3);
        table.number(room.ceiling_height, 3);
        table.count(room.walls.size());
        std::string neighbors;
        for (const RoomNeighbor& neighbor : room.neighbors) {
            if (!neighbors.empty()) neighbors += ", ";
            neighbors += neighbor.room;
            if (!neighbor.through.empty()) neighbors += " through " + neighbor.through;
        }
        table.text(neighbors.empty() ? "\u2013" : neighbors);
    }
    return table.finish();
}

std::string components_table(const Reconstruction& reconstruction) {
    HtmlTable table(
        "Coverage is the share of the outline that points cover; RMS their distance to its plane. "
        "Rejected components are not in scene.json.",
        {{"Component", false},
         {"What", false},
         {"Size (m)", true},
         {"Area (m\u00b2)", true},
         {"Points", true},
         {"Coverage (%)", true},
         {"RMS (mm)", true},
         {"Verdict, confidence", false},
         {"Why", false}});
    for (const Component& component : reconstruction.scene.components) {
        const Evidence& evidence = component.evidence;
        table.begin_row(css_class_of(component.verdict));
        const std::string parent =
            component.parent.empty()
                ? std::string()
                : fmt::format(" <small>in {}</small>", escape_html(component.parent));
        table.html(escape_html(component.id) + parent, component.id);
        const std::string label = in_words(label_name(component.label));
        const std::string what = component.kind.empty() ? label : in_words(component.kind);
        table.html(fmt::format("<span class=\"nowrap\"><i class=\"swatch label-{}\"></i>{}</span>",
                               label_name(component.label), escape_html(what)),
                   fmt::format("{} {}", label, what));
        put_size(table, size_of(component, reconstruction.scene.room_from_map));
        table.number(area_of(component), 2);
        table.count(evidence.points);
        table.number(in_percent(evidence.coverage), 0);
        table.number(times_thousand(evidence.rms), 1);
        const std::string_view verdict = verdict_name(component.verdict);
        table.html(fmt::format("{} <small>{:.0f} %</small>", verdict_mark(verdict),
                               100.0 * component.confidence),
                   fmt::format("{} {:03.0f}", verdict, 100.0 * component.confidence));
        std::string why = escape_html(evidence.rule);
        if (!evidence.alternative.empty()) {
            why += fmt::format(" <small>Or else: {}</small>", escape_html(evidence.alternative));
        }
        table.html(fmt::format("<div class=\"wide\">{}</div>", why));
    }
    return table.finish();
}

std::string links_table(const Reconstruction& reconstruction) {
    if (!reconstruction.registration) return {};
    HtmlTable table(
        "Sigma is one standard deviation along the direction that is known least; free directions "
        "are those along which the scans slide on each other.",
        {{"Source", false},
         {"Target", false},
         {"Verdict", false},
         {"Probability (%)", true},
         {"Loops", false},
         {"Overlap (%)", true},
         {"Agreement (%)", true},
         {"RMSE (mm)", true},
         {"Inliers", true},
         {"Sigma translation (mm)", true},
         {"Sigma rotation (\u00b0)", true},
         {"Free directions", true},
         {"Stopped because", false}});
    const std::vector<MapSection>& sections = reconstruction.map.sections;
    const auto put_scan = [&](std::size_t scan) {
        const std::string name = scan < sections.size() ? sections[scan].name : std::string();
        table.html(fmt::format("{} <small>{}</small>", scan, escape_html(name)),
                   fmt::format("{}", scan));
    };
    for (const RegistrationLink& link : reconstruction.registration->links) {
        table.begin_row(link.verdict == LinkVerdict::rejected ? "muted" : "");
        put_scan(link.source);
        put_scan(link.target);
        table.html(verdict_mark(link_verdict_name(link.verdict)));
        table.number(100.0 * link.probability, 1);
        table.text(loop_check_name(link.loops));
        table.number(100.0 * link.overlap, 1);
        table.number(100.0 * link.agreement, 1);
        table.number(1000.0 * link.rmse, 2);
        table.count(link.inliers);
        table.number(1000.0 * worst_deviation(link.covariance.bottomRightCorner<3, 3>()), 2);
        table.number(degrees(worst_deviation(link.covariance.topLeftCorner<3, 3>())), 4);
        table.count(link.unobservable.size());
        table.text(in_words(link.stop_reason));
    }
    return table.finish();
}

std::string poses_table(const Reconstruction& reconstruction) {
    if (!reconstruction.registration) return {};
    const Registration& registration = *reconstruction.registration;
    HtmlTable table(
        "Each scan's frame in the map frame; turned by yaw about z, then pitch about y, then roll "
        "about x.",
        {{"Scan", false},
         {"Points", true},
         {"x (m)", true},
         {"y (m)", true},
         {"z (m)", true},
         {"Yaw (\u00b0)", true},
         {"Pitch (\u00b0)", true},
         {"Roll (\u00b0)", true},
         {"Residual (mm)", true},
         {"Overlap (%)", true}});
    for (std::size_t i = 0; i < registration.map_from_scan.size(); ++i) {
        const std::optional<Transform>& pose = registration.map_from_scan[i];
        const bool has_section = i < reconstruction.map.sections.size();
        table.begin_row(pose ? "" : "muted");
        table.text(has_section ? fmt::format("{} {}", i, reconstruction.map.sections[i].name)
                               : fmt::format("{}", i));
        table.count(has_section ? reconstruction.map.sections[i].count : 0);
        std::array<std::optional<double>, 6> numbers;
        if (pose) {
            const Eigen::Matrix3d r = pose->linear();
            const Eigen::Vector3d t = pose->translation();
            numbers = {t.x(),
                       t.y(),
                       t.z(),
                       degrees(std::atan2(r(1, 0), r(0, 0))),
                       degrees(std::asin(std::clamp(-r(2, 0), -1.0, 1.0))),
                       degrees(std::atan2(r(2, 1), r(2, 2)))};
        }
        for (std::size_t k = 0; k < numbers.size(); ++k)
            table.number(numbers[k], k < 3 ? 3 : 2);
        const bool has_residual = i < registration.residuals.size();
        table.number(
            has_residual ? std::optional(1000.0 * registration.residuals[i]) : std::nullopt, 2);
        table.number(i < registration.overlaps.size()
                         ? std::optional(100.0 * registration.overlaps[i])
                         : std::nullopt,
                     1);
    }
    return table.finish();
}

std::string derived_values_table(const Reconstruction& reconstruction) {
    HtmlTable table("What the program chose from the data, and why.",
                    {{"Value", false}, {"Chosen", true}, {"Why", false}});
    for (const DerivedValue& derived : reconstruction.derived_values) {
        table.begin_row();
        table.html(fmt::format("<code>{}</code>", escape_html(derived.name)));
        table.html(fmt::format("{:.4g} {}", derived.value, escape_html(derived.unit)),
                   fmt::format("{}", derived.value));
        table.html(fmt::format("<div class=\"wide\">{}</div>", escape_html(derived.reason)));
    }
    return table.finish();
}

std::string changed_settings_table(const RunRecord& run) {
    std::map<std::string, std::string> defaults;
    for (const SettingEntry& entry : list_settings(PipelineSettings{})) {
        defaults[entry.name] = entry.value;
    }
    HtmlTable table("Settings that differ from their defaults.",
                    {{"Setting", false}, {"Value", true}, {"Default", true}, {"Meaning", false}});
    for (const SettingEntry& entry : run.settings) {
        const auto found = defaults.find(entry.name);
        if (found != defaults.end() && found->second == entry.value) continue;
        table.begin_row();
        table.html(fmt::format("<code>{}</code>", escape_html(entry.name)));
        table.text(entry.unit.empty() ? entry.value : entry.value + " " + entry.unit);
        table.text(found == defaults.end() ? "\u2013" : found->second);
        table.text(entry.doc);
    }
    return table.finish();
}

std::string stages_table(const Reconstruction& reconstruction) {
    double total = 0.0;
    for (const StageCost& cost : reconstruction.stage_costs)
        total += cost.seconds;
    HtmlTable table(
        fmt::format("{:.2f} s in all. Memory is the most that the process had held by "
                    "the end of the stage.",
                    total),
        {{"Stage", false}, {"Time (s)", true}, {"Share", false}, {"Memory (MB)", true}});
    for (const StageCost& cost : reconstruction.stage_costs) {
        table.begin_row();
        table.text(in_words(cost.stage));
        table.number(cost.seconds, 2);
        const double share = total > 0.0 ? 100.0 * cost.seconds / total : 0.0;
        table.html(
            fmt::format("<span class=\"bar\"><span style=\"width:{:.1f}%\"></span></span>", share),
            fmt::format("{:.1f}", share));
        table.html(megabytes(cost.peak_memory), fmt::format("{}", cost.peak_memory));
    }
    return table.finish();
}

std::string scores_tables(const EvaluationSummary& score) {
    std::string html;
    for (const ScoreTable& scores : score_tables(score)) {
        std::vector<HtmlColumn> columns;
        for (const std::string& title : scores.rows.front())
            columns.push_back({title, !columns.empty()});
        HtmlTable table(scores.group, std::move(columns));
        for (std::size_t row = 1; row < scores.rows.size(); ++row) {
            table.begin_row();
            for (const std::string& cell : scores.rows[row])
                table.text(cell);
        }
        html += table.finish();
    }
    return html;
}

std::string files_table(std::span<const FileRecord> files) {
    HtmlTable table("xxh64sum gives the same hashes.",
                    {{"File", false}, {"Holds", false}, {"Size (MB)", true}, {"XXH64", false}});
    for (const FileRecord& file : files) {
        table.begin_row();
        table.html(fmt::format("<span class=\"break\">{}</span>", escape_html(file.path)));
        table.text(file_role_name(file.role));
        table.number(static_cast<double>(file.size) / 1e6, 2);
        table.html(fmt::format("<code>{:016x}</code>", file.xxh64));
    }
    return table.finish();
}

}  // namespace roomscribe
