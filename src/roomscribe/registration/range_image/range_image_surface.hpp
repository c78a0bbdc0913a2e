// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/registration/range_image/range_image.hpp"
#include "roomscribe/registration/range_image/symmetric_matrix.hpp"

namespace roomscribe {

/// The points of an image one coordinate after another, with a margin all round, so that a
/// neighbour is read without asking whether it is in the image. Pixels without a range are
/// so far away that they are nobody's neighbours.
struct PaddedPoints {
    static constexpr float nowhere = 1e15F;

    std::size_t margin = 0;
    std::size_t stride = 0;
    std::vector<float> x;
    std::vector<float> y;
    std::vector<float> z;
    std::vector<float> range;

    PaddedPoints(const RangeImage& image, int margin_size);
    std::size_t index(int column, int row) const {
        return (static_cast<std::size_t>(row) + margin) * stride +
               static_cast<std::size_t>(column) + margin;
    }
};

/// A plane through the neighbours of every pixel that are not beyond a jump: among 5 x 5 pixels
/// those within twice the distance of the 9th nearest.
struct RangeImageSurface {
    PaddedPoints points;
    std::vector<float> squared_reach;      ///< of the 9th nearest; negative where there is no plane
    std::vector<Eigen::Vector3f> normals;  ///< towards the scanner
    std::vector<float> plane_offsets;  ///< normal . (a point of the plane - the sensor's position)

    bool is_known(std::size_t pixel) const { return squared_reach[pixel] >= 0.0F; }
};

RangeImageSurface find_surface(const RangeImage& image, int margin, const Context& context);

}  // namespace roomscribe
