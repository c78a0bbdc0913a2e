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
#include "cli/progress_display.hpp"
#include "roomscribe/core/context.hpp"
#include "roomscribe/model/scan.hpp"
#include "roomscribe/pipeline/reconstruct.hpp"

namespace roomscribe::cli {

/// Progress goes to `display`, which must outlive the context.
Context make_context(const JobOptions& options, const std::atomic<bool>& cancel,
                     ProgressDisplay& display);

/// Reads all scans. Throws IoError if one cannot be read, or holds too few points, or points all in
/// one place, so that nothing can be found in it.
std::vector<Scan> load_scans(std::span<const std::string> paths, const Context& context);

/// The poses of --poses, one entry per scan; none if no file was given. Throws IoError for a file
/// that cannot be read or another number of poses.
std::vector<std::optional<Transform>> load_poses(const JobOptions& options, const Context& context);

/// What a job computes from its scans and what is known of their poses (--poses), in metres.
using Work =
    std::function<Reconstruction(std::vector<Scan>& scans, KnownPoses poses,
                                 const PipelineSettings& settings, const Context& context)>;

/// The frame of every job: resolves the settings, makes the output folder, reads the scans, brings
/// them into metres, works, writes what was found with run.json and the report, and prints the
/// result. `verb` is for run.json.
ExitCode run_job(std::string_view verb, const JobOptions& options, const std::atomic<bool>& cancel,
                 const Work& work);

}  // namespace roomscribe::cli
