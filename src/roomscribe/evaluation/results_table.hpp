// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "roomscribe/evaluation/evaluation_summary.hpp"

namespace roomscribe {

/// The scores of one group of list_scores as cells with their units; the first row is the heading.
struct ScoreTable {
    std::string_view group;
    std::vector<std::vector<std::string>> rows;
};
std::vector<ScoreTable> score_tables(const EvaluationSummary& summary);

/// Tables to read: one per group of list_scores, values with their units, "-" where a value is not
/// defined.
std::string summary_to_text(const EvaluationSummary& summary);

/// The same tables in Markdown, each under a heading of the third level.
std::string summary_to_markdown(const EvaluationSummary& summary);

/// One line a value: group,item,measure,value. Shares are in [0, 1], lengths metres, angles
/// degrees; the value is empty where it is not defined.
std::string summary_to_csv(const EvaluationSummary& summary);

/// {"format": "roomscribe-evaluation", "version": 1, "scenes": n, group: {item: {measure: value}}},
/// values as in CSV, null where not defined.
std::string summary_to_json(const EvaluationSummary& summary);

/// That of one scene, with every component ("matches"), scan and link one by one.
std::string evaluation_to_json(const Evaluation& evaluation);

}  // namespace roomscribe
