// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>

#include "roomscribe/core/context.hpp"
#include "roomscribe/model/ground_truth.hpp"
#include "roomscribe/model/scan.hpp"

namespace roomscribe {

/// Writes a truth folder (docs/formats.md), made with its parents where it is not there:
///
///     scans/000.ply ...        each scan in its own frame
///     map.ply                  all scans by their true poses
///     truth/poses.txt          scan -> map
///     truth/scene.json         components with `visible`
///     truth/000.labels.npy ... uint8, per point of the scan
///     truth/map.labels.npy     uint8, per point of the map
///     truth/map.instances.npy  int32
///     truth/map.acceptable.npy uint16, LabelSet: an addition of roomscribe's
///
/// `scans` are those that the map was made of, in its order. Scans and labels of a longer scene
/// that was in the folder before are removed. Throws InvalidArgument if the arrays do not fit
/// together, and IoError if a file cannot be written.
void write_truth_folder(const std::filesystem::path& folder, const GroundTruth& truth,
                        std::span<const Scan> scans, const Context& context = {});

/// Reads a truth folder, also one of another program: what the files say and how far they must
/// agree is in docs/formats.md. Of the scans only the sizes are used: the map's sections come from
/// the label files of the scans, and there is one section for all where these are missing. Without
/// map.acceptable.npy the acceptable labels follow from labels and kinds, by acceptable_labels().
/// Geometry is brought into the coordinates of the map's cloud in memory, less its global shift.
/// Throws IoError for what is missing, malformed or of another length.
GroundTruth read_truth_folder(const std::filesystem::path& folder, const Context& context = {});

/// The labels that are right for a point with this label that belongs to a component of this kind
/// (docs/formats.md): a column may be wall or unknown, a beam ceiling, wall or unknown, the lining
/// of a doorway door_frame or wall, the reveal of a window wall or window_frame. A kind is told by
/// the word in it, so that "wall_column" is a column.
LabelSet acceptable_labels(Label label, std::string_view kind);

}  // namespace roomscribe
