// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/scan_features.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "roomscribe/core/units.hpp"
#include "roomscribe/registration/pair/pair_registration.hpp"
#include "support/matchers.hpp"
#include "support/shapes.hpp"
#include "support/simulated_rooms.hpp"

namespace roomscribe {
namespace {

using test::TransformNear;

constexpr RegistrationScale scale{.coarse_voxel = 0.08,
                                  .fine_voxel = 0.04,
                                  .fpfh_radius = 0.4,
                                  .narf_support = 0.4,
                                  .noise = 0.002};

/// The L-shaped room from two places a step apart, the scanner turned in between.
struct Step {
    Transform first = Transform::Identity();
    Transform second = Transform::Identity();
    Scan target;
    Scan source;

    Step() {
        first.translation() << 1.6, 2.0, 1.4;
        second.translation() << 2.0, 2.3, 1.5;
        second.rotate(Eigen::AngleAxisd(radians(30.0), Eigen::Vector3d::UnitZ()));
        target = test::simulate_scan(test::l_shaped_room(), first, 1, 3.0);
        source = test::simulate_scan(test::l_shaped_room(), second, 2, 3.0);
    }
};

TEST(PrepareScan, HasTheFeaturesThatAreAskedFor) {
    const Step step;
    const PreparedScan fpfh = prepare_scan(step.target, scale, PairFeatures::fpfh);
    const PreparedScan at_narf = prepare_scan(step.target, scale, PairFeatures::fpfh_at_narf);
    const PreparedScan narf = prepare_scan(step.target, scale, PairFeatures::narf);
    const PreparedScan combined = prepare_scan(step.target, scale, PairFeatures::combined);
    EXPECT_EQ(fpfh.fpfh.descriptors.rows(), 33);
    EXPECT_TRUE(fpfh.narf.positions.empty());
    EXPECT_GT(narf.narf.positions.size(), 20U);
    EXPECT_EQ(narf.narf.descriptors.rows(), 36);
    EXPECT_EQ(narf.narf.descriptors.cols(), std::ssize(narf.narf.positions));
    EXPECT_EQ(narf.narf.normals.size(), narf.narf.positions.size());
    EXPECT_TRUE(at_narf.narf.positions.empty());
    EXPECT_EQ(combined.narf.positions, narf.narf.positions);
    EXPECT_EQ(combined.fpfh.positions, fpfh.fpfh.positions);

    const NarfView view = find_narf_view(step.target, {.support_size = scale.narf_support});
    ASSERT_LE(at_narf.fpfh.positions.size(), view.keypoints.size());
    EXPECT_GT(at_narf.fpfh.positions.size(), view.keypoints.size() / 2);
    // Outliers and thinning move some points, never many: a voxel's diagonal and a neighbour's.
    const auto num_near = std::count_if(
        at_narf.fpfh.positions.begin(), at_narf.fpfh.positions.end(), [&](const auto& point) {
            return std::any_of(view.keypoints.begin(), view.keypoints.end(), [&](const auto& k) {
                return (k.position - point).norm() < 2.0 * scale.coarse_voxel;
            });
        });
    EXPECT_GE(10 * num_near, 9 * std::ssize(at_narf.fpfh.positions));
}

TEST(RegisterPair, FindsThePoseByEveryKindOfFeatures) {
    const Step step;
    for (const PairFeatures features : {PairFeatures::fpfh, PairFeatures::fpfh_at_narf,
                                        PairFeatures::narf, PairFeatures::combined}) {
        const PreparedScan source = prepare_scan(step.source, scale, features);
        const PreparedScan target = prepare_scan(step.target, scale, features);
        for (const InitialAlignment method :
             {InitialAlignment::sample_consensus, InitialAlignment::compatibility_graph}) {
            const PairRegistrationSettings settings{.initial_alignment = method,
                                                    .features = features};
            const RegistrationLink link = register_pair(source, target, 1, settings);
            EXPECT_EQ(link.verdict, LinkVerdict::accepted)
                << static_cast<int>(features) << " " << static_cast<int>(method);
            EXPECT_THAT(link.target_from_source,
                        TransformNear(step.first.inverse() * step.second, 0.01, radians(0.2)));
        }
    }
}

TEST(MatchPoints, LeavesOutPointsWithoutANormal) {
    DescribedPoints points;
    points.positions = {{1.0F, 0.0F, 0.0F}, {2.0F, 0.0F, 0.0F}, {3.0F, 0.0F, 0.0F}};
    points.normals = {Eigen::Vector3f::UnitX(), Eigen::Vector3f::Constant(NAN),
                      Eigen::Vector3f::UnitZ()};
    points.descriptors = Eigen::MatrixXf::Identity(3, 3);
    const std::vector<PointMatch> matches = match_points(points, points);
    ASSERT_EQ(matches.size(), 2U);
    EXPECT_EQ(matches[0].source, Eigen::Vector3d(1.0, 0.0, 0.0));
    EXPECT_EQ(matches[1].target, Eigen::Vector3d(3.0, 0.0, 0.0));
    EXPECT_EQ(matches[1].target_normal, Eigen::Vector3d(0.0, 0.0, 1.0));
}

}  // namespace
}  // namespace roomscribe
