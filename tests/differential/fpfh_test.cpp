// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include <gtest/gtest.h>
#include <pcl/features/fpfh_omp.h>
#include <pcl/registration/correspondence_estimation.h>
#include <pcl/search/kdtree.h>

#include "rival_clouds.hpp"
#include "roomscribe/registration/features/correspondences.hpp"
#include "roomscribe/registration/features/fpfh_descriptor.hpp"

namespace roomscribe {
namespace {

using Signatures = pcl::PointCloud<pcl::FPFHSignature33>;

Signatures::Ptr describe_with_pcl(const test::Input& input, double radius) {
    pcl::FPFHEstimationOMP<pcl::PointXYZ, pcl::Normal, pcl::FPFHSignature33> estimation(2);
    estimation.setInputCloud(test::to_pcl(input.positions));
    estimation.setInputNormals(test::normals_to_pcl(input.normals));
    estimation.setSearchMethod(std::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
    estimation.setRadiusSearch(radius);
    auto signatures = std::make_shared<Signatures>();
    estimation.compute(*signatures);
    return signatures;
}

FpfhDescriptors to_matrix(const Signatures& signatures) {
    FpfhDescriptors matrix(fpfh_size, static_cast<Eigen::Index>(signatures.size()));
    for (std::size_t i = 0; i < signatures.size(); ++i) {
        matrix.col(static_cast<Eigen::Index>(i)) =
            Eigen::Map<const Eigen::VectorXf>(signatures[i].histogram, fpfh_size);
    }
    return matrix;
}

TEST(FpfhAgainstPcl, All33ValuesAgree) {
    for (const test::Input& input : test::inputs(0.1)) {
        SCOPED_TRACE(input.name);
        constexpr double radius = 0.35;
        std::vector<std::uint32_t> all(input.positions.size());
        std::iota(all.begin(), all.end(), 0U);
        const FpfhDescriptors ours =
            compute_fpfh(input.positions, input.normals, input.tree, all, {.radius = radius});
        const FpfhDescriptors theirs = to_matrix(*describe_with_pcl(input, radius));
        ASSERT_EQ(theirs.cols(), ours.cols());
        // Of 100 per angle. An angle on the border of two bins, decided by the last bit of its
        // rounding, moves a neighbour's share from one bin to the next.
        const auto differences = (ours - theirs).cwiseAbs().colwise().maxCoeff().eval();
        const auto num_different = (differences.array() > 1e-2F).count();
        EXPECT_LT(static_cast<double>(num_different), 0.02 * static_cast<double>(ours.cols()));
    }
}

/// Two scans of one room, described by PCL for both libraries.
class MatchesAgainstPcl : public testing::Test {
  protected:
    MatchesAgainstPcl() : source_(describe(2.3, 1)), target_(describe(3.3, 2)) {
        estimation_.setInputSource(source_);
        estimation_.setInputTarget(target_);
    }
    static Signatures::Ptr describe(double x, std::uint64_t seed) {
        const Transform pose(Eigen::Translation3d(x, 1.8, 1.4));
        const PointCloud cloud = test::simulate_scan(test::l_shaped_room(), pose, seed).cloud;
        return describe_with_pcl(test::Input("simulated", cloud, 0.15), 0.6);
    }

    Signatures::Ptr source_;
    Signatures::Ptr target_;
    pcl::registration::CorrespondenceEstimation<pcl::FPFHSignature33, pcl::FPFHSignature33>
        estimation_;
};

TEST_F(MatchesAgainstPcl, NearestNeighboursAreAsNear) {
    pcl::Correspondences theirs;
    estimation_.determineCorrespondences(theirs);
    const auto ours = match_descriptors(to_matrix(*source_), to_matrix(*target_),
                                        {.method = MatchMethod::one_to_one});
    ASSERT_EQ(ours.size(), theirs.size());
    ASSERT_GT(ours.size(), 1000U);
    for (std::size_t i = 0; i < ours.size(); ++i) {
        // Ours come from products of vectors whose squares are up to 30,000: float32 rounds them in
        // steps of 0.002.
        const float ours_squared = ours[i].distance * ours[i].distance;
        EXPECT_LE(ours_squared, theirs[i].distance * (1.0F + 1e-5F) + 0.02F);
    }
}

TEST_F(MatchesAgainstPcl, MutualNearestNeighboursAgree) {
    pcl::Correspondences theirs;
    estimation_.determineReciprocalCorrespondences(theirs);
    std::set<std::pair<std::uint32_t, std::uint32_t>> their_pairs;
    for (const pcl::Correspondence& pair : theirs) {
        their_pairs.emplace(pair.index_query, pair.index_match);
    }
    const auto ours = match_descriptors(to_matrix(*source_), to_matrix(*target_));
    const auto num_common = std::count_if(ours.begin(), ours.end(), [&](const auto& match) {
        return their_pairs.count({match.source, match.target}) != 0;
    });
    // On walls the descriptors are nearly equal, and which one is nearest is decided by rounding.
    const double count = static_cast<double>(theirs.size());
    EXPECT_NEAR(static_cast<double>(ours.size()), count, 0.02 * count);
    EXPECT_GT(static_cast<double>(num_common), 0.85 * count);
}

}  // namespace
}  // namespace roomscribe
