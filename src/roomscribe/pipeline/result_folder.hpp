// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "roomscribe/core/context.hpp"
#include "roomscribe/evaluation/label_conventions.hpp"
#include "roomscribe/evaluation/prediction.hpp"
#include "roomscribe/model/ground_truth.hpp"
#include "roomscribe/pipeline/reconstruct.hpp"

namespace roomscribe {

/// Reads what a run left in its output folder (docs/formats.md), to be held against truth:
/// labels.ply with scene.json, and poses.txt with registration.json, each where it is there.
/// Coordinates are those of the files less the global shift of the true map. Throws IoError if the
/// folder holds none of these files, one is malformed, scene.json and labels.ply are not there
/// together, or a file does not fit the truth: other points or another number of scans.
Prediction read_result_folder(const std::filesystem::path& folder, const GroundTruth& truth,
                              const Context& context = {});

/// Reads the map of a result with its labels and scene, where it has them: what is needed to show
/// it. Registration, sections and costs stay empty. Throws IoError as read_result_folder does.
Reconstruction read_reconstruction(const std::filesystem::path& folder,
                                   const Context& context = {});

/// Reads a cloud that was labelled by hand, with integer channels (int8 excepted) `label` (or
/// `class`) and, where it has them, `instance`. Throws IoError if it has no such label.
GroundTruth read_labelled_cloud(const std::filesystem::path& path,
                                const LabelConvention& convention, const Context& context = {});

}  // namespace roomscribe
