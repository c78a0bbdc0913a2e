// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/registration/pair/prepared_scan.hpp"

namespace roomscribe {

/// What became of some witnesses, points of one scan, in the other scan. Those in space that the
/// other scan did not see count in `total` alone.
struct WitnessTally {
    std::size_t total = 0;
    std::size_t confirmed = 0;     ///< on a surface of the other scan that faces the same way
    std::size_t displaced = 0;     ///< near such a surface, but off it by more than it is uncertain
    std::size_t contradicted = 0;  ///< where the other scan's rays passed and met nothing

    std::size_t judged() const { return confirmed + displaced + contradicted; }
    /// Contradicted as a share of those that are confirmed or contradicted; 0 of none.
    double contradicted_share() const;
    WitnessTally& operator+=(const WitnessTally& other);
};

/// Share of contradicted witnesses from which nothing speaks for a pose any more. Glass, moved
/// things and bent scans bring right poses to 6 per cent; wrong ones that confirm much lie above.
inline constexpr double max_contradiction = 0.1;

/// Witnesses of one kind, counted one by one and by pieces. A piece is what most of its witnesses
/// are that the other scan has a say on, if there are two at least.
struct WitnessCount {
    WitnessTally points;
    WitnessTally pieces;
    /// Contradicted pieces, those of one small body counted once: people walk and chairs are pushed
    /// about as a whole. A body is what touches; it is small if no longer than a person is tall.
    std::size_t contradictions = 0;

    WitnessCount& operator+=(const WitnessCount& other);
};

/// How well a pose explains two scans, by the witnesses of both. Those on the shell, the large
/// planes that all rooms have, say how far the scans overlap; the details, furniture and reveals
/// and all that is small, tell a room from its mirror image and one office from the next.
struct PoseSupport {
    WitnessCount shell;
    WitnessCount detail;
    /// Whether both scans' free space could be asked; without it nothing is ever contradicted.
    bool free_space_is_known = false;

    WitnessTally all() const;
    /// Share of all witnesses that have a counterpart: confirmed or displaced.
    double overlap() const;
    /// Share that is confirmed of those on which the other scan has a say.
    double agreement() const;
    /// What poses are ranked and judged by, in confirmed pieces of detail: these, and a little for
    /// the shell's, less the more pieces are contradicted; below 0 beyond `max_contradiction`. A
    /// share counts and not a number, because contradictions come together: one pane of glass, one
    /// door that was moved, one bend in a scan. Of the details a person counts once where much
    /// of the shell is confirmed and none contradicted: at a wrong pose most often both are. Counts
    /// of both scans' pieces are halved, because most of them see the same place.
    double evidence() const;
    /// The same where the shell counts five times as much if nothing contradicts the pose, and less
    /// so up to one contradicted piece in a hundred. Holds for scans that see around themselves and
    /// the best of all poses that bring their surfaces together: a wrong one of these lays some of
    /// either room into the other's free space. Cameras see too little of it.
    double evidence_with_shell() const;

    /// Whether as good as nothing of the shell is contradicted, of so much that one per cent would
    /// show. Rooms do not move: what is contradicted then is people and what they push about.
    bool shell_agrees() const;

  private:
    /// In confirmed pieces of detail, of which one of the shell is worth `weight_of_shell`.
    double weigh(double weight_of_shell) const;
};

/// How near a witness must come.
struct SupportTolerance {
    double off_plane = 0.02;           ///< m off the surface: confirmed
    double max_off_plane = 0.04;       ///< m, of surface that is as rough as that itself
    double reach = 0.1;                ///< m to the nearest point of a surface
    double margin = 0.06;              ///< m before what the other scan saw: contradicted
    std::size_t num_witnesses = 4000;  ///< of each scan, about
};

/// Before the pose is refined: it may be off by a good part of a coarse voxel.
SupportTolerance coarse_tolerance(const RegistrationScale& scale);
/// After: three times the noise, or half of the fine spacing over which surfaces are curved.
SupportTolerance fine_tolerance(const RegistrationScale& scale);

/// Holds a pose against both scans: each scan's witnesses, as the other judges them.
PoseSupport measure_support(const PreparedScan& source, const PreparedScan& target,
                            const Transform& target_from_source, const SupportTolerance& tolerance,
                            const Context& context = {});

}  // namespace roomscribe
