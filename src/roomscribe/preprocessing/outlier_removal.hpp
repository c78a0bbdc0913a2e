// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/geometry/search_tree.hpp"

namespace roomscribe {

struct OutlierSettings {
    int num_neighbors = 8;
    double max_deviations = 3.0;

    void visit(SettingVisitor& visitor) {
        visitor(num_neighbors, {.name = "num_neighbors",
                                .unit = "",
                                .min = 1,
                                .max = 1000,
                                .doc = "Nearest points whose mean distance is looked at."});
        visitor(max_deviations,
                {.name = "max_deviations",
                 .unit = "",
                 .min = 0.0,
                 .max = 1e6,
                 .doc = "A point stays while the logarithm of its mean distance is at most this "
                        "many robust standard deviations above the median."});
    }
};

/// Numbers of the points that stay, ascending. Statistical outlier removal (Rusu et al. 2008) on
/// the logarithm of the distances with median and MAD, which the outliers themselves cannot move
/// and which a density that falls with range does not mislead. Precondition: `tree` was made of
/// `positions`, all finite.
std::vector<std::uint32_t> remove_outliers(std::span<const Eigen::Vector3f> positions,
                                           const SearchTree& tree,
                                           const OutlierSettings& settings = {},
                                           const Context& context = {});

}  // namespace roomscribe
