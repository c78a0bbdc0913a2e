// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/upright/upright.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include "roomscribe/core/quantile.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/interpretation/upright/axis_profile.hpp"

namespace roomscribe {
namespace {

/// Door leaves (EN 14351, DIN 18101: 0.61 to 1.24 m wide, 1.98 to 2.11 m high) and their frames;
/// the rim of a patch may be missing.
constexpr double min_door_height = 1.85;
constexpr double max_door_height = 2.25;
constexpr double min_door_width = 0.55;
constexpr double max_door_width = 1.35;
constexpr double door_gap = 0.15;
/// A level that holds a tenth of all area across the axis is one of few.
constexpr double few_levels_share = 0.1;
constexpr double max_storey_height = 5.0;
/// Seats are 0.3 m high or more, worktops and bars up to 1.2 m.
constexpr double min_seat_height = 0.3;
constexpr double max_worktop_height = 1.2;
/// Narrower level surfaces are ledges, frames and lintels.
constexpr double min_seat_depth = 0.25;
/// Larger ones are steps of the floor or of the ceiling.
constexpr double max_table_area = 2.5;
constexpr double min_scanner_height = 0.2;
constexpr double max_scanner_height = 2.2;
/// One seat: evidence from less area than this counts in proportion.
constexpr double seat_area = 0.2;
/// By UprightEvidence. What tells an axis from the others (the first three, and the last) counts
/// more than what tells its two directions apart, since cupboards and clutter before a wall look
/// much like tables and clutter on a floor. Among the latter, clutter is the most dependable;
/// furniture and doors are told by size alone and only break ties. The mount of a
/// camera outweighs a lone wall, which has few levels. That of other scanners breaks ties: without
/// it the right direction of scans and maps of lidars leads by 0.6 and 1.0 or more (docs).
constexpr std::array<double, num_upright_evidence> evidence_weights{4.0, 3.0, 1.5, 0.25, 0.5, 2.0,
                                                                    1.0, 1.0, 1.0, 1.5,  4.0};

/// (a - b) / (a + b), drawn to 0 where both are smaller than `scale`.
double contrast(double a, double b, double scale) {
    return (a - b) / std::max(a + b, scale);
}

double few_levels(const AxisProfile& profile) {
    double at_levels = 0.0;
    double taken_to = -std::numeric_limits<double>::infinity();
    for (const LevelPatch& patch : profile.patches) {
        if (patch.height <= taken_to) continue;
        const double area = level_area(profile, patch.height);
        if (area < few_levels_share * profile.area) continue;
        at_levels += area;
        taken_to = patch.height + level_thickness;
    }
    return profile.area > 0.0 ? at_levels / profile.area : 0.0;
}

double room_height(const AxisProfile& profile) {
    const auto plausible = [](double height) {
        return height >= min_storey_height && height <= max_storey_height;
    };
    if (!profile.low && !profile.high) return 0.0;
    if (!profile.low || !profile.high) {
        return plausible(profile.top - profile.bottom) ? 0.5 : 0.0;
    }
    if (plausible(*profile.high - *profile.low)) return 1.0;
    // Several storeys: some level with much surface is a storey above the lowest.
    for (const LevelPatch& patch : profile.patches) {
        if (plausible(patch.height - *profile.low) &&
            level_area(profile, patch.height) >= level_share * profile.low_area) {
            return 0.5;
        }
    }
    return -1.0;
}

bool is_furniture_top(const LevelPatch& patch) {
    return patch.depth >= min_seat_depth && patch.area <= max_table_area;
}

double furniture_height(const AxisProfile& profile) {
    double seats = 0.0;
    double hanging = 0.0;
    for (const LevelPatch& patch : profile.patches) {
        if (!is_furniture_top(patch)) continue;
        const double above = patch.height - profile.floor();
        const double below = profile.ceiling() - patch.height;
        if (above >= min_seat_height && above <= max_worktop_height) seats += patch.area;
        if (below >= min_seat_height && below <= max_worktop_height) hanging += patch.area;
    }
    return contrast(seats, hanging, seat_area);
}

/// The paper's rule (section 4.3): what has a door's size and touches one level stands on the
/// floor.
double doors_stand_on_floor(const AxisProfile& profile) {
    double standing = 0.0;
    double hanging = 0.0;
    for (const WallPatch& wall : profile.walls) {
        const double height = wall.top - wall.bottom;
        if (height < min_door_height || height > max_door_height) continue;
        if (wall.width < min_door_width || wall.width > max_door_width) continue;
        const bool at_low = profile.low && wall.bottom - *profile.low < door_gap;
        const bool at_high = profile.high && *profile.high - wall.top < door_gap;
        if (at_low && !at_high) standing += wall.area;
        if (at_high && !at_low) hanging += wall.area;
    }
    return contrast(standing, hanging, min_door_height * min_door_width);
}

double nothing_beyond(const AxisProfile& profile) {
    const auto beyond = std::count_if(
        profile.planar_heights.begin(), profile.planar_heights.end(), [&](float height) {
            const auto h = static_cast<double>(height);
            return (profile.low && h < *profile.low - level_thickness) ||
                   (profile.high && h > *profile.high + level_thickness);
        });
    return -static_cast<double>(beyond) /
           static_cast<double>(std::max<std::size_t>(profile.planar_heights.size(), 1));
}

double scanner_height(const AxisProfile& profile, std::span<const double> scanners) {
    if (scanners.empty()) return 0.0;
    double score = 0.0;
    for (const double scanner : scanners) {
        const double height = scanner - profile.floor();
        const bool plausible = height > min_scanner_height && height < max_scanner_height &&
                               scanner < profile.ceiling();
        score += plausible ? 1.0 : 0.0;
    }
    return score / static_cast<double>(scanners.size());
}

/// Two levels less than a storey's height apart are no floor and ceiling: the smaller one is a
/// table or a shelf.
AxisProfile without_table_as_level(const AxisProfile& profile) {
    AxisProfile result = profile;
    if (!profile.low || !profile.high || *profile.high - *profile.low >= min_storey_height)
        return result;
    if (profile.high_area <= profile.low_area) {
        result.high.reset();
        result.high_area = 0.0;
    } else {
        result.low.reset();
        result.low_area = 0.0;
    }
    return result;
}

/// `profile` is along the direction, pointing up. `worst_slanted` is over the three axes.
UprightCandidate judge(const Eigen::Vector3d& up, const AxisProfile& profile, double worst_slanted,
                       double supported, const SurfaceSample& sample) {
    UprightCandidate candidate;
    candidate.up = up;
    const auto set = [&](UprightEvidence which, double value) {
        candidate.evidence[static_cast<std::size_t>(which)] = value;
        candidate.score += evidence_weights[static_cast<std::size_t>(which)] * value;
    };
    // Less than a twentieth of slanted surface on every axis says nothing.
    const double slanted = std::max(0.0, profile.slanted_share - profile.roof_above);
    set(UprightEvidence::few_slanted_surfaces,
        (worst_slanted - slanted) / std::max(worst_slanted, 0.05));
    set(UprightEvidence::few_levels, few_levels(profile));
    set(UprightEvidence::room_height, room_height(profile));
    set(UprightEvidence::furniture_height, furniture_height(profile));
    set(UprightEvidence::doors_stand_on_floor, doors_stand_on_floor(profile));
    // Less clutter than a twentieth of the surface counts in proportion.
    set(UprightEvidence::clutter_below,
        contrast(profile.clutter_below, profile.clutter_above,
                 0.05 * static_cast<double>(profile.planar_heights.size())));
    set(UprightEvidence::things_stand_on_it, supported);
    std::vector<double> scanners;
    for (const Eigen::Vector3d& sensor : sample.sensor_positions)
        scanners.push_back(sensor.dot(up));
    set(UprightEvidence::scanner_height, scanner_height(profile, scanners));
    if (!profile.low || !profile.high) {
        set(UprightEvidence::floor_rather_than_ceiling,
            0.5 * contrast(profile.low_area, profile.high_area, seat_area));
    }
    set(UprightEvidence::nothing_beyond, nothing_beyond(profile));
    set(UprightEvidence::scanner_mount, std::max(0.0, sample.usual_up.dot(up)));
    return candidate;
}

/// Axes of a single plane, turned about its normal so that the second is as near as can be to `up`;
/// as they are if the normal is up.
PrincipalAxes turned_upright(const PrincipalAxes& axes, const Eigen::Vector3d& up) {
    const Eigen::Vector3d normal = axes.axes.col(0);
    const Eigen::Vector3d along = up - up.dot(normal) * normal;
    if (along.norm() < std::sin(level_angle) * up.norm() || up.isZero()) return axes;
    PrincipalAxes turned = axes;
    turned.axes.col(1) = along.normalized();
    turned.axes.col(2) = normal.cross(turned.axes.col(1));
    return turned;
}

/// The direction that is nearest to all normals of level patches and to the perpendicular of all
/// upright ones, each weighted with its area.
Eigen::Vector3d refine_up(const Eigen::Vector3d& up, std::span<const PlanarPatch> patches) {
    Eigen::Vector3d refined = up;
    for (int i = 0; i < 5; ++i) {
        // The first round admits what the axes' tolerance admits, later ones only what agrees.
        const double angle = i == 0 ? radians(5.0) : radians(3.0);
        Eigen::Matrix3d sum = 1e-9 * (Eigen::Matrix3d::Identity() - refined * refined.transpose());
        for (const PlanarPatch& patch : patches) {
            const Eigen::Vector3d& normal = patch.plane.normal;
            const double cosine = std::abs(normal.dot(refined));
            if (cosine <= std::sin(angle)) sum += patch.area * normal * normal.transpose();
            if (cosine >= std::cos(angle)) {
                sum += patch.area * (Eigen::Matrix3d::Identity() - normal * normal.transpose());
            }
        }
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sum);
        Eigen::Vector3d next = solver.eigenvectors().col(0).normalized();
        if (next.dot(up) < 0.0) next = -next;
        if (next.dot(up) < std::cos(level_angle)) break;
        refined = next;
    }
    return refined;
}

/// Turns a horizontal direction so that the middle 98 % of the surface reach further from the
/// median along it than against it, and says how far they extend.
double orient_by_reach(const SurfaceSample& sample, Eigen::Vector3d& direction) {
    std::vector<float> positions;
    positions.reserve(sample.cloud.size());
    const Eigen::Vector3f along = direction.cast<float>();
    for (const Eigen::Vector3f& point : sample.cloud.positions)
        positions.push_back(point.dot(along));
    const double low = static_cast<double>(quantile(positions, 0.01));
    const double middle = static_cast<double>(quantile(positions, 0.5));
    const double high = static_cast<double>(quantile(positions, 0.99));
    if (high - middle < middle - low) direction = -direction;
    return high - low;
}

Eigen::Matrix3d room_axes(const Eigen::Vector3d& up, const Eigen::Matrix3d& axes,
                          const SurfaceSample& sample) {
    // The principal axis that is most level gives the walls' direction.
    Eigen::Index most_level = 0;
    (axes.transpose() * up).cwiseAbs().minCoeff(&most_level);
    const Eigen::Vector3d level = axes.col(most_level);
    Eigen::Vector3d first = (level - level.dot(up) * up).normalized();
    Eigen::Vector3d second = up.cross(first);
    const double first_extent = orient_by_reach(sample, first);
    const double second_extent = orient_by_reach(sample, second);
    const Eigen::Vector3d x = first_extent >= second_extent ? first : second;
    Eigen::Matrix3d rotation;
    rotation.row(0) = x.transpose();
    rotation.row(1) = up.cross(x).transpose();
    rotation.row(2) = up.transpose();
    return rotation;
}

}  // namespace

