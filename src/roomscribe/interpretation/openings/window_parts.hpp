// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace roomscribe {

/// A point in the hole of a window, as seen from the room.
struct HolePoint {
    float along = 0.0F;  ///< m from the hole's left side
    float above = 0.0F;  ///< m from its lower side
    float depth = 0.0F;  ///< m behind the face of the wall
};

/// What a window's hole is like, as far as its wall told.
struct WindowHole {
    double width = 0.0;        ///< m
    double height = 0.0;       ///< m
    double frame_width = 0.0;  ///< m
    double frame_depth = 0.0;  ///< m behind the face, of the frame's front
    double pane_depth = 0.0;   ///< m behind the face
};

enum class WindowPart : std::uint8_t { reveal, frame, pane };

/// Sorts the points in a window's hole into its parts, in their order.
///
/// Frame and pane are two layers: the frame's front is where most points along the hole's sides
/// lie; the pane is where most of those lie that are farther inside and behind it. Where the frame
/// shows densely, mullions, sashes and transoms are told by the places that it covers, and what
/// lies close around them at the pane's depth are their sides; else by `frame_width`. A blind
/// covers the hole from its lintel downwards, in or before the frame: the pane's, as it is what the
/// window shows. Before the frame lies the reveal, which is the wall's.
///
/// `noise`: m, of the points. Too few points to see a layer: the depths of `hole` hold.
std::vector<WindowPart> sort_window_points(std::span<const HolePoint> points,
                                           const WindowHole& hole, double noise);

}  // namespace roomscribe
