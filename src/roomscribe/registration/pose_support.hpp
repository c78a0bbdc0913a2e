// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "roomscribe/core/context.hpp"
#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/registration/prepared_scan.hpp"

namespace roomscribe {

/// How well a pose explains two scans: what becomes of a sample of both scans' points in the other
/// scan. Points in space that the other scan did not see count in `total` alone.
struct PoseSupport {
    std::size_t total = 0;
    std::size_t confirmed = 0;     ///< on a surface of the other scan that faces the same way
    std::size_t displaced = 0;     ///< near such a surface, but off it by more than it is uncertain
    std::size_t contradicted = 0;  ///< where the other scan's rays passed and met nothing
    /// Whether both scans' free space could be asked; without it nothing is ever contradicted.
    bool free_space_is_known = false;

    /// Share of all points that have a counterpart: confirmed or displaced.
    double overlap() const;
    /// Share that is confirmed of those on which the other scan has a say.
    double agreement() const;
    /// What candidate poses are ranked by: confirmed less contradicted, as a share of all.
    double score() const;
};

/// Holds a pose against both scans: each scan's coarse sample, as the other judges it.
PoseSupport measure_support(const PreparedScan& source, const PreparedScan& target,
                            const Transform& target_from_source, const RegistrationScale& scale,
                            const Context& context = {});

}  // namespace roomscribe
