// SPDX-License-Identifier: MIT
#include "roomscribe/reproduction/algorithm_1.hpp"

#include "roomscribe/registration/alignment/pose_covariance.hpp"
#include "roomscribe/registration/features/described_points.hpp"

namespace roomscribe {
namespace {

DescribedPoints describe_fpfh(const PaperScan& paper, PairFeatures features, double radius,
                              const Context& context) {
    std::vector<std::uint32_t> keypoints;
    if (features == PairFeatures::fpfh_at_narf) {
        keypoints = nearest_points(paper.surface(), paper.view.keypoints);
    } else {
        constexpr std::size_t stride = 10;
        for (std::size_t i = 0; i < paper.positions.size(); i += stride)
            keypoints.push_back(static_cast<std::uint32_t>(i));
    }
    return describe_by_fpfh(paper.surface(), keypoints, radius, context);
}

}  // namespace

FilteredMatches match_as_paper(const PaperPair& pair, PairFeatures features, std::uint64_t seed,
                               const Context& context) {
    FilteredMatches result;
    if (uses_fpfh(features)) {
        const auto describe = [&](const PaperScan& scan) {
            return describe_fpfh(scan, features, pair.fpfh_radius(), context);
        };
        result.matches = match_points(describe(pair.source), describe(pair.target),
                                      {.method = MatchMethod::one_to_one}, context);
    }
    if (uses_narf(features)) {
        const auto describe = [&](const PaperScan& scan) {
            return describe_by_narf(scan.view, scan.surface(), pair.support_size, context);
        };
        const std::vector<PointMatch> more = match_points(
            describe(pair.source), describe(pair.target),
            {.method = MatchMethod::one_to_one, .metric = DescriptorMetric::manhattan}, context);
        result.matches.insert(result.matches.end(), more.begin(), more.end());
    }
    result.rejection = reject_by_sample_consensus(result.matches, seed,
                                                  {.inlier_distance = pair.inlier_distance()});
    return result;
}

std::optional<PaperAlignment> align_by_algorithm_1(const PaperPair& pair, PairFeatures features,
                                                   std::uint64_t seed, const Context& context) {
    // Steps 1 to 3: features of both scans, then the initial alignment from the filtered matches.
    const FilteredMatches filtered = match_as_paper(pair, features, seed, context);
    if (!filtered.rejection.target_from_source) return std::nullopt;
    PaperAlignment result;
    result.initial_target_from_source = *filtered.rejection.target_from_source;
    // Steps 4 to 7, by equation (1). Without normals: the paper asks nothing of them.
    const IcpSource moving{pair.source.positions, {}};
    const IcpTarget fixed{pair.target.positions, {}, pair.target.tree};
    const IcpSettings icp{.method = IcpMethod::point_to_point,
                          .max_correspondence_distance = 1.0,
                          .max_iterations = 100};
    result.icp = align_icp(moving, fixed, result.initial_target_from_source, icp, context);
    if (result.icp.stop == IcpStop::too_few_pairs) return result;
    result.covariance = estimate_pose_covariance(
                            moving, fixed, result.icp.target_from_source, icp, paper_sensor_noise,
                            {.method = CovarianceMethod::fisher_information}, context)
                            .covariance;
    return result;
}

}  // namespace roomscribe
