// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include <Eigen/Core>

#include "roomscribe/simulation/simulated_world.hpp"

namespace roomscribe {

struct RayHit {
    double distance = 0.0;  ///< m
    std::uint32_t part = 0;
    std::uint32_t triangle = 0;
    double cosine = 1.0;     ///< of the angle between the ray and the surface's normal, positive
    Eigen::Vector3f normal;  ///< unit, towards the ray's origin
};

/// Finds what rays hit first, by Embree (Wald et al. 2014). Keeps a reference to the world, which
/// must outlive it. May be asked from many threads.
class RayCaster {
  public:
    explicit RayCaster(const SimulatedWorld& world);
    ~RayCaster();
    RayCaster(const RayCaster&) = delete;
    RayCaster& operator=(const RayCaster&) = delete;

    /// First surface along the unit direction, at more than `min_distance`; empty if there is none.
    std::optional<RayHit> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                               double min_distance = 1e-4) const;

    /// The same, but looks through the parts for which `ignores` is true, also where they coincide
    /// with others.
    std::optional<RayHit> cast_past(const std::function<bool(std::uint32_t part)>& ignores,
                                    const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                    double min_distance = 1e-4) const;

    const SimulatedWorld& world() const { return world_; }

  private:
    struct Tree;
    struct Query;
    std::optional<RayHit> run(Query& query, const Eigen::Vector3d& origin,
                              const Eigen::Vector3d& direction, double min_distance) const;

    const SimulatedWorld& world_;
    std::unique_ptr<Tree> tree_;
};

}  // namespace roomscribe
