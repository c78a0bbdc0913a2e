// SPDX-License-Identifier: MIT
#include "roomscribe/structure/principal_axes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "roomscribe/geometry/transform.hpp"

namespace roomscribe {
namespace {

/// Frames are proposed by the largest patches only: pairs grow with the square, and an axis that
/// none of these shares is not a principal one.
constexpr std::size_t max_proposing_patches = 60;
constexpr int max_refinements = 10;

struct NearestAxis {
    int axis = 0;
    double sign = 1.0;
    double cosine = 0.0;
};

NearestAxis nearest_axis(const Eigen::Matrix3d& axes, const Eigen::Vector3d& normal) {
    const Eigen::Vector3d cosines = axes.transpose() * normal;
    NearestAxis result;
    cosines.cwiseAbs().maxCoeff(&result.axis);
    result.cosine = std::abs(cosines[result.axis]);
    result.sign = cosines[result.axis] < 0.0 ? -1.0 : 1.0;
    return result;
}

Eigen::Matrix3d frame_from(const Eigen::Vector3d& first, const Eigen::Vector3d& second) {
    Eigen::Matrix3d axes;
    axes.col(0) = first.normalized();
    axes.col(1) = (second - second.dot(axes.col(0)) * axes.col(0)).normalized();
    axes.col(2) = axes.col(0).cross(axes.col(1));
    return axes;
}

double agreeing_area(std::span<const PlanarPatch> patches, const Eigen::Matrix3d& axes,
                     double min_cosine) {
    double area = 0.0;
    for (const PlanarPatch& patch : patches) {
        if (nearest_axis(axes, patch.plane.normal).cosine >= min_cosine) area += patch.area;
    }
    return area;
}

/// Rotation nearest in the least-squares sense to all agreeing normals (Wahba's problem).
Eigen::Matrix3d refine(std::span<const PlanarPatch> patches, Eigen::Matrix3d axes,
                       double min_cosine) {
    for (int i = 0; i < max_refinements; ++i) {
        Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
        for (const PlanarPatch& patch : patches) {
            const NearestAxis nearest = nearest_axis(axes, patch.plane.normal);
            if (nearest.cosine < min_cosine) continue;
            sum.col(nearest.axis) += patch.area * nearest.sign * patch.plane.normal;
        }
        // An axis that no patch measures stays where the other two put it.
        for (int axis = 0; axis < 3; ++axis) {
            if (sum.col(axis).squaredNorm() == 0.0) sum.col(axis) = 1e-9 * axes.col(axis);
        }
        const Eigen::Matrix3d refined = nearest_rotation(sum);
        const bool settled = (refined - axes).norm() < 1e-12;
        axes = refined;
        if (settled) break;
    }
    return axes;
}

/// Angle of the rotation between two frames of axes without order and signs.
double frame_angle(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
    double worst = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double cosine = nearest_axis(a, b.col(axis)).cosine;
        worst = std::max(worst, std::acos(std::min(cosine, 1.0)));
    }
    return worst;
}

struct Proposal {
    Eigen::Matrix3d axes;
    double area = 0.0;
};

std::vector<Proposal> propose_frames(std::span<const PlanarPatch> patches, double tolerance) {
    const std::size_t count = std::min(patches.size(), max_proposing_patches);
    std::vector<Proposal> proposals;
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = i + 1; j < count; ++j) {
            const Eigen::Vector3d& a = patches[i].plane.normal;
            const Eigen::Vector3d& b = patches[j].plane.normal;
            if (std::abs(a.dot(b)) > std::sin(tolerance)) continue;
            const Eigen::Matrix3d axes = frame_from(a, b);
            proposals.push_back({axes, agreeing_area(patches, axes, std::cos(tolerance))});
        }
    }
    return proposals;
}

const Proposal* best_of(std::span<const Proposal> proposals) {
    const auto best =
        std::max_element(proposals.begin(), proposals.end(),
                         [](const Proposal& a, const Proposal& b) { return a.area < b.area; });
    return best == proposals.end() ? nullptr : &*best;
}

PrincipalAxesStop measured_axes(std::span<const PlanarPatch> patches, const Eigen::Matrix3d& axes,
                                double min_cosine) {
    std::array<bool, 3> measured{};
    for (const PlanarPatch& patch : patches) {
        const NearestAxis nearest = nearest_axis(axes, patch.plane.normal);
        if (nearest.cosine >= min_cosine) measured[static_cast<std::size_t>(nearest.axis)] = true;
    }
    const auto count = std::count(measured.begin(), measured.end(), true);
    return count == 3   ? PrincipalAxesStop::three_planes
           : count == 2 ? PrincipalAxesStop::two_planes
                        : PrincipalAxesStop::one_plane;
}

double total_area(std::span<const PlanarPatch> patches) {
    double area = 0.0;
    for (const PlanarPatch& patch : patches)
        area += patch.area;
    return area;
}

