// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/structure/planar_patch.hpp"
#include "roomscribe/structure/plane_ransac.hpp"

namespace roomscribe {

enum class PrincipalAxesStop : std::uint8_t {
    three_planes,  ///< three mutually perpendicular directions were measured
    two_planes,    ///< two; the third is their cross product
    one_plane,     ///< one; the other two are arbitrary
    no_plane       ///< none: the axes are those of the cloud's own frame
};
std::string_view principal_axes_stop_name(PrincipalAxesStop stop);

struct PrincipalAxes {
    /// The columns are the axes: a rotation, axes_frame -> cloud frame. Neither order nor signs say
    /// which way is up.
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
    PrincipalAxesStop stop = PrincipalAxesStop::no_plane;
    /// Share of the planar area whose normal lies within the tolerance of an axis, in [0, 1].
    double score = 0.0;
    /// The same for the best frame that is turned against this one by more than twice the
    /// tolerance: a slanted wing, say. 0 if there is none.
    double runner_up_score = 0.0;
    Eigen::Matrix3d runner_up_axes = Eigen::Matrix3d::Identity();
};

struct PrincipalAxesSettings {
    double angle_tolerance = radians(5.0);

    void visit(SettingVisitor& visitor) {
        visitor(angle_tolerance,
                {.name = "angle_tolerance",
                 .unit = "rad",
                 .min = 1e-6,
                 .max = 0.5,
                 .doc = "Patches are perpendicular, and agree with an axis, up to this angle (the "
                        "paper's 90 +- 5 degrees)."});
    }
};

/// The axes that most of the planar area is parallel or perpendicular to (a Manhattan frame): every
/// pair of perpendicular patches proposes a frame, all patches vote with their area, whatever
/// density they were scanned with, and the winner is refined by weighted least squares over the
/// patches that agree with it.
PrincipalAxes estimate_principal_axes(std::span<const PlanarPatch> patches,
                                      const PrincipalAxesSettings& settings = {},
                                      const Context& context = {});

struct PaperAxesSettings {
    PlaneRansacSettings planes;
    double angle_tolerance = radians(5.0);

    void visit(SettingVisitor& visitor) {
        visitor.group("planes", planes);
        visitor(angle_tolerance, {.name = "angle_tolerance",
                                  .unit = "rad",
                                  .min = 1e-6,
                                  .max = 0.5,
                                  .doc = "Planes are perpendicular up to this angle."});
    }
};

/// The paper's Algorithm 2, step by step: planes by RANSAC, largest first; the first gives an axis,
/// the next that is perpendicular to it the second, the next that is perpendicular to the second
/// the third. As the pseudo-code has it, the third is not held against the first: where it is
/// parallel to it, or none is found, the cross product of the first two takes its place
/// (section 4.2's last sentence). `score` is the share of the planes' area that agrees with the
/// axes; there is no runner-up.
PrincipalAxes estimate_principal_axes_paper(const PointCloud& cloud, std::uint64_t seed,
                                            const PaperAxesSettings& settings = {},
                                            const Context& context = {});

/// Steps 5 to 30 of it, for planes that were found before, in the order in which they were.
PrincipalAxes principal_axes_of_planes(std::span<const PlanarPatch> planes,
                                       double angle_tolerance = radians(5.0));

}  // namespace roomscribe
