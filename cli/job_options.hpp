// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "cli/progress_display.hpp"
#include "roomscribe/core/length_unit.hpp"
#include "roomscribe/pipeline/pipeline_settings.hpp"

namespace roomscribe::cli {

/// What run, register, interpret, explain and demo have in common.
struct JobOptions {
    std::vector<std::string> inputs;
    std::vector<std::string> pose_files;  ///< what is known of where the scans stand
    std::optional<LengthUnit> unit;       ///< of the scans; empty: told by their size
    std::string output;
    std::string memory;   ///< at most, "8G"; empty: as much as there is
    bool resume = false;  ///< goes on where a run before it was stopped
    std::string
        corrections;    ///< file; empty: corrections.json in the output folder, if it is there
    std::string truth;  ///< folder; empty where nobody knows
    std::string settings_file;
    std::vector<std::string> assignments;
    std::optional<std::string> seed;
    int num_threads = 0;
    bool as_json = false;
    ProgressMode progress = ProgressMode::automatic;
};

/// Declares --config, --set, --seed, --threads, --json and --progress, and puts every setting under
/// the help of the verb.
void add_job_options(CLI::App& verb, JobOptions& options);

/// Declares the scans, which the verb needs, and --unit.
void add_scans(CLI::App& verb, JobOptions& options);

/// Declares --unit.
void add_unit(CLI::App& verb, std::optional<LengthUnit>& unit);

/// Declares --poses, which says where the scans stand.
void add_poses(CLI::App& verb, JobOptions& options);

/// Declares -o, which the verb needs.
void add_output(CLI::App& verb, JobOptions& options);

/// Declares --memory.
void add_memory(CLI::App& verb, JobOptions& options);

/// Declares --resume.
void add_resume(CLI::App& verb, JobOptions& options);

/// Declares --corrections, which overrule what is found.
void add_corrections(CLI::App& verb, JobOptions& options);

/// Declares --truth, which scores the result.
void add_truth(CLI::App& verb, JobOptions& options);

/// The defaults, with --config, --set and --seed on top, in this order.
PipelineSettings resolve_settings(const JobOptions& options);

}  // namespace roomscribe::cli
