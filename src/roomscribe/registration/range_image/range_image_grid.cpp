// SPDX-License-Identifier: MIT
#include "roomscribe/registration/range_image/range_image_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "roomscribe/core/quantile.hpp"

namespace roomscribe {
namespace {

double wrapped(double angle) {
    return std::remainder(angle, 2.0 * std::numbers::pi);
}

/// One of the two angles of every ray; NaN for a ray without return.
using Angles = std::vector<double>;

/// angle = first + step * number of the row or column.
struct EvenSteps {
    double first = 0.0;
    double step = 0.0;
};

/// How one angle runs along the rows (by column) or down the columns (by row) of a grid.
class AngleFit {
  public:
    AngleFit(const Angles& angles, const ScanGrid& grid, bool by_column)
        : angles_(angles), grid_(grid), by_column_(by_column) {}

    EvenSteps fit() const {
        EvenSteps steps;
        steps.step = median_step();
        double sum_sin = 0.0;
        double sum_cos = 0.0;
        for_each([&](std::size_t, double place, double angle) {
            sum_sin += std::sin(angle - steps.step * place);
            sum_cos += std::cos(angle - steps.step * place);
        });
        steps.first = std::atan2(sum_sin, sum_cos);
        // A median of single differences is coarse, and its error grows with the place.
        Eigen::Matrix2d normal_matrix = Eigen::Matrix2d::Zero();
        Eigen::Vector2d right_side = Eigen::Vector2d::Zero();
        for_each([&](std::size_t, double place, double angle) {
            const Eigen::Vector2d row(1.0, place);
            normal_matrix += row * row.transpose();
            right_side += row * wrapped(angle - steps.first - steps.step * place);
        });
        const double determinant = normal_matrix.determinant();
        if (determinant > 0.0) {
            steps.first +=
                (normal_matrix(1, 1) * right_side(0) - normal_matrix(0, 1) * right_side(1)) /
                determinant;
            steps.step +=
                (normal_matrix(0, 0) * right_side(1) - normal_matrix(0, 1) * right_side(0)) /
                determinant;
        }
        return steps;
    }

    /// True if nearly all rays are within half a step of their place; an error of a longitude
    /// counts for what it is on the sphere.
    bool holds(const EvenSteps& steps, const Angles* latitudes) const {
        std::size_t num_rays = 0;
        std::size_t num_off = 0;
        for_each([&](std::size_t i, double place, double angle) {
            ++num_rays;
            const double error = std::abs(wrapped(angle - steps.first - steps.step * place));
            const double scale = latitudes == nullptr ? 1.0 : std::cos((*latitudes)[i]);
            if (error * scale > 0.5 * std::abs(steps.step)) ++num_off;
        });
        return num_rays > 0 && steps.step != 0.0 &&
               static_cast<double>(num_off) <= 0.02 * static_cast<double>(num_rays);
    }

  private:
    template <typename Visit>
    void for_each(Visit&& visit) const {
        for (std::size_t i = 0; i < angles_.size(); ++i) {
            if (std::isnan(angles_[i])) continue;
            visit(i, static_cast<double>(by_column_ ? i % grid_.columns : i / grid_.columns),
                  angles_[i]);
        }
    }

    double median_step() const {
        std::vector<double> steps;
        const std::size_t stride = by_column_ ? 1 : grid_.columns;
        for (std::size_t i = 0; i + stride < angles_.size(); ++i) {
            if (by_column_ && (i + 1) % grid_.columns == 0) continue;
            const double step = wrapped(angles_[i + stride] - angles_[i]);
            if (!std::isnan(step)) steps.push_back(step);
        }
        return median(steps);
    }

