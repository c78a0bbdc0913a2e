// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/scanning/scanner_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/units.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

/// Angles from `first` towards `last`, `step` apart, in degrees there and in radians here.
std::vector<double> angles(double first, double last, double step) {
    const auto count = static_cast<std::size_t>(std::floor(std::abs(last - first) / step + 1e-9));
    std::vector<double> result;
    for (std::size_t i = 0; i <= count; ++i) {
        result.push_back(radians(first + (last < first ? -step : step) * static_cast<double>(i)));
    }
    return result;
}

/// Columns from `first` on over `extent` degrees; a full turn does not repeat its first column.
void set_columns(ScannerModel& model, double first, double extent, double step) {
    model.first_column = radians(first);
    model.column_step = radians(step);
    const double steps = std::floor(extent / step + 1e-9);
    model.num_columns = static_cast<std::size_t>(steps) + (extent < 360.0 ? 1 : 0);
}

ScannerModel sick_lms200(double coarseness) {
    ScannerModel model;
    model.pattern = ScanPattern::tilting_plane;
    model.row_angles = angles(60.0, -60.0, 0.5 * coarseness);
    set_columns(model, -90.0, 180.0, 0.25 * coarseness);
    model.min_range = 0.1;
    model.max_range = 80.0;
    model.dark_range = 10.0;
    model.range_noise = 0.005;
    model.darkness_bias = 0.005;
    model.range_step = 0.01;
    model.beam_exit = 0.010;
    model.divergence = 0.0044;
    model.pulse_resolution = 1.3;
    model.row_jitter = radians(0.03);
    model.ray_jitter = radians(0.01);
    model.dropout_rate = 0.001;
    model.outlier_rate = 0.0002;
    return model;
}

ScannerModel hokuyo_utm30lx(double coarseness) {
    ScannerModel model;
    model.pattern = ScanPattern::tilting_plane;
    model.row_angles = angles(80.0, -42.0, 0.33 * coarseness);
    set_columns(model, -135.0, 270.0, 0.25 * coarseness);
    model.min_range = 0.1;
    model.max_range = 30.0;
    model.dark_range = 10.0;
    model.range_noise = 0.008;
    model.darkness_bias = 0.01;
    model.range_step = 0.001;
    model.beam_exit = 0.01;
    model.divergence = 0.006;
    model.pulse_resolution = 0.8;
    model.row_jitter = radians(0.02);
    model.ray_jitter = radians(0.01);
    model.dropout_rate = 0.002;
    model.outlier_rate = 0.0003;
    return model;
}

ScannerModel terrestrial(double coarseness) {
    ScannerModel model;
    model.pattern = ScanPattern::sphere;
    model.row_angles = angles(90.0, -62.5, 0.15 * coarseness);
    set_columns(model, -180.0, 360.0, 0.15 * coarseness);
    model.min_range = 0.6;
    model.max_range = 120.0;
    model.dark_range = 25.0;
    model.range_noise = 0.002;
    model.darkness_bias = 0.001;
    model.range_step = 0.0001;
    model.beam_exit = 0.003;
    model.divergence = 0.00019;
    // By phase, not by pulse: whatever a beam meets is mixed, however far apart.
    model.pulse_resolution = 1000.0;
    model.row_jitter = radians(0.002);
    model.ray_jitter = radians(0.002);
    model.dropout_rate = 0.0005;
    model.outlier_rate = 0.00002;
    return model;
}

ScannerModel structured_light(double wanted_coarseness) {
    const double coarseness = std::max(1.0, wanted_coarseness);
    ScannerModel model;
    model.pattern = ScanPattern::image;
    model.row_angles.resize(
        static_cast<std::size_t>(std::max(1.0, std::floor(480.0 / coarseness))));
    model.num_columns = static_cast<std::size_t>(std::max(1.0, std::floor(640.0 / coarseness)));
    model.min_range = 0.5;
    model.max_range = 5.0;
    model.dark_range = 3.5;
    model.focal_length = 580.0 / coarseness;
    model.baseline = 0.075;
    // In pixels of this image, so that a coarser one has the same depths.
    model.disparity_step = 0.125 / coarseness;
    model.disparity_noise = 0.052 / coarseness;
    model.noise_size = std::max(1.0, 5.0 / coarseness);
    model.pixel_jitter = 0.8 / coarseness;
    model.blind_columns = static_cast<std::size_t>(std::round(8.0 / coarseness));
    model.dropout_rate = 0.0005;
    return model;
}

