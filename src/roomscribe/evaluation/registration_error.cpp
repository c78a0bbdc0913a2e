// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/registration_error.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "roomscribe/evaluation/voxel_weights.hpp"

namespace roomscribe {
namespace {

bool is_within(const PoseError& error, const protocol::PoseTolerance& tolerance) {
    return error.translation <= tolerance.translation + protocol::rounding &&
           error.rotation <= tolerance.rotation + protocol::rounding;
}

/// The coarse voxels that each scan fills; no entries if truth has not one section per scan.
std::vector<std::vector<std::uint64_t>> voxels_of_scans(const GroundTruth& truth,
                                                        const Context& context) {
    std::vector<std::vector<std::uint64_t>> voxels;
    if (truth.map.sections.size() != truth.map_from_scan.size()) return voxels;
    const std::span<const Eigen::Vector3f> points(truth.map.cloud.positions);
    for (const MapSection& section : truth.map.sections) {
        voxels.push_back(filled_voxels(points.subspan(section.first, section.count),
                                       protocol::overlap_voxel_size, context));
    }
    return voxels;
}

double overlap_of(const std::vector<std::uint64_t>& a, const std::vector<std::uint64_t>& b) {
    std::vector<std::uint64_t> both;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
    const std::size_t fewer = std::min(a.size(), b.size());
    return fewer == 0 ? 0.0 : static_cast<double>(both.size()) / static_cast<double>(fewer);
}

LinkTruth judge(const PoseError& error, std::optional<double> overlap) {
    if (is_within(error, protocol::strict_pose)) return LinkTruth::right;
    if (is_within(error, protocol::loose_pose)) return LinkTruth::near;
    return overlap.value_or(1.0) < protocol::min_overlap ? LinkTruth::apart : LinkTruth::wrong;
}

}  // namespace

PoseError pose_error(const Transform& a, const Transform& b) {
    const Transform off = a.inverse() * b;
    return {off.translation().norm(), rotation_angle(off.linear())};
}

RegistrationError evaluate_registration(const GroundTruth& truth, const Prediction& prediction,
                                        const Context& context) {
    RegistrationError result;
    result.anchor = anchor_scan(prediction);
    const Transform predicted_from_true = predicted_from_true_map(truth, prediction);
    for (std::size_t i = 0; i < truth.map_from_scan.size(); ++i) {
        if (i == result.anchor.value_or(0)) continue;
        ScanError& scan = result.scans.emplace_back();
        scan.scan = i;
        if (const std::optional<Transform>& pose = prediction.map_from_scan[i]) {
            scan.error = pose_error(predicted_from_true * truth.map_from_scan[i], *pose);
        }
    }

    const auto voxels = prediction.links.empty() ? std::vector<std::vector<std::uint64_t>>()
                                                 : voxels_of_scans(truth, context);
    for (const RegistrationLink& link : prediction.links) {
        const Transform expected =
            truth.map_from_scan.at(link.target).inverse() * truth.map_from_scan.at(link.source);
        LinkOutcome& outcome = result.links.emplace_back();
        outcome.source = link.source;
        outcome.target = link.target;
        outcome.verdict = link.verdict;
        outcome.error = pose_error(expected, link.target_from_source);
        if (!voxels.empty())
            outcome.true_overlap = overlap_of(voxels[link.source], voxels[link.target]);
        outcome.truth = judge(outcome.error, outcome.true_overlap);
    }
    return result;
}

std::optional<double> registration_recall(std::span<const ScanError> scans,
                                          const protocol::PoseTolerance& tolerance) {
    if (scans.empty()) return std::nullopt;
    const auto recalled = std::count_if(scans.begin(), scans.end(), [&](const ScanError& scan) {
        return scan.error && is_within(*scan.error, tolerance);
    });
    return static_cast<double>(recalled) / static_cast<double>(scans.size());
}

std::optional<double> translation_rmse(std::span<const ScanError> scans) {
    double sum = 0.0;
    int num_placed = 0;
    for (const ScanError& scan : scans) {
        if (!scan.error) continue;
        sum += scan.error->translation * scan.error->translation;
        ++num_placed;
    }
    if (num_placed == 0) return std::nullopt;
    return std::sqrt(sum / num_placed);
}

}  // namespace roomscribe
