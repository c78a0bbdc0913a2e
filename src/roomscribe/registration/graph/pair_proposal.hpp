// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/registration/features/fpfh_descriptor.hpp"
#include "roomscribe/registration/pair/prepared_scan.hpp"

namespace roomscribe {

/// The most distinctive places of a scan: enough to guess which scans show the same place.
struct ScanSignature {
    std::vector<Eigen::Vector3f> positions;
    std::vector<Eigen::Vector3f> normals;
    FpfhDescriptors descriptors;    ///< one column per place
    Eigen::VectorXf squared_norms;  ///< of the descriptors
    Eigen::VectorXf summary;        ///< mean and deviation of all the scan's descriptors
};

ScanSignature make_signature(const PreparedScan& scan);

/// How promising it is to register two scans: about the number of mutually nearest places whose
/// distances and normals agree with one rigid motion. Symmetric; the same for any poses of the
/// scans. Some milliseconds.
double measure_promise(const ScanSignature& a, const ScanSignature& b,
                       const RegistrationScale& scale);

/// A pair that is worth a try, a < b.
struct ProposedPair {
    std::size_t a = 0;
    std::size_t b = 0;
    double promise = 0.0;
};

/// For every scan the `max_partners` most promising others, most promising pairs first. Beyond 30
/// scans promise is measured for the 30 others with the likest summaries alone, so that a scan's
/// cost does not grow with their number.
std::vector<ProposedPair> propose_pairs(std::span<const PreparedScan> scans,
                                        std::size_t max_partners, const RegistrationScale& scale,
                                        const Context& context = {});

}  // namespace roomscribe
