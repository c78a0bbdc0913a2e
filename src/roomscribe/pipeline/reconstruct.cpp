// SPDX-License-Identifier: MIT
#include "roomscribe/pipeline/reconstruct.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "roomscribe/interpretation/bent_walls.hpp"
#include "roomscribe/interpretation/component_support.hpp"
#include "roomscribe/interpretation/doubtful_places.hpp"
#include "roomscribe/interpretation/fixtures/find_fixtures.hpp"
#include "roomscribe/interpretation/fixtures/front_parts.hpp"
#include "roomscribe/interpretation/fixtures/furniture_fixtures.hpp"
#include "roomscribe/interpretation/fixtures/mounting_faces.hpp"
#include "roomscribe/interpretation/furniture/furniture.hpp"
#include "roomscribe/interpretation/openings/wall_openings.hpp"
#include "roomscribe/interpretation/paper_rules/label_by_rules.hpp"
#include "roomscribe/interpretation/paper_rules/orient_by_door.hpp"
#include "roomscribe/interpretation/paper_rules/plane_quadrilaterals.hpp"
#include "roomscribe/model/kept_result.hpp"
#include "roomscribe/model/result_bytes.hpp"
#include "roomscribe/preprocessing/beam_offsets.hpp"
#include "roomscribe/preprocessing/false_returns.hpp"
#include "roomscribe/preprocessing/inferred_views.hpp"
#include "roomscribe/preprocessing/scan_origin.hpp"
#include "roomscribe/structure/outlined_patches.hpp"
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

/// A cloud that does not say where it was seen from mostly was from its origin: then its rays are
/// evidence.
void settle_scanners(Reconstruction& reconstruction, const Context& context) {
    ScanMap& map = reconstruction.map;
    for (const auto& [section, test] : settle_assumed_scanners(map, context)) {
        if (test.is_scanner && map.sections.size() > 1) continue;
        reconstruction.derived_values.push_back(
            {"structure.jumps_from_origin", test.share_of_jumps, "",
             map.sections[section].name +
                 (test.is_scanner
                      ? ": so few neighbours in direction differ in distance that the cloud was "
                        "scanned from its origin"
                      : ": neighbours in direction that differ in distance; it was merged before, "
                        "and where it was scanned from is not known")});
    }
}

/// Times stages and reports that they are done.
class StageReporter {
  public:
    StageReporter(Reconstruction& reconstruction, const Context& context)
        : timer_(reconstruction.stage_costs), context_(context) {}

    void finish(const char* stage, double fraction) {
        timer_.finish(stage);
        context_.report_progress("interpret", fraction);
        context_.throw_if_cancelled();
    }

  private:
    StageTimer timer_;
    const Context& context_;
};

/// Doors' leaves, windows' sashes, furniture's fronts, and what may be one that nothing else was
/// told of. `num_before`: components of the scene before the furniture's.
std::vector<MountingFace> faces_for_fixtures(const SurfaceSample& sample,
                                             std::span<const PlanarPatch> patches,
                                             const RoomSurfaces& surfaces, const Openings& openings,
                                             const Furniture& furniture, std::size_t num_before) {
    std::vector<MountingFace> faces =
        mounting_faces_of_doors(sample, patches, surfaces, openings, surfaces.surfaces.size());
    const std::vector<MountingFace> windows =
        mounting_faces_of_windows(surfaces, openings, surfaces.surfaces.size());
    faces.insert(faces.end(), windows.begin(), windows.end());
    for (MountingFace face : furniture.fronts) {
        face.component += num_before;
        faces.push_back(face);
    }
    const std::vector<MountingFace> others =
        mounting_faces_of_patches(sample, patches, surfaces, furniture, num_before);
    faces.insert(faces.end(), others.begin(), others.end());
    return faces;
}

std::vector<Fixture> find_fixtures_by(const ScanMap& map, const SurfaceSample& sample,
                                      std::span<const MountingFace> faces, std::uint64_t seed,
                                      const FixtureSettings& settings, const Context& context) {
    if (settings.method == FixtureMethod::algorithm_5) {
        return detect_furniture_fixtures(map, sample, faces, seed,
                                         {.aperture = settings.gripper.aperture, .consensus = {}},
                                         context);
    }
    return find_fixtures(map, sample, faces, settings, context);
}

