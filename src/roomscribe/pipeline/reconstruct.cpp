// SPDX-License-Identifier: MIT
#include "roomscribe/pipeline/reconstruct.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "roomscribe/interpretation/fixtures/find_fixtures.hpp"
#include "roomscribe/interpretation/fixtures/furniture_fixtures.hpp"
#include "roomscribe/interpretation/fixtures/mounting_faces.hpp"
#include "roomscribe/interpretation/openings/wall_openings.hpp"
#include "roomscribe/structure/planar_surfaces.hpp"
#include "roomscribe/structure/plane_hough.hpp"
#include "roomscribe/structure/plane_ransac.hpp"

namespace roomscribe {
namespace {

std::uint64_t seed_of(const PipelineSettings& settings) {
    return static_cast<std::uint64_t>(settings.seed);
}

std::vector<PlanarPatch> find_planes(const ScanMap& map, const SurfaceSample& sample,
                                     const PipelineSettings& settings, const Context& context) {
    const PlaneDetectionSettings detection{.distance_tolerance = sample.tolerance,
                                           .min_inliers = settings.structure.min_plane_inliers};
    if (settings.structure.plane_method == PlaneMethod::ransac) {
        return detect_planes_ransac(sample.cloud, seed_of(settings),
                                    {.detection = detection, .consensus = {}}, context)
            .planes;
    }
    if (settings.structure.plane_method == PlaneMethod::hough)
        return detect_planes_hough(sample.cloud, {.detection = detection}, context).planes;
    return find_planar_surfaces(
               map, sample,
               {.distance_tolerance = sample.tolerance, .cell_size = 2.0 * sample.spacing}, context)
        .patches;
}

PrincipalAxes find_axes(const ScanMap& map, const SurfaceSample& sample,
                        std::span<const PlanarPatch> patches, const PipelineSettings& settings,
                        const Context& context) {
    if (settings.structure.axes_method == AxesMethod::algorithm_2) {
        PaperAxesSettings paper;
        paper.planes.detection.distance_tolerance = sample.tolerance;
        paper.planes.detection.min_inliers = settings.structure.min_plane_inliers;
        return estimate_principal_axes_paper(map.cloud, seed_of(settings), paper, context);
    }
    return estimate_principal_axes(patches, settings.structure.axes, context);
}

void add_derived_values(std::vector<DerivedValue>& derived, const ScanStatistics& statistics,
                        const SurfaceSample& sample, const StructureSettings& settings) {
    derived.push_back({"structure.point_spacing", statistics.point_spacing, "m",
                       "distance of neighbouring points of the map, median over its surface"});
    derived.push_back(
        {"structure.noise", statistics.noise, "m", "residuals of smooth surface of the map"});
    derived.push_back(
        {"structure.voxel_size", sample.voxel_size, "m",
         settings.sample.voxel_size ? "set by hand" : "half the point spacing, at least 0.04 m"});
    derived.push_back({"structure.plane_tolerance", sample.tolerance, "m",
                       settings.plane_tolerance
                           ? "set by hand"
                           : "three times the noise and the evenness of finished walls"});
}

}  // namespace

Reconstruction register_to_map(std::span<const Scan> scans, const PipelineSettings& settings,
                               const Context& context, KnownPoses known_poses) {
    check_settings(settings);
    Reconstruction result;
    StageTimer timer(result.stage_costs);

    ScanRegistration registration =
        register_scans(scans, known_poses, seed_of(settings), settings.registration, context);
    timer.finish("register");
    result.map = merge_scans(scans, registration.registration.map_from_scan);
    timer.finish("merge");

    result.registration = std::move(registration.registration);
    result.derived_values = std::move(registration.derived_values);
    return result;
}

void interpret_map(Reconstruction& reconstruction, const PipelineSettings& settings,
                   const Context& context) {
    check_settings(settings);
    const ScanMap& map = reconstruction.map;
    StageTimer timer(reconstruction.stage_costs);
    const auto finish = [&](const char* stage, double fraction) {
        timer.finish(stage);
        context.report_progress("interpret", fraction);
        context.throw_if_cancelled();
    };

    const ScanStatistics statistics = estimate_scan_statistics(map.cloud, context);
    SurfaceSample sample = sample_surface(map, statistics, settings.structure.sample, context);
    sample.tolerance = settings.structure.plane_tolerance.value_or(sample.tolerance);
    finish("sample surface", 0.4);
    const std::vector<PlanarPatch> patches = find_planes(map, sample, settings, context);
    finish("planes", 0.7);
    const PrincipalAxes axes = find_axes(map, sample, patches, settings, context);
    finish("principal axes", 0.75);
    const Upright upright =
        find_upright(sample, patches, axes, settings.interpretation.upright, context);
    finish("upright", 0.8);
    RoomSurfaces surfaces = find_room_surfaces(map, sample, patches, upright,
                                               settings.interpretation.surfaces, context);
    finish("floor, ceiling, walls", 0.85);
    Openings openings = find_openings(map, sample, patches, surfaces, upright.room_from_map,
                                      statistics.point_spacing, context);
    finish("doors, windows", 0.9);
    reconstruction.labels = label_points(map.cloud, sample, patches, surfaces, openings,
                                         settings.interpretation.labels, context);
    finish("point labels", 0.97);
    std::vector<MountingFace> faces =
        mounting_faces_of_doors(sample, patches, surfaces, openings, surfaces.surfaces.size());
    const std::vector<MountingFace> others = mounting_faces_of_patches(sample, patches, surfaces);
    faces.insert(faces.end(), others.begin(), others.end());
    const FixtureSettings& fixture_settings = settings.interpretation.fixtures;
    const std::vector<Fixture> fixtures =
        fixture_settings.method == FixtureMethod::algorithm_5
            ? detect_furniture_fixtures(
                  map, sample, faces, seed_of(settings),
                  {.aperture = fixture_settings.gripper.aperture, .consensus = {}}, context)
            : find_fixtures(map, sample, faces, fixture_settings, context);

    reconstruction.scene.room_from_map = surfaces.room_from_map;
    reconstruction.scene.rooms = std::move(surfaces.rooms);
    for (RoomSurface& surface : surfaces.surfaces) {
        reconstruction.scene.components.push_back(std::move(surface.component));
    }
    std::move(openings.components.begin(), openings.components.end(),
              std::back_inserter(reconstruction.scene.components));
    add_fixtures(fixtures, faces, reconstruction.scene, reconstruction.labels);
    finish("fixtures", 1.0);
    add_derived_values(reconstruction.derived_values, statistics, sample, settings.structure);
}

Reconstruction reconstruct(std::span<const Scan> scans, const PipelineSettings& settings,
                           const Context& context, KnownPoses known_poses) {
    Reconstruction result = register_to_map(scans, settings, context, known_poses);
    interpret_map(result, settings, context);
    return result;
}

}  // namespace roomscribe
