// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command.hpp"
#include "cli/job_options.hpp"
#include "cli/memory_limit.hpp"
#include "cli/progress_display.hpp"
#include "roomscribe/core/context.hpp"
#include "roomscribe/model/scan.hpp"
#include "roomscribe/pipeline/reconstruct.hpp"

namespace roomscribe::cli {

/// Progress goes to `display`, which must outlive the context.
Context make_context(const JobOptions& options, const std::atomic<bool>& cancel,
                     ProgressDisplay& display);

/// What a job works on, one entry per scan in each list.
struct JobInput {
    std::vector<Scan> scans;
    std::vector<std::string> paths;  ///< the file that each is from
    /// Where they stand by their own files (E57, PTX), less map_shift; empty where that says
    /// nothing.
    std::vector<std::optional<Transform>> stored_poses;
    Eigen::Vector3d map_shift = Eigen::Vector3d::Zero();
    /// What is said of their poses by hand (--poses); none if nothing is.
    std::vector<std::optional<Transform>> given_poses;
};

/// Reads all scans of all files. Throws IoError if one cannot be read, or holds too few points, or
/// points all in one place, so that nothing can be found in it; UsageError if the scans need more
/// memory than there may be.
JobInput load_scans(std::span<const std::string> paths, const Context& context,
                    const MemoryLimit& memory = MemoryLimit(std::nullopt));

/// Adds the poses of --poses. Throws IoError for a file that cannot be read or another number of
/// poses than scans.
void load_poses(JobInput& input, const JobOptions& options, const Context& context);

/// What a job computes from its input, in metres.
using Work = std::function<Reconstruction(JobInput& input, const PipelineSettings& settings,
                                          const Context& context)>;

/// The frame of every job: resolves the settings, makes the output folder, reads the scans, brings
/// them into metres, works, writes what was found with run.json and the report, and prints the
/// result. `verb` is for run.json.
ExitCode run_job(std::string_view verb, const JobOptions& options, const std::atomic<bool>& cancel,
                 const Work& work);

}  // namespace roomscribe::cli
