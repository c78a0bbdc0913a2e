// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "roomscribe/core/random.hpp"
#include "roomscribe/simulation/scanning/ray_caster.hpp"

namespace roomscribe {

/// What comes back along a thin ray.
struct Echo {
    float range = 0.0F;     ///< m, length of the whole path; 0 where nothing comes back
    float cosine = 1.0F;    ///< of the angle of incidence where the path ends
    float strength = 0.0F;  ///< relative to a white Lambertian surface hit squarely at that range
    std::uint32_t part = 0;
    bool is_ghost = false;  ///< seen in a mirror

    explicit operator bool() const { return range > 0.0F; }
};

/// Follows a ray through panes and off mirrors, up to four of them, to the surface that sends it
/// back. Draws from `random` only where chance decides: at panes and glossy surfaces.
Echo trace_ray(const RayCaster& caster, const Eigen::Vector3d& origin,
               const Eigen::Vector3d& direction, Random& random);

}  // namespace roomscribe
