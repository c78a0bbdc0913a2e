// SPDX-License-Identifier: MIT
#include "roomscribe/registration/range_image/range_image.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/registration/range_image/range_image_grid.hpp"

namespace roomscribe {
namespace {

using std::numbers::pi;

/// Of a direction: what a sinusoidal image counts in pixels, from its left and upper edge.
struct ImageAngles {
    float across = 0.0F;  ///< [0, 2 pi]
    float down = 0.0F;    ///< [0, pi]
    float range = std::numeric_limits<float>::quiet_NaN();
};

std::vector<ImageAngles> image_angles(std::span<const Eigen::Vector3f> positions,
                                      const RangeImage& image, const Context& context) {
    const Eigen::Matrix3f polar_from_cloud =
        image.projection.cloud_from_polar.transpose().cast<float>();
    std::vector<ImageAngles> angles(positions.size());
    parallel_for(context, positions.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!is_finite(positions[i])) continue;
            const Eigen::Vector3f ray = polar_from_cloud * (positions[i] - image.sensor_position);
            const float range = ray.norm();
            if (!(range > 0.0F)) continue;
            const float latitude = std::asin(std::clamp(ray.y() / range, -1.0F, 1.0F));
            const float longitude = std::atan2(ray.x(), ray.z());
            angles[i] = {longitude * std::hypot(ray.x(), ray.z()) / range + static_cast<float>(pi),
                         latitude + static_cast<float>(pi / 2.0), range};
        }
    });
    return angles;
}

/// Share of the pixels that are empty between two that are not.
double hole_share(std::span<const ImageAngles> angles, double resolution) {
    const int width = static_cast<int>(2.0 * pi / resolution) + 1;
    const int height = static_cast<int>(pi / resolution) + 1;
    std::vector<std::uint8_t> is_filled(static_cast<std::size_t>(width) *
                                        static_cast<std::size_t>(height));
    const auto scale = static_cast<float>(1.0 / resolution);
    for (const ImageAngles& point : angles) {
        if (!std::isfinite(point.range)) continue;
        const auto x = static_cast<std::size_t>(point.across * scale);
        const auto y = static_cast<std::size_t>(point.down * scale);
        is_filled[std::min(y * static_cast<std::size_t>(width) + x, is_filled.size() - 1)] = 1;
    }
    std::size_t num_holes = 0;
    std::size_t num_filled = 0;
    const auto row_size = static_cast<std::size_t>(width);
    for (std::size_t i = row_size; i + row_size < is_filled.size(); ++i) {
        if (is_filled[i] != 0) {
            ++num_filled;
        } else if ((is_filled[i - 1] & is_filled[i + 1]) != 0 ||
                   (is_filled[i - row_size] & is_filled[i + row_size]) != 0) {
            ++num_holes;
        }
    }
    return static_cast<double>(num_holes) /
           static_cast<double>(std::max<std::size_t>(num_filled + num_holes, 1));
}

/// The pixels shrink as long as they have no holes: the other way round, an image far too fine has
/// no pixel left between two neighbours.
double derive_resolution(std::span<const ImageAngles> angles) {
    constexpr double finest = radians(0.2);
    constexpr double max_hole_share = 0.02;
    double resolution = radians(4.0);
    for (double next = resolution; next >= finest; next /= 1.25) {
        if (hole_share(angles, next) > max_hole_share) break;
        resolution = next;
    }
    return resolution;
}

/// The nearest range of each pixel of a whole sphere. A point tells most about the pixel that it
/// falls into, but also fills those beside it that have none.
struct DepthBuffer {
    int width;
    int height;
    std::vector<float> ranges;

    DepthBuffer(std::span<const ImageAngles> angles, double resolution)
        : width(static_cast<int>(2.0 * pi / resolution)),
          height(static_cast<int>(pi / resolution)),
          ranges(static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                 RangeImage::far) {
        std::vector<float> beside = ranges;
        const auto scale = static_cast<float>(1.0 / resolution);
        for (const ImageAngles& point : angles) {
            if (!std::isfinite(point.range)) continue;
            const float x = point.across * scale;
            const float y = point.down * scale;
            if (!lower(ranges, std::lrint(x), std::lrint(y), point.range)) continue;
            const auto left = static_cast<long>(x);
            const auto top = static_cast<long>(y);
            lower(beside, left, top, point.range);
            lower(beside, left + 1, top, point.range);
            lower(beside, left, top + 1, point.range);
            lower(beside, left + 1, top + 1, point.range);
        }
        for (std::size_t i = 0; i < ranges.size(); ++i) {
            if (ranges[i] == RangeImage::far) ranges[i] = beside[i];
        }
    }

    std::size_t index(long x, long y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x);
    }

    bool lower(std::vector<float>& buffer, long x, long y, float range) const {
        if (x < 0 || x >= width || y < 0 || y >= height) return false;
        float& value = buffer[index(x, y)];
        value = std::min(value, range);
        return true;
    }
};

