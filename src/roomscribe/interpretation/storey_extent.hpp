// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "roomscribe/interpretation/level_surfaces.hpp"
#include "roomscribe/interpretation/wall_surfaces.hpp"

namespace roomscribe {

/// Where a storey reaches, seen from above. Through windows and open doors a scanner also sees
/// streets, facades and balconies; they are told by their distance.
class StoreyExtent {
  public:
    using Points = std::vector<Eigen::Vector2d>;

    /// `x` and `y` are level unit vectors.
    StoreyExtent(const SurfaceSample& sample, std::span<const PlanarPatch> patches,
                 const Eigen::Vector3d& x, const Eigen::Vector3d& y, double max_gap)
        : sample_(sample), patches_(patches), x_(x), y_(y), max_gap_(max_gap) {}

    /// Breaks levels into pieces at gaps wider than `max_gap`. Of a storey with floor and ceiling,
    /// pieces stay that have a piece of the other within `max_gap`; of one that shows either only,
    /// all do. Sloping ceilings stay that are near the floor and have nothing above them.
    Storey without_outside(const Storey& storey) const;

    /// Whether at least half of the surface's width lies within `max_gap` of floor or ceiling; true
    /// if none was seen.
    bool is_beside(const UprightSurface& surface, const Points& footprint) const;

    /// Of floor and ceilings, thinned.
    Points footprint(const Storey& storey) const;

  private:
    /// Whether next to nothing was seen above it, as is so of ceilings under a roof, but not of the
    /// underside of stairs and shelves.
    bool is_topmost(const PlanarPatch& patch) const;
    Points footprint(std::span<const Level> levels) const;
    std::vector<Level> split(const Level& level) const;
    void keep_near(std::vector<Level>& levels, const Points& others) const;

    const SurfaceSample& sample_;
    std::span<const PlanarPatch> patches_;
    Eigen::Vector3d x_;
    Eigen::Vector3d y_;
    double max_gap_;
};

}  // namespace roomscribe
