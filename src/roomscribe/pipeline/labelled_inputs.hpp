// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

#include "roomscribe/core/context.hpp"

namespace roomscribe {

/// Writes the labels of a result into copies of the user's own files: every scan that run.json in
/// `result` names, with its points as they stand in the file (its frame, unit and order), all that
/// was read of them, and per point `label`, `instance` and `confidence` (docs/formats.md), which
/// are called `roomscribe_label` and so on where the file has such a name already. A format that
/// write_point_cloud does not have, or that has no place for labels, becomes PLY, and one of
/// several scans E57. Numbers are binary where the format has that.
/// The files go into `output`, an existing folder, under their own names. Returns their paths.
/// Throws IoError if there is no run.json or labels.ply, a scan cannot be read or is not any more
/// what it was, or a file cannot be written; Cancelled between files.
std::vector<std::filesystem::path> write_labelled_inputs(const std::filesystem::path& result,
                                                         const std::filesystem::path& output,
                                                         const Context& context = {});

}  // namespace roomscribe
