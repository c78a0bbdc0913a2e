// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/registration/features/correspondence_rejection.hpp"

namespace roomscribe {

/// A motion that many matches agree on.
struct PoseCandidate {
    Transform target_from_source = Transform::Identity();
    std::size_t num_inliers = 0;
};

struct CompatibilitySettings {
    double length_tolerance = 0.1;
    double angle_tolerance = 0.35;
    double min_difference = 0.4;
    int max_candidates = 12;

    void visit(SettingVisitor& visitor) {
        visitor(length_tolerance,
                {.name = "length_tolerance",
                 .unit = "m",
                 .min = 1e-9,
                 .max = 1e6,
                 .doc = "Two matches agree if the distances between their points differ by at most "
                        "this."});
        visitor(angle_tolerance,
                {.name = "angle_tolerance",
                 .unit = "rad",
                 .min = 0.0,
                 .max = 3.15,
                 .doc = "... and the angles of their normals with each other and with their "
                        "connection by at most this."});
        visitor(
            min_difference,
            {.name = "min_difference",
             .unit = "m",
             .min = 0.0,
             .max = 1e6,
             .doc = "Poses that move the points less than this apart (root mean square) are one "
                    "candidate."});
        visitor(max_candidates, {.name = "max_candidates",
                                 .unit = "",
                                 .min = 1,
                                 .max = 1000,
                                 .doc = "Most poses that are handed on."});
    }
};

/// Several poses that sets of mutually compatible matches agree on, best first, no two alike: a
/// rectangular room or a repeated office has more than one, and only the scans themselves can
/// decide. Matches are joined in a compatibility graph; every match grows the set of matches that
/// share the most compatible partners with it (second-order measure: Chen et al. 2022), and the
/// motion fitted to it is refined on its inliers. No random draw.
std::vector<PoseCandidate> propose_poses(std::span<const PointMatch> matches,
                                         const CompatibilitySettings& settings = {},
                                         const Context& context = {});

}  // namespace roomscribe
