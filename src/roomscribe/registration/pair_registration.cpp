// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair_registration.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>

#include "roomscribe/registration/correspondence_rejection.hpp"
#include "roomscribe/registration/correspondences.hpp"
#include "roomscribe/registration/pose_candidates.hpp"
#include "roomscribe/registration/pose_support.hpp"

namespace roomscribe {
namespace {

/// Poses that ICP cannot lead into one another: it reaches three voxels far.
constexpr double icp_reach_in_voxels = 3.0;

bool different_poses(const PreparedScan& source, const Transform& a, const Transform& b,
                     const RegistrationScale& scale) {
    return rms_displacement(source.spread, a, b) > icp_reach_in_voxels * scale.coarse_voxel;
}

/// A pose that was refined and held against both scans.
struct VerifiedPose {
    Transform target_from_source = Transform::Identity();
    PoseSupport support;
};

std::vector<PointMatch> match_scans(const PreparedScan& source, const PreparedScan& target,
                                    const Context& context) {
    std::vector<PointMatch> matches;
    for (const Correspondence& match :
         match_descriptors(source.descriptors, target.descriptors, {}, context)) {
        const std::uint32_t source_point = source.keypoints[match.source];
        const std::uint32_t target_point = target.keypoints[match.target];
        matches.push_back({source.coarse.positions[source_point].cast<double>(),
                           target.coarse.positions[target_point].cast<double>(),
                           source.coarse.normals[source_point].cast<double>(),
                           target.coarse.normals[target_point].cast<double>()});
    }
    std::erase_if(matches, [](const PointMatch& match) {
        return !match.source_normal.allFinite() || !match.target_normal.allFinite();
    });
    return matches;
}

std::vector<Transform> find_initial_poses(std::span<const PointMatch> matches,
                                          const RegistrationScale& scale, std::uint64_t seed,
                                          const PairRegistrationSettings& settings,
                                          const Context& context) {
    // Two voxel centroids of the same surface are up to about a voxel's diagonal apart.
    const double tolerance = 1.5 * scale.coarse_voxel;
    std::vector<Transform> poses;
    if (settings.initial_alignment == InitialAlignment::sample_consensus) {
        const RejectionResult rejection =
            reject_by_sample_consensus(matches, seed, {.inlier_distance = tolerance});
        if (rejection.target_from_source) poses.push_back(*rejection.target_from_source);
        return poses;
    }
    for (const PoseCandidate& candidate :
         propose_poses(matches,
                       {.length_tolerance = tolerance,
                       .min_difference = icp_reach_in_voxels * scale.coarse_voxel,
                       .max_candidates = settings.max_candidates},
                       context)) {
        poses.push_back(candidate.target_from_source);
    }
    return poses;
}

IcpSource icp_source(const OrientedPoints& points) {
    return {points.positions, points.normals};
}

IcpTarget icp_target(const SurfacePoints& points) {
    return {points.positions, points.normals, points.tree};
}

/// A guess, settled by ICP. A share of the coarse points is enough to find the valley it lies in.
Transform settle(const PreparedScan& source, const PreparedScan& target, const Transform& guess,
                 const RegistrationScale& scale, const PairRegistrationSettings& settings,
                 const Context& context) {
    return align_icp(icp_source(source.coarse_sample), icp_target(target.coarse), guess,
                     {.method = settings.icp_method,
                      .max_correspondence_distance = icp_reach_in_voxels * scale.coarse_voxel,
                      .max_iterations = 30,
                      .min_error_change = 1e-2 * scale.coarse_voxel},
                     context)
        .target_from_source;
}

/// The different poses that the guesses lead to, best supported first.
std::vector<VerifiedPose> verify_poses(const PreparedScan& source, const PreparedScan& target,
                                       std::span<const Transform> guesses,
                                       const RegistrationScale& scale,
                                       const PairRegistrationSettings& settings,
                                       const Context& context) {
    std::vector<VerifiedPose> poses;
    for (const Transform& guess : guesses) {
        const Transform pose = settle(source, target, guess, scale, settings, context);
        const bool is_new = std::all_of(poses.begin(), poses.end(), [&](const VerifiedPose& known) {
            return different_poses(source, pose, known.target_from_source, scale);
        });
        if (is_new) poses.push_back({pose, measure_support(source, target, pose, scale, context)});
    }
    std::stable_sort(poses.begin(), poses.end(), [](const auto& a, const auto& b) {
        return a.support.score() > b.support.score();
    });
    return poses;
}

/// Fine alignment with a shrinking reach: wide enough to leave the coarse pose's error, then narrow
/// enough that other surfaces do not pull.
IcpResult refine(const PreparedScan& source, const PreparedScan& target, const Transform& guess,
                 const RegistrationScale& scale, const PairRegistrationSettings& settings,
                 const Context& context) {
    IcpSettings icp{.method = settings.icp_method,
                    .max_correspondence_distance = 2.0 * scale.coarse_voxel,
                    .max_iterations = settings.icp_max_iterations,
                    // A step of a tenth of the noise is about what the data can tell.
                    .min_error_change = 1e-2 * std::max(scale.noise, 1e-3)};
    const IcpResult wide =
        align_icp(icp_source(source.coarse_sample), icp_target(target.fine), guess, icp, context);
    icp.max_correspondence_distance = 2.0 * scale.fine_voxel;
    return align_icp(icp_source(source.fine_sample), icp_target(target.fine),
                     wide.target_from_source, icp, context);
}

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Covariance by the Cramer-Rao bound of the alignment, sigma^2 (J^T J)^-1, and the directions
/// along which the surfaces hold less than a hundredth of what they hold along the others.
void add_uncertainty(RegistrationLink& link, const IcpResult& icp, const PreparedScan& target,
                     const RegistrationScale& scale) {
    double mean_square_radius = 0.0;
    for (const Eigen::Vector3f& point : target.fine.positions) {
        mean_square_radius += point.cast<double>().squaredNorm();
    }
    mean_square_radius /= static_cast<double>(target.fine.positions.size());
    // Scaled by the size of the scan, turns and shifts have the same unit.
    Vector6d scaling = Vector6d::Ones();
    scaling.head<3>().setConstant(1.0 / std::sqrt(std::max(mean_square_radius, 1e-12)));
    const Matrix6d scaled = scaling.asDiagonal() * icp.information * scaling.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(scaled);
    const double mean_information = solver.eigenvalues().mean();
    const double variance = std::max(scale.noise * scale.noise, icp.rmse * icp.rmse);
    Matrix6d covariance = Matrix6d::Zero();
    for (Eigen::Index i = 0; i < 6; ++i) {
        const double held = std::max(solver.eigenvalues()[i], 1e-9 * mean_information);
        const Vector6d direction = scaling.asDiagonal() * solver.eigenvectors().col(i);
        covariance += (variance / held) * direction * direction.transpose();
        if (held < 0.01 * mean_information) link.unobservable.push_back(direction.normalized());
    }
    link.covariance = covariance;
}

/// Whether the scans support the refined pose.
bool is_supported(const PoseSupport& support, const PairRegistrationSettings& settings) {
    const double min_agreement =
        support.free_space_is_known ? settings.min_agreement : settings.min_agreement_alone;
    return support.overlap() >= settings.min_overlap && support.agreement() >= min_agreement &&
           static_cast<double>(support.contradicted) <=
               settings.max_contradiction * static_cast<double>(support.confirmed);
}

}  // namespace

void PairRegistrationSettings::visit(SettingVisitor& visitor) {
    visitor(initial_alignment,
            {.name = "initial_alignment",
             .unit = "",
             .doc = "How poses are found from matches: the paper's sample consensus, or several "
                    "candidates from the compatibility graph."});
    visitor(icp_method, {.name = "icp_method", .unit = "", .doc = "What ICP minimises."});
    visitor(icp_max_iterations,
            {.name = "icp_max_iterations",
             .unit = "",
             .min = 1,
             .max = 100'000,
             .doc = "Most iterations of the fine alignment (the paper's 100)."});
    visitor(max_candidates, {.name = "max_candidates",
                             .unit = "",
                             .min = 1,
                             .max = 1000,
                             .doc = "Most candidate poses that are held against the scans."});
    visitor(min_overlap,
            {.name = "min_overlap",
             .unit = "",
             .min = 0.0,
             .max = 1.0,
             .doc = "A link is rejected if a smaller share of the points has a counterpart."});
    visitor(
        min_agreement,
        {.name = "min_agreement",
         .unit = "",
         .min = 0.0,
         .max = 1.0,
         .doc = "... or if, of the points on which the other scan has a say, a smaller share is "
                "confirmed."});
    visitor(min_agreement_alone,
            {.name = "min_agreement_alone",
             .unit = "",
             .min = 0.0,
             .max = 1.0,
             .doc = "The same where it is not known what the scanners' rays passed through."});
    visitor(
        max_contradiction,
        {.name = "max_contradiction",
         .unit = "",
         .min = 0.0,
         .max = 1.0,
         .doc = "... or if more points than this, as a share of the confirmed ones, lie where the "
                "other scan's rays passed."});
    visitor(min_lead,
            {.name = "min_lead",
             .unit = "",
             .min = 0.0,
             .max = 1.0,
             .doc = "A link is ambiguous if a different pose comes this close to the best "
                    "one's score (as a share of it)."});
}

RegistrationLink register_pair(const PreparedScan& source, const PreparedScan& target,
                               const RegistrationScale& scale, std::uint64_t seed,
                               const PairRegistrationSettings& settings, const Context& context) {
    check_settings(settings);
    RegistrationLink link;
    link.stop_reason = "no_candidate";
    const std::vector<PointMatch> matches = match_scans(source, target, context);
    const std::vector<VerifiedPose> poses =
        verify_poses(source, target, find_initial_poses(matches, scale, seed, settings, context),
                     scale, settings, context);
    if (poses.empty()) return link;

    const IcpResult icp =
        refine(source, target, poses.front().target_from_source, scale, settings, context);
    const PoseSupport support =
        measure_support(source, target, icp.target_from_source, scale, context);
    link.target_from_source = icp.target_from_source;
    link.rmse = icp.rmse;
    link.inliers = icp.num_pairs;
    link.stop_reason = icp_stop_name(icp.stop);
    link.overlap = support.overlap();
    link.agreement = support.agreement();
    if (icp.stop == IcpStop::too_few_pairs) return link;
    add_uncertainty(link, icp, target, scale);
    if (!is_supported(support, settings)) return link;

    link.verdict = LinkVerdict::accepted;
    const auto rival = std::find_if(poses.begin(), poses.end(), [&](const VerifiedPose& pose) {
        return different_poses(source, pose.target_from_source, link.target_from_source, scale);
    });
    if (rival != poses.end() &&
        rival->support.score() > (1.0 - settings.min_lead) * support.score()) {
        link.verdict = LinkVerdict::ambiguous;
        link.rival = rival->target_from_source;
    }
    return link;
}

}  // namespace roomscribe
