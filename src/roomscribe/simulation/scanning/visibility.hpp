// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include "roomscribe/core/context.hpp"
#include "roomscribe/simulation/scanning/ray_caster.hpp"
#include "roomscribe/simulation/scenario.hpp"

namespace roomscribe {

/// Fills `visible` of every component of `scene`: the share of it that the scans saw, in [0, 1].
/// The components are those of the caster's world, in any frame; `points` says how many points of
/// the scans each has.
///
/// Some hundred samples spread evenly over the component are looked at from every station that has
/// them in its field of view and range. A sample counts as seen if nothing stands between but panes
/// and the component itself, with what is part of it (faces and handles of a piece of furniture).
/// Samples lie on the polygon of doors, windows and faces of furniture, for glass and open doorways
/// return little though they are seen; on the surface of everything else, where a station behind
/// a wall does not see it, because the wall's other face is between. Of frames the side that is
/// seen better counts. Where furniture touches something it is not meant to be seen and not
/// sampled. Of a component with fewer than 33 points, except doors and windows, the share is scaled
/// by points / 33: with fewer than 10 it is below the 0.3 from which on misses count.
void measure_visibility(Scene& scene, const RayCaster& caster, ScannerKind scanner,
                        double coarseness, std::span<const Station> stations,
                        std::span<const std::size_t> points, const Context& context = {});

}  // namespace roomscribe
