// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/pair_registration.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "roomscribe/registration/features/correspondence_rejection.hpp"
#include "roomscribe/registration/features/described_points.hpp"
#include "roomscribe/registration/pair/pose_candidates.hpp"
#include "roomscribe/registration/pair/pose_search.hpp"
#include "roomscribe/registration/pair/pose_support.hpp"

namespace roomscribe {
namespace {

/// ICP on the coarse points reaches so many coarse voxels far: poses further apart than that are
/// different ones.
constexpr double icp_reach_in_voxels = 3.0;

bool different_poses(const PreparedScan& source, const Transform& a, const Transform& b,
                     const RegistrationScale& scale) {
    return rms_displacement(source.spread, a, b) > icp_reach_in_voxels * scale.coarse_voxel;
}

/// A pose that was refined and held against both scans.
struct VerifiedPose {
    IcpResult icp;
    PoseSupport support;
};

std::vector<PointMatch> match_scans(const PreparedScan& source, const PreparedScan& target,
                                    const PairRegistrationSettings& settings,
                                    const Context& context) {
    std::vector<PointMatch> matches;
    if (uses_fpfh(settings.features)) {
        matches =
            match_points(source.fpfh, target.fpfh, {.method = settings.match_method}, context);
    }
    if (uses_narf(settings.features)) {
        const std::vector<PointMatch> more = match_points(
            source.narf, target.narf,
            {.method = settings.match_method, .metric = DescriptorMetric::manhattan}, context);
        matches.insert(matches.end(), more.begin(), more.end());
    }
    return matches;
}

std::vector<Transform> propose_from_matches(const PreparedScan& source, const PreparedScan& target,
                                            const RegistrationScale& scale, std::uint64_t seed,
                                            const PairRegistrationSettings& settings,
                                            const Context& context) {
    const std::vector<PointMatch> matches = match_scans(source, target, settings, context);
    // Two voxel centroids of the same surface are up to about a voxel's diagonal apart.
    const double tolerance = settings.match_tolerance.value_or(1.5 * scale.coarse_voxel);
    std::vector<Transform> poses;
    if (settings.initial_alignment == InitialAlignment::sample_consensus) {
        const RejectionResult rejection =
            reject_by_sample_consensus(matches, seed, {.inlier_distance = tolerance});
        if (rejection.target_from_source) poses.push_back(*rejection.target_from_source);
        return poses;
    }
    for (const PoseCandidate& candidate :
         propose_poses(matches,
                       {.length_tolerance = tolerance,
                       .min_difference = icp_reach_in_voxels * scale.coarse_voxel,
                       .max_candidates = settings.max_candidates},
                       context)) {
        poses.push_back(candidate.target_from_source);
    }
    return poses;
}

std::vector<std::size_t> order_by(std::span<const double> scores) {
    std::vector<std::size_t> order(scores.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return scores[a] > scores[b]; });
    return order;
}

std::vector<Transform> keep_best(std::span<const Transform> poses, std::span<const double> scores,
                                 std::size_t max_count) {
    std::vector<Transform> best;
    for (const std::size_t i : order_by(scores)) {
        if (best.size() == max_count) break;
        best.push_back(poses[i]);
    }
    return best;
}

/// The best of the poses by their scores, no two closer than two coarse voxels.
std::vector<Transform> pick_best(const PreparedScan& source, std::span<const Transform> poses,
                                 std::span<const double> scores, std::size_t max_count,
                                 const RegistrationScale& scale) {
    std::vector<Transform> best;
    for (const std::size_t i : order_by(scores)) {
        const bool is_new = std::all_of(best.begin(), best.end(), [&](const Transform& other) {
            return rms_displacement(source.spread, poses[i], other) > 2.0 * scale.coarse_voxel;
        });
        if (is_new) best.push_back(poses[i]);
        if (best.size() == max_count) break;
    }
    return best;
}

/// All poses that bring surfaces together, thinned in two steps: the look at a few witnesses drops
/// what is plainly wrong.
std::vector<Transform> propose_from_surfaces(const PreparedScan& source, const PreparedScan& target,
                                             const RegistrationScale& scale,
                                             const PairRegistrationSettings& settings,
                                             const Context& context) {
    constexpr std::size_t num_looked_at = 1000;
    std::vector<Transform> poses = search_poses(source, target, scale, context);
    poses = keep_best(poses, screen_poses(source, target, poses, scale, Screening::glance, context),
                      num_looked_at);
    const std::vector<double> scores =
        screen_poses(source, target, poses, scale, Screening::look, context);
    return pick_best(source, poses, scores, static_cast<std::size_t>(settings.max_candidates),
                     scale);
}

IcpSource icp_source(const OrientedPoints& points) {
    return {points.positions, points.normals};
}

IcpTarget icp_target(const SurfacePoints& points) {
    return {points.positions, points.normals, points.tree};
}

/// A guess, settled by ICP. A share of the coarse points is enough to find the valley it lies in.
IcpResult settle(const PreparedScan& source, const PreparedScan& target, const Transform& guess,
                 const RegistrationScale& scale, const PairRegistrationSettings& settings,
                 const Context& context) {
    // From afar the normals of one side say enough; those of both hold a pose back.
    const IcpMethod method = settings.icp_method == IcpMethod::point_to_point
                                 ? IcpMethod::point_to_point
                                 : IcpMethod::point_to_plane;
    return align_icp(icp_source(source.coarse_sample), icp_target(target.coarse), guess,
                     {.method = method,
                      .max_correspondence_distance = icp_reach_in_voxels * scale.coarse_voxel,
                      .max_iterations = 30,
                      .min_error_change = 1e-2 * scale.coarse_voxel},
                     context);
}

IcpSettings fine_settings(const RegistrationScale& scale,
                          const PairRegistrationSettings& settings) {
    return {.method = settings.icp_method,
            .max_correspondence_distance = 2.0 * scale.fine_voxel,
            .max_iterations = settings.icp_max_iterations,
            // A step of a tenth of the noise is about what the data can tell.
            .min_error_change = 1e-2 * std::max(scale.noise, 1e-3),
            .kernel = settings.icp_kernel};
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

void sort_by_evidence(std::vector<VerifiedPose>& poses) {
    std::stable_sort(poses.begin(), poses.end(), [](const auto& a, const auto& b) {
        return a.support.evidence() > b.support.evidence();
    });
}

/// The different poses that the guesses lead to, best supported first. The best is refined, and so
/// is the next if it may be its rival.
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
            return different_poses(source, icp.target_from_source, known.icp.target_from_source,
                                   scale);
        });
        if (!is_new) continue;
        poses.push_back({icp, measure_support(source, target, icp.target_from_source,
                                              coarse_tolerance(scale), context)});
    }
    sort_by_evidence(poses);
    // What a tenth contradicts even with a coarse pose's leeway will not be right after refinement:
    // the best alone is refined, for the record.
    const auto first_hopeless = std::stable_partition(
        poses.begin(), poses.end(),
        [](const VerifiedPose& pose) { return pose.support.contradiction() <= 0.1; });
    const auto num_hopeful = static_cast<std::size_t>(first_hopeless - poses.begin());
    poses.resize(std::min({poses.size(), num_drawn_in, std::max<std::size_t>(num_hopeful, 1)}));
    const auto improve = [&](VerifiedPose& pose, auto step) {
        pose.icp = step(source, target, pose.icp.target_from_source, scale, settings, context);
        pose.support = measure_support(source, target, pose.icp.target_from_source,
                                       fine_tolerance(scale), context);
    };
    for (VerifiedPose& pose : poses)
        improve(pose, draw_in);
    sort_by_evidence(poses);
    for (std::size_t i = 0; i < std::min<std::size_t>(poses.size(), 2); ++i) {
        if (i == 0 || poses[i].support.evidence() >= 0.0) improve(poses[i], refine);
    }
    sort_by_evidence(poses);
    return poses;
}

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
        return different_poses(source, pose.icp.target_from_source, best.icp.target_from_source,
                               scale) &&
               is_tenable(pose.support, settings) && pose.support.evidence() > min_evidence;
    });
    return rival == poses.end() ? nullptr : &*rival;
}

}  // namespace

