// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/pair_registration.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "roomscribe/registration/pair/pose_probability.hpp"
#include "roomscribe/registration/pair/pose_proposal.hpp"
#include "roomscribe/registration/pair/pose_search.hpp"
#include "roomscribe/registration/pair/pose_slides.hpp"
#include "roomscribe/registration/pair/pose_verification.hpp"

namespace roomscribe {
namespace {

/// Whether both scans are a camera's and the pose turns one on its side against the other.
bool tilts_a_camera(const PreparedScan& source, const PreparedScan& target,
                    const Transform& target_from_source) {
    return are_cameras(source, target) &&
           is_tilted(source.usual_up, target.usual_up, target_from_source);
}

bool see_around(const PreparedScan& source, const PreparedScan& target) {
    return !source.usual_up.is_camera && !target.usual_up.is_camera;
}

/// Scans that see around themselves meet through doors, where they share 3 to 6 per cent; frames of
/// cameras that share so little slide.
PairRegistrationSettings settings_of_pair(const PreparedScan& source, const PreparedScan& target,
                                          PairRegistrationSettings settings) {
    if (see_around(source, target)) settings.min_overlap *= 0.3;
    return settings;
}

/// Whether the scans agree with the refined pose, if only because neither says much.
bool is_tenable(const PoseSupport& support, const PairRegistrationSettings& settings) {
    const double min_agreement =
        support.free_space_is_known ? settings.min_agreement : settings.min_agreement_alone;
    return support.overlap() >= settings.min_overlap && support.agreement() >= min_agreement &&
           support.evidence() >= 0.0;
}

LinkVerdict verdict_of(const PoseSupport& support, const PoseStanding& standing,
                       const PairRegistrationSettings& settings) {
    if (!is_tenable(support, settings)) return LinkVerdict::rejected;
    if (probability_of(standing) >= settings.min_probability) return LinkVerdict::accepted;
    return probability_without_rivals(standing) >= 0.5 ? LinkVerdict::ambiguous
                                                       : LinkVerdict::rejected;
}

RegistrationLink link_of(const VerifiedPose& pose, const PoseStanding& standing,
                         const PreparedScan& source, const PreparedScan& target,
                         const RegistrationScale& scale, const PairRegistrationSettings& settings,
                         const Context& context) {
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
    link.probability = probability_of(standing);
    link.verdict = verdict_of(pose.support, standing, settings);
    return link;
}

/// The different poses that the scans bear out, too.
std::vector<const VerifiedPose*> find_rivals(const PreparedScan& source,
                                             std::span<const VerifiedPose> poses,
                                             const RegistrationScale& scale,
                                             const PairRegistrationSettings& settings) {
    const VerifiedPose& best = poses.front();
    std::vector<const VerifiedPose*> rivals;
    for (const VerifiedPose& pose : poses) {
        if (is_tenable(pose.support, settings) &&
            are_different(source, pose.icp.target_from_source, best.icp.target_from_source,
                          scale)) {
            rivals.push_back(&pose);
        }
    }
    return rivals;
}

/// Cameras are held upright, give or take 30 degrees each: a pose that turns one of them on its
/// side against the other is none, whatever bears it out. It remains a rival.
void put_tilted_last(const PreparedScan& source, const PreparedScan& target,
                     std::vector<VerifiedPose>& poses) {
    std::stable_partition(poses.begin(), poses.end(), [&](const VerifiedPose& pose) {
        return !tilts_a_camera(source, target, pose.icp.target_from_source);
    });
}

/// Whether the list of surfaces' poses is complete.
bool lists_all_poses(const PreparedScan& source, const PreparedScan& target,
                     const PairRegistrationSettings& settings) {
    return settings.initial_alignment == InitialAlignment::surfaces &&
           faces_three_ways(source.directions) && faces_three_ways(target.directions);
}

PoseSearch search_of(const PreparedScan& source, const PreparedScan& target,
                     const PairRegistrationSettings& settings) {
    if (are_cameras(source, target) || settings.initial_alignment != InitialAlignment::surfaces)
        return PoseSearch::narrow;
    if (lists_all_poses(source, target, settings)) return PoseSearch::exhaustive;
    return see_around(source, target) ? PoseSearch::wide : PoseSearch::narrow;
}

/// What a pose is judged by: of scans that see around themselves and all of whose poses were looked
/// at, an uncontradicted shell says more.
double evidence_of(const PoseSupport& support, const PreparedScan& source,
                   const PreparedScan& target, PoseSearch search) {
    return search == PoseSearch::exhaustive && see_around(source, target)
               ? support.evidence_with_shell()
               : support.evidence();
}

/// The best of all poses, judged by its evidence and its lead over the others.
RegistrationLink link_of_best(const PreparedScan& source, const PreparedScan& target,
                              std::span<const VerifiedPose> poses, const RegistrationScale& scale,
                              const PairRegistrationSettings& settings, const Context& context) {
    const std::vector<const VerifiedPose*> rivals = find_rivals(source, poses, scale, settings);
    const PoseSearch search = search_of(source, target, settings);
    const auto evidence = [&](const VerifiedPose& pose) {
        return evidence_of(pose.support, source, target, search);
    };
    PoseStanding standing{evidence(poses.front()), {}, search};
    for (const VerifiedPose* rival : rivals)
        standing.rival = std::max(standing.rival.value_or(0.0), evidence(*rival));
    RegistrationLink link =
        link_of(poses.front(), standing, source, target, scale, settings, context);
    if (link.verdict == LinkVerdict::ambiguous) {
        for (const VerifiedPose* rival : rivals) {
            if (!tilts_a_camera(source, target, rival->icp.target_from_source))
                link.rivals.push_back(rival->icp.target_from_source);
        }
    }
    return link;
}

/// Where surfaces leave a pose free, as along a corridor, the list may hold one of many that fit as
/// well: its neighbours along what is free are heard, too. Those that detail draws back to where
/// they came from are no rivals.
void add_slid_poses(const PreparedScan& source, const PreparedScan& target,
                    const RegistrationLink& link, const RegistrationScale& scale,
                    const PairRegistrationSettings& settings, std::vector<VerifiedPose>& poses,
                    const Context& context) {
    // Half as far again as ICP reaches: nearer it would draw them back.
    for (const Transform& guess : slide_pose(source.spread, link.target_from_source,
                                             link.unobservable, 1.5 * icp_reach(scale))) {
        poses.push_back(verify_pose(source, target, guess, scale, settings, context));
    }
    sort_by_evidence(poses, settings.min_overlap);
    put_tilted_last(source, target, poses);
}

}  // namespace

RegistrationLink register_pair(const PreparedScan& source, const PreparedScan& target,
                               std::uint64_t seed, const PairRegistrationSettings& given,
                               const Context& context) {
    check_settings(given);
    const PairRegistrationSettings settings = settings_of_pair(source, target, given);
    const RegistrationScale scale = joint_scale(source, target);
    std::vector<VerifiedPose> poses;
    if (settings.initial_alignment == InitialAlignment::surfaces) {
        poses = verify_poses(source, target,
                             propose_from_surfaces(source, target, scale, settings, context), scale,
                             settings, context);
    }
    // Where people walk about, their contradictions may push the right pose off an exhaustive list.
    const double enough_evidence = lists_all_poses(source, target, settings) ? 0.0 : 15.0;
    const bool is_supported_already =
        !poses.empty() && poses.front().support.evidence() > enough_evidence;
    if (!is_supported_already) {
        for (VerifiedPose& pose :
             verify_poses(source, target,
                          propose_from_matches(source, target, scale, seed, settings, context),
                          scale, settings, context)) {
            poses.push_back(std::move(pose));
        }
        sort_by_evidence(poses, settings.min_overlap);
    }
    put_tilted_last(source, target, poses);
    if (poses.empty() || tilts_a_camera(source, target, poses[0].icp.target_from_source)) {
        RegistrationLink nothing;
        nothing.stop_reason = "no_candidate";
        return nothing;
    }
    RegistrationLink link = link_of_best(source, target, poses, scale, settings, context);
    if (link.verdict != LinkVerdict::rejected && !link.unobservable.empty()) {
        add_slid_poses(source, target, link, scale, settings, poses, context);
        link = link_of_best(source, target, poses, scale, settings, context);
    }
    return link;
}

RegistrationLink register_pair_from(const PreparedScan& source, const PreparedScan& target,
                                    const Transform& target_from_source_guess,
                                    const PairRegistrationSettings& given, const Context& context) {
    check_settings(given);
    const PairRegistrationSettings settings = settings_of_pair(source, target, given);
    const RegistrationScale scale = joint_scale(source, target);
    const VerifiedPose pose =
        verify_pose(source, target, target_from_source_guess, scale, settings, context);
    // The guess stands for the search.
    constexpr PoseSearch search = PoseSearch::exhaustive;
    const PoseStanding standing{evidence_of(pose.support, source, target, search), {}, search};
    RegistrationLink link = link_of(pose, standing, source, target, scale, settings, context);
    // Of a pose out of its reach it says nothing.
    const bool left_guess =
        are_different(source, link.target_from_source, target_from_source_guess, scale);
    if (left_guess && link.verdict == LinkVerdict::accepted) link.verdict = LinkVerdict::ambiguous;
    return link;
}

}  // namespace roomscribe
