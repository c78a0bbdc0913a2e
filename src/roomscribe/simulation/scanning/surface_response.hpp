// SPDX-License-Identifier: MIT
#pragma once

#include "roomscribe/simulation/simulated_world.hpp"

namespace roomscribe {

/// What a material sends back at 850 to 905 nm (docs/simulation.md says where the numbers come
/// from).
struct SurfaceResponse {
    double diffuse = 0.8;      ///< Lambertian reflectance, in [0, 1]
    double gloss = 0.0;        ///< added when hit squarely, relative to a white Lambertian surface
    double gloss_angle = 0.2;  ///< rad, at which the gloss has fallen to 1/e
    double loss = 0.0;         ///< share of rays thrown away from the scanner, unless hit squarely
};

const SurfaceResponse& surface_response(Material material);

/// Echo of a surface, relative to a white Lambertian one hit squarely at the same range.
double echo_strength(const SurfaceResponse& surface, double cosine);

/// Chance that a ray is lost by being mirrored away. 0 for a matt surface.
double glare_loss(const SurfaceResponse& surface, double cosine);

/// What becomes of rays at a pane. The shares sum to 1 with what is lost.
struct PaneShares {
    double passed = 0.0;
    double returned = 0.0;
};

/// `transparency` is the share that passes when the pane is hit squarely. Panes mirror more the
/// more obliquely they are hit (Schlick's approximation), so less passes; of what does not pass,
/// most returns when hit squarely, and a little by dirt otherwise.
PaneShares pane_shares(double transparency, double cosine);

}  // namespace roomscribe
