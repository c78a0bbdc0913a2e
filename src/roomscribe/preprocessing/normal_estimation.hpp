// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/geometry/search_tree.hpp"

namespace roomscribe {

struct NormalSettings {
    int num_neighbors = 20;

    void visit(SettingVisitor& visitor) {
        visitor(
            num_neighbors,
            {.name = "num_neighbors",
             .unit = "",
             .min = 3,
             .max = 1000,
             .doc = "Nearest points, the point itself among them, that a normal is fitted to."});
    }
};

struct PointNormals {
    /// Unit normal per point; NaN where the neighbours lie on one line or are fewer than 3.
    std::vector<Eigen::Vector3f> normals;
    /// m, root mean square distance of the neighbours to the fitted plane; NaN as above.
    std::vector<float> residuals;
};

/// Normals by principal components of the nearest points. The sign is turned towards
/// `sensor_position` (towards the scanner, since a surface is seen from its front).
/// Precondition: `tree` was made of `positions`, all finite.
PointNormals estimate_normals(std::span<const Eigen::Vector3f> positions, const SearchTree& tree,
                              const Eigen::Vector3d& sensor_position,
                              const NormalSettings& settings = {}, const Context& context = {});

}  // namespace roomscribe
