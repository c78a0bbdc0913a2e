// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/pose_verification.hpp"

#include <algorithm>
#include <utility>

namespace roomscribe {

double icp_reach(const RegistrationScale& scale) {
    return 3.0 * scale.coarse_voxel;
}

IcpSource icp_source(const OrientedPoints& points) {
    return {points.positions, points.normals};
}

IcpTarget icp_target(const SurfacePoints& points) {
    return {points.positions, points.normals, points.tree};
}

namespace {

/// ICP of the chosen method between points with such a spacing.
IcpSettings settings_for(double spacing, double reach, const PairRegistrationSettings& settings) {
    IcpSettings icp{.method = settings.icp_method, .max_correspondence_distance = reach};
    // Along the surface the nearest sample is no farther than the spacing; between the lines of a
    // spinning scanner, which are farther apart than its points on average, twice that.
    if (icp.method != IcpMethod::point_to_point) icp.max_offset_along_surface = 2.0 * spacing;
    return icp;
}

/// A guess, settled by ICP. A share of the coarse points is enough to find the valley it lies in.
IcpResult settle(const PreparedScan& source, const PreparedScan& target, const Transform& guess,
                 const RegistrationScale& scale, const PairRegistrationSettings& settings,
                 const Context& context) {
    IcpSettings icp = settings_for(scale.coarse_voxel, icp_reach(scale), settings);
    icp.max_iterations = 30;
    icp.min_error_change = 1e-2 * scale.coarse_voxel;
    return align_icp(icp_source(source.coarse_sample), icp_target(target.coarse), guess, icp,
                     context);
}

/// A settled pose drawn to the fine points: wide enough a reach to leave the coarse pose's error.
IcpResult draw_in(const PreparedScan& source, const PreparedScan& target, const Transform& settled,
                  const RegistrationScale& scale, const PairRegistrationSettings& settings,
                  const Context& context) {
    IcpSettings icp = fine_settings(scale, settings);
    icp.max_correspondence_distance = 2.0 * scale.coarse_voxel;
    return align_icp(icp_source(source.coarse_sample), icp_target(target.fine), settled, icp,
                     context);
}

/// The last step, with so narrow a reach that other surfaces do not pull.
IcpResult refine(const PreparedScan& source, const PreparedScan& target, const Transform& drawn_in,
                 const RegistrationScale& scale, const PairRegistrationSettings& settings,
                 const Context& context) {
    return align_icp(icp_source(source.fine_sample), icp_target(target.fine), drawn_in,
                     fine_settings(scale, settings), context);
}

}  // namespace

IcpSettings fine_settings(const RegistrationScale& scale,
                          const PairRegistrationSettings& settings) {
    IcpSettings icp = settings_for(scale.fine_voxel, 2.0 * scale.fine_voxel, settings);
    icp.max_iterations = settings.icp_max_iterations;
    // A step of a tenth of the noise is about what the data can tell.
    icp.min_error_change = 1e-2 * std::max(scale.noise, 1e-3);
    icp.kernel = settings.icp_kernel;
    return icp;
}

bool are_different(const PreparedScan& source, const Transform& a, const Transform& b,
                   const RegistrationScale& scale) {
    return rms_displacement(source.spread, a, b) > icp_reach(scale);
}

VerifiedPose verify_pose(const PreparedScan& source, const PreparedScan& target,
                         const Transform& guess, const RegistrationScale& scale,
                         const PairRegistrationSettings& settings, const Context& context) {
    const IcpResult settled = settle(source, target, guess, scale, settings, context);
    const IcpResult drawn_in =
        draw_in(source, target, settled.target_from_source, scale, settings, context);
    VerifiedPose pose;
    pose.icp = refine(source, target, drawn_in.target_from_source, scale, settings, context);
    pose.support = measure_support(source, target, pose.icp.target_from_source,
                                   fine_tolerance(scale), context);
    return pose;
}

void sort_by_evidence(std::vector<VerifiedPose>& poses, double min_overlap) {
    const auto worth = [min_overlap](const VerifiedPose& pose) {
        return std::pair(pose.support.overlap() >= min_overlap, pose.support.evidence());
    };
    std::stable_sort(poses.begin(), poses.end(),
                     [&](const auto& a, const auto& b) { return worth(a) > worth(b); });
}

std::vector<VerifiedPose> verify_poses(const PreparedScan& source, const PreparedScan& target,
                                       std::span<const Transform> guesses,
                                       const RegistrationScale& scale,
                                       const PairRegistrationSettings& settings,
                                       const Context& context) {
    // Coarse evidence tells right from wrong but not one good pose from the next.
    constexpr std::size_t num_drawn_in = 6;
    std::vector<VerifiedPose> poses;
    for (const Transform& guess : guesses) {
        const IcpResult icp = settle(source, target, guess, scale, settings, context);
        if (icp.stop == IcpStop::too_few_pairs) continue;
        const bool is_new = std::all_of(poses.begin(), poses.end(), [&](const VerifiedPose& known) {
            return are_different(source, icp.target_from_source, known.icp.target_from_source,
                                 scale);
        });
        if (!is_new) continue;
        poses.push_back({icp, measure_support(source, target, icp.target_from_source,
                                              coarse_tolerance(scale), context)});
    }
    sort_by_evidence(poses, settings.min_overlap);
    // What a tenth contradicts even with a coarse pose's leeway will not be right after refinement:
    // the best alone is refined, for the record.
    const auto first_hopeless =
        std::stable_partition(poses.begin(), poses.end(), [&](const VerifiedPose& pose) {
            return pose.support.all().contradicted_share() <= max_contradiction &&
                   pose.support.overlap() >= settings.min_overlap;
        });
    const auto num_hopeful = static_cast<std::size_t>(first_hopeless - poses.begin());
    poses.resize(std::min({poses.size(), num_drawn_in, std::max<std::size_t>(num_hopeful, 1)}));
    const auto improve = [&](VerifiedPose& pose, auto step) {
        pose.icp = step(source, target, pose.icp.target_from_source, scale, settings, context);
        pose.support = measure_support(source, target, pose.icp.target_from_source,
                                       fine_tolerance(scale), context);
    };
    for (VerifiedPose& pose : poses)
        improve(pose, draw_in);
    sort_by_evidence(poses, settings.min_overlap);
    for (std::size_t i = 0; i < std::min<std::size_t>(poses.size(), 2); ++i) {
        if (i == 0 || poses[i].support.evidence() >= 0.0) improve(poses[i], refine);
    }
    sort_by_evidence(poses, settings.min_overlap);
    return poses;
}

}  // namespace roomscribe