void interpret_by_default(Reconstruction& reconstruction, const PipelineSettings& settings,
                          const Context& context) {
    StageReporter stages(reconstruction, context);
    ScanMap& map = reconstruction.map;
    const ScanStatistics statistics = estimate_scan_statistics(map.cloud, context);
    SurfaceSample sample = sample_surface(map, statistics, settings.structure.sample, context);
    sample.tolerance = settings.structure.plane_tolerance.value_or(sample.tolerance);
    stages.finish("sample surface", 0.4);
    std::vector<PlanarPatch> patches = find_planes(map, sample, settings, context);
    stages.finish("planes", 0.7);
    reconstruction.patches = outline_patches(sample, patches, context);
    stages.finish("outlines for pictures", 0.72);
    const PrincipalAxes axes = find_axes(map, sample, patches, settings, context);
    stages.finish("principal axes", 0.75);
    Upright upright = find_upright(sample, patches, axes, settings.interpretation.upright, context);
    stages.finish("upright", 0.8);
    map.inferred_views = infer_views(map, upright.room_from_map.row(2).transpose(), context);
    upright.facing_is_known |= face_inferred_views(map, sample, patches);
    stages.finish("views", 0.82);
    const std::vector<Ray> rays = sample_rays(map);
    RoomSurfaces surfaces = find_room_surfaces(rays, sample, patches, upright,
                                               settings.interpretation.surfaces, context);
    stages.finish("floor, ceiling, walls", 0.85);
    Openings openings = find_openings(map, rays, sample, patches, surfaces, upright.room_from_map,
                                      statistics.point_spacing, context);
    stages.finish("doors, windows", 0.9);
    reconstruction.labels = label_points(map.cloud, sample, patches, surfaces, openings,
                                         settings.interpretation.labels, context);
    continue_bent_walls(sample, surfaces, reconstruction.labels, context);
    stages.finish("point labels", 0.95);
    const std::size_t num_before = surfaces.surfaces.size() + openings.components.size();
    Furniture furniture =
        find_furniture(map, sample, patches, surfaces, reconstruction.labels.labels,
                       static_cast<std::int32_t>(num_before), seed_of(settings),
                       settings.interpretation.furniture, context);
    label_furniture(sample, furniture, reconstruction.labels);
    stages.finish("furniture", 0.97);
    std::vector<MountingFace> faces =
        faces_for_fixtures(sample, patches, surfaces, openings, furniture, num_before);
    std::vector<Fixture> fixtures = find_fixtures_by(map, sample, faces, seed_of(settings),
                                                     settings.interpretation.fixtures, context);
    part_fronts_by_fixtures(furniture, num_before, faces, fixtures);

    reconstruction.scene.room_from_map = surfaces.room_from_map;
    reconstruction.scene.rooms = std::move(surfaces.rooms);
    for (RoomSurface& surface : surfaces.surfaces) {
        reconstruction.scene.components.push_back(std::move(surface.component));
    }
    std::move(openings.components.begin(), openings.components.end(),
              std::back_inserter(reconstruction.scene.components));
    std::move(furniture.components.begin(), furniture.components.end(),
              std::back_inserter(reconstruction.scene.components));
    add_fixtures(fixtures, faces, reconstruction.scene, reconstruction.labels);
    doubt_open_places(reconstruction.scene, reconstruction.labels);
    stages.finish("fixtures", 1.0);
    add_derived_values(reconstruction.derived_values, statistics, sample, settings.structure);
}

/// The default's word on which way is up, for maps in which the paper's rule finds no door.
Eigen::Matrix3d upright_without_door(const ScanMap& map, const ScanStatistics& statistics,
                                     const PipelineSettings& settings, const Context& context) {
    const SurfaceSample sample =
        sample_surface(map, statistics, settings.structure.sample, context);
    const std::vector<PlanarPatch> patches = find_planes(map, sample, settings, context);
    const PrincipalAxes axes = find_axes(map, sample, patches, settings, context);
    return find_upright(sample, patches, axes, settings.interpretation.upright, context)
        .room_from_map;
}

