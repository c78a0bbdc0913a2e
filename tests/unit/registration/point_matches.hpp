// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "roomscribe/registration/features/correspondence_rejection.hpp"
#include "support/shapes.hpp"

namespace roomscribe::test {

/// A match that a motion fits, up to noise.
inline PointMatch true_match(Random& random, const Transform& target_from_source,
                             double noise = 0.0) {
    PointMatch match;
    for (double& coordinate : match.source)
        coordinate = random.uniform(-3.0, 3.0);
    match.target = target_from_source * match.source;
    for (double& coordinate : match.target)
        coordinate += noise * random.normal();
    match.source_normal = random_direction(random);
    match.target_normal = target_from_source.linear() * match.source_normal;
    return match;
}

/// A match of two places that have nothing to do with each other.
inline PointMatch false_match(Random& random) {
    PointMatch match = true_match(random, Transform::Identity());
    for (double& coordinate : match.target)
        coordinate = random.uniform(-3.0, 3.0);
    match.target_normal = random_direction(random);
    return match;
}

}  // namespace roomscribe::test
