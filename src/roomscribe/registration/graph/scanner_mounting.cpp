// SPDX-License-Identifier: MIT
#include "roomscribe/registration/graph/scanner_mounting.hpp"

#include <cmath>

#include "roomscribe/core/units.hpp"

namespace roomscribe {
namespace {

bool are_mounted_alike(std::span<const RegistrationLink> links, std::span<const UsualUp> ups) {
    // Of scans that are turned at random one link in 21 keeps the scanner's upright axis so well,
    // two in 450 do.
    constexpr double max_angle = radians(25.0);
    int num_alike = 0;
    int num_others = 0;
    for (const RegistrationLink& link : links) {
        const UsualUp& source = ups[link.source];
        const UsualUp& target = ups[link.target];
        if (link.verdict != LinkVerdict::accepted) continue;
        if (source.is_camera && target.is_camera) continue;
        const double cosine = target.up.dot(link.target_from_source.linear() * source.up);
        ++(cosine >= std::cos(max_angle) ? num_alike : num_others);
    }
    return num_alike >= 2 && num_alike >= 4 * num_others;
}

}  // namespace

bool drop_tilted_poses(std::vector<RegistrationLink>& links, std::span<const UsualUp> ups) {
    if (!are_mounted_alike(links, ups)) return false;
    bool has_parted = false;
    for (RegistrationLink& link : links) {
        const UsualUp& source = ups[link.source];
        const UsualUp& target = ups[link.target];
        if (link.verdict == LinkVerdict::rejected) continue;
        if (source.is_camera && target.is_camera) continue;
        std::erase_if(link.rivals,
                      [&](const Transform& rival) { return is_tilted(source, target, rival); });
        if (!is_tilted(source, target, link.target_from_source)) continue;
        has_parted = has_parted || link.verdict == LinkVerdict::accepted;
        link.probability = 0.0;
        link.verdict = LinkVerdict::rejected;
        if (link.rivals.empty()) continue;
        link.verdict = LinkVerdict::ambiguous;
        link.target_from_source = link.rivals.front();
        link.rivals.erase(link.rivals.begin());
    }
    return has_parted;
}

}  // namespace roomscribe