std::string_view upright_evidence_name(UprightEvidence evidence) {
    switch (evidence) {
        case UprightEvidence::few_slanted_surfaces:
            return "few_slanted_surfaces";
        case UprightEvidence::few_levels:
            return "few_levels";
        case UprightEvidence::room_height:
            return "room_height";
        case UprightEvidence::furniture_height:
            return "furniture_height";
        case UprightEvidence::doors_stand_on_floor:
            return "doors_stand_on_floor";
        case UprightEvidence::clutter_below:
            return "clutter_below";
        case UprightEvidence::things_stand_on_it:
            return "things_stand_on_it";
        case UprightEvidence::scanner_height:
            return "scanner_height";
        case UprightEvidence::floor_rather_than_ceiling:
            return "floor_rather_than_ceiling";
        case UprightEvidence::nothing_beyond:
            return "nothing_beyond";
        case UprightEvidence::scanner_mount:
            return "scanner_mount";
    }
    return "";
}

std::string_view upright_stop_name(UprightStop stop) {
    switch (stop) {
        case UprightStop::decided:
            return "decided";
        case UprightStop::ambiguous:
            return "ambiguous";
        case UprightStop::no_plane:
            return "no_plane";
    }
    return "no_plane";
}

Upright find_upright(const SurfaceSample& sample, std::span<const PlanarPatch> patches,
                     const PrincipalAxes& found_axes, const UprightSettings& settings,
                     const Context& context) {
    check_settings(settings);
    Upright result;
    if (patches.empty()) return result;

    // With one plane only, the other two axes are arbitrary and cannot be up, unless the scanner
    // says which of them is.
    const bool has_one_plane = found_axes.stop == PrincipalAxesStop::one_plane;
    const PrincipalAxes axes =
        has_one_plane ? turned_upright(found_axes, sample.usual_up) : found_axes;
    const int num_axes = has_one_plane && sample.usual_up.isZero() ? 1 : 3;
    const std::vector<Eigen::Vector3f> clutter = find_clutter(sample, patches);
    std::vector<AxisProfile> profiles;
    double worst_slanted = 0.0;
    for (int axis = 0; axis < num_axes; ++axis) {
        context.throw_if_cancelled();
        profiles.push_back(profile_along(axes.axes.col(axis), sample, patches, clutter));
        worst_slanted = std::max(worst_slanted, profiles.back().slanted_share);
    }
    for (int axis = 0; axis < num_axes; ++axis) {
        AxisProfile& profile = profiles[static_cast<std::size_t>(axis)];
        for (const double sign : {1.0, -1.0}) {
            const Eigen::Vector3d up = sign * axes.axes.col(axis);
            const double supported = supported_share(clutter, profile, sample, patches, up);
            result.candidates.push_back(
                judge(up, without_table_as_level(profile), worst_slanted, supported, sample));
            reverse(profile);
        }
    }
    std::stable_sort(result.candidates.begin(), result.candidates.end(),
                     [](const auto& a, const auto& b) { return a.score > b.score; });
    const double margin = result.candidates[0].score - result.candidates[1].score;
    double area = 0.0;
    for (const PlanarPatch& patch : patches)
        area += patch.area;
    const bool is_clear = margin >= settings.ambiguous_margin && area >= settings.min_room_surface;
    result.stop = is_clear ? UprightStop::decided : UprightStop::ambiguous;
    const Eigen::Vector3d up = refine_up(result.candidates.front().up, patches);
    result.room_from_map = room_axes(up, axes.axes, sample);

    const AxisProfile profile = profile_along(up, sample, patches, clutter);
    result.facing_is_known =
        sample.normals_face_scanner &&
        std::all_of(sample.sensor_positions.begin(), sample.sensor_positions.end(),
                    [&](const Eigen::Vector3d& sensor) {
                        return sensor.dot(up) > profile.floor() &&
                               sensor.dot(up) < profile.ceiling();
                    });
    return result;
}

}  // namespace roomscribe
