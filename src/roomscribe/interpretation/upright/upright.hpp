// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/structure/planar_patch.hpp"
#include "roomscribe/structure/principal_axes.hpp"
#include "roomscribe/structure/surface_sample.hpp"

namespace roomscribe {

/// What speaks for a direction being up. Each piece of evidence is a number in [-1, 1]; a
/// direction's score is their weighted sum. The low and the high level are the lowest and the
/// highest height at which there is much planar surface across the direction: floor and ceiling, if
/// it is up.
enum class UprightEvidence : std::uint8_t {
    /// Furniture may be turned about the plumb line but stays level: the share of planar area that
    /// is
    /// neither parallel nor perpendicular to the axis, nor a roof's over it, against that of the
    /// worst axis.
    few_slanted_surfaces,
    /// Floors and ceilings lie at few heights, walls at many distances: the share of the area
    /// across
    /// the axis that lies at heights which hold a tenth of it each.
    few_levels,
    /// Storeys are 2 to 5 m high (building practice): whether two levels are that far apart, or,
    /// with
    /// one level, whether all surface ends within that height (half as good).
    room_height,
    /// Seats, tables, worktops and sills are 0.3 to 1.2 m above the floor (ergonomics) and no
    /// larger
    /// than a table: their area, against that of such surfaces as far below the high level.
    furniture_height,
    /// The paper's rule (section 4.3): an upright surface of a door's size that touches one level
    /// only
    /// stands on the floor.
    doors_stand_on_floor,
    /// What stands about stands on the floor: unplanar surface in the lower half of the height
    /// against that in the upper half, above and below seen floor and ceiling only.
    clutter_below,
    /// Small things stand on floors, tables and shelves: the share of unplanar surface that has
    /// level
    /// surface closely under it.
    things_stand_on_it,
    /// A scanner stands 0.2 to 2.2 m above the floor and below the ceiling. 0 if it is not known.
    scanner_height,
    /// Where one level only was seen, it is more likely the floor: whoever carries a camera looks
    /// down.
    floor_rather_than_ceiling,
    /// Below a floor and above a ceiling there is nothing: the share of surface beyond them,
    /// negative.
    nothing_beyond,
    /// Scanners are mounted with their z up, depth cameras with y down, and held upright to some 30
    /// degrees: the cosine to what is up for them (SurfaceSample::usual_up), at least 0.
    scanner_mount
};
inline constexpr std::size_t num_upright_evidence = 11;
std::string_view upright_evidence_name(UprightEvidence evidence);

struct UprightCandidate {
    Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< unit vector in the map frame
    double score = 0.0;
    std::array<double, num_upright_evidence> evidence{};  ///< by UprightEvidence
};

enum class UprightStop : std::uint8_t {
    decided,    ///< score - runner_up score >= ambiguous_margin
    ambiguous,  ///< less than that, or less planar surface than min_room_surface
    no_plane    ///< there is no planar patch: the map's own z is taken, without any evidence
};
std::string_view upright_stop_name(UprightStop stop);

struct Upright {
    /// Map frame -> room frame, without translation: z is up, x lies along the walls with the
    /// larger extent of the room, and looks to the side where the room's surface reaches further
    /// from its median, so that the same room gets the same x however it was turned.
    Eigen::Matrix3d room_from_map = Eigen::Matrix3d::Identity();
    std::vector<UprightCandidate> candidates;  ///< best first
    UprightStop stop = UprightStop::no_plane;
    /// The scanners are known and lie between the lowest and the highest level, as they must; then
    /// the way that surfaces look can be trusted.
    bool facing_is_known = false;

    Eigen::Vector3d up() const { return room_from_map.row(2).transpose(); }
};

struct UprightSettings {
    double ambiguous_margin = 0.25;
    double min_room_surface = 20.0;

    void visit(SettingVisitor& visitor) {
        visitor(
            ambiguous_margin,
            {.name = "ambiguous_margin",
             .unit = "",
             .min = 0.0,
             .max = 10.0,
             .doc = "Two directions whose scores differ by less are both possible: a quarter of "
                    "what one piece of evidence of weight 1 can add."});
        visitor(
            min_room_surface,
            {.name = "min_room_surface",
             .unit = "m2",
             .min = 0.0,
             .max = 1e6,
             .doc = "Of less planar surface, which way is up is a guess: a room of 2 x 2 x 2 m has "
                    "24 m2, some of it hidden."});
    }
};

/// Which of the six directions of the principal axes is up. Nothing is taken from the file's frame
/// but that of a scanner that is known.
/// The direction found is then refined by least squares over all patches that are level or upright
/// with respect to it, whatever way they face. Where the signs of normals are not known
/// (`sample.normals_face_scanner`), the evidence that needs them is 0.
Upright find_upright(const SurfaceSample& sample, std::span<const PlanarPatch> patches,
                     const PrincipalAxes& axes, const UprightSettings& settings = {},
                     const Context& context = {});

}  // namespace roomscribe
