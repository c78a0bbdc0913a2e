// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/interpretation/rooms/room_surfaces.hpp"
#include "roomscribe/model/label.hpp"
#include "roomscribe/structure/planar_patch.hpp"
#include "roomscribe/structure/surface_sample.hpp"

namespace roomscribe {

/// In FurnitureVoxel: part of no patch.
inline constexpr std::uint32_t off_patch = std::numeric_limits<std::uint32_t>::max();

/// A voxel of the surface sample within a room that no floor, ceiling, wall or opening explains.
struct FurnitureVoxel {
    std::uint32_t voxel = 0;  ///< of the sample
    std::uint32_t storey = 0;
    std::int32_t room = 0;  ///< of the storey's plan
    Eigen::Vector3d place;  ///< m, along the axes of the room frame, without its translation
    double height = 0.0;    ///< m above the room's floor
    double noise = 0.0;     ///< m, across its surface
    std::uint32_t patch = off_patch;  ///< planar patch that it is part of
    bool is_level = false;            ///< part of a level surface
    bool is_upright = false;          ///< part of an upright one
    bool is_planar = false;           ///< part of a patch that is more than a hand's breadth wide
    bool looks_down = false;          ///< its normal looks down, and normals look to the scanner
    bool is_near_wall = false;        ///< within the relief of a wall's face
    bool is_stray = false;            ///< hangs together with nothing, off walls
    /// Hangs together with others in the room: neither a stray nor what is left of a wall's face.
    bool is_core = false;
};

/// What may be furniture, and which voxels are near each other.
struct FurnitureVoxels {
    std::vector<FurnitureVoxel> voxels;
    double reach = 0.0;  ///< m, within which voxels are neighbours
    /// Neighbours of each, ascending, without itself, one list after another.
    std::vector<std::size_t> first;
    std::vector<std::uint32_t> neighbors;

    std::span<const std::uint32_t> neighbors_of(std::uint32_t i) const {
        return {neighbors.data() + first[i], first[i + 1] - first[i]};
    }
};

/// The voxels that are left in rooms: most points of which have label unknown, above the floor's
/// unevenness and below what is fixed to the ceiling. `labels` are those of the map's points so
/// far.
FurnitureVoxels gather_furniture_voxels(const SurfaceSample& sample,
                                        std::span<const PlanarPatch> patches,
                                        const RoomSurfaces& surfaces, std::span<const Label> labels,
                                        const Context& context = {});

/// Connected sets of those of `candidates` for which `belongs` is true, by their first member;
/// members ascending. `belongs` is false for them afterwards.
std::vector<std::vector<std::uint32_t>> connected_voxels(const FurnitureVoxels& all,
                                                         std::span<const std::uint32_t> candidates,
                                                         std::vector<bool>& belongs);

/// Where they lie as seen from above.
std::vector<Eigen::Vector2d> places_of(const FurnitureVoxels& all,
                                       std::span<const std::uint32_t> members);

}  // namespace roomscribe
