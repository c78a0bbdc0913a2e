// SPDX-License-Identifier: MIT
#include "roomscribe/reproduction/paper_tables.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "roomscribe/core/quantile.hpp"
#include "roomscribe/evaluation/protocol.hpp"
#include "roomscribe/evaluation/registration_error.hpp"
#include "roomscribe/registration/features/fpfh_descriptor.hpp"
#include "roomscribe/registration/features/narf_descriptor.hpp"
#include "roomscribe/reproduction/algorithm_1.hpp"

namespace roomscribe {
namespace {

constexpr int num_runs = 10;

template <typename Function>
double seconds_of(const Function& function) {
    const auto start = std::chrono::steady_clock::now();
    function();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double time_narf(const PaperScan& paper, double support_size, const Context& context) {
    std::vector<std::uint32_t> pixels;
    for (const NarfKeypoint& keypoint : paper.view.keypoints)
        pixels.push_back(keypoint.pixel);
    return seconds_of(
        [&] { compute_narf(paper.view.image, pixels, {.support_size = support_size}, context); });
}

double time_fpfh(const PaperScan& paper, double radius, const Context& context) {
    const std::vector<std::uint32_t> keypoints =
        nearest_points(paper.surface(), paper.view.keypoints);
    return seconds_of([&] {
        compute_fpfh(paper.positions, paper.normals, paper.tree, keypoints, {.radius = radius},
                     context);
    });
}

/// As PCL's getFitnessScore without a limit.
double fitness_score(const PaperPair& pair, const Transform& target_from_source) {
    double sum = 0.0;
    for (const Eigen::Vector3f& position : pair.source.positions) {
        const Eigen::Vector3d moved = target_from_source * position.cast<double>();
        sum += pair.target.tree.nearest(moved.cast<float>()).squared_distance;
    }
    return sum / static_cast<double>(pair.source.positions.size());
}

bool is_near(const Transform& found, const Transform& truth) {
    const PoseError error = pose_error(found, truth);
    return error.translation <= protocol::loose_pose.translation &&
           error.rotation <= protocol::loose_pose.rotation;
}

/// Of the source scan's origin, m per axis of the target frame.
Eigen::Vector3d predicted_deviation(const PaperAlignment& alignment) {
    const Eigen::Vector3d t = alignment.icp.target_from_source.translation();
    Eigen::Matrix<double, 3, 6> origin_by_twist;
    origin_by_twist << 0.0, t.z(), -t.y(), 1.0, 0.0, 0.0,  //
        -t.z(), 0.0, t.x(), 0.0, 1.0, 0.0,                 //
        t.y(), -t.x(), 0.0, 0.0, 0.0, 1.0;
    const Eigen::Matrix3d covariance =
        origin_by_twist * alignment.covariance * origin_by_twist.transpose();
    return covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
}

AxisErrors summarize_errors(std::span<const Eigen::Vector3d> errors) {
    AxisErrors summary;
    if (errors.empty()) return summary;
    const auto count = static_cast<double>(errors.size());
    for (const Eigen::Vector3d& error : errors)
        summary.mean += error / count;
    if (errors.size() < 2) return summary;
    Eigen::Vector3d variance = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& error : errors)
        variance += (error - summary.mean).cwiseAbs2() / (count - 1.0);
    summary.deviation = variance.cwiseSqrt();
    return summary;
}

struct PreparedPair {
    PaperPair scans;
    Transform target_from_source;
};

AlignmentComparison compare_alignment(std::span<const PreparedPair> pairs, PairFeatures features,
                                      const Context& context) {
    AlignmentComparison row;
    row.num_pairs = pairs.size();
    std::vector<Eigen::Vector3d> errors;
    for (const PreparedPair& pair : pairs) {
        context.throw_if_cancelled();
        const auto alignment = align_by_algorithm_1(pair.scans, features, 1, context);
        if (!alignment) continue;
        const Transform& found = alignment->icp.target_from_source;
        if (!is_near(found, pair.target_from_source)) continue;
        errors.emplace_back(
            (found.translation() - pair.target_from_source.translation()).cwiseAbs());
        row.predicted += predicted_deviation(*alignment);
    }
    row.num_aligned = errors.size();
    row.errors = summarize_errors(errors);
    if (!errors.empty()) row.predicted /= static_cast<double>(errors.size());
    return row;
}

}  // namespace

DescriptorComparison compare_descriptors(const ScanPair& scans, const Context& context) {
    const PaperPair pair = make_paper_pair(scans.source, scans.target, {}, context);
    DescriptorComparison row;
    row.num_points =
        0.5 * static_cast<double>(pair.source.positions.size() + pair.target.positions.size());
    row.num_keypoints = 0.5 * static_cast<double>(pair.source.view.keypoints.size() +
                                                  pair.target.view.keypoints.size());
    if (scans.target_from_source) {
        row.true_fitness = fitness_score(pair, *scans.target_from_source);
    }
    Context alone = context;
    alone.num_threads = 1;
    for (int run = 0; run < num_runs; ++run) {
        context.throw_if_cancelled();
        for (const PaperScan* scan : {&pair.source, &pair.target}) {
            row.ours.seconds[0] += time_narf(*scan, pair.support_size, alone) / (2 * num_runs);
            row.ours.seconds[1] += time_fpfh(*scan, pair.fpfh_radius(), alone) / (2 * num_runs);
        }
    }
    constexpr std::array features{PairFeatures::narf, PairFeatures::fpfh_at_narf};
    for (std::size_t i = 0; i < features.size(); ++i) {
        std::vector<double> scores;
        int num_aligned = 0;
        for (std::uint64_t seed = 1; seed <= num_runs; ++seed) {
            context.throw_if_cancelled();
            const auto pose =
                match_as_paper(pair, features[i], seed, context).rejection.target_from_source;
            scores.push_back(pose ? fitness_score(pair, *pose)
                                  : std::numeric_limits<double>::infinity());
            num_aligned +=
                pose && scans.target_from_source && is_near(*pose, *scans.target_from_source) ? 1
                                                                                              : 0;
        }
        row.ours.fitness[i] = median(scores);
        if (scans.target_from_source) row.num_aligned[i] = num_aligned;
    }
    return row;
}

std::array<AxisErrors, 3> table_2_of_paper() {
    return {{{{0.0270, 0.0221, 0.0390}, {0.0296, 0.0274, 0.0418}},
             {{0.0132, 0.0159, 0.0271}, {0.0308, 0.0213, 0.0406}},
             {{0.0121, 0.0116, 0.0182}, {0.0259, 0.0297, 0.0325}}}};
}

std::array<AlignmentComparison, 3> compare_alignments(std::span<const ScanPair> pairs,
                                                      const Context& context) {
    std::vector<PreparedPair> prepared;
    for (const ScanPair& pair : pairs) {
        context.throw_if_cancelled();
        prepared.push_back(
            {make_paper_pair(pair.source, pair.target, {}, context), *pair.target_from_source});
    }
    return {compare_alignment(prepared, PairFeatures::narf, context),
            compare_alignment(prepared, PairFeatures::fpfh, context),
            compare_alignment(prepared, PairFeatures::combined, context)};
}

}  // namespace roomscribe
