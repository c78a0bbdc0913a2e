// SPDX-License-Identifier: MIT
#include "roomscribe/registration/features/described_points.hpp"

namespace roomscribe {

std::vector<PointMatch> match_points(const DescribedPoints& source, const DescribedPoints& target,
                                     const MatchSettings& settings, const Context& context) {
    std::vector<PointMatch> matches;
    for (const Correspondence& match :
         match_descriptors(source.descriptors, target.descriptors, settings, context)) {
        matches.push_back({source.positions[match.source].cast<double>(),
                           target.positions[match.target].cast<double>(),
                           source.normals[match.source].cast<double>(),
                           target.normals[match.target].cast<double>()});
    }
    std::erase_if(matches, [](const PointMatch& match) {
        return !match.source_normal.allFinite() || !match.target_normal.allFinite();
    });
    return matches;
}

}  // namespace roomscribe