/// The paper's section 4 (docs/reproduction.md). Its planes are of the whole map, which no voxel
/// grid thins: 2,500 inliers mean points as they were scanned.
void interpret_as_paper(Reconstruction& reconstruction, const ScanMap& map,
                        const PipelineSettings& settings, const Context& context) {
    const PaperRulesSettings& rules = settings.interpretation.paper;
    StageReporter stages(reconstruction, context);
    const ScanStatistics statistics = estimate_scan_statistics(map.cloud, context);
    const double tolerance =
        settings.structure.plane_tolerance.value_or(plane_tolerance(statistics.noise));
    PlaneRansacSettings planes_settings;
    planes_settings.detection = {.distance_tolerance = tolerance,
                                 .min_inliers = settings.structure.min_plane_inliers};
    const std::vector<PlanarPatch> planes =
        detect_planes_ransac(map.cloud, seed_of(settings), planes_settings, context).planes;
    stages.finish("planes", 0.6);
    const PrincipalAxes axes = principal_axes_of_planes(planes, rules.angle_tolerance);
    const std::vector<PlaneQuadrilateral> quadrilaterals = find_plane_quadrilaterals(
        map.cloud, planes, statistics.point_spacing, seed_of(settings), rules, context);
    stages.finish("quadrilaterals", 0.8);
    const DoorOrientation orientation = orient_by_door(quadrilaterals, planes, axes, rules);
    const bool has_door = orientation.stop == DoorOrientationStop::door_found;
    const Eigen::Matrix3d room_from_map =
        has_door ? orientation.room_from_map
                 : upright_without_door(map, statistics, settings, context);
    stages.finish("upright", 0.9);
    RuleLabels found =
        label_by_rules(map.cloud, planes, quadrilaterals, room_from_map, tolerance, rules, context);
    stages.finish("rules", 1.0);

    reconstruction.scene = std::move(found.scene);
    reconstruction.labels = std::move(found.labels);
    reconstruction.derived_values.push_back(
        {"interpretation.paper.doors_that_say_up", static_cast<double>(orientation.num_doors), "",
         has_door ? "quadrilaterals of a door's size on an edge of a bigger one"
                  : "none: the default decided which way is up"});
    reconstruction.derived_values.push_back(
        {"structure.plane_tolerance", tolerance, "m",
         settings.structure.plane_tolerance
             ? "set by hand"
             : "three times the noise and the evenness of finished walls"});
}

/// The scans `chosen` of a registration, which their links join, as a map of their own.
Reconstruction map_apart(std::span<const Scan> scans, const Registration& whole,
                         std::span<const std::size_t> chosen) {
    Reconstruction apart;
    Registration& part = apart.registration.emplace();
    std::vector<std::size_t> number_of(scans.size(), scans.size());
    std::vector<Scan> own;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        const std::size_t scan = chosen[i];
        number_of[scan] = i;
        own.push_back(scans[scan]);
        part.map_from_scan.push_back(whole.apart_from_scan[scan]);
        part.apart_from_scan.emplace_back();
        part.covariances.push_back(whole.covariances[scan]);
        part.is_doubtful.push_back(whole.is_doubtful[scan]);
        part.residuals.push_back(whole.residuals[scan]);
        part.overlaps.push_back(whole.overlaps[scan]);
    }
    for (RegistrationLink link : whole.links) {
        link.source = number_of[link.source];
        link.target = number_of[link.target];
        if (std::max(link.source, link.target) < chosen.size()) part.links.push_back(link);
    }
    part.components.emplace_back(chosen.size());
    std::iota(part.components[0].begin(), part.components[0].end(), std::size_t{0});
    apart.map = merge_scans(std::move(own), part.map_from_scan);
    return apart;
}

/// Points without a place keep the labels that they have in their own map.
void take_labels(const Reconstruction& apart, std::span<const std::size_t> scans,
                 Reconstruction& result) {
    for (std::size_t i = 0; i < scans.size(); ++i) {
        const MapSection& from = apart.map.sections[i];
        const MapSection& to = result.map.sections[scans[i]];
        std::copy_n(apart.labels.labels.begin() + from.first, from.count,
                    result.labels.labels.begin() + to.first);
        std::copy_n(apart.labels.confidences.begin() + from.first, from.count,
                    result.labels.confidences.begin() + to.first);
    }
}

