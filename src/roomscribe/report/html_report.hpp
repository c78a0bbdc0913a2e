// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "roomscribe/core/context.hpp"
#include "roomscribe/evaluation/evaluation_summary.hpp"
#include "roomscribe/pipeline/reconstruct.hpp"
#include "roomscribe/pipeline/workspace.hpp"

namespace roomscribe {

/// What a report says beside the results.
struct ReportInfo {
    std::string title = "Scan report";
    RunRecord run;
    std::optional<EvaluationSummary> score;  ///< against truth, where somebody knows it
    std::size_t picture_width = 1400;        ///< pixels
    /// Points in the 3D view: what a graphics card of a plain laptop turns smoothly, in a file that
    /// still can be mailed. 0 leaves the view out.
    std::size_t viewer_points = 2'000'000;
};

/// One HTML file that opens without a network: summary, 3D view (where the program was built with
/// it, viewer_bundle.hpp), plan, section and registration pictures,
/// tables of rooms, components, links, poses, settings, costs and inputs. What the reconstruction
/// does not hold (no registration, no labels) is left out. Names from files are escaped.
std::string render_html_report(const Reconstruction& reconstruction, const ReportInfo& info,
                               const Context& context = {});

/// Writes the report, whole or not at all. Throws IoError if it cannot be written.
void write_html_report(const std::filesystem::path& path, const Reconstruction& reconstruction,
                       const ReportInfo& info, const Context& context = {});

}  // namespace roomscribe