ScannerModel spinning_lidar(double coarseness) {
    ScannerModel model;
    model.pattern = ScanPattern::sphere;
    model.min_range = 0.4;
    model.max_range = 100.0;
    model.dark_range = 35.0;
    if (coarseness < 1.5) {  // Ouster OS1-64
        model.row_angles = angles(16.6, -16.7, 33.2 / 63.0);
    } else if (coarseness < 3.0) {  // Velodyne HDL-32E
        model.row_angles = angles(10.67, -30.68, 4.0 / 3.0);
    } else {  // Velodyne VLP-16
        model.row_angles = angles(15.0, -15.0, 2.0);
    }
    const double azimuth_step = model.num_rows() == 64 ? 360.0 / 2048.0 : 0.2;
    set_columns(model, -180.0, 360.0, azimuth_step * std::max(1.0, coarseness / 4.0));
    model.range_noise = 0.022;
    model.row_bias = 0.02;
    model.darkness_bias = 0.01;
    model.range_step = 0.002;
    model.beam_exit = 0.011;
    model.divergence = 0.003;
    model.pulse_resolution = 0.8;
    model.ray_jitter = radians(0.01);
    model.dropout_rate = 0.001;
    model.outlier_rate = 0.00005;
    return model;
}

/// The tilts at which a tilting plane, with rays to its front or to its back, holds a direction.
bool is_in_tilting_plane(const ScannerModel& model, const Vector3d& direction) {
    const double low = model.row_angles.back();
    const double high = model.row_angles.front();
    const double last_column =
        model.first_column + model.column_step * static_cast<double>(model.num_columns - 1);
    const double side = std::asin(std::clamp(direction.y(), -1.0, 1.0));
    const auto holds = [&](double tilt, double column) {
        return tilt >= low && tilt <= high && column >= model.first_column && column <= last_column;
    };
    const double behind = side < 0.0 ? -std::numbers::pi - side : std::numbers::pi - side;
    return holds(std::atan2(-direction.z(), direction.x()), side) ||
           holds(std::atan2(direction.z(), -direction.x()), behind);
}

bool is_in_image(const ScannerModel& model, const Vector3d& point) {
    if (point.z() < model.min_range || point.z() > model.max_range) return false;
    return std::abs(point.x() / point.z()) * model.focal_length <=
               0.5 * static_cast<double>(model.num_columns) &&
           std::abs(point.y() / point.z()) * model.focal_length <=
               0.5 * static_cast<double>(model.num_rows());
}

}  // namespace

bool ScannerModel::is_closed() const {
    return pattern == ScanPattern::sphere &&
           column_step * static_cast<double>(num_columns + 1) > 2.0 * std::numbers::pi;
}

ScannerModel scanner_model(ScannerKind scanner, double coarseness) {
    if (!(coarseness >= 0.5 && coarseness <= 100.0)) {
        throw InvalidArgument("coarseness", fmt::format("{}", coarseness), "0.5 to 100");
    }
    switch (scanner) {
        case ScannerKind::sick_lms200:
            return sick_lms200(coarseness);
        case ScannerKind::hokuyo_utm30lx:
            return hokuyo_utm30lx(coarseness);
        case ScannerKind::terrestrial:
            return terrestrial(coarseness);
        case ScannerKind::structured_light:
            return structured_light(coarseness);
        case ScannerKind::spinning_lidar:
            break;
    }
    return spinning_lidar(coarseness);
}

Vector3d ray_direction(const ScannerModel& model, std::size_t row, std::size_t column,
                       double row_error, double column_error) {
    if (model.pattern == ScanPattern::image) {
        const auto centered = [](std::size_t pixel, std::size_t count, double error) {
            return static_cast<double>(pixel) + 0.5 - 0.5 * static_cast<double>(count) + error;
        };
        return Vector3d(centered(column, model.num_columns, column_error),
                        centered(row, model.num_rows(), row_error), model.focal_length)
            .normalized();
    }
    const double u = model.row_angles[row] + row_error;
    const double v =
        model.first_column + model.column_step * static_cast<double>(column) + column_error;
    if (model.pattern == ScanPattern::tilting_plane) {
        return {std::cos(u) * std::cos(v), std::sin(v), -std::sin(u) * std::cos(v)};
    }
    return {std::cos(u) * std::cos(v), std::cos(u) * std::sin(v), std::sin(u)};
}

bool is_in_view(const ScannerModel& model, const Vector3d& point_in_scan) {
    if (model.pattern == ScanPattern::image) return is_in_image(model, point_in_scan);
    const double range = point_in_scan.norm();
    if (range < model.min_range || range > model.max_range) return false;
    const Vector3d direction = point_in_scan / range;
    if (model.pattern == ScanPattern::tilting_plane) return is_in_tilting_plane(model, direction);
    const double elevation = std::asin(std::clamp(direction.z(), -1.0, 1.0));
    return elevation <= model.row_angles.front() && elevation >= model.row_angles.back();
}

}  // namespace roomscribe
