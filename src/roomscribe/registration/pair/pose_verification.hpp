// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/registration/alignment/icp.hpp"
#include "roomscribe/registration/pair/pair_settings.hpp"
#include "roomscribe/registration/pair/pose_support.hpp"
#include "roomscribe/registration/pair/prepared_scan.hpp"

namespace roomscribe {

/// A pose that was refined and held against both scans.
struct VerifiedPose {
    IcpResult icp;
    PoseSupport support;
};

/// m, how far ICP on the coarse points reaches.
double icp_reach(const RegistrationScale& scale);
/// True if the poses lie further apart than ICP reaches, root mean square over the source's points.
bool are_different(const PreparedScan& source, const Transform& a, const Transform& b,
                   const RegistrationScale& scale);

/// What the last step of the alignment works on, and how.
IcpSource icp_source(const OrientedPoints& points);
IcpTarget icp_target(const SurfacePoints& points);
IcpSettings fine_settings(const RegistrationScale& scale, const PairRegistrationSettings& settings);

/// A guess within the reach of ICP, refined and held against both scans.
VerifiedPose verify_pose(const PreparedScan& source, const PreparedScan& target,
                         const Transform& guess, const RegistrationScale& scale,
                         const PairRegistrationSettings& settings, const Context& context);

/// By falling evidence; those with too little overlap, which nothing can contradict, come last.
void sort_by_evidence(std::vector<VerifiedPose>& poses, double min_overlap);

/// The different poses that the guesses lead to, by falling evidence. The best is refined to the
/// end, and so is the next if it may be its rival.
std::vector<VerifiedPose> verify_poses(const PreparedScan& source, const PreparedScan& target,
                                       std::span<const Transform> guesses,
                                       const RegistrationScale& scale,
                                       const PairRegistrationSettings& settings,
                                       const Context& context);

}  // namespace roomscribe
