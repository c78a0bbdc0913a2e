// SPDX-License-Identifier: MIT
#include "roomscribe/registration/range_image/range_image_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "roomscribe/core/parallel.hpp"

namespace roomscribe {
namespace {

constexpr int radius = 2;
constexpr int side = 2 * radius + 1;
constexpr int num_pixels = side * side;
constexpr int num_nearest = 9;
constexpr float largest_real = 1e25F;  // m^2; what is farther is nowhere

/// Four at a time; the last three are nowhere.
using Neighbors = Eigen::Array<float, 28, 1>;

struct Neighborhood {
    Neighbors x = Neighbors::Constant(PaddedPoints::nowhere);
    Neighbors y = Neighbors::Constant(PaddedPoints::nowhere);
    Neighbors z = Neighbors::Constant(PaddedPoints::nowhere);

    /// Positions as seen from the pixel's own point.
    void read(const PaddedPoints& points, std::size_t center) {
        int i = 0;
        for (int dy = -radius; dy <= radius; ++dy) {
            const std::size_t first =
                center +
                static_cast<std::size_t>(dy * static_cast<std::ptrdiff_t>(points.stride) - radius);
            using Row = Eigen::Map<const Eigen::Array<float, side, 1>>;
            x.segment<side>(i) = Row(&points.x[first]);
            y.segment<side>(i) = Row(&points.y[first]);
            z.segment<side>(i) = Row(&points.z[first]);
            i += side;
        }
        x -= points.x[center];
        y -= points.y[center];
        z -= points.z[center];
    }
};

/// Squared distance of the 9th nearest of the neighbours, the pixel itself among them; of the
/// farthest if there are fewer.
float squared_reach(const Neighbors& squared_distances) {
    float inner = 0.0F;
    for (int dy = -1; dy <= 1; ++dy) {
        const int middle = (dy + radius) * side + radius;
        inner = std::max({inner, squared_distances[middle - 1], squared_distances[middle],
                          squared_distances[middle + 1]});
    }
    if (inner < largest_real) {
        // The 9 nearest are the 3 x 3 pixels, but for a few where the surface is seen aslant.
        while ((squared_distances < inner).count() >= num_nearest)
            inner = (squared_distances < inner).select(squared_distances, -1.0F).maxCoeff();
        return inner;
    }
    std::array<float, num_pixels> sorted;
    const auto end = std::copy_if(squared_distances.begin(), squared_distances.end(),
                                  sorted.begin(), [](float d) { return d < largest_real; });
    const auto count = end - sorted.begin();
    const auto nth = sorted.begin() + std::min<std::ptrdiff_t>(count, num_nearest) - 1;
    std::nth_element(sorted.begin(), nth, end);
    return *nth;
}

}  // namespace

PaddedPoints::PaddedPoints(const RangeImage& image, int margin_size)
    : margin(static_cast<std::size_t>(std::max(margin_size, radius))),
      stride(static_cast<std::size_t>(image.width) + 2 * margin) {
    const std::size_t size = stride * (static_cast<std::size_t>(image.height) + 2 * margin);
    for (std::vector<float>* values : {&x, &y, &z})
        values->assign(size, nowhere);
    range.assign(size, RangeImage::unobserved);
    for (int row = 0; row < image.height; ++row) {
        for (int column = 0; column < image.width; ++column) {
            const std::size_t pixel = image.index(column, row);
            const std::size_t i = index(column, row);
            range[i] = image.ranges[pixel];
            if (!image.has_range(pixel)) continue;
            x[i] = image.points[pixel].x();
            y[i] = image.points[pixel].y();
            z[i] = image.points[pixel].z();
        }
    }
}

RangeImageSurface find_surface(const RangeImage& image, int margin, const Context& context) {
    RangeImageSurface surface{PaddedPoints(image, margin), std::vector<float>(image.size(), -1.0F),
                              std::vector<Eigen::Vector3f>(image.size(), Eigen::Vector3f::Zero()),
                              std::vector<float>(image.size(), 0.0F)};
    const auto rows = static_cast<std::size_t>(image.height);
    parallel_for(context, rows, 8, [&](std::size_t begin, std::size_t end) {
        Neighborhood around;
        for (std::size_t pixel = begin * static_cast<std::size_t>(image.width);
             pixel < end * static_cast<std::size_t>(image.width); ++pixel) {
            if (!image.has_range(pixel)) continue;
            around.read(surface.points,
                        surface.points.index(image.column(pixel), image.row(pixel)));
            const auto& [x, y, z] = around;
            const Neighbors squared_distances = x * x + y * y + z * z;
            const float reach = squared_reach(squared_distances);
            const Neighbors weights = (squared_distances <= 4.0F * reach).cast<float>();
            const float count = weights.sum();
            if (count < 3.0F) continue;
            const Neighbors wx = weights * x;
            const Neighbors wy = weights * y;
            const Neighbors wz = weights * z;
            const Eigen::Vector3f mean = Eigen::Vector3f(wx.sum(), wy.sum(), wz.sum()) / count;
            SymmetricMatrix covariance{(wx * x).sum(), (wx * y).sum(), (wx * z).sum(),
                                       (wy * y).sum(), (wy * z).sum(), (wz * z).sum()};
            covariance.add_square(mean, -count);
            Eigen::Vector3f normal = covariance.eigenvector(covariance.smallest_eigenvalue());
            const Eigen::Vector3f ray = image.points[pixel] - image.sensor_position;
            if (normal.dot(ray) > 0.0F) normal = -normal;
            surface.squared_reach[pixel] = reach;
            surface.normals[pixel] = normal;
            surface.plane_offsets[pixel] = normal.dot(mean + ray);
        }
    });
    return surface;
}

}  // namespace roomscribe
