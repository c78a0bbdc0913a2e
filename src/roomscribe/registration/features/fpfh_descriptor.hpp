// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/geometry/search_tree.hpp"

namespace roomscribe {

struct FpfhSettings {
    double radius = 0.5;

    void visit(SettingVisitor& visitor) {
        visitor(radius, {.name = "radius",
                         .unit = "m",
                         .min = 1e-6,
                         .max = 1e6,
                         .doc = "Neighbours up to this distance shape a point's histogram."});
    }
};

inline constexpr int fpfh_bins_per_angle = 11;
inline constexpr int fpfh_size = 3 * fpfh_bins_per_angle;

/// One column per keypoint: three histograms of 11 bins over the angles between a point's normal
/// and its neighbours', each of which sums to 100. All zero for a keypoint without a neighbour.
using FpfhDescriptors = Eigen::Matrix<float, fpfh_size, Eigen::Dynamic>;

/// Fast Point Feature Histograms (Rusu, Blodow and Beetz 2009; steps 1 and 2 of the paper's
/// Algorithm 1), with the simplified histogram of every point computed once. Invariant to rigid
/// motion. Points whose normal is NaN count for nothing.
/// Preconditions: `tree` was made of `positions`, all finite; one unit normal (or NaN) per
/// position; every keypoint < positions.size().
FpfhDescriptors compute_fpfh(std::span<const Eigen::Vector3f> positions,
                             std::span<const Eigen::Vector3f> normals, const SearchTree& tree,
                             std::span<const std::uint32_t> keypoints,
                             const FpfhSettings& settings = {}, const Context& context = {});

}  // namespace roomscribe
