// SPDX-License-Identifier: MIT
#include "roomscribe/registration/graph/pairs_across.hpp"

#include <algorithm>

namespace roomscribe {

std::vector<PairAcross> nearest_across(std::span<const PreparedScan> scans,
                                       const LinkForest& forest, std::size_t source_set,
                                       std::size_t target_set,
                                       const Transform& target_set_from_source_set,
                                       std::size_t max_pairs) {
    std::vector<PairAcross> pairs;
    for (std::size_t a = 0; a < scans.size(); ++a) {
        if (forest.set_of[a] != source_set) continue;
        const Transform from_source = target_set_from_source_set * forest.set_from_scan[a];
        for (std::size_t b = 0; b < scans.size(); ++b) {
            if (forest.set_of[b] != target_set) continue;
            const Transform& from_target = forest.set_from_scan[b];
            pairs.push_back(
                {a, b, from_target.inverse() * from_source,
                 (from_source * scans[a].spread.mean - from_target * scans[b].spread.mean).norm()});
        }
    }
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const auto& a, const auto& b) { return a.distance < b.distance; });
    pairs.resize(std::min(pairs.size(), max_pairs));
    return pairs;
}

}  // namespace roomscribe
