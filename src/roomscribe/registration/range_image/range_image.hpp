// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/model/scan.hpp"

namespace roomscribe {

/// What the pixels of a range image are made of.
enum class RangeImageSource : std::uint8_t {
    cloud,  ///< the points, sorted into square pixels of one angle
    grid,   ///< the scanner's own rays, if they are known and regular; else as `cloud`
};

inline std::span<const std::string_view> enumerator_names(RangeImageSource) {
    static constexpr std::array<std::string_view, 2> names{"cloud", "grid"};
    return names;
}

/// How the scanner's axes stand in the scan.
enum class SensorFrame : std::uint8_t {
    laser,   ///< x forward, y left, z up
    camera,  ///< z forward, x right, y down
};

inline std::span<const std::string_view> enumerator_names(SensorFrame) {
    static constexpr std::array<std::string_view, 2> names{"laser", "camera"};
    return names;
}

struct RangeImageSettings {
    RangeImageSource source = RangeImageSource::cloud;
    SensorFrame frame = SensorFrame::laser;
    std::optional<double> angular_resolution = {};

    void visit(SettingVisitor& visitor) {
        visitor(source, {.name = "source",
                         .unit = "",
                         .doc = "Pixels from the points, or from the scanner's grid of rays."});
        visitor(frame, {.name = "frame",
                        .unit = "",
                        .doc = "Axes of the scanner: laser (x forward, z up) or camera (z forward, "
                               "y down)."});
        visitor(angular_resolution,
                {.name = "angular_resolution",
                 .unit = "rad",
                 .min = 1e-4,
                 .max = 0.5,
                 .doc = "Angle of a pixel; auto: the smallest that leaves hardly a hole (for a "
                        "grid: its own)."});
    }
};

/// Where the pixels look. Angles are first + step * pixel; the pole is the axis about which
/// longitudes turn.
struct RangeProjection {
    enum class Kind : std::uint8_t {
        sinusoidal,           ///< y: latitude; x: longitude * cos(latitude), so pixels are square
        longitude_by_column,  ///< x: longitude, y: latitude
        longitude_by_row,     ///< x: latitude, y: longitude (a scanner that nods)
    };
    Kind kind = Kind::sinusoidal;
    double first_x = 0.0;
    double step_x = 0.0;
    double first_y = 0.0;
    double step_y = 0.0;
    /// Columns: the direction of longitude 90 degrees, the pole, and that of longitude 0.
    Eigen::Matrix3d cloud_from_polar = Eigen::Matrix3d::Identity();

    /// Unit direction of a pixel's ray in the cloud's frame.
    Eigen::Vector3d direction(double x, double y) const;
    /// The pixel, with its fraction, that a direction (of any length) falls into.
    Eigen::Vector2d pixel(const Eigen::Vector3d& direction) const;
};

/// Ranges as seen from the scanner, row by row from above. Pixels do not wrap: what lies behind
/// the scanner is cut by the image's sides, as in PCL.
struct RangeImage {
    static constexpr float unobserved = -HUGE_VALF;  ///< no ray is known to have gone there
    static constexpr float far = HUGE_VALF;          ///< a ray went there and did not return

    int width = 0;
    int height = 0;
    RangeImageSource source = RangeImageSource::cloud;
    RangeProjection projection;
    Eigen::Vector3f sensor_position = Eigen::Vector3f::Zero();
    /// Unit direction "up" of the scanner in the cloud's frame.
    Eigen::Vector3f up = Eigen::Vector3f::UnitZ();
    std::vector<float> ranges;  ///< m, `unobserved` or `far`
    /// In the cloud's frame; NaN unless the range is finite. For source `cloud` they lie in the
    /// middle of their pixels; for `grid` they are the scan's own points.
    std::vector<Eigen::Vector3f> points;

    std::size_t size() const { return ranges.size(); }
    bool contains(int x, int y) const { return x >= 0 && x < width && y >= 0 && y < height; }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x);
    }
    bool has_range(std::size_t pixel) const { return std::isfinite(ranges[pixel]); }
    bool has_range(int x, int y) const { return contains(x, y) && has_range(index(x, y)); }
    int column(std::size_t pixel) const {
        return static_cast<int>(pixel % static_cast<std::size_t>(width));
    }
    int row(std::size_t pixel) const {
        return static_cast<int>(pixel / static_cast<std::size_t>(width));
    }
};

/// The spherical range image of a scan, cropped to what was seen (Steder et al. 2011; the nearest
/// point of a pixel counts, and a pixel without one takes the nearest of those that fall between it
/// and its neighbours). Points that are not finite count for nothing, but in a grid a ray without
/// return among others without return is `far`. The scanner stands and is turned as
/// PointCloud::sensor_pose says, else at the cloud's origin. 0 x 0 pixels if no point is finite.
RangeImage make_range_image(const Scan& scan, const RangeImageSettings& settings = {},
                            const Context& context = {});

}  // namespace roomscribe