void PairRegistrationSettings::visit(SettingVisitor& visitor) {
    visitor(
        initial_alignment,
        {.name = "initial_alignment",
         .unit = "",
         .doc =
             "How poses are found: from descriptor matches by the paper's sample consensus or as "
             "several candidates from the compatibility graph, or from the scans' surfaces, "
             "and from the graph where these hold none."});
    visitor(features,
            {.name = "features",
             .unit = "",
             .doc = "What points are matched by: FPFH at distinctive points or at NARF keypoints, "
                    "NARF, or the matches of fpfh and narf combined (the paper's)."});
    visitor(match_method,
            {.name = "match_method",
             .unit = "",
             .doc = "Every descriptor to its nearest, or only those that are nearest both ways."});
    visitor(match_tolerance,
            {.name = "match_tolerance",
             .unit = "m",
             .min = 1e-6,
             .max = 1e6,
             .doc = "How far a motion may leave the points of its matches apart; auto: 1.5 coarse "
                    "voxels."});
    visitor(icp_method, {.name = "icp_method", .unit = "", .doc = "What ICP minimises."});
    visitor(icp_max_iterations,
            {.name = "icp_max_iterations",
             .unit = "",
             .min = 1,
             .max = 100'000,
             .doc = "Most iterations of the fine alignment (the paper's 100)."});
    visitor(icp_kernel, {.name = "icp_kernel",
                         .unit = "",
                         .doc = "How much a pair of points counts in the fine alignment by its "
                                "residual."});
    visitor.group("covariance", covariance);
    visitor(max_candidates, {.name = "max_candidates",
                             .unit = "",
                             .min = 1,
                             .max = 1000,
                             .doc = "Most candidate poses that are held against the scans."});
    visitor(min_overlap,
            {.name = "min_overlap",
             .unit = "",
             .min = 0.0,
             .max = 1.0,
             .doc = "A link is rejected if a smaller share of the points has a counterpart."});
    visitor(
        min_agreement,
        {.name = "min_agreement",
         .unit = "",
         .min = 0.0,
         .max = 1.0,
         .doc = "... or if, of the points on which the other scan has a say, a smaller share is "
                "confirmed."});
    visitor(min_agreement_alone,
            {.name = "min_agreement_alone",
             .unit = "",
             .min = 0.0,
             .max = 1.0,
             .doc = "The same where it is not known what the scanners' rays passed through."});
    visitor(min_evidence,
            {.name = "min_evidence",
             .unit = "",
             .min = 0.0,
             .max = 1e6,
             .doc = "A link is ambiguous if fewer pieces of detail speak for it, net of those that "
                    "speak against it, and rejected if more speak against it."});
    visitor(min_lead,
            {.name = "min_lead",
             .unit = "",
             .min = 0.0,
             .max = 1e6,
             .doc = "A link is ambiguous if a different pose has as many pieces but for this."});
}

RegistrationLink register_pair(const PreparedScan& source, const PreparedScan& target,
                               const RegistrationScale& scale, std::uint64_t seed,
                               const PairRegistrationSettings& settings, const Context& context) {
    check_settings(settings);
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
                                    const RegistrationScale& scale,
                                    const PairRegistrationSettings& settings,
                                    const Context& context) {
    check_settings(settings);
    const IcpResult settled =
        settle(source, target, target_from_source_guess, scale, settings, context);
    const IcpResult drawn_in =
        draw_in(source, target, settled.target_from_source, scale, settings, context);
    VerifiedPose pose;
    pose.icp = refine(source, target, drawn_in.target_from_source, scale, settings, context);
    pose.support = measure_support(source, target, pose.icp.target_from_source,
                                   fine_tolerance(scale), context);
    return link_of(pose, source, target, scale, settings, context);
}

}  // namespace roomscribe
