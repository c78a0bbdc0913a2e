// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/geometry/transform.hpp"

namespace roomscribe {

enum class ScalarType : std::uint8_t {
    int8,
    uint8,
    int16,
    uint16,
    int32,
    uint32,
    int64,
    uint64,
    float32,
    float64
};

/// Bytes that one value of the type takes.
std::size_t size_of(ScalarType type);

/// A property of the points that roomscribe carries along without reading it, as it stood in the
/// file: `count` values of `type` per point, native byte order, point after point.
struct Channel {
    std::string name;
    ScalarType type = ScalarType::float32;
    std::size_t count = 1;
    std::vector<std::byte> values;

    std::size_t bytes_per_point() const { return size_of(type) * count; }
};

/// The scanner's own order of its rays: point (row, column) is number row * columns + column, and
/// a ray without return has NaN coordinates.
struct ScanGrid {
    std::size_t rows = 0;
    std::size_t columns = 0;
};

/// Points as a structure of arrays. Every array but `positions` is empty or as long as it.
/// Positions are metres in the cloud's own frame; a point may be NaN or infinite (no return).
struct PointCloud {
    std::vector<Eigen::Vector3f> positions;
    std::vector<Eigen::Vector3f> normals;
    std::vector<std::array<std::uint8_t, 3>> colors;  ///< red, green, blue
    std::vector<float> intensities;
    std::vector<Channel> channels;
    std::optional<ScanGrid> grid;
    /// Where the scanner stood and how it was turned, in the cloud's frame, if the file says so.
    /// What a ray did not hit is evidence, and rays start here.
    std::optional<Transform> sensor_pose;
    /// Far coordinates (map grids) are kept small: file coordinates = positions + global_shift.
    Eigen::Vector3d global_shift = Eigen::Vector3d::Zero();

    std::size_t size() const { return positions.size(); }
    bool empty() const { return positions.empty(); }
};

inline bool is_finite(const Eigen::Vector3f& point) {
    return point.allFinite();
}

/// Numbers of the points with finite coordinates, ascending.
std::vector<std::uint32_t> finite_points(const PointCloud& cloud);

/// The points with these numbers, in that order, with all their arrays and channels; the grid is
/// dropped, the sensor pose kept. Precondition: every index < cloud.size().
PointCloud select_points(const PointCloud& cloud, std::span<const std::uint32_t> indices);

/// How far half of the finite points are from their middle, from an even sample of them; the middle
/// is the median along each axis. Far returns and ghosts blow up the box of a scan, but not this. 0
/// if there is none.
double median_distance(std::span<const Eigen::Vector3f> points);

/// Multiplies all coordinates: positions, the sensor pose's place and the global shift. Channels
/// stay as they are.
void scale_in_place(PointCloud& cloud, double factor);

/// Moves positions, normals and sensor pose. Grid, colours and channels are kept.
void transform_in_place(PointCloud& cloud, const Transform& target_from_source);

}  // namespace roomscribe
