// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/interpretation/openings/wall_relief.hpp"
#include "roomscribe/interpretation/rooms/wall_faces.hpp"
#include "roomscribe/structure/planar_patch.hpp"
#include "roomscribe/structure/surface_sample.hpp"

namespace roomscribe {

/// What an upright patch shows of a leaf that stands open. Places: m along the wall's face, m
/// behind it.
struct OpenLeafSide {
    std::uint32_t patch = 0;
    Eigen::Vector2d hinge = Eigen::Vector2d::Zero();
    Eigen::Vector2d free_edge = Eigen::Vector2d::Zero();
};

/// Leaves told among the upright patches of a map: those that stand open or ajar by their hinge at
/// a side of a hole, closed ones by how much of it they fill. What is handed over must outlive it.
class OpenLeafFinder {
  public:
    OpenLeafFinder(const SurfaceSample& sample, std::span<const PlanarPatch> patches,
                   const Eigen::Vector3d& up);

    /// What shows of leaves that stand open in a wall of a thickness, the one that fits the hole
    /// best first: upright patches, as wide and high as the hole, with one upright edge at a side
    /// of it. The lining of that side, as deep as the wall, may go on in the leaf's plane.
    std::vector<OpenLeafSide> find(const WallFace& face, const WallRectangle& hole,
                                   double thickness) const;

    /// m behind the face, of a closed leaf: patches parallel to the wall and no deeper than leaves
    /// lie, which fill 0.4 of the hole at one depth. However aslant it was seen, a reveal lies
    /// across the wall, and a frame fills less.
    std::optional<double> closed_leaf_depth(const WallFace& face, const WallRectangle& hole) const;

    /// m behind the face, to which the sides of a hole go on without a gap, in [0.1,
    /// max_thickness]: where the room behind was not seen, that tells the wall's thickness. The
    /// lesser of both, as a leaf that stands open may go on in the plane of one.
    std::optional<double> lining_depth(const WallFace& face, const WallRectangle& hole,
                                       double max_thickness) const;

    /// A leaf that stands ajar hides a part of its hole: that reaches to the hinge then.
    void widen_to_hinge(const WallFace& face, WallRectangle& hole) const;

  private:
    /// An upright patch: m along its own level direction and along up.
    struct Extent {
        Eigen::Vector3d along = Eigen::Vector3d::UnitX();
        double across = 0.0;  ///< m along its normal
        double start = 0.0;
        double end = 0.0;
        double bottom = 0.0;
        double top = 0.0;
    };

    bool is_upright(const PlanarPatch& patch) const;
    Extent extent_of(const PlanarPatch& patch) const;

    const SurfaceSample& sample_;
    std::span<const PlanarPatch> patches_;
    Eigen::Vector3d up_;
    std::vector<Extent> extents_;  ///< per patch; those of upright ones alone mean something
};

/// Whether leaves can close a hole: one that is as wide, or one at each side.
bool can_close(std::span<const OpenLeafSide> leaves, const WallRectangle& hole);

}  // namespace roomscribe
