// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/surface_truth.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/contexts.hpp"

namespace roomscribe {
namespace {

struct Scanned {
    Scenario scenario =
        plan_scene(SceneKind::room, 17,
                   {.scanner = ScannerKind::terrestrial, .scans_per_room = 2, .coarseness = 6.0});
    SimulatedScene scene = simulate_scene(scenario);
};

TEST(FindSurfaceTruth, PutsNearlyAllPointsOnASurfaceAndThemCloseToIt) {
    const Scanned scanned;
    const SurfaceTruth truth = find_surface_truth(scanned.scenario, scanned.scene);
    const auto& positions = scanned.scene.truth.map.cloud.positions;
    ASSERT_EQ(truth.surface_of_point.size(), positions.size());
    std::size_t num_finite = 0;
    std::size_t num_known = 0;
    std::size_t num_far = 0;
    std::size_t num_on_large = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (!is_finite(positions[i])) continue;
        ++num_finite;
        if (truth.surface_of_point[i] < 0) continue;
        ++num_known;
        const TrueSurface& surface =
            truth.surfaces[static_cast<std::size_t>(truth.surface_of_point[i])];
        if (surface.area < 1.0) continue;
        ++num_on_large;
        // Walls are out of true by up to a centimetre.
        num_far += std::abs(surface.plane.signed_distance(positions[i].cast<double>())) > 0.03;
    }
    EXPECT_GT(num_known, num_finite * 9 / 10);
    EXPECT_GT(num_on_large, num_finite / 2);
    EXPECT_LT(num_far, num_on_large / 1000);
}

TEST(FindSurfaceTruth, DoesNotDependOnThreads) {
    const Scanned scanned;
    EXPECT_EQ(
        find_surface_truth(scanned.scenario, scanned.scene, test::with_threads(1)).surface_of_point,
        find_surface_truth(scanned.scenario, scanned.scene, test::with_threads(3))
            .surface_of_point);
}

}  // namespace
}  // namespace roomscribe
