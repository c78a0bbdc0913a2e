// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/derived_value.hpp"
#include "roomscribe/model/registration_result.hpp"
#include "roomscribe/model/scan.hpp"
#include "roomscribe/model/scene.hpp"
#include "roomscribe/model/surface_outlines.hpp"
#include "roomscribe/pipeline/pipeline_settings.hpp"
#include "roomscribe/pipeline/stage_costs.hpp"

namespace roomscribe {

/// Everything that a run finds out. `registration` is empty for a map that came registered.
/// `apart` holds a reconstruction per further component of the registration: scans that hang
/// together, but nobody knows where in the map.
struct Reconstruction {
    std::optional<Registration> registration;
    ScanMap map;
    Scene scene;
    PointLabels labels;
    std::vector<OutlinedPatch> patches;  ///< what the scene was made of, for pictures
    std::vector<DerivedValue> derived_values;
    std::vector<StageCost> stage_costs;
    std::vector<Reconstruction> apart;
};

/// Poses that are known of scans: none, or one entry per scan, empty where nothing is known.
using KnownPoses = std::span<const std::optional<Transform>>;

/// Scans as the scanner left them -> one map, and further ones of scans that could not be joined to
/// it. A map's frame is its first scan's, or that of known poses that are kept
/// (registration.known_poses).
/// Throws InvalidArgument if there are no scans, or another number of known poses.
/// A scan without a sensor pose counts as seen from its origin: locate_scanner tells where else.
Reconstruction register_to_map(std::span<const Scan> scans, const PipelineSettings& settings = {},
                               const Context& context = {}, KnownPoses known_poses = {});

/// The same, where the scans are not needed any more: they take no memory beside their map.
Reconstruction register_to_map(std::vector<Scan>&& scans, const PipelineSettings& settings = {},
                               const Context& context = {}, KnownPoses known_poses = {});

/// A registered map -> scene and labels, added to a reconstruction that has its map.
void interpret_map(Reconstruction& reconstruction, const PipelineSettings& settings = {},
                   const Context& context = {});

/// The whole job: register_to_map, then interpret_map of each map. Points of the map's scans that
/// have no place in it get the labels that they have in their own map, of no instance here.
Reconstruction reconstruct(std::span<const Scan> scans, const PipelineSettings& settings = {},
                           const Context& context = {}, KnownPoses known_poses = {});

/// The same, where the scans are not needed any more.
Reconstruction reconstruct(std::vector<Scan>&& scans, const PipelineSettings& settings = {},
                           const Context& context = {}, KnownPoses known_poses = {});

}  // namespace roomscribe
