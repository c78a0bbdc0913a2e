// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "roomscribe/interpretation/rooms/room_surfaces_settings.hpp"
#include "roomscribe/structure/planar_patch.hpp"
#include "roomscribe/structure/surface_sample.hpp"

namespace roomscribe {

/// Level patches at one height.
struct Level {
    double height = 0.0;  ///< m along up, mean weighted with area
    double area = 0.0;
    double facing_up = 0.0;  ///< area that looks up minus area that looks down; 0 if not known
    std::vector<std::uint32_t> patches;
};

/// One storey: a floor with its ceilings. Either may not have been seen.
struct Storey {
    std::optional<Level> floor;       ///< the largest
    std::vector<Level> other_floors;  ///< within a low step of it
    std::vector<Level> ceilings;      ///< by height
    /// Patches that rise to a room's height, under a roof's slope.
    std::vector<std::uint32_t> sloping_ceilings;

    /// Height of the lowest ceiling.
    std::optional<double> ceiling_height() const {
        return ceilings.empty() ? std::nullopt : std::optional(ceilings.front().height);
    }
};

/// The storeys of the map, from the lowest; at least one, which may be empty.
std::vector<Storey> find_storeys(const SurfaceSample& sample, std::span<const PlanarPatch> patches,
                                 const Eigen::Vector3d& up, bool facing_is_known,
                                 const RoomSurfacesSettings& settings);

}  // namespace roomscribe
