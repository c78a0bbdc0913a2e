// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/model/ground_truth.hpp"
#include "roomscribe/model/scan.hpp"
#include "roomscribe/simulation/building/building_plan.hpp"
#include "roomscribe/simulation/scenario.hpp"
#include "roomscribe/simulation/simulated_world.hpp"

namespace roomscribe {

struct SceneOptions {
    ScannerKind scanner = ScannerKind::terrestrial;
    int scans_per_room = 0;   ///< 0: as many as the scanner needs
    double coarseness = 1.0;  ///< of the scanner's angular steps
};

/// Makes up a whole scenario: building, furniture, stations. The same arguments, the same scenario.
/// Throws InvalidArgument for a coarseness or number out of range.
Scenario plan_scene(SceneKind kind, std::uint64_t seed, const SceneOptions& options = {});

/// The building with all that stands in it, in its own frame. Throws InvalidArgument for a scenario
/// that cannot be built.
SimulatedWorld build_world(const Scenario& scenario);

/// What the scanner brings home, and the truth about it.
struct SimulatedScene {
    std::vector<Scan> scans;  ///< in the scanner's frame, without poses
    GroundTruth truth;
};

/// Builds the scenario and scans it. The world frame of the map is of random orientation. The same
/// scenario gives the same bits on any number of threads. Throws InvalidArgument for a scenario
/// that cannot be built or has no stations.
SimulatedScene simulate_scene(const Scenario& scenario, const Context& context = {});

}  // namespace roomscribe
