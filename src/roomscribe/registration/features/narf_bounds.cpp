// SPDX-License-Identifier: MIT
#include "roomscribe/registration/features/narf_bounds.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace roomscribe {
namespace {

constexpr float rounding = 1e-4F;

/// Per direction what the best change of another one makes of it.
AngleHistogram best_partners(const AngleHistogram& most) {
    constexpr std::size_t n = num_change_angles;
    std::array<float, 2 * n> twice;
    std::copy(most.begin(), most.end(), twice.begin());
    std::copy(most.begin(), most.end(), twice.begin() + n);
    AngleHistogram partners{};
    for (std::size_t steps = 1; steps <= n / 2; ++steps) {
        const float difference = angle_difference(0, steps);
        for (std::size_t a = 0; a < n; ++a) {
            partners[a] = std::max(partners[a],
                                   difference * std::max(twice[a + steps], twice[a + n - steps]));
        }
    }
    return partners;
}

}  // namespace

void NarfBounds::add(const std::vector<NearChange>& changes, const PointBox& box, float radius,
                     std::vector<NearChange>& kept) {
    kept.resize(changes.size());
    std::size_t num_kept = 0;
    const float inverse_radius = 1.0F / radius;
    const float diagonal = box.diagonal() * inverse_radius;
    // Nobody can foresee what is kept, so there are no branches.
    for (const NearChange& change : changes) {
        const float distance =
            (change.position - change.position.max(box.low).min(box.high)).matrix().norm();
        const float nearness = 1.0F - distance * inverse_radius;
        const float weight = change.score * nearness;
        float& most_here = most[change.angle];
        float& sure_here = sure[change.angle];
        most_here = std::max(most_here, weight);
        sure_here = std::max(sure_here, change.score * (nearness - diagonal));
        kept[num_kept] = {change.position, change.score, change.angle, weight};
        num_kept += static_cast<std::size_t>(weight > 0.0F) &
                    static_cast<std::size_t>(weight >= sure_here - rounding);
    }
    kept.resize(num_kept);
}

float NarfBounds::best_pair(float enough, AngleHistogram& least) const {
    const AngleHistogram partners = best_partners(most);
    float best = 0.0F;
    for (std::size_t a = 0; a < num_change_angles; ++a) {
        best = std::max(best, most[a] * partners[a]);
        least[a] =
            std::max((1.0F - rounding) * enough / std::max(partners[a], 1e-9F), sure[a] - rounding);
    }
    return best;
}

void drop_weak(const AngleHistogram& least, std::vector<NearChange>& changes) {
    std::size_t num_kept = 0;
    for (const NearChange& change : changes) {
        changes[num_kept] = change;
        num_kept += static_cast<std::size_t>(change.weight >= least[change.angle]);
    }
    changes.resize(num_kept);
}

}  // namespace roomscribe
