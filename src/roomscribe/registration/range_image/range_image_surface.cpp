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
constexpr std::size_t num_pixels{side * side};
constexpr std::size_t num_nearest = 9;
constexpr float largest_real = 1e25F;  // m^2; what is farther is nowhere

/// One value for each of some pixels side by side, which one instruction takes together.
constexpr int num_lanes = 4;
using Lanes = Eigen::Array<float, num_lanes, 1>;

/// The neighbours of some pixels as seen from their own points.
struct Neighborhoods {
    std::array<Lanes, num_pixels> x, y, z, squared_distances;

    void read(const PaddedPoints& points, std::size_t center) {
        using Values = Eigen::Map<const Lanes>;
        std::size_t i = 0;
        for (int dy = -radius; dy <= radius; ++dy) {
            for (int dx = -radius; dx <= radius; ++dx, ++i) {
                const std::size_t other =
                    center +
                    static_cast<std::size_t>(dy * static_cast<std::ptrdiff_t>(points.stride) + dx);
                x[i] = Values(&points.x[other]) - Values(&points.x[center]);
                y[i] = Values(&points.y[other]) - Values(&points.y[center]);
                z[i] = Values(&points.z[other]) - Values(&points.z[center]);
                squared_distances[i] = x[i] * x[i] + y[i] * y[i] + z[i] * z[i];
            }
        }
    }

    /// Squared distance of the 9th nearest of the neighbours, the pixel itself among them; of the
    /// farthest if there are fewer.
    Lanes squared_reach() const {
        std::array<Lanes, num_nearest> nearest;
        nearest.fill(Lanes::Constant(2.0F * largest_real));
        for (Lanes distance : squared_distances) {
            for (Lanes& place : nearest) {
                const Lanes farther = place.max(distance);
                place = place.min(distance);
                distance = farther;
            }
        }
        Lanes reach = Lanes::Zero();
        for (const Lanes& distance : nearest)
            reach = reach.max((distance < largest_real).select(distance, reach));
        return reach;
    }
};

/// Count, mean and scatter of the neighbours within twice a reach.
struct Moments {
    Lanes count = Lanes::Zero();
    Lanes x = Lanes::Zero(), y = Lanes::Zero(), z = Lanes::Zero();
    Lanes xx = Lanes::Zero(), xy = Lanes::Zero(), xz = Lanes::Zero();
    Lanes yy = Lanes::Zero(), yz = Lanes::Zero(), zz = Lanes::Zero();

    Moments(const Neighborhoods& around, const Lanes& squared_reach) {
        const Lanes limit = 4.0F * squared_reach;
        for (std::size_t i = 0; i < num_pixels; ++i) {
            const Lanes weight = (around.squared_distances[i] <= limit).cast<float>();
            const Lanes wx = weight * around.x[i];
            const Lanes wy = weight * around.y[i];
            const Lanes wz = weight * around.z[i];
            count += weight;
            x += wx;
            y += wy;
            z += wz;
            xx += wx * around.x[i];
            xy += wx * around.y[i];
            xz += wx * around.z[i];
            yy += wy * around.y[i];
            yz += wy * around.z[i];
            zz += wz * around.z[i];
        }
        x /= count;
        y /= count;
        z /= count;
        xx -= count * x * x;
        xy -= count * x * y;
        xz -= count * x * z;
        yy -= count * y * y;
        yz -= count * y * z;
        zz -= count * z * z;
    }

    SymmetricMatrix scatter(Eigen::Index lane) const {
        return {xx[lane], xy[lane], xz[lane], yy[lane], yz[lane], zz[lane]};
    }

    /// As SymmetricMatrix::smallest_eigenvalue.
    Lanes smallest_eigenvalues() const {
        using Doubles = Eigen::Array<double, num_lanes, 1>;
        const Doubles m = xx.cast<double>(), n = yy.cast<double>(), o = zz.cast<double>();
        const Doubles p = xy.cast<double>(), q = xz.cast<double>(), r = yz.cast<double>();
        const Doubles a = m + n + o;
        const Doubles b = m * n - p * p + m * o - q * q + n * o - r * r;
        const Doubles c = m * (n * o - r * r) - p * (p * o - r * q) + q * (p * r - n * q);
        Doubles root = Doubles::Zero();
        Doubles change = a;
        for (int step = 0; step < 40 && (change.abs() > 1e-7 * a).any(); ++step) {
            const Doubles value = ((root - a) * root + b) * root - c;
            const Doubles slope = (3.0 * root - 2.0 * a) * root + b;
            for (Eigen::Index lane = 0; lane < num_lanes; ++lane)
                change[lane] = slope[lane] > 0.0 ? value[lane] / slope[lane] : 0.0;
            root -= change;
        }
        return root.cast<float>();
    }
};

/// Sets the planes of the pixels of a row from x on.
void fit_planes(const RangeImage& image, int x, int y, RangeImageSurface& surface) {
    const int end = std::min(x + num_lanes, image.width);
    bool is_empty = true;
    for (int column = x; column < end; ++column)
        is_empty = is_empty && !image.has_range(image.index(column, y));
    if (is_empty) return;
    Neighborhoods around;
    around.read(surface.points, surface.points.index(x, y));
    const Lanes reach = around.squared_reach();
    const Moments moments(around, reach);
    const Lanes eigenvalues = moments.smallest_eigenvalues();
    for (int column = x; column < end; ++column) {
        const Eigen::Index lane = column - x;
        const std::size_t pixel = image.index(column, y);
        if (!image.has_range(pixel) || moments.count[lane] < 3.0F) continue;
        Eigen::Vector3f normal = moments.scatter(lane).eigenvector(eigenvalues[lane]);
        const Eigen::Vector3f ray = image.points[pixel] - image.sensor_position;
        if (normal.dot(ray) > 0.0F) normal = -normal;
        const Eigen::Vector3f mean(moments.x[lane], moments.y[lane], moments.z[lane]);
        surface.squared_reach[pixel] = reach[lane];
        surface.normals[pixel] = normal;
        surface.plane_offsets[pixel] = normal.dot(mean + ray);
    }
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
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            for (int x = 0; x < image.width; x += num_lanes)
                fit_planes(image, x, y, surface);
        }
    });
    return surface;
}

}  // namespace roomscribe
