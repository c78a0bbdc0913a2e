// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/reproduction/algorithm_1.hpp"
#include "roomscribe/reproduction/correspondence_figure.hpp"
#include "roomscribe/reproduction/paper_tables.hpp"
#include "support/matchers.hpp"

namespace roomscribe {
namespace {

using test::TransformNear;
using testing::HasSubstr;

std::size_t count(std::string_view text, std::string_view word) {
    std::size_t number = 0;
    for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1))
        ++number;
    return number;
}

TEST(MakePaperPair, ThinsBothScansByOneVoxelAndKeepsTheBestKeypoints) {
    const ScanPair scans = simulate_cluttered_pair(1);
    const PaperPair pair =
        make_paper_pair(scans.source, scans.target, {.num_points = 4000, .num_keypoints = 30});
    const std::size_t total = pair.source.positions.size() + pair.target.positions.size();
    EXPECT_NEAR(static_cast<double>(total), 8000.0, 200.0);
    EXPECT_EQ(pair.source.view.keypoints.size(), 30U);
    EXPECT_EQ(pair.target.view.keypoints.size(), 30U);
    EXPECT_EQ(pair.source.normals.size(), pair.source.positions.size());

    Scan few;
    few.cloud.positions.assign(99, Eigen::Vector3f::Ones());
    EXPECT_THROW(make_paper_pair(few, scans.target), InvalidArgument);
}

TEST(AlignByAlgorithm1, FindsThePoseByNarfFpfhAndBoth) {
    const ScanPair scans = simulate_cluttered_pair(1);
    const PaperPair pair = make_paper_pair(scans.source, scans.target);
    for (const PairFeatures features : {PairFeatures::narf, PairFeatures::fpfh,
                                        PairFeatures::fpfh_at_narf, PairFeatures::combined}) {
        const auto result = align_by_algorithm_1(pair, features, 1);
        ASSERT_TRUE(result);
        EXPECT_THAT(result->icp.target_from_source,
                    TransformNear(*scans.target_from_source, 0.1, radians(2.0)));
        EXPECT_LE(result->icp.errors.size(), 101U);
        // The bound for so many points, whose residuals are far above 1 cm, is no more than hope.
        EXPECT_GT(result->covariance(3, 3), 0.0);
        EXPECT_LT(result->covariance(3, 3), 1e-6);
    }
}

TEST(MatchAsPaper, CombinesTheMatchesOfBoth) {
    const ScanPair scans = simulate_cluttered_pair(1);
    const PaperPair pair = make_paper_pair(scans.source, scans.target);
    const auto num_matches = [&pair](PairFeatures features) {
        return match_as_paper(pair, features, 1).matches.size();
    };
    EXPECT_EQ(num_matches(PairFeatures::combined),
              num_matches(PairFeatures::fpfh) + num_matches(PairFeatures::narf));
}

TEST(CompareAlignments, HoldsThePosesAgainstTheTruth) {
    std::vector<ScanPair> pairs = simulate_pairs(1, 1);
    const AlignmentComparison right = compare_alignments(pairs)[1];
    EXPECT_EQ(right.num_pairs, 1U);
    ASSERT_EQ(right.num_aligned, 1U);
    EXPECT_EQ(right.errors.deviation, Eigen::Vector3d::Zero());
    EXPECT_GT(right.predicted.minCoeff(), 0.0);

    // A truth that is 10 cm off along one axis shows there, one that is a metre off not at all.
    const double y = pairs[0].target_from_source->translation().y();
    pairs[0].target_from_source->translation().y() = y + 0.1;
    const AlignmentComparison off = compare_alignments(pairs)[1];
    EXPECT_NEAR(off.errors.mean.x(), right.errors.mean.x(), 1e-12);
    EXPECT_GT(off.errors.mean.y() + right.errors.mean.y(), 0.1 - 1e-9);
    pairs[0].target_from_source->translation().y() = y + 1.0;
    EXPECT_EQ(compare_alignments(pairs)[1].num_aligned, 0U);
}

TEST(DrawCorrespondences, HasALineForEveryMatch) {
    const ScanPair scans = simulate_turned_pair(1);
    const PaperPair pair = make_paper_pair(scans.source, scans.target);
    const FilteredMatches matches = match_as_paper(pair, PairFeatures::fpfh_at_narf, 1);
    ASSERT_GE(matches.rejection.inliers.size(), 5U);
    EXPECT_LT(matches.rejection.inliers.size(), matches.matches.size());
    const std::string svg = draw_correspondences(pair, matches, scans.target_from_source);
    EXPECT_EQ(count(svg, "<circle"),
              2 * (matches.matches.size() + matches.rejection.inliers.size()));
    EXPECT_EQ(count(svg, "<g") - count(svg, "</g>"), 0U);
    EXPECT_THAT(svg, HasSubstr("turned by 45\u00b0"));
    EXPECT_EQ(count(svg, "nan"), 0U);
}

}  // namespace
}  // namespace roomscribe
