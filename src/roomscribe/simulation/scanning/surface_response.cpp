// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/scanning/surface_response.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace roomscribe {
namespace {

// In the order of Material. Diffuse values follow the remission table of the SICK LD-LRS manual
// (plaster 100 %, white paper 80 %, soiled fir 40 %, grey cardboard 20 %, black rubber 2 %) and,
// for textiles and leaves, their known brightness in the near infrared.
constexpr std::array<SurfaceResponse, 16> responses{{
    {.diffuse = 0.80},                                                    // paint
    {.diffuse = 0.55, .gloss = 0.05, .gloss_angle = 0.15},                // wood
    {.diffuse = 0.25, .gloss = 0.05, .gloss_angle = 0.15, .loss = 0.02},  // dark_wood
    {.diffuse = 0.45},                                                    // fabric
    {.diffuse = 0.30},                                                    // carpet
    {.diffuse = 0.50, .gloss = 0.40, .gloss_angle = 0.10, .loss = 0.04},  // tile
    {.diffuse = 0.65, .gloss = 0.50, .gloss_angle = 0.08, .loss = 0.02},  // lacquer
    {.diffuse = 0.30, .gloss = 1.00, .gloss_angle = 0.30, .loss = 0.25},  // metal
    {.diffuse = 0.05, .gloss = 2.00, .gloss_angle = 0.12, .loss = 0.75},  // chrome
    {.diffuse = 0.05, .gloss = 0.10, .gloss_angle = 0.15, .loss = 0.10},  // black_plastic
    {.diffuse = 0.03, .gloss = 0.60, .gloss_angle = 0.08, .loss = 0.60},  // screen
    {.diffuse = 0.80, .gloss = 0.02, .gloss_angle = 0.15},                // paper
    {.diffuse = 0.50},                                                    // plant
    {.diffuse = 0.35},                                                    // facade
    {.diffuse = 0.10, .gloss = 1.00, .gloss_angle = 0.20, .loss = 0.00},  // glass: its pane
    {.diffuse = 0.02, .gloss = 1.00, .gloss_angle = 0.05, .loss = 0.90},  // mirror: its dust
}};

/// exp(-(angle / width)^2) of the angle of incidence; the sine serves for the angle.
double lobe(double cosine, double width) {
    const double squared_sine = std::max(0.0, 1.0 - cosine * cosine);
    return std::exp(-squared_sine / (width * width));
}

}  // namespace

const SurfaceResponse& surface_response(Material material) {
    return responses[static_cast<std::size_t>(material)];
}

double echo_strength(const SurfaceResponse& surface, double cosine) {
    double strength = surface.diffuse * cosine;
    if (surface.gloss > 0.0) strength += surface.gloss * lobe(cosine, surface.gloss_angle);
    return strength;
}

double glare_loss(const SurfaceResponse& surface, double cosine) {
    if (surface.loss <= 0.0) return 0.0;
    return surface.loss * (1.0 - lobe(cosine, surface.gloss_angle));
}

PaneShares pane_shares(double transparency, double cosine) {
    const double mirrored = std::pow(1.0 - cosine, 5);
    const double kept_square = 1.0 - transparency;
    PaneShares shares;
    shares.passed = transparency * (1.0 - mirrored);
    shares.returned = kept_square * (0.15 + 0.75 * lobe(cosine, 0.20)) * (1.0 - mirrored);
    return shares;
}

}  // namespace roomscribe
