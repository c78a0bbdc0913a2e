// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>

#include "roomscribe/pipeline/reconstruct.hpp"
#include "roomscribe/report/cloud_picture.hpp"

namespace roomscribe {

/// What runs along one edge of a picture: an axis of the room frame, forwards or backwards.
struct PictureAxis {
    int axis = 0;  ///< 0, 1, 2 for x, y, z
    double sign = 1.0;
};

/// A view of the map with the room axes that its edges show.
struct RoomView {
    CloudView view;
    PictureAxis horizontal;
    PictureAxis vertical;
};

/// Whether the map was interpreted: a label for each of its points.
bool has_labels(const Reconstruction& reconstruction);

/// The box of what was found, in the room frame: rooms and components; else of the middle 98 % of
/// the points along each axis (some returns come from far outside, through glass). Never empty.
Eigen::AlignedBox3d interesting_box(const Reconstruction& reconstruction);

/// The same with the scanners in it.
Eigen::AlignedBox3d scanned_box(const Reconstruction& reconstruction);

/// From above on what lies in the box. The longer side of interesting_box runs to the right.
RoomView plan_view(const Reconstruction& reconstruction, const Eigen::AlignedBox3d& box,
                   std::size_t width);

/// Through the middle of the box, upright, along its longer side: the half behind is seen.
RoomView section_view(const Reconstruction& reconstruction, const Eigen::AlignedBox3d& box,
                      std::size_t width);

}  // namespace roomscribe
