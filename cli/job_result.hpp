// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "cli/scan_unit.hpp"
#include "roomscribe/evaluation/evaluation_summary.hpp"
#include "roomscribe/pipeline/reconstruct.hpp"

namespace roomscribe::cli {

/// How a job ended, beside what it found.
struct JobSummary {
    std::string output;  ///< folder
    std::string report;  ///< file
    double seconds = 0.0;
    ScanUnit unit;                           ///< of the scans
    std::string doubt;                       ///< of that unit, in one line; empty if there is none
    std::string corrections;                 ///< what became of them; empty if there are none
    std::optional<EvaluationSummary> score;  ///< against truth, where it was given
};

/// The tables that a job prints: scans, links, room, components, where the report lies.
std::string result_tables(const Reconstruction& reconstruction, const JobSummary& summary);

/// The same as one JSON object.
std::string result_json(const Reconstruction& reconstruction, const JobSummary& summary);

/// What a job was to find and did not, in one line; empty if it found something.
std::string missing_result(const Reconstruction& reconstruction);

}  // namespace roomscribe::cli
