// SPDX-License-Identifier: MIT
#include "roomscribe/registration/alignment/closest_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace roomscribe {

std::uint32_t ClosestPoints::find(std::size_t query, const Eigen::Vector3f& place,
                                  float max_distance) {
    // Many times the rounding of a distance: what passes with it is sure.
    constexpr float margin = 1.0F + 4e-6F;
    Memory& memory = memories_[query];
    const float moved = (place - memory.place).norm();
    if (memory.nearest == none) {
        if ((max_distance + moved) * margin < memory.clear) return none;
    } else {
        const float distance = (place - positions_[memory.nearest]).norm();
        if ((distance + moved) * margin < memory.clear) {
            return distance <= max_distance ? memory.nearest : none;
        }
    }
    // A little farther than asked for, so that points out of reach can be remembered as such.
    const float reach = 1.25F * max_distance;
    const std::array<Neighbor, 2> found = tree_.nearest_two(place, reach);
    memory.place = place;
    memory.nearest = std::isfinite(found[0].squared_distance) ? found[0].index : none;
    memory.clear = std::min(reach, std::sqrt(found[1].squared_distance));
    return found[0].squared_distance <= max_distance * max_distance ? memory.nearest : none;
}

}  // namespace roomscribe
