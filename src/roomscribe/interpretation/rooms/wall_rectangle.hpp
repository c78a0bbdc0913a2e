// SPDX-License-Identifier: MIT
#pragma once

namespace roomscribe {

/// A rectangle on an upright plane: m along a level direction within it and m along up.
struct WallRectangle {
    double start = 0.0;
    double end = 0.0;
    double bottom = 0.0;
    double top = 0.0;

    double width() const { return end - start; }
    double height() const { return top - bottom; }
    double area() const { return width() * height(); }
    WallRectangle grown(double left_right, double below, double above) const {
        return {start - left_right, end + left_right, bottom - below, top + above};
    }
};

}  // namespace roomscribe
