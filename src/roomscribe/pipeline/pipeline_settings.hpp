// SPDX-License-Identifier: MIT
#pragma once

#include "roomscribe/core/settings.hpp"
#include "roomscribe/registration/scan_registration.hpp"

namespace roomscribe {

/// Everything that changes a result, in one tree.
struct PipelineSettings {
    int seed = 1;
    ScanRegistrationSettings registration;

    void visit(SettingVisitor& visitor) {
        visitor(seed, {.name = "seed",
                       .unit = "",
                       .min = 0,
                       .max = 2147483647,
                       .doc = "Of all random draws. The same seed gives the same bits."});
        visitor.group("registration", registration);
    }
};

}  // namespace roomscribe
