// SPDX-License-Identifier: MIT
#include "roomscribe/registration/features/correspondence_rejection.hpp"

#include <array>
#include <cmath>

#include <Eigen/SVD>

namespace roomscribe {
namespace {

/// Sample consensus over rigid motions from three matches.
class MotionProblem {
  public:
    using Model = Transform;

    MotionProblem(std::span<const PointMatch> matches, double inlier_distance)
        : matches_(matches), inlier_distance_(inlier_distance) {}

    std::size_t num_data() const { return matches_.size(); }
    int sample_size() const { return 3; }

    std::optional<Transform> propose(Random& random) const {
        const auto count = static_cast<std::uint32_t>(matches_.size());
        std::array<PointMatch, 3> sample;
        for (PointMatch& match : sample)
            match = matches_[random.below(count)];
        for (std::size_t i = 0; i < 3; ++i) {
            const PointMatch& a = sample[i];
            const PointMatch& b = sample[(i + 1) % 3];
            const double source_length = (a.source - b.source).norm();
            const double target_length = (a.target - b.target).norm();
            // Each end may be off by the inlier distance; shorter sides fix no rotation.
            if (source_length < 2.0 * inlier_distance_ ||
                std::abs(source_length - target_length) > 2.0 * inlier_distance_) {
                return std::nullopt;
            }
        }
        return fit_transform(sample);
    }

    double score(const Transform& target_from_source) const {
        return static_cast<double>(inliers(target_from_source).size());
    }

    std::vector<std::uint32_t> inliers(const Transform& target_from_source) const {
        std::vector<std::uint32_t> indices;
        const double squared_limit = inlier_distance_ * inlier_distance_;
        for (std::uint32_t i = 0; i < matches_.size(); ++i) {
            const Eigen::Vector3d moved = target_from_source * matches_[i].source;
            if ((moved - matches_[i].target).squaredNorm() <= squared_limit) indices.push_back(i);
        }
        return indices;
    }

  private:
    std::span<const PointMatch> matches_;
    double inlier_distance_;
};

}  // namespace

std::optional<Transform> fit_transform(std::span<const PointMatch> matches,
                                       std::span<const double> weights) {
    if (matches.size() < 3) return std::nullopt;
    const auto weight_of = [weights](std::size_t i) { return weights.empty() ? 1.0 : weights[i]; };
    double total = 0.0;
    Eigen::Vector3d source_mean = Eigen::Vector3d::Zero();
    Eigen::Vector3d target_mean = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < matches.size(); ++i) {
        total += weight_of(i);
        source_mean += weight_of(i) * matches[i].source;
        target_mean += weight_of(i) * matches[i].target;
    }
    if (!(total > 0.0)) return std::nullopt;
    source_mean /= total;
    target_mean /= total;

    Eigen::Matrix3d correlation = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < matches.size(); ++i) {
        correlation += weight_of(i) * (matches[i].target - target_mean) *
                       (matches[i].source - source_mean).transpose();
    }
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(correlation,
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    // Matches on one line leave the turn about it free: the second singular value vanishes.
    if (!(svd.singularValues()[1] > 1e-9 * svd.singularValues()[0])) return std::nullopt;
    const Eigen::Matrix3d& u = svd.matrixU();
    const Eigen::Matrix3d& v = svd.matrixV();
    Eigen::Vector3d signs = Eigen::Vector3d::Ones();
    if ((u * v.transpose()).determinant() < 0.0) signs[2] = -1.0;

    Transform transform = Transform::Identity();
    transform.linear() = u * signs.asDiagonal() * v.transpose();
    transform.translation() = target_mean - transform.linear() * source_mean;
    return transform;
}

RejectionResult reject_by_sample_consensus(std::span<const PointMatch> matches, std::uint64_t seed,
                                           const RejectionSettings& settings) {
    check_settings(settings);
    const MotionProblem problem(matches, settings.inlier_distance);
    const auto consensus = sample_consensus(problem, seed, settings.consensus);
    RejectionResult result;
    result.iterations = consensus.iterations;
    result.stop = consensus.stop;
    if (!consensus.model) return result;

    result.target_from_source = consensus.model;
    result.inliers = problem.inliers(*consensus.model);
    std::vector<PointMatch> kept;
    for (const std::uint32_t index : result.inliers)
        kept.push_back(matches[index]);
    if (const auto refined = fit_transform(kept)) {
        const std::vector<std::uint32_t> refined_inliers = problem.inliers(*refined);
        if (refined_inliers.size() >= result.inliers.size()) {
            result.target_from_source = refined;
            result.inliers = refined_inliers;
        }
    }
    return result;
}

}  // namespace roomscribe
