// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/report/png_image.hpp"

namespace roomscribe {

/// A parallel projection: what the viewer sees of a box. In the view frame x runs to the right, y
/// up and z towards the viewer, in metres.
struct CloudView {
    Transform view_from_cloud = Transform::Identity();
    Eigen::Vector3d low = Eigen::Vector3d::Zero();   ///< corner of the box in the view frame
    Eigen::Vector3d high = Eigen::Vector3d::Ones();  ///< points outside the box are not drawn
    std::size_t width = 1400;                        ///< pixels; the height follows from the box

    double pixel_size() const { return (high.x() - low.x()) / static_cast<double>(width); }
    std::size_t height() const;
};

enum class PictureStyle : std::uint8_t {
    surface,  ///< the point next to the viewer wins; shaded by depth and by its edges
    density   ///< as an X-ray: mean colour, the more opaque the more points lie behind each other
};

/// A point's colour; opacity 0 leaves the point out. Called from many threads.
using PointColor = std::function<Pixel(std::size_t index)>;

/// Draws the finite points in the view's box. Gaps between the points of a surface are closed as
/// far as the mean spacing of the points tells that they are gaps. Nothing is drawn where no point
/// is: those pixels stay transparent. Same bits on any number of threads. Throws InvalidArgument if
/// the box has no extent or the image would exceed 100 million pixels.
Image draw_cloud(std::span<const Eigen::Vector3f> points, const PointColor& color,
                 const CloudView& view, PictureStyle style = PictureStyle::surface,
                 const Context& context = {});

}  // namespace roomscribe
