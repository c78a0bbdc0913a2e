// SPDX-License-Identifier: MIT
#include "roomscribe/registration/graph/set_contradiction.hpp"

#include <cstddef>

#include "roomscribe/registration/graph/link_forest.hpp"
#include "roomscribe/registration/graph/pairs_across.hpp"
#include "roomscribe/registration/pair/pose_support.hpp"

namespace roomscribe {
namespace {

/// All that both sets say of the link. Chains of links may be off by a good part of a voxel.
PoseSupport hear_sets(std::span<const PreparedScan> scans, const LinkForest& forest,
                      const RegistrationLink& link, const Context& context) {
    PoseSupport sum;
    constexpr std::size_t max_pairs = 8;
    const Transform target_set_from_source_set = forest.set_from_scan[link.target] *
                                                 link.target_from_source *
                                                 forest.set_from_scan[link.source].inverse();
    for (const PairAcross& pair :
         nearest_across(scans, forest, forest.set_of[link.source], forest.set_of[link.target],
                        target_set_from_source_set, max_pairs)) {
        const PreparedScan& source = scans[pair.source];
        const PreparedScan& target = scans[pair.target];
        const PoseSupport support =
            measure_support(source, target, pair.target_from_source,
                            coarse_tolerance(joint_scale(source, target)), context);
        sum.shell += support.shell;
        sum.detail += support.detail;
    }
    return sum;
}

bool is_contradicted(std::span<const PreparedScan> scans, const LinkForest& forest,
                     const RegistrationLink& link, const Context& context) {
    // As much as a link needs for it, in confirmed pieces (docs/registration.md).
    constexpr double enough_evidence = 10.0;
    const PoseSupport support = hear_sets(scans, forest, link, context);
    // Pooled over pairs, one person counts as often as somebody sees the place.
    return !support.shell_agrees() && support.evidence() <= -enough_evidence;
}

}  // namespace

bool reject_what_sets_contradict(std::vector<RegistrationLink>& links,
                                 std::span<const PreparedScan> scans, double min_ambiguous,
                                 const Context& context) {
    bool has_parted = false;
    std::vector<RegistrationLink> heard;
    for (const std::size_t i : likeliest_first(links, min_ambiguous)) {
        RegistrationLink& link = links[i];
        const LinkForest forest = grow_forest(heard, scans.size(), min_ambiguous);
        const bool joins = forest.set_of[link.source] != forest.set_of[link.target];
        if (joins && is_contradicted(scans, forest, link, context)) {
            has_parted = has_parted || link.verdict == LinkVerdict::accepted;
            link.verdict = LinkVerdict::rejected;
            link.loops = LoopCheck::disagrees;
        } else {
            heard.push_back(link);
        }
    }
    return has_parted;
}

}  // namespace roomscribe