PrincipalAxes axes_of_one_plane(const Eigen::Vector3d& normal) {
    PrincipalAxes result;
    const PlaneAxes others = plane_axes(normal);
    result.axes = frame_from(normal, others.u);
    result.stop = PrincipalAxesStop::one_plane;
    return result;
}

}  // namespace

std::string_view principal_axes_stop_name(PrincipalAxesStop stop) {
    switch (stop) {
        case PrincipalAxesStop::three_planes:
            return "three_planes";
        case PrincipalAxesStop::two_planes:
            return "two_planes";
        case PrincipalAxesStop::one_plane:
            return "one_plane";
        case PrincipalAxesStop::no_plane:
            return "no_plane";
    }
    return "no_plane";
}

PrincipalAxes estimate_principal_axes(std::span<const PlanarPatch> patches,
                                      const PrincipalAxesSettings& settings,
                                      const Context& context) {
    check_settings(settings);
    context.throw_if_cancelled();
    if (patches.empty()) return {};
    const double min_cosine = std::cos(settings.angle_tolerance);
    const double area = total_area(patches);

    const std::vector<Proposal> proposals = propose_frames(patches, settings.angle_tolerance);
    const Proposal* best = best_of(proposals);
    if (best == nullptr) {
        const auto largest = std::max_element(
            patches.begin(), patches.end(),
            [](const PlanarPatch& a, const PlanarPatch& b) { return a.area < b.area; });
        PrincipalAxes result = axes_of_one_plane(largest->plane.normal);
        result.score = agreeing_area(patches, result.axes, min_cosine) / area;
        return result;
    }

    PrincipalAxes result;
    result.axes = refine(patches, best->axes, min_cosine);
    result.stop = measured_axes(patches, result.axes, min_cosine);
    result.score = agreeing_area(patches, result.axes, min_cosine) / area;
    for (const Proposal& proposal : proposals) {
        const auto is_other = [&](const Eigen::Matrix3d& axes) {
            return frame_angle(result.axes, axes) > 2.0 * settings.angle_tolerance;
        };
        if (proposal.area <= result.runner_up_score * area || !is_other(proposal.axes)) continue;
        const Eigen::Matrix3d rival = refine(patches, proposal.axes, min_cosine);
        const double score = agreeing_area(patches, rival, min_cosine) / area;
        // Refinement may lead back to the winner.
        if (score <= result.runner_up_score || !is_other(rival)) continue;
        result.runner_up_score = score;
        result.runner_up_axes = rival;
    }
    return result;
}

PrincipalAxes estimate_principal_axes_paper(const PointCloud& cloud, std::uint64_t seed,
                                            const PaperAxesSettings& settings,
                                            const Context& context) {
    check_settings(settings);
    // Steps 2-4, 26 and 31: fit a plane, take out its inliers, again until too few are left. All
    // planes are fitted first; those behind the third axis are looked at no more (steps 28-30).
    return principal_axes_of_planes(
        detect_planes_ransac(cloud, seed, settings.planes, context).planes,
        settings.angle_tolerance);
}

PrincipalAxes principal_axes_of_planes(std::span<const PlanarPatch> planes,
                                       double angle_tolerance) {
    const double max_dot = std::sin(angle_tolerance);
    std::optional<Eigen::Vector3d> plane1;
    std::optional<Eigen::Vector3d> plane2;
    std::optional<Eigen::Vector3d> plane3;
    for (const PlanarPatch& patch : planes) {
        const Eigen::Vector3d& normal = patch.plane.normal;
        if (!plane1) {  // steps 5-8
            plane1 = normal;
        } else if (!plane2) {  // steps 10-15
            if (std::abs(plane1->dot(normal)) <= max_dot) plane2 = normal;
        } else if (!plane3) {  // steps 17-22
            if (std::abs(plane2->dot(normal)) <= max_dot) plane3 = normal;
        } else {  // steps 28-30
            break;
        }
    }
    if (!plane1) return {};
    if (!plane2) return axes_of_one_plane(*plane1);

    PrincipalAxes result;
    Eigen::Matrix3d axes = frame_from(*plane1, *plane2);
    result.stop = PrincipalAxesStop::two_planes;
    if (plane3 && std::abs(plane1->dot(*plane3)) <= max_dot) {
        const double sign = axes.col(2).dot(*plane3) < 0.0 ? -1.0 : 1.0;
        axes.col(0) = *plane1;
        axes.col(1) = *plane2;
        axes.col(2) = sign * *plane3;
        axes = nearest_rotation(axes);
        result.stop = PrincipalAxesStop::three_planes;
    }
    result.axes = axes;
    const double area = total_area(planes);
    if (area > 0.0) {
        result.score = agreeing_area(planes, axes, std::cos(angle_tolerance)) / area;
    }
    return result;
}

}  // namespace roomscribe