/// RangeProjection::direction for one row, with what its pixels share computed once.
struct SinusoidalRow {
    Eigen::Matrix3f cloud_from_polar;
    float sin_latitude;
    float cos_latitude;
    float first_longitude;
    float longitude_step;

    SinusoidalRow(const RangeProjection& projection, int y)
        : cloud_from_polar(projection.cloud_from_polar.cast<float>()) {
        const double latitude = projection.first_y + projection.step_y * y;
        const double cosine = std::max(std::cos(latitude), 1e-6);
        sin_latitude = static_cast<float>(std::sin(latitude));
        cos_latitude = static_cast<float>(cosine);
        first_longitude = static_cast<float>(projection.first_x / cosine);
        longitude_step = static_cast<float>(projection.step_x / cosine);
    }
    Eigen::Vector3f direction(int x) const {
        const float longitude = first_longitude + longitude_step * static_cast<float>(x);
        return cloud_from_polar * Eigen::Vector3f(std::sin(longitude) * cos_latitude, sin_latitude,
                                                  std::cos(longitude) * cos_latitude);
    }
};

/// Copies what was seen of the buffer, and places the points.
void fill_cropped(RangeImage& image, const DepthBuffer& buffer, double resolution,
                  const Context& context) {
    int left = buffer.width;
    int right = -1;
    int top = buffer.height;
    int bottom = -1;
    for (int y = 0; y < buffer.height; ++y) {
        for (int x = 0; x < buffer.width; ++x) {
            if (buffer.ranges[buffer.index(x, y)] == RangeImage::far) {
                continue;
            }
            left = std::min(left, x);
            right = std::max(right, x);
            top = std::min(top, y);
            bottom = y;
        }
    }
    if (right < left) return;
    image.width = right - left + 1;
    image.height = bottom - top + 1;
    image.projection.step_x = image.projection.step_y = resolution;
    image.projection.first_x = left * resolution - pi;
    image.projection.first_y = top * resolution - pi / 2.0;
    const std::size_t size =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    image.ranges.assign(size, RangeImage::unobserved);
    image.points.assign(size, Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
    const auto rows = static_cast<std::size_t>(image.height);
    parallel_for(context, rows, 8, [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            const SinusoidalRow row(image.projection, y);
            for (int x = 0; x < image.width; ++x) {
                const float range = buffer.ranges[buffer.index(x + left, y + top)];
                if (range == RangeImage::far) continue;
                const std::size_t i = image.index(x, y);
                image.ranges[i] = range;
                image.points[i] = image.sensor_position + range * row.direction(x);
            }
        }
    });
}

}  // namespace

Eigen::Vector3d RangeProjection::direction(double x, double y) const {
    const double u = first_x + step_x * x;
    const double v = first_y + step_y * y;
    const double latitude = kind == Kind::longitude_by_row ? u : v;
    const double cos_latitude = std::cos(latitude);
    double longitude = kind == Kind::longitude_by_row ? v : u;
    if (kind == Kind::sinusoidal) longitude = cos_latitude == 0.0 ? 0.0 : u / cos_latitude;
    return cloud_from_polar * Eigen::Vector3d(std::sin(longitude) * cos_latitude,
                                              std::sin(latitude),
                                              std::cos(longitude) * cos_latitude);
}

Eigen::Vector2d RangeProjection::pixel(const Eigen::Vector3d& direction) const {
    const Eigen::Vector3d ray = cloud_from_polar.transpose() * direction.normalized();
    const double latitude = std::asin(std::clamp(ray.y(), -1.0, 1.0));
    const double longitude = std::atan2(ray.x(), ray.z());
    double u = kind == Kind::longitude_by_row ? latitude : longitude;
    if (kind == Kind::sinusoidal) u *= std::cos(latitude);
    const double v = kind == Kind::longitude_by_row ? longitude : latitude;
    return {(u - first_x) / step_x, (v - first_y) / step_y};
}

RangeImage make_range_image(const Scan& scan, const RangeImageSettings& settings,
                            const Context& context) {
    check_settings(settings);
    RangeImage image;
    image.sensor_position = scan.sensor_position().cast<float>();
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
    if (settings.frame == SensorFrame::laser) axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    if (scan.cloud.sensor_pose) axes = scan.cloud.sensor_pose->linear() * axes;
    image.projection.cloud_from_polar = axes;
    image.up = -axes.col(1).cast<float>();

    if (settings.source == RangeImageSource::grid &&
        fill_from_grid(image, scan.cloud, settings.angular_resolution)) {
        return image;
    }
    const std::vector<ImageAngles> angles = image_angles(scan.cloud.positions, image, context);
    const double resolution =
        settings.angular_resolution ? *settings.angular_resolution : derive_resolution(angles);
    fill_cropped(image, DepthBuffer(angles, resolution), resolution, context);
    return image;
}

}  // namespace roomscribe
