// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/model/registration_result.hpp"
#include "roomscribe/registration/graph/link_consistency.hpp"
#include "roomscribe/registration/pair/pair_registration.hpp"
#include "roomscribe/registration/pair/prepared_scan.hpp"

namespace roomscribe {

struct ScanGraphSettings {
    int max_partners = 30;
    int max_closures = 4;

    void visit(SettingVisitor& visitor) {
        visitor(
            max_partners,
            {.name = "max_partners",
             .unit = "",
             .min = 1,
             .max = 1000,
             .doc =
                 "Other scans that a scan is registered to without a guess, at most, while they do "
                 "not hang together yet."});
        visitor(max_closures,
                {.name = "max_closures",
                 .unit = "",
                 .min = 0,
                 .max = 1000,
                 .doc = "Nearby scans that a placed scan is also linked to, at most: they close "
                        "loops."});
    }
};

/// A pose that is known beforehand, with its standard deviations.
struct KnownPose {
    Transform world_from_scan = Transform::Identity();
    double rotation_deviation = 0.0;     ///< rad
    double translation_deviation = 0.0;  ///< m
};

/// What links of scans of such sizes may be off by and still be right.
LinkTolerance link_tolerance(const RegistrationScale& scale);

/// Links between scans in any order: the most promising pairs first, until the scans hang together
/// or every scan has tried its partners; then links between scans that lie near each other, which
/// close loops; then all links are held against the loops (check_loops). The scans around a link
/// can have it rejected (reject_what_sets_contradict); known poses, the scans around it (join_sets)
/// and loops can make an ambiguous link accepted. `known` is empty or has one entry per scan: known
/// poses are the first guesses. The number of links grows with the number of scans, not with that
/// of their pairs. Their order is that of their scans, source > target.
std::vector<RegistrationLink> link_scans(std::span<const PreparedScan> scans,
                                         std::span<const std::optional<KnownPose>> known,
                                         const RegistrationScale& scale, std::uint64_t seed,
                                         const PairRegistrationSettings& pair,
                                         const ScanGraphSettings& settings = {},
                                         const Context& context = {});

}  // namespace roomscribe
