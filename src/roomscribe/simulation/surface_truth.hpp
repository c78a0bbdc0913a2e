// SPDX-License-Identifier: MIT
#pragma once

#include "roomscribe/core/context.hpp"
#include "roomscribe/model/surface_truth.hpp"
#include "roomscribe/simulation/scenario.hpp"
#include "roomscribe/simulation/simulated_scene.hpp"

namespace roomscribe {

/// The planar surfaces of the scenario's world, and on which of them each point of its map lies:
/// the surface that a thin ray towards the point meets, if it meets it where the point was
/// measured, give or take the scanner's noise. `scene` must be what simulate_scene made of the
/// scenario.
SurfaceTruth find_surface_truth(const Scenario& scenario, const SimulatedScene& scene,
                                const Context& context = {});

}  // namespace roomscribe