    const Angles& angles_;
    const ScanGrid& grid_;
    bool by_column_;
};

/// Sets kind, first and step of the projection if the rays fit its axes.
bool fit_projection(RangeProjection& projection, const PointCloud& cloud,
                    const Eigen::Vector3d& origin) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    Angles longitudes(cloud.size(), nan);
    Angles latitudes(cloud.size(), nan);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        if (!is_finite(cloud.positions[i])) continue;
        const Eigen::Vector3d ray = projection.cloud_from_polar.transpose() *
                                    (cloud.positions[i].cast<double>() - origin).normalized();
        latitudes[i] = std::asin(std::clamp(ray.y(), -1.0, 1.0));
        longitudes[i] = std::atan2(ray.x(), ray.z());
    }
    for (const bool longitude_by_column : {true, false}) {
        const AngleFit longitude_fit(longitudes, *cloud.grid, longitude_by_column);
        const AngleFit latitude_fit(latitudes, *cloud.grid, !longitude_by_column);
        const EvenSteps longitude = longitude_fit.fit();
        const EvenSteps latitude = latitude_fit.fit();
        if (!longitude_fit.holds(longitude, &latitudes) || !latitude_fit.holds(latitude, nullptr)) {
            continue;
        }
        projection.kind = longitude_by_column ? RangeProjection::Kind::longitude_by_column
                                              : RangeProjection::Kind::longitude_by_row;
        const EvenSteps& across = longitude_by_column ? longitude : latitude;
        const EvenSteps& down = longitude_by_column ? latitude : longitude;
        projection.first_x = across.first;
        projection.step_x = across.step;
        projection.first_y = down.first;
        projection.step_y = down.step;
        return true;
    }
    return false;
}

std::size_t rays_per_pixel(double step, std::optional<double> angular_resolution) {
    if (!angular_resolution) return 1;
    return static_cast<std::size_t>(
        std::max(1L, std::lround(*angular_resolution / std::abs(step))));
}

/// A single ray without return is a dropout; it is one of the sky if its neighbours are so too.
bool is_among_far(const PointCloud& cloud, std::size_t row, std::size_t column) {
    const ScanGrid& grid = *cloud.grid;
    for (std::size_t y = row > 0 ? row - 1 : 0; y <= std::min(row + 1, grid.rows - 1); ++y) {
        for (std::size_t x = column > 0 ? column - 1 : 0;
             x <= std::min(column + 1, grid.columns - 1); ++x) {
            if (is_finite(cloud.positions[y * grid.columns + x])) return false;
        }
    }
    return true;
}

void fill_pixel(RangeImage& image, const PointCloud& cloud, std::size_t pixel, std::size_t row,
                std::size_t column) {
    const Eigen::Vector3f& point = cloud.positions[row * cloud.grid->columns + column];
    float& range = image.ranges[pixel];
    if (is_finite(point)) {
        const float distance = (point - image.sensor_position).norm();
        if (std::isfinite(range) && range <= distance) return;
        range = distance;
        image.points[pixel] = point;
    } else if (!std::isfinite(range) && is_among_far(cloud, row, column)) {
        range = RangeImage::far;
    }
}

}  // namespace

bool fill_from_grid(RangeImage& image, const PointCloud& cloud,
                    std::optional<double> angular_resolution) {
    if (!cloud.grid || cloud.grid->rows < 2 || cloud.grid->columns < 2) return false;
    const Eigen::Vector3d origin = image.sensor_position.cast<double>();
    const Eigen::Matrix3d axes = image.projection.cloud_from_polar;
    Eigen::Matrix3d nodding;
    nodding << axes.col(1), axes.col(0), axes.col(2);
    RangeProjection projection = image.projection;
    bool is_regular = false;
    for (const Eigen::Matrix3d& candidate : {axes, nodding}) {
        projection.cloud_from_polar = candidate;
        is_regular = fit_projection(projection, cloud, origin);
        if (is_regular) break;
    }
    if (!is_regular) return false;

    const std::size_t rays_x = rays_per_pixel(projection.step_x, angular_resolution);
    const std::size_t rays_y = rays_per_pixel(projection.step_y, angular_resolution);
    projection.first_x += 0.5 * projection.step_x * static_cast<double>(rays_x - 1);
    projection.first_y += 0.5 * projection.step_y * static_cast<double>(rays_y - 1);
    projection.step_x *= static_cast<double>(rays_x);
    projection.step_y *= static_cast<double>(rays_y);
    image.projection = projection;
    image.source = RangeImageSource::grid;
    const std::size_t width = (cloud.grid->columns + rays_x - 1) / rays_x;
    const std::size_t height = (cloud.grid->rows + rays_y - 1) / rays_y;
    image.width = static_cast<int>(width);
    image.height = static_cast<int>(height);
    image.ranges.assign(width * height, RangeImage::unobserved);
    image.points.assign(width * height,
                        Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
    for (std::size_t row = 0; row < cloud.grid->rows; ++row) {
        for (std::size_t column = 0; column < cloud.grid->columns; ++column) {
            fill_pixel(image, cloud, row / rays_y * width + column / rays_x, row, column);
        }
    }
    return true;
}

}  // namespace roomscribe
