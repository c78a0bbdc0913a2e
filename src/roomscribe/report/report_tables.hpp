// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

#include "roomscribe/evaluation/evaluation_summary.hpp"
#include "roomscribe/pipeline/reconstruct.hpp"
#include "roomscribe/pipeline/workspace.hpp"

namespace roomscribe {

// Each gives one table, or nothing where there is nothing to list.

std::string rooms_table(const Reconstruction& reconstruction);

/// Every component, rejected ones too: why something is not in scene.json is worth knowing.
std::string components_table(const Reconstruction& reconstruction);

std::string links_table(const Reconstruction& reconstruction);

/// Per scan: points, place and turn in the map frame, residual.
std::string poses_table(const Reconstruction& reconstruction);

std::string derived_values_table(const Reconstruction& reconstruction);

/// Settings whose value is not the default.
std::string changed_settings_table(const RunRecord& run);

std::string stages_table(const Reconstruction& reconstruction);

/// One table per group of scores: how the result compares with known truth.
std::string scores_tables(const EvaluationSummary& score);

/// Files that went in or came out, with sizes and hashes.
std::string files_table(std::span<const FileRecord> files);

}  // namespace roomscribe
