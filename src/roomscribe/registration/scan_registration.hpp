// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/derived_value.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/model/registration_result.hpp"
#include "roomscribe/model/scan.hpp"
#include "roomscribe/registration/pair_registration.hpp"

namespace roomscribe {

struct ScanRegistrationSettings {
    std::optional<double> coarse_voxel;
    std::optional<double> fine_voxel;
    std::optional<double> fpfh_radius;
    PairRegistrationSettings pair;

    void visit(SettingVisitor& visitor);
};

struct ScanRegistration {
    Registration registration;
    std::vector<DerivedValue> derived_values;
};

/// Any number of scans, one frame: that of the first scan. Every scan is registered to the one
/// before it (the paper's iterative registration, without loop closure) and, where that link is not
/// accepted, to the others that have a place, latest first. A scan that no link holds stays without
/// a place; it is never put at the identity in silence. Throws InvalidArgument if there are no
/// scans.
ScanRegistration register_scans(std::span<const Scan> scans, std::uint64_t seed,
                                const ScanRegistrationSettings& settings = {},
                                const Context& context = {});

}  // namespace roomscribe
