// SPDX-License-Identifier: MIT
#include "roomscribe/registration/graph/scan_placement.hpp"

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"
#include "support/matchers.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using test::TransformNear;
using testing::ElementsAre;

constexpr double noise = 0.002;

class PlaceScans : public testing::Test {
  protected:
    PlaceScans() {
        Random random(1);
        for (int i = 0; i < 5; ++i)
            poses_.push_back(test::random_transform(random, 4.0));
    }

    RegistrationLink link(std::size_t source, std::size_t target,
                          LinkVerdict verdict = LinkVerdict::accepted) const {
        RegistrationLink link;
        link.source = source;
        link.target = target;
        link.target_from_source = poses_[target].inverse() * poses_[source];
        link.covariance = 1e-6 * Matrix6d::Identity();
        link.verdict = verdict;
        link.overlap = 0.1 * static_cast<double>(source);
        link.agreement = 1.0;
        link.inliers = 100;
        link.rmse = 0.001 * static_cast<double>(source);
        return link;
    }

    Transform from_first(std::size_t scan) const { return poses_[0].inverse() * poses_[scan]; }

    std::vector<Transform> poses_;
};

TEST_F(PlaceScans, SetsThatNothingJoinsAreReportedAndNotForcedTogether) {
    const Registration result =
        place_scans({link(2, 0), link(3, 1), link(4, 1), link(2, 1, LinkVerdict::rejected)}, 5, {},
                    KnownPoseUse::prior, noise);
    EXPECT_THAT(result.components, ElementsAre(ElementsAre(1, 3, 4), ElementsAre(0, 2)));
    EXPECT_THAT(*result.map_from_scan[1], TransformNear(Transform::Identity(), 0.0, 0.0));
    for (const std::size_t scan : {3U, 4U}) {
        EXPECT_THAT(*result.map_from_scan[scan],
                    TransformNear(poses_[1].inverse() * poses_[scan], 1e-6, 1e-6));
    }
    for (const std::size_t scan : {0U, 2U}) {
        EXPECT_FALSE(result.map_from_scan[scan]);
        EXPECT_THAT(*result.apart_from_scan[scan], TransformNear(from_first(scan), 1e-6, 1e-6));
    }
    EXPECT_FALSE(result.apart_from_scan[3]);
    EXPECT_EQ(result.links.size(), 4U);
    EXPECT_NEAR(result.residuals[2], 0.002, 1e-12);
    EXPECT_NEAR(result.residuals[1], std::sqrt((9.0 + 16.0) / 2.0) * 1e-3, 1e-12);
    EXPECT_NEAR(result.overlaps[1], 0.4, 1e-12);
    EXPECT_TRUE(result.covariances[1].isZero());
    EXPECT_GT(result.covariances[3].trace(), 0.0);
}

TEST_F(PlaceScans, OfEquallyLargeSetsTheFirstScansIsTheMap) {
    const Registration result =
        place_scans({link(2, 0), link(3, 1)}, 4, {}, KnownPoseUse::prior, noise);
    EXPECT_THAT(result.components, ElementsAre(ElementsAre(0, 2), ElementsAre(1, 3)));
    EXPECT_THAT(*result.map_from_scan[2], TransformNear(from_first(2), 1e-6, 1e-6));
    EXPECT_FALSE(result.map_from_scan[3]);
}

TEST_F(PlaceScans, AcceptedLinksComeBeforeAmbiguousOnes) {
    RegistrationLink wrong = link(2, 0, LinkVerdict::ambiguous);
    wrong.target_from_source.translation().x() += 1.0;
    wrong.probability = 1.0;
    RegistrationLink likely = link(3, 2, LinkVerdict::ambiguous);
    likely.probability = min_probability_to_place;
    const Registration result =
        place_scans({link(1, 0), wrong, link(2, 1), likely}, 4, {}, KnownPoseUse::prior, noise);
    EXPECT_THAT(*result.map_from_scan[2], TransformNear(from_first(2), 1e-6, 1e-6));
    EXPECT_THAT(*result.map_from_scan[3], TransformNear(from_first(3), 1e-6, 1e-6));
    EXPECT_THAT(result.is_doubtful, ElementsAre(false, false, false, true));
}

TEST_F(PlaceScans, LinksThatAreLikelierWrongPlaceNothingUnlessAsked) {
    RegistrationLink unlikely = link(1, 0, LinkVerdict::ambiguous);
    unlikely.probability = 0.4;
    const Registration apart = place_scans({unlikely}, 2, {}, KnownPoseUse::prior, noise);
    EXPECT_THAT(apart.components, ElementsAre(ElementsAre(0), ElementsAre(1)));
    const Registration joined = place_scans({unlikely}, 2, {}, KnownPoseUse::prior, noise, 0.0);
    EXPECT_THAT(joined.components, ElementsAre(ElementsAre(0, 1)));
    EXPECT_TRUE(joined.is_doubtful[1]);
}

TEST_F(PlaceScans, AWeakPriorYieldsToLinksAndHoldsWhatTheyLeaveFree) {
    std::vector<std::optional<KnownPose>> known(3);
    for (std::size_t scan = 0; scan < 3; ++scan) {
        known[scan] = KnownPose{poses_[scan], 0.05, 0.5};
        known[scan]->world_from_scan.translation().x() += scan == 2 ? 0.2 : 0.0;
    }
    RegistrationLink sliding = link(1, 0);
    sliding.unobservable.emplace_back(Eigen::Matrix<double, 6, 1>::Unit(3));
    sliding.target_from_source.translation().x() += 0.7;
    const Registration result =
        place_scans({sliding, link(2, 0)}, 3, known, KnownPoseUse::prior, noise);
    EXPECT_THAT(*result.map_from_scan[2], TransformNear(from_first(2), 0.001, 0.001));
    EXPECT_THAT(*result.map_from_scan[1], TransformNear(from_first(1), 0.3, 0.01));
    EXPECT_LT(result.covariances[1].trace(), 10.0);
    const Registration without =
        place_scans({sliding, link(2, 0)}, 3, {}, KnownPoseUse::prior, noise);
    EXPECT_GT(without.covariances[1](3, 3), 1e5);
}

TEST_F(PlaceScans, KeptPosesStayAndCarryWhatIsLinkedToThem) {
    std::vector<std::optional<KnownPose>> known(4);
    known[1] = KnownPose{poses_[1], 0.05, 0.5};
    known[2] = KnownPose{poses_[2], 0.05, 0.5};
    RegistrationLink wrong = link(2, 1);
    wrong.target_from_source.translation().x() += 1.0;
    const Registration result =
        place_scans({wrong, link(3, 2)}, 4, known, KnownPoseUse::fixed, noise);
    EXPECT_THAT(*result.map_from_scan[1], TransformNear(poses_[1], 1e-12, 1e-12));
    EXPECT_THAT(*result.map_from_scan[2], TransformNear(poses_[2], 1e-9, 1e-9));
    EXPECT_THAT(*result.map_from_scan[3], TransformNear(poses_[3], 1e-6, 1e-6));
    EXPECT_FALSE(result.map_from_scan[0]);
}

}  // namespace
}  // namespace roomscribe
