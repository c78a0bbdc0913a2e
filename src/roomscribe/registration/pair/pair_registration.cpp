// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/pair_registration.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "roomscribe/registration/pair/pose_proposal.hpp"
#include "roomscribe/registration/pair/pose_search.hpp"
#include "roomscribe/registration/pair/pose_verification.hpp"

namespace roomscribe {
namespace {

/// Whether the scans agree with the refined pose, if only because neither says much.
bool is_tenable(const PoseSupport& support, const PairRegistrationSettings& settings) {
    const double min_agreement =
        support.free_space_is_known ? settings.min_agreement : settings.min_agreement_alone;
    return support.overlap() >= settings.min_overlap && support.agreement() >= min_agreement &&
           support.evidence() >= 0.0;
}

/// That a pose is right, by its evidence and what that exceeds the best rival's by (pieces).
double probability_of(double evidence, double lead) {
    const auto logistic = [](double x) { return 1.0 / (1.0 + std::exp(-x)); };
    return logistic(0.3 * (evidence - 8.0)) * logistic(0.3 * lead);
}

/// What a pose says of a pair, its verdict but for rivals.
RegistrationLink link_of(const VerifiedPose& pose, const PreparedScan& source,
                         const PreparedScan& target, const RegistrationScale& scale,
                         const PairRegistrationSettings& settings, const Context& context) {
    RegistrationLink link;
    link.target_from_source = pose.icp.target_from_source;
    link.rmse = pose.icp.rmse;
    link.inliers = pose.icp.num_pairs;
    link.stop_reason = icp_stop_name(pose.icp.stop);
    link.overlap = pose.support.overlap();
    link.agreement = pose.support.agreement();
    if (pose.icp.stop == IcpStop::too_few_pairs) return link;
    const PoseCovariance uncertainty = estimate_pose_covariance(
        icp_source(source.fine_sample), icp_target(target.fine), link.target_from_source,
        fine_settings(scale, settings), scale.noise, settings.covariance, context);
    link.covariance = uncertainty.covariance;
    link.unobservable = uncertainty.unobservable;
    link.probability = probability_of(pose.support.evidence(), pose.support.evidence());
    if (is_tenable(pose.support, settings)) {
        link.verdict = pose.support.evidence() >= settings.min_evidence ? LinkVerdict::accepted
                                                                        : LinkVerdict::ambiguous;
    }
    return link;
}

/// The best different pose that would do as well.
const VerifiedPose* find_rival(const PreparedScan& source, std::span<const VerifiedPose> poses,
                               const RegistrationScale& scale,
                               const PairRegistrationSettings& settings) {
    const VerifiedPose& best = poses.front();
    const double min_evidence = best.support.evidence() - settings.min_lead;
    const auto rival = std::find_if(poses.begin(), poses.end(), [&](const VerifiedPose& pose) {
        return are_different(source, pose.icp.target_from_source, best.icp.target_from_source,
                             scale) &&
               is_tenable(pose.support, settings) && pose.support.evidence() > min_evidence;
    });
    return rival == poses.end() ? nullptr : &*rival;
}

}  // namespace

RegistrationLink register_pair(const PreparedScan& source, const PreparedScan& target,
                               std::uint64_t seed, const PairRegistrationSettings& settings,
                               const Context& context) {
    check_settings(settings);
    const RegistrationScale scale = joint_scale(source, target);
    std::vector<VerifiedPose> poses;
    if (settings.initial_alignment == InitialAlignment::surfaces) {
        poses = verify_poses(source, target,
                             propose_from_surfaces(source, target, scale, settings, context), scale,
                             settings, context);
    }
    const bool is_supported_already =
        !poses.empty() && poses.front().support.evidence() >= settings.min_evidence;
    const bool is_listed = settings.initial_alignment == InitialAlignment::surfaces &&
                           faces_three_ways(source.directions) &&
                           faces_three_ways(target.directions);
    if (!is_supported_already && !is_listed) {
        for (VerifiedPose& pose :
             verify_poses(source, target,
                          propose_from_matches(source, target, scale, seed, settings, context),
                          scale, settings, context)) {
            poses.push_back(std::move(pose));
        }
        sort_by_evidence(poses);
    }
    if (poses.empty()) {
        RegistrationLink nothing;
        nothing.stop_reason = "no_candidate";
        return nothing;
    }
    RegistrationLink link = link_of(poses.front(), source, target, scale, settings, context);
    if (link.verdict != LinkVerdict::accepted) return link;
    if (const VerifiedPose* rival = find_rival(source, poses, scale, settings)) {
        link.verdict = LinkVerdict::ambiguous;
        link.rival = rival->icp.target_from_source;
        const double evidence = poses.front().support.evidence();
        link.probability = probability_of(evidence, evidence - rival->support.evidence());
    }
    return link;
}

RegistrationLink register_pair_from(const PreparedScan& source, const PreparedScan& target,
                                    const Transform& target_from_source_guess,
                                    const PairRegistrationSettings& settings,
                                    const Context& context) {
    check_settings(settings);
    const RegistrationScale scale = joint_scale(source, target);
    const VerifiedPose pose =
        verify_pose(source, target, target_from_source_guess, scale, settings, context);
    return link_of(pose, source, target, scale, settings, context);
}

}  // namespace roomscribe
