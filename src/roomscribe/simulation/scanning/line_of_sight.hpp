// SPDX-License-Identifier: MIT
#pragma once

#include "roomscribe/simulation/scanning/ray_caster.hpp"

namespace roomscribe {

/// True if nothing stands between two points but what `ignores(part)` says to look through, and
/// what lies within `tolerance` of `to`.
template <typename Ignores>
bool is_in_sight(const RayCaster& caster, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                 double tolerance, Ignores&& ignores) {
    const Eigen::Vector3d path = to - from;
    const auto hit = caster.cast_past(ignores, from, path.normalized());
    return !hit || hit->distance >= path.norm() - tolerance;
}

/// True for panes: they let see what is behind.
inline bool is_pane(const WorldPart& part) {
    return part.transparency > 0.0 || part.material == Material::glass;
}

}  // namespace roomscribe
