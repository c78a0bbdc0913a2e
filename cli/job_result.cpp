// SPDX-License-Identifier: MIT
#include "cli/job_result.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/text_table.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/evaluation/results_table.hpp"
#include "roomscribe/pipeline/workspace.hpp"

namespace roomscribe::cli {
namespace {

using Json = nlohmann::ordered_json;

struct LabelSummary {
    std::size_t components = 0;
    std::size_t points = 0;
    double coverage_sum = 0.0;
    std::size_t with_coverage = 0;

    std::optional<double> mean_coverage() const {
        if (with_coverage == 0) return std::nullopt;
        return coverage_sum / static_cast<double>(with_coverage);
    }
};

std::array<LabelSummary, num_labels> summarize_labels(const Reconstruction& reconstruction) {
    std::array<LabelSummary, num_labels> summaries;
    for (const Component& component : reconstruction.scene.components) {
        LabelSummary& summary = summaries[static_cast<std::size_t>(component.label)];
        ++summary.components;
        if (component.evidence.coverage) {
            summary.coverage_sum += *component.evidence.coverage;
            ++summary.with_coverage;
        }
    }
    for (const Label label : reconstruction.labels.labels) {
        ++summaries[static_cast<std::size_t>(label)].points;
    }
    return summaries;
}

bool is_interpreted(const Reconstruction& reconstruction) {
    return !reconstruction.labels.labels.empty();
}

bool is_placed(const Reconstruction& reconstruction, std::size_t scan) {
    return !reconstruction.registration ||
           reconstruction.registration->map_from_scan[scan].has_value();
}

std::optional<double> residual_of(const Reconstruction& reconstruction, std::size_t scan) {
    const auto& registration = reconstruction.registration;
    if (!registration || scan >= registration->residuals.size()) return std::nullopt;
    const double residual = registration->residuals[scan];
    return std::isfinite(residual) ? std::optional(residual) : std::nullopt;
}

/// Along the axes of the room frame, over all floors, ceilings and walls; empty if there are none.
Eigen::AlignedBox3d extent_of_rooms(const Scene& scene) {
    Eigen::AlignedBox3d extent;
    for (const Component& component : scene.components) {
        if (component.label != Label::floor && component.label != Label::ceiling &&
            component.label != Label::wall) {
            continue;
        }
        for (const Eigen::Vector3d& corner : component.polygon) {
            extent.extend(scene.room_from_map * corner);
        }
    }
    return extent;
}

/// Angle between the map's z axis and the true vertical.
double tilt_of_map(const Scene& scene) {
    return std::acos(std::clamp(scene.room_from_map.linear()(2, 2), -1.0, 1.0));
}

std::string percent(double share) {
    return fmt::format("{:.0f} %", 100.0 * share);
}

std::string millimetres(double metres) {
    return fmt::format("{:.1f} mm", 1000.0 * metres);
}

/// Largest share that the scan has in common with another one.
std::optional<double> overlap_of(const Reconstruction& reconstruction, std::size_t scan) {
    const auto& registration = reconstruction.registration;
    if (!registration || scan >= registration->overlaps.size()) return std::nullopt;
    return registration->overlaps[scan];
}

/// Number of the set of scans, from 1, that a scan is joined to; 1 is the map.
std::size_t set_of(const Registration& registration, std::size_t scan) {
    const auto& sets = registration.components;
    const auto set = std::find_if(sets.begin(), sets.end(), [scan](const auto& scans) {
        return std::find(scans.begin(), scans.end(), scan) != scans.end();
    });
    return static_cast<std::size_t>(set - sets.begin()) + 1;
}

std::string place_of(const Reconstruction& reconstruction, std::size_t scan) {
    const auto& registration = reconstruction.registration;
    if (!is_placed(reconstruction, scan)) {
        return registration ? fmt::format("in set {}", set_of(*registration, scan)) : "no";
    }
    const bool is_doubtful =
        registration && scan < registration->is_doubtful.size() && registration->is_doubtful[scan];
    return is_doubtful ? "in doubt" : "yes";
}

template <typename Format>
std::string or_dash(const std::optional<double>& value, Format format) {
    return value ? format(*value) : "-";
}

std::string scan_table(const Reconstruction& reconstruction) {
    TextTable table("lrlrr");
    table.add_row({"scan", "points", "placed", "residual", "overlap"});
    for (std::size_t i = 0; i < reconstruction.map.sections.size(); ++i) {
        const MapSection& section = reconstruction.map.sections[i];
        table.add_row({section.name, std::to_string(section.count), place_of(reconstruction, i),
                       or_dash(residual_of(reconstruction, i), millimetres),
                       or_dash(overlap_of(reconstruction, i), percent)});
    }
    return table.to_text();
}

std::string link_table(const Reconstruction& reconstruction) {
    TextTable table("llrlrrr");
    table.add_row({"link", "verdict", "probability", "loops", "overlap", "RMSE", "inliers"});
    const auto& sections = reconstruction.map.sections;
    for (const RegistrationLink& link : reconstruction.registration->links) {
        table.add_row(
            {fmt::format("{} -> {}", sections[link.source].name, sections[link.target].name),
             std::string(link_verdict_name(link.verdict)), percent(link.probability),
             std::string(loop_check_name(link.loops)), percent(link.overlap),
             millimetres(link.rmse), std::to_string(link.inliers)});
    }
    return table.to_text();
}

std::string room_lines(const Scene& scene) {
    const Eigen::AlignedBox3d extent = extent_of_rooms(scene);
    std::string text = "no floor, ceiling or wall\n";
    if (!extent.isEmpty()) {
        const Eigen::Vector3d size = extent.sizes();
        text = fmt::format("size {:.2f} x {:.2f} x {:.2f} m, map frame {:.1f} deg off level\n",
                           size.x(), size.y(), size.z(), degrees(tilt_of_map(scene)));
    }
    for (const Room& room : scene.rooms) {
        text += fmt::format("{}: {:.1f} m2, {:.2f} m high, {:.1f} m3\n", room.id, room.area,
                            room.ceiling_height - room.floor_height, room.volume);
    }
    return text;
}

std::string label_table(const Reconstruction& reconstruction) {
    TextTable table("lrrr");
    table.add_row({"label", "found", "coverage", "points"});
    const auto summaries = summarize_labels(reconstruction);
    const auto total = static_cast<double>(reconstruction.labels.labels.size());
    const auto add = [&](Label label) {
        const LabelSummary& summary = summaries[static_cast<std::size_t>(label)];
        if (summary.components == 0 && summary.points == 0) return;
        table.add_row(
            {std::string(label_name(label)),
             label == Label::unknown ? "-" : std::to_string(summary.components),
             or_dash(summary.mean_coverage(), percent),
             fmt::format("{:.1f} %", 100.0 * static_cast<double>(summary.points) / total)});
    };
    for (std::size_t label = 1; label < num_labels; ++label)
        add(static_cast<Label>(label));
    add(Label::unknown);
    return table.to_text();
}

Json json_or_null(const std::optional<double>& value) {
    return value ? Json(*value) : Json(nullptr);
}

Json scans_to_json(const Reconstruction& reconstruction) {
    Json scans = Json::array();
    for (std::size_t i = 0; i < reconstruction.map.sections.size(); ++i) {
        const MapSection& section = reconstruction.map.sections[i];
        scans.push_back({{"name", section.name},
                         {"points", section.count},
                         {"placed", is_placed(reconstruction, i)},
                         {"residual", json_or_null(residual_of(reconstruction, i))}});
    }
    return scans;
}

Json links_to_json(const Registration& registration) {
    Json links = Json::array();
    for (const RegistrationLink& link : registration.links) {
        links.push_back({{"source", link.source},
                         {"target", link.target},
                         {"verdict", link_verdict_name(link.verdict)},
                         {"probability", link.probability},
                         {"loops", loop_check_name(link.loops)},
                         {"overlap", link.overlap},
                         {"rmse", link.rmse},
                         {"inliers", link.inliers}});
    }
    return links;
}

Json rooms_to_json(const Scene& scene) {
    Json rooms = Json::array();
    for (const Room& room : scene.rooms) {
        rooms.push_back({{"id", room.id},
                         {"area", room.area},
                         {"height", room.ceiling_height - room.floor_height},
                         {"volume", room.volume}});
    }
    return rooms;
}

Json labels_to_json(const Reconstruction& reconstruction) {
    Json labels;
    const auto summaries = summarize_labels(reconstruction);
    for (std::size_t i = 0; i < num_labels; ++i) {
        labels[std::string(label_name(static_cast<Label>(i)))] = {
            {"components", summaries[i].components},
            {"points", summaries[i].points},
            {"coverage", json_or_null(summaries[i].mean_coverage())}};
    }
    return labels;
}

}  // namespace

std::string result_tables(const Reconstruction& reconstruction, const JobSummary& summary) {
    std::string text = scan_table(reconstruction);
    if (summary.unit.unit != LengthUnit::metre) {
        text += fmt::format("\nthe scans are in {} ({}): results are in metres\n",
                            length_unit_word(summary.unit.unit), summary.unit.reason);
    }
    if (!summary.doubt.empty()) text += fmt::format("\n{}\n", summary.doubt);
    if (!summary.corrections.empty()) text += fmt::format("\n{}\n", summary.corrections);
    if (reconstruction.registration && !reconstruction.registration->links.empty()) {
        text += fmt::format("\n{}", link_table(reconstruction));
    }
    if (reconstruction.registration && reconstruction.registration->components.size() > 1) {
        text += fmt::format(
            "\nthe scans fall into {} sets that no link joins: set 1 is the map, each of the "
            "others "
            "has a folder of its own, {} and so on\n",
            reconstruction.registration->components.size(), folder_of_apart(0));
    }
    if (is_interpreted(reconstruction)) {
        text +=
            fmt::format("\n{}\n{}", room_lines(reconstruction.scene), label_table(reconstruction));
    }
    if (summary.score) text += fmt::format("\n{}", summary_to_text(*summary.score));
    text += fmt::format("\nreport  {}\ntime    {:.1f} s\n", summary.report, summary.seconds);
    return text;
}

std::string result_json(const Reconstruction& reconstruction, const JobSummary& summary) {
    Json result;
    result["output"] = summary.output;
    result["report"] = summary.report;
    result["seconds"] = summary.seconds;
    result["input_unit"] = length_unit_name(summary.unit.unit);
    if (!summary.doubt.empty()) result["doubt"] = summary.doubt;
    if (!summary.corrections.empty()) result["corrections"] = summary.corrections;
    result["scans"] = scans_to_json(reconstruction);
    if (reconstruction.registration) {
        result["links"] = links_to_json(*reconstruction.registration);
    }
    if (is_interpreted(reconstruction)) {
        const Eigen::AlignedBox3d extent = extent_of_rooms(reconstruction.scene);
        result["size"] = nullptr;
        if (!extent.isEmpty()) {
            const Eigen::Vector3d size = extent.sizes();
            result["size"] = {size.x(), size.y(), size.z()};
        }
        result["tilt"] = tilt_of_map(reconstruction.scene);
        result["rooms"] = rooms_to_json(reconstruction.scene);
        result["labels"] = labels_to_json(reconstruction);
    }
    if (summary.score) result["score"] = Json::parse(summary_to_json(*summary.score));
    return result.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string missing_result(const Reconstruction& reconstruction) {
    if (reconstruction.registration) {
        const auto& poses = reconstruction.registration->map_from_scan;
        const bool none_joined =
            poses.size() > 1 && std::none_of(poses.begin() + 1, poses.end(),
                                             [](const auto& pose) { return pose.has_value(); });
        if (none_joined) {
            return "no scan could be joined to the first: the scans must share part of the room";
        }
    }
    if (is_interpreted(reconstruction) && reconstruction.scene.components.empty()) {
        return "no floor, ceiling or wall was found: the scan must show large plane surfaces";
    }
    return "";
}

}  // namespace roomscribe::cli
