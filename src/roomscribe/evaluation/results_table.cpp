// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/results_table.hpp"

#include <algorithm>
#include <iterator>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "roomscribe/core/units.hpp"
#include "roomscribe/evaluation/score_list.hpp"

namespace roomscribe {
namespace {

// Keys come out in the order in which they were put in.
using Json = nlohmann::ordered_json;
using Row = std::vector<std::string>;

std::string cell_text(const Score& score) {
    if (!score.value) return "-";
    switch (score.unit) {
        case ScoreUnit::count:
            return fmt::format("{:.0f}", *score.value);
        case ScoreUnit::share:
            return fmt::format("{:.1f} %", 100.0 * *score.value);
        case ScoreUnit::metre:
            return fmt::format("{:.3f} m", *score.value);
        case ScoreUnit::degree:
            return fmt::format("{:.2f} deg", *score.value);
    }
    return "";
}

std::string heading(std::string_view name) {
    std::string text(name);
    std::replace(text.begin(), text.end(), '_', ' ');
    return text;
}

/// Columns are the measures of the group, in the order in which they first occur.
ScoreTable table_of(std::span<const Score> scores) {
    std::vector<std::string_view> measures;
    for (const Score& score : scores) {
        if (std::find(measures.begin(), measures.end(), score.measure) == measures.end())
            measures.push_back(score.measure);
    }
    ScoreTable table{scores.front().group, {{""}}};
    for (const std::string_view measure : measures)
        table.rows[0].push_back(heading(measure));
    const std::string* item = nullptr;
    for (const Score& score : scores) {
        if (item == nullptr || *item != score.item) {
            table.rows.emplace_back(measures.size() + 1);
            table.rows.back()[0] = score.item;
            item = &score.item;
        }
        const auto column = std::find(measures.begin(), measures.end(), score.measure);
        table.rows.back()[static_cast<std::size_t>(column - measures.begin()) + 1] =
            cell_text(score);
    }
    return table;
}

void append_aligned(const ScoreTable& table, std::string& text) {
    std::vector<std::size_t> widths(table.rows[0].size(), 0);
    for (const Row& row : table.rows) {
        for (std::size_t i = 0; i < row.size(); ++i)
            widths[i] = std::max(widths[i], row[i].size());
    }
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        const std::string& title = table.rows[row][0];
        std::string line = fmt::format("{:<{}}", row == 0 ? table.group : title,
                                       std::max(widths[0], table.group.size()));
        for (std::size_t i = 1; i < widths.size(); ++i)
            fmt::format_to(std::back_inserter(line), "  {:>{}}", table.rows[row][i], widths[i]);
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
}

template <typename Number>
Json number_or_null(const std::optional<Number>& value) {
    return value ? Json(*value) : Json();
}

Json json_of(const EvaluationSummary& summary) {
    Json json{{"format", "roomscribe-evaluation"}, {"version", 1}, {"scenes", summary.scenes}};
    for (const Score& score : list_scores(summary)) {
        Json value = number_or_null(score.value);
        if (score.value && score.unit == ScoreUnit::count)
            value = static_cast<std::uint64_t>(*score.value);
        json[std::string(score.group)][score.item][std::string(score.measure)] = std::move(value);
    }
    return json;
}

Json json_of(const DetectionMatch& match) {
    Json json{{"label", label_name(match.label)},
              {"outcome", detection_outcome_name(match.outcome)}};
    if (!match.true_id.empty()) json["true"] = match.true_id;
    if (match.predicted_id.empty()) return json;
    json["predicted"] = match.predicted_id;
    if (!match.true_id.empty()) json["score"] = match.score;
    json["confidence"] = match.confidence;
    json["verdict"] = verdict_name(match.verdict);
    return json;
}

Json json_of(const DetectedOpening& opening) {
    Json json{{"predicted", opening.predicted_id},
              {"ground", opening_ground_names[static_cast<std::size_t>(opening.ground)]}};
    if (!opening.true_id.empty()) json["true"] = opening.true_id;
    return json;
}

Json json_of(const RoomMatch& match) {
    Json json{{"outcome", detection_outcome_name(match.outcome)}};
    if (!match.true_id.empty()) json["true"] = match.true_id;
    if (!match.predicted_id.empty()) json["predicted"] = match.predicted_id;
    if (match.true_id.empty() || match.predicted_id.empty()) return json;
    json["iou"] = match.iou;
    json["area_error"] = match.area_error;
    json["height_error"] = match.height_error;
    json["volume_error"] = match.volume_error;
    return json;
}

Json json_of(const ScanError& scan) {
    Json json{{"scan", scan.scan}, {"placed", scan.error.has_value()}};
    if (scan.error) {
        json["translation"] = scan.error->translation;
        json["rotation"] = degrees(scan.error->rotation);
    }
    return json;
}

Json json_of(const LinkOutcome& link) {
    return {{"source", link.source},
            {"target", link.target},
            {"verdict", link_verdict_name(link.verdict)},
            {"truth", link_truth_names[static_cast<std::size_t>(link.truth)]},
            {"translation", link.error.translation},
            {"rotation", degrees(link.error.rotation)},
            {"true_overlap", number_or_null(link.true_overlap)}};
}

template <typename Items>
Json list_of(const Items& items) {
    Json list = Json::array();
    for (const auto& item : items)
        list.push_back(json_of(item));
    return list;
}

/// Ids come from files and may hold bytes that are not UTF-8.
std::string text_of(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::vector<ScoreTable> score_tables(const EvaluationSummary& summary) {
    const std::vector<Score> scores = list_scores(summary);
    std::vector<ScoreTable> tables;
    for (auto begin = scores.begin(); begin != scores.end();) {
        const auto end = std::find_if(
            begin, scores.end(), [&](const Score& score) { return score.group != begin->group; });
        tables.push_back(table_of({begin, end}));
        begin = end;
    }
    return tables;
}

std::string summary_to_text(const EvaluationSummary& summary) {
    std::string text;
    for (const ScoreTable& table : score_tables(summary)) {
        if (!text.empty()) text += "\n";
        append_aligned(table, text);
    }
    return text;
}

std::string summary_to_markdown(const EvaluationSummary& summary) {
    std::string text;
    for (const ScoreTable& table : score_tables(summary)) {
        if (!text.empty()) text += "\n";
        fmt::format_to(std::back_inserter(text), "### {}\n\n", heading(table.group));
        for (std::size_t row = 0; row < table.rows.size(); ++row) {
            fmt::format_to(std::back_inserter(text), "| {} |\n", fmt::join(table.rows[row], " | "));
            if (row > 0) continue;
            text += "|---|";
            for (std::size_t i = 1; i < table.rows[0].size(); ++i)
                text += "---:|";
            text += "\n";
        }
    }
    return text;
}

std::string summary_to_csv(const EvaluationSummary& summary) {
    std::string text = "group,item,measure,value\n";
    for (const Score& score : list_scores(summary)) {
        // The recall's items hold a comma.
        fmt::format_to(std::back_inserter(text), "{},\"{}\",{},{}\n", score.group, score.item,
                       score.measure, score.value ? fmt::format("{}", *score.value) : "");
    }
    return text;
}

std::string summary_to_json(const EvaluationSummary& summary) {
    return text_of(json_of(summary));
}

std::string evaluation_to_json(const Evaluation& evaluation) {
    Json json = json_of(summarize({&evaluation, 1}));
    if (evaluation.detections) json["matches"] = list_of(evaluation.detections->matches);
    if (evaluation.decoys) json["opening_grounds"] = list_of(evaluation.decoys->openings);
    if (evaluation.rooms) json["room_matches"] = list_of(evaluation.rooms->matches);
    if (evaluation.registration) {
        json["scan_errors"] = list_of(evaluation.registration->scans);
        json["link_outcomes"] = list_of(evaluation.registration->links);
    }
    return text_of(json);
}

}  // namespace roomscribe
