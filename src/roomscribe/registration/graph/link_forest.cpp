// SPDX-License-Identifier: MIT
#include "roomscribe/registration/graph/link_forest.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace roomscribe {
namespace {

/// The better link first.
bool is_better(const RegistrationLink& a, const RegistrationLink& b) {
    const auto worth = [](const RegistrationLink& link) {
        return std::tuple(link.verdict == LinkVerdict::accepted, link.probability,
                          link.overlap * link.agreement);
    };
    return worth(a) > worth(b);
}

/// Moves the set of the higher first scan into the frame of the lower one.
void join(LinkForest& forest, const RegistrationLink& link) {
    const std::size_t source_set = forest.set_of[link.source];
    const std::size_t target_set = forest.set_of[link.target];
    const bool moves_source = target_set < source_set;
    const Transform target_set_from_source_set = forest.set_from_scan[link.target] *
                                                 link.target_from_source *
                                                 forest.set_from_scan[link.source].inverse();
    const Transform to_stay =
        moves_source ? target_set_from_source_set : target_set_from_source_set.inverse();
    const std::size_t moved = moves_source ? source_set : target_set;
    const std::size_t stay = moves_source ? target_set : source_set;
    for (std::size_t scan = 0; scan < forest.set_of.size(); ++scan) {
        if (forest.set_of[scan] != moved) continue;
        forest.set_of[scan] = stay;
        forest.set_from_scan[scan] = to_stay * forest.set_from_scan[scan];
        // Accepted links come first: what one joins later is sure to its set's first scan or not at
        // all.
        if (link.verdict != LinkVerdict::accepted) forest.is_doubtful[scan] = true;
    }
}

}  // namespace

std::vector<std::size_t> likeliest_first(std::span<const RegistrationLink> links,
                                         std::optional<double> min_ambiguous) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < links.size(); ++i) {
        if (links[i].verdict == LinkVerdict::accepted ||
            (min_ambiguous && links[i].verdict == LinkVerdict::ambiguous &&
             links[i].probability >= *min_ambiguous)) {
            order.push_back(i);
        }
    }
    std::stable_sort(order.begin(), order.end(), [&links](std::size_t a, std::size_t b) {
        return is_better(links[a], links[b]);
    });
    return order;
}

LinkForest grow_forest(std::span<const RegistrationLink> links, std::size_t num_scans,
                       std::optional<double> min_ambiguous) {
    LinkForest forest;
    forest.set_of.resize(num_scans);
    std::iota(forest.set_of.begin(), forest.set_of.end(), std::size_t{0});
    forest.set_from_scan.assign(num_scans, Transform::Identity());
    forest.is_doubtful.assign(num_scans, false);
    for (const std::size_t i : likeliest_first(links, min_ambiguous)) {
        if (forest.set_of[links[i].source] == forest.set_of[links[i].target]) continue;
        join(forest, links[i]);
        forest.used_links.push_back(i);
    }
    std::sort(forest.used_links.begin(), forest.used_links.end());
    return forest;
}

}  // namespace roomscribe
