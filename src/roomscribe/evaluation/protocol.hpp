// SPDX-License-Identifier: MIT
#pragma once

#include "roomscribe/core/units.hpp"
#include "roomscribe/model/label.hpp"

// The numbers of the evaluation protocol (docs/evaluation.md). They are no settings: scores are
// compared over years and programs, so they never change.
namespace roomscribe::protocol {

/// True components of which the scans saw less are ignored: neither hit nor miss.
inline constexpr double min_visible = 0.3;
/// Least IoU of instances (floor, ceiling, wall, furniture) and of rectangles (door, window, their
/// frames).
inline constexpr double min_iou = 0.5;
/// Every voxel counts once in the IoU of instances.
inline constexpr double voxel_size = 0.05;  // m
inline constexpr double max_normal_angle = radians(10.0);
inline constexpr double max_plane_distance = 0.15;   // m
inline constexpr double max_handle_distance = 0.05;  // m

/// What hangs on a wall or goes into it lies this near to an opening that it is taken for: the
/// depth of a niche in a wall of one brick.
inline constexpr double max_decoy_distance = 0.3;  // m
/// A cell of a wall was seen if a point on it was: within this of its plane (a board hangs there),
/// in cells that the coarsest scans fill.
inline constexpr double max_wall_distance = 0.1;  // m
inline constexpr double wall_cell_size = 0.2;     // m
/// A rectangle lies where most of it lies.
inline constexpr double min_share = 0.5;

/// How near a pose has to be to count as recalled.
struct PoseTolerance {
    double translation = 0.0;  ///< m
    double rotation = 0.0;     ///< rad
};
inline constexpr PoseTolerance strict_pose{0.1, radians(1.0)};
inline constexpr PoseTolerance loose_pose{0.3, radians(5.0)};

/// Two scans overlap if they share this much of the voxels of the one that fills fewer.
inline constexpr double min_overlap = 0.3;
inline constexpr double overlap_voxel_size = 0.2;  // m

/// What a limit may be missed by for the rounding of sums.
inline constexpr double rounding = 1e-9;

inline constexpr LabelSet every_label = (1U << num_labels) - 1U;
/// Labels whose instances are compared point by point.
inline constexpr LabelSet instance_labels = label_bit(Label::floor) | label_bit(Label::ceiling) |
                                            label_bit(Label::wall) | label_bit(Label::furniture);
/// Labels whose rectangles are compared.
inline constexpr LabelSet rectangle_labels = label_bit(Label::door) | label_bit(Label::door_frame) |
                                             label_bit(Label::window) |
                                             label_bit(Label::window_frame);
/// Labels whose centres are compared.
inline constexpr LabelSet center_labels = label_bit(Label::handle);

constexpr bool contains(LabelSet labels, Label label) {
    return (labels & label_bit(label)) != 0;
}

}  // namespace roomscribe::protocol