ScanRegistration register_or_recall(std::span<const Scan> scans, KnownPoses known_poses,
                                    const PipelineSettings& settings, const Context& context) {
    ScanRegistration found;
    if (recall(context, "registration", found.registration, found.derived_values)) return found;
    found = register_scans(scans, known_poses, seed_of(settings), settings.registration, context);
    keep(context, "registration", found.registration, found.derived_values);
    return found;
}

void interpret_or_recall(Reconstruction& map, const std::string& name,
                         const PipelineSettings& settings, const Context& context) {
    if (recall(context, name, map.scene, map.labels, map.patches, map.derived_values,
               map.stage_costs))
        return;
    interpret_map(map, settings, context);
    keep(context, name, map.scene, map.labels, map.patches, map.derived_values, map.stage_costs);
}

}  // namespace

Reconstruction register_to_map(std::span<const Scan> scans, const PipelineSettings& settings,
                               const Context& context, KnownPoses known_poses) {
    return register_to_map(std::vector<Scan>(scans.begin(), scans.end()), settings, context,
                           known_poses);
}

Reconstruction register_to_map(std::vector<Scan>&& scans, const PipelineSettings& settings,
                               const Context& context, KnownPoses known_poses) {
    check_settings(settings);
    Reconstruction result;
    StageTimer timer(result.stage_costs);

    ScanRegistration registration = register_or_recall(scans, known_poses, settings, context);
    timer.finish("register");
    result.registration = std::move(registration.registration);
    result.derived_values = std::move(registration.derived_values);
    const auto& components = result.registration->components;
    for (std::size_t i = 1; i < components.size(); ++i)
        result.apart.push_back(map_apart(scans, *result.registration, components[i]));
    result.map = merge_scans(std::move(scans), result.registration->map_from_scan);
    timer.finish("merge");
    return result;
}

void interpret_map(Reconstruction& reconstruction, const PipelineSettings& settings,
                   const Context& context) {
    check_settings(settings);
    settle_scanners(reconstruction, context);
    const std::vector<HiddenPoint> hidden = hide_false_returns(reconstruction.map, context);
    if (!hidden.empty()) {
        reconstruction.derived_values.push_back(
            {"interpretation.false_returns", static_cast<double>(hidden.size()), "",
             "points at the end of the scanner's range or on no surface: left out, unknown"});
    }
    const std::vector<HiddenPoint> moved = remove_beam_offsets(reconstruction.map);
    if (!moved.empty()) {
        reconstruction.derived_values.push_back(
            {"interpretation.beam_offsets", static_cast<double>(moved.size()), "",
             "points on rings of a spinning lidar whose ranges are too long or too short: "
             "interpreted where they should be"});
    }
    const ScanMap& map = reconstruction.map;
    if (settings.interpretation.method == InterpretationMethod::paper) {
        interpret_as_paper(reconstruction, map, settings, context);
    } else {
        interpret_by_default(reconstruction, settings, context);
    }
    measure_support(map, reconstruction.labels, reconstruction.scene.components, context);
    doubt_blurred_places(reconstruction.scene, reconstruction.labels);
    put_back(moved, reconstruction.map);
    put_back(hidden, reconstruction.map);
}

Reconstruction reconstruct(std::span<const Scan> scans, const PipelineSettings& settings,
                           const Context& context, KnownPoses known_poses) {
    return reconstruct(std::vector<Scan>(scans.begin(), scans.end()), settings, context,
                       known_poses);
}

Reconstruction reconstruct(std::vector<Scan>&& scans, const PipelineSettings& settings,
                           const Context& context, KnownPoses known_poses) {
    Reconstruction result = register_to_map(std::move(scans), settings, context, known_poses);
    interpret_or_recall(result, "interpretation", settings, context);
    for (std::size_t i = 0; i < result.apart.size(); ++i) {
        interpret_or_recall(result.apart[i], fmt::format("interpretation-{}", i + 2), settings,
                            context);
        take_labels(result.apart[i], result.registration->components[i + 1], result);
    }
    return result;
}

}  // namespace roomscribe
