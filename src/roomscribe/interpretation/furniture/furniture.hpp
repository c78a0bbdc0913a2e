// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/interpretation/fixtures/mounting_face.hpp"
#include "roomscribe/interpretation/furniture/furniture_settings.hpp"
#include "roomscribe/interpretation/rooms/room_surfaces.hpp"
#include "roomscribe/model/label.hpp"
#include "roomscribe/model/scan.hpp"
#include "roomscribe/model/scene.hpp"
#include "roomscribe/structure/planar_patch.hpp"
#include "roomscribe/structure/surface_sample.hpp"

namespace roomscribe {

/// In Furniture::component_of_voxel: furniture, but nothing tells which piece.
inline constexpr std::int32_t unnamed_furniture = -2;

/// Pieces of furniture with their faces, and what hangs on walls besides.
struct Furniture {
    /// Each piece (label furniture, `box`) before its faces (label furniture, `polygon`, parent the
    /// piece); then what is no furniture but has a kind (label unknown).
    std::vector<Component> components;
    /// Number in `components` per voxel of the sample, of the piece or thing that its points
    /// belong to; -1 for none, or unnamed_furniture.
    std::vector<std::int32_t> component_of_voxel;
    /// Voxels whose points are a piece's back though they were taken for the wall behind it.
    /// Ascending.
    std::vector<std::uint32_t> backs;
    /// The upright faces; `component` numbers `components`.
    std::vector<MountingFace> fronts;
};

/// What stands in the rooms, and hangs on their walls, piece by piece. `labels` are those of the
/// map's points so far: floor, ceiling, walls and openings; instances are counted on from
/// `first_instance`. Nothing found gives empty tables.
///
/// By the default, voxels that no room surface or opening explains are parted into things
/// (draft_tall_pieces, draft_pieces), and what has a piece's size and form is one (judge_piece). By
/// Algorithm 5 each of its surfaces is a component of its own, without a piece; `seed` is of its
/// draws.
Furniture find_furniture(const ScanMap& map, const SurfaceSample& sample,
                         std::span<const PlanarPatch> patches, const RoomSurfaces& surfaces,
                         std::span<const Label> labels, std::int32_t first_instance,
                         std::uint64_t seed, const FurnitureSettings& settings = {},
                         const Context& context = {});

/// Gives the points that are unknown so far and lie in a piece's or thing's voxels to it, and a
/// wall's points in voxels of a piece's back.
void label_furniture(const SurfaceSample& sample, const Furniture& furniture, PointLabels& labels);

}  // namespace roomscribe
