// SPDX-License-Identifier: MIT
#include "roomscribe/registration/graph/pair_proposal.hpp"

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "support/shapes.hpp"
#include "support/simulated_rooms.hpp"

namespace roomscribe {
namespace {

/// Two rooms with three scans each, alternating.
std::vector<PreparedScan> prepare_two_rooms(const RegistrationScale& scale) {
    Random random(1);
    const std::vector<Eigen::Vector3d> places = {{1.3, 2.2, 1.4}, {2.0, 1.8, 1.5}, {1.2, 3.4, 1.3},
                                                 {1.0, 1.2, 1.6}, {3.4, 2.2, 1.4}, {2.8, 1.0, 1.2}};
    std::vector<PreparedScan> scans;
    for (std::size_t i = 0; i < places.size(); ++i) {
        Transform pose = test::random_transform(random);
        pose.translation() = places[i];
        const Scenario room = i % 2 == 0 ? test::l_shaped_room() : test::other_room();
        scans.push_back(prepare_scan(test::simulate_scan(room, pose, i, 4.0), scale));
    }
    return scans;
}

TEST(ProposePairs, ScansOfOneRoomComeFirst) {
    const RegistrationScale scale{
        .coarse_voxel = 0.08, .fine_voxel = 0.04, .fpfh_radius = 0.4, .noise = 0.002};
    const std::vector<PreparedScan> scans = prepare_two_rooms(scale);
    const std::vector<ProposedPair> pairs = propose_pairs(scans, 5, scale);
    ASSERT_EQ(pairs.size(), 15U);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        EXPECT_LT(pairs[i].a, pairs[i].b);
        if (i > 0) {
            EXPECT_LE(pairs[i].promise, pairs[i - 1].promise);
        }
        if (i < 4) {
            EXPECT_EQ(pairs[i].a % 2, pairs[i].b % 2) << pairs[i].promise;
        }
    }
    const ScanSignature a = make_signature(scans[0]);
    const ScanSignature b = make_signature(scans[2]);
    EXPECT_NEAR(measure_promise(a, b, scale), measure_promise(b, a, scale), 0.5);
    EXPECT_EQ(propose_pairs(std::span(scans).first(1), 5, scale).size(), 0U);
    // Each scan asks for one partner: at most one pair per scan, and every scan is in one.
    const std::vector<ProposedPair> best = propose_pairs(scans, 1, scale);
    EXPECT_LE(best.size(), scans.size());
    std::vector<bool> has_pair(scans.size(), false);
    for (const ProposedPair& pair : best)
        has_pair[pair.a] = has_pair[pair.b] = true;
    EXPECT_EQ(has_pair, std::vector<bool>(scans.size(), true));
}

TEST(ProposePairs, AnEmptyScanPromisesNothing) {
    Scan scan;
    scan.cloud.positions.assign(1000, Eigen::Vector3f::Constant(NAN));
    const ScanSignature empty = make_signature(prepare_scan(scan, {}));
    EXPECT_EQ(measure_promise(empty, empty, {}), 0.0);
}

}  // namespace
}  // namespace roomscribe
