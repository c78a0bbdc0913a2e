// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/simulation/scenario.hpp"

namespace roomscribe {

/// In which order and directions a scanner sends its rays.
enum class ScanPattern : std::uint8_t {
    tilting_plane,  ///< rows are tilts (nose down positive), columns angles within the tilted plane
    sphere,         ///< rows are elevations, columns azimuths
    image           ///< rows and columns of a pinhole camera: x right, y down, z forward
};

/// The numbers of a scanner. docs/simulation.md says where they come from. Angles are radians.
struct ScannerModel {
    ScanPattern pattern = ScanPattern::sphere;
    std::vector<double> row_angles;
    double first_column = 0.0;
    double column_step = 0.0;
    std::size_t num_columns = 0;

    double min_range = 0.1;   ///< m; of the depth z for an image
    double max_range = 30.0;  ///< m; of the depth z for an image
    /// At which a surface of 10 % reflectance, hit squarely, is returned half the time.
    double dark_range = 10.0;

    double range_noise = 0.01;   ///< m, standard deviation on a bright surface
    double row_bias = 0.0;       ///< m, standard deviation of a beam's constant error
    double darkness_bias = 0.0;  ///< m longer for every factor of 10 in reflectance below 50 %
    double range_step = 0.001;   ///< m, to which ranges are rounded
    double beam_exit = 0.005;    ///< m, diameter of the beam where it leaves
    double divergence = 0.003;   ///< full angle of the beam
    /// Surfaces of one beam closer to each other than this melt into one range.
    double pulse_resolution = 0.5;

    double row_jitter = 0.0;  ///< of a whole row's angle
    double ray_jitter = 0.0;  ///< of each ray across the row
    double dropout_rate = 0.0;
    double outlier_rate = 0.0;

    // An image has these instead of beams: pixels, metres.
    double focal_length = 0.0;
    double baseline = 0.0;          ///< the projector is this far to the right of the camera
    double disparity_step = 0.0;    ///< to which disparities are rounded
    double disparity_noise = 0.0;   ///< standard deviation before rounding
    double noise_size = 0.0;        ///< pixels over which the noise of disparities is alike
    double pixel_jitter = 0.0;      ///< standard deviation of where a pixel looks
    std::size_t blind_columns = 0;  ///< at the right edge, where the pattern cannot be matched

    std::size_t num_rows() const { return row_angles.size(); }
    /// True if the last column is followed by the first.
    bool is_closed() const;
};

/// `coarseness` multiplies the angular steps; of the spinning lidar it chooses the device: 64 beams
/// for 1, 32 for 2, 16 for 4 or more; no image has more than 640 x 480 pixels. Throws
/// InvalidArgument unless it is in [0.5, 100].
ScannerModel scanner_model(ScannerKind scanner, double coarseness = 1.0);

/// Unit direction of a ray in the scanner's frame. `row_error` and `column_error` are added to its
/// angles (to its pixel, for an image).
Eigen::Vector3d ray_direction(const ScannerModel& model, std::size_t row, std::size_t column,
                              double row_error = 0.0, double column_error = 0.0);

/// True if the scanner has rays in this direction of its own frame and at this range.
bool is_in_view(const ScannerModel& model, const Eigen::Vector3d& point_in_scan);

}  // namespace roomscribe
