// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/evaluation/prediction.hpp"
#include "roomscribe/evaluation/protocol.hpp"

namespace roomscribe {

struct PoseError {
    double translation = 0.0;  ///< m, of the scan's origin
    double rotation = 0.0;     ///< rad, in [0, pi]
};

/// What the pose of `b` is off by, given as `a`: both map the same source to the same target.
PoseError pose_error(const Transform& a, const Transform& b);

struct ScanError {
    std::size_t scan = 0;
    std::optional<PoseError> error;  ///< empty if the scan has no place
};

/// What a link's pose is worth, whatever its verdict.
enum class LinkTruth : std::uint8_t {
    right,  ///< within the strict tolerance
    near,   ///< within the loose one
    wrong,  ///< neither, though the scans overlap
    apart   ///< neither, and the scans overlap too little
};
inline constexpr std::array<std::string_view, 4> link_truth_names{"right", "near", "wrong",
                                                                  "apart"};

struct LinkOutcome {
    std::size_t source = 0;
    std::size_t target = 0;
    LinkVerdict verdict = LinkVerdict::rejected;
    LinkTruth truth = LinkTruth::wrong;
    PoseError error;
    /// Share of the coarse voxels that both scans fill, of those of the one that fills fewer; empty
    /// if truth does not say which points are whose.
    std::optional<double> true_overlap;
};

struct RegistrationError {
    std::optional<std::size_t> anchor;
    /// All scans but the anchor, whose error is 0 by definition; all but the first if none is
    /// placed.
    std::vector<ScanError> scans;
    std::vector<LinkOutcome> links;
};

/// Compares poses relative to the anchor scan, and links with the true relative poses.
/// Precondition: the prediction has one pose slot per scan of truth.
RegistrationError evaluate_registration(const GroundTruth& truth, const Prediction& prediction,
                                        const Context& context = {});

/// Share of the scans that are placed within the tolerance (inclusive); empty if there are none.
std::optional<double> registration_recall(std::span<const ScanError> scans,
                                          const protocol::PoseTolerance& tolerance);

/// Root mean square of the translation errors of the scans that have a place; empty if none has.
std::optional<double> translation_rmse(std::span<const ScanError> scans);

}  // namespace roomscribe
