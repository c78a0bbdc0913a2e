// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/pose_proposal.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "roomscribe/registration/features/correspondence_rejection.hpp"
#include "roomscribe/registration/features/described_points.hpp"
#include "roomscribe/registration/pair/pose_candidates.hpp"
#include "roomscribe/registration/pair/pose_screening.hpp"
#include "roomscribe/registration/pair/pose_search.hpp"
#include "roomscribe/registration/pair/pose_verification.hpp"

namespace roomscribe {
namespace {

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

}  // namespace

std::vector<Transform> propose_from_surfaces(const PreparedScan& source, const PreparedScan& target,
                                             const RegistrationScale& scale,
                                             const PairRegistrationSettings& settings,
                                             const Context& context) {
    // Each look is closer than the one before and given to fewer poses, about as long in all. All
    // ask for free space: of two rooms that see a little of each other through a door the right
    // pose confirms less than a wrong one that lays room upon room, but contradicts nothing.
    struct Look {
        Screening screening;
        std::size_t num_kept;
    };
    constexpr std::array<Look, 2> looks{Look{{16, false}, 4000}, Look{{80, false}, 1000}};
    std::vector<Transform> poses = search_poses(source, target, scale, context);
    for (const Look& look : looks) {
        if (poses.size() <= look.num_kept) continue;
        poses =
            keep_best(poses, screen_poses(source, target, poses, scale, look.screening, context),
                      look.num_kept);
    }
    const std::vector<double> scores =
        screen_poses(source, target, poses, scale, {300, true}, context);
    return pick_best(source, poses, scores, static_cast<std::size_t>(settings.max_candidates),
                     scale);
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
    for (const PoseCandidate& candidate : propose_poses(matches,
                                                        {.length_tolerance = tolerance,
                                                        .min_difference = icp_reach(scale),
                                                        .max_candidates = settings.max_candidates},
                                                        context)) {
        poses.push_back(candidate.target_from_source);
    }
    return poses;
}

}  // namespace roomscribe
