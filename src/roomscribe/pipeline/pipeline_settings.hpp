// SPDX-License-Identifier: MIT
#pragma once

#include "roomscribe/core/settings.hpp"

namespace roomscribe {

/// Everything that changes a result, in one tree.
struct PipelineSettings {
    int seed = 1;

    void visit(SettingVisitor& visitor) {
        visitor(seed, {.name = "seed",
                       .unit = "",
                       .min = 0,
                       .max = 2147483647,
                       .doc = "Of all random draws. The same seed gives the same bits."});
    }
};

}  // namespace roomscribe
