// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <filesystem>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/io/file_contents.hpp"

namespace roomscribe {

// 3DTK's UOS format: one point per line, "x y z" and perhaps more, in centimetres and a left-handed
// frame: x right, y up, z forward. Beside it stands a .pose file: position in centimetres, then
// three angles in degrees, in the same frame. roomscribe's frame is x forward, y left, z up:
//
//     x =  z_uos / 100        x_uos = -100 y
//     y = -x_uos / 100        y_uos =  100 z
//     z =  y_uos / 100        z_uos =  100 x
//
// which is 3DTK's own exchange with right-handed frames (its ROS wrapper). Call that swap of axes
// M (it mirrors, det = -1): a rotation R_uos becomes M R_uos M^-1.
// Source: 3DTK, EulerToMatrix4 and Matrix4ToEuler: R_uos = R_x(a) R_y(b) R_z(c).

/// Reads a .3d file. The .pose beside it is not applied, and returns that are too near or too far
/// to be true are kept. A fourth column, if it is the last, is the intensity; of more columns each
/// is a channel column_4, column_5, ... of float64. Lines that begin with # are skipped at the top.
FileContents read_uos(const std::filesystem::path& path, PointsAs as, const Context& context);

/// Writes positions and intensities with 9 digits: read_uos gives the same float32 back.
void write_uos(const std::filesystem::path& path, const PointCloud& cloud, const Context& context);

/// The six numbers of a .pose file and the motion they stand for.
Transform transform_from_uos(const std::array<double, 6>& pose);
std::array<double, 6> uos_from_transform(const Transform& transform);

}  // namespace roomscribe
