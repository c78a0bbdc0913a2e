// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/wall_surfaces.hpp"

#include <algorithm>
#include <cmath>

#include "roomscribe/core/quantile.hpp"
#include "roomscribe/core/units.hpp"

namespace roomscribe {
namespace {

/// Walls lean by millimetres; tilting laser scanners bend them by up to 12 degrees at the top of
/// what they see. Nothing else in a building leans by so little: mansard walls and stairs' cheeks
/// lean by 20 degrees and more.
constexpr double max_lean = radians(15.0);
/// Pieces of one wall agree in direction up to the error of a small piece's normal.
constexpr double max_turn = radians(5.0);
/// Share of a patch's points that its extent leaves out at either end: strays.
constexpr double stray_share = 0.005;
/// Skirtings, cables and boxes hide a wall's foot up to here.
constexpr double floor_reach = 0.3;
/// Cupboards and shelves are 0.2 to 0.9 m deep.
constexpr double max_cupboard_depth = 1.0;
/// A cupboard's top leaves this much of the wall behind it to see.
constexpr double cupboard_clearance = 0.15;

/// Behind the outer wall of what was seen there is next to nothing: strays through windows.
constexpr double max_share_behind = 0.02;
/// A door leaf has 1.6 m2, the front of a desk less than 1.
constexpr double min_closing_area = 1.0;

struct Extent {
    double low = 0.0;
    double high = 0.0;

    void include(const Extent& other) {
        low = std::min(low, other.low);
        high = std::max(high, other.high);
    }
    double gap_to(const Extent& other) const {
        return std::max({0.0, other.low - high, low - other.high});
    }
};

Extent extent_along(const SurfaceSample& sample, const PlanarPatch& patch,
                    const Eigen::Vector3d& direction) {
    std::vector<double> positions;
    positions.reserve(patch.points.size());
    for (const std::uint32_t point : patch.points) {
        positions.push_back(sample.cloud.positions[point].cast<double>().dot(direction));
    }
    return {quantile(positions, stray_share), quantile(positions, 1.0 - stray_share)};
}

Plane upright_plane(const PlanarPatch& patch, const Eigen::Vector3d& up) {
    Plane plane;
    const Eigen::Vector3d& normal = patch.plane.normal;
    plane.normal = (normal - normal.dot(up) * up).normalized();
    plane.offset = plane.normal.dot(patch.centroid);
    return plane;
}

class WallJoiner {
  public:
    WallJoiner(const SurfaceSample& sample, std::span<const PlanarPatch> patches,
               const Eigen::Vector3d& up, const RoomSurfacesSettings& settings)
        : sample_(sample), patches_(patches), up_(up), settings_(settings) {}

    void add(std::uint32_t patch);
    std::vector<UprightSurface> take() && { return std::move(surfaces_); }

  private:
    bool belongs(const UprightSurface& surface, const PlanarPatch& patch) const;
    void extend(UprightSurface& surface, std::uint32_t patch) const;

    const SurfaceSample& sample_;
    std::span<const PlanarPatch> patches_;
    Eigen::Vector3d up_;
    const RoomSurfacesSettings& settings_;
    std::vector<UprightSurface> surfaces_;
};

bool WallJoiner::belongs(const UprightSurface& surface, const PlanarPatch& patch) const {
    const double cosine = surface.plane.normal.dot(patch.plane.normal);
    const double agreement = sample_.normals_face_scanner ? cosine : std::abs(cosine);
    if (agreement < std::cos(max_turn)) return false;
    // Two errors of the same kind: the surface's and the patch's.
    const double tolerance = std::sqrt(2.0) * sample_.tolerance;
    const double across = surface.plane.signed_distance(patch.centroid);
    if (std::abs(across) > tolerance) return false;
    const Extent width = extent_along(sample_, patch, surface.along);
    const Extent height = extent_along(sample_, patch, up_);
    return Extent{surface.start, surface.end}.gap_to(width) <= settings_.max_gap &&
           Extent{surface.bottom, surface.top}.gap_to(height) <= settings_.max_gap;
}

void WallJoiner::extend(UprightSurface& surface, std::uint32_t number) const {
    const PlanarPatch& patch = patches_[number];
    Extent width = extent_along(sample_, patch, surface.along);
    Extent height = extent_along(sample_, patch, up_);
    if (!surface.patches.empty()) {
        width.include({surface.start, surface.end});
        height.include({surface.bottom, surface.top});
    }
    surface.start = width.low;
    surface.end = width.high;
    surface.bottom = height.low;
    surface.top = height.high;
    const double area = surface.area + patch.area;
    surface.rms = std::sqrt(
        (surface.rms * surface.rms * surface.area + patch.rms * patch.rms * patch.area) / area);
    surface.area = area;
    surface.patches.push_back(number);
}

void WallJoiner::add(std::uint32_t number) {
    for (UprightSurface& surface : surfaces_) {
        if (!belongs(surface, patches_[number])) continue;
        extend(surface, number);
        return;
    }
    UprightSurface surface;
    surface.plane = upright_plane(patches_[number], up_);
    surface.along = up_.cross(surface.plane.normal);
    extend(surface, number);
    surfaces_.push_back(std::move(surface));
}

/// Counts a part of the sample: shares to a percent need no more.
void compare_sides(const SurfaceSample& sample, UprightSurface& surface) {
    constexpr double max_clear_share = 0.25;
    constexpr std::size_t max_counted = 20'000;
    const std::size_t step = sample.cloud.size() / max_counted + 1;
    const Eigen::Vector3f normal = surface.plane.normal.cast<float>();
    const Eigen::Vector3f along = surface.along.cast<float>();
    const auto offset = static_cast<float>(surface.plane.offset);
    const auto start = static_cast<float>(surface.start);
    const auto end = static_cast<float>(surface.end);
    // As far as the wall's own unevenness and the thickness of what hangs on it.
    const auto clearance = static_cast<float>(0.05 + 2.0 * sample.tolerance);
    std::size_t before = 0;
    std::size_t behind = 0;
    for (std::size_t i = 0; i < sample.cloud.size(); i += step) {
        const Eigen::Vector3f& point = sample.cloud.positions[i];
        const float position = point.dot(along);
        if (position < start || position > end) continue;
        const float distance = point.dot(normal) - offset;
        if (distance > clearance) ++before;
        if (distance < -clearance) ++behind;
    }
    const std::size_t total = before + behind;
    if (total == 0) return;
    surface.share_behind =
        static_cast<double>(std::min(before, behind)) / static_cast<double>(total);
    if (surface.share_behind <= max_clear_share) surface.back_side = before < behind ? 1 : -1;
}

/// A taller parallel surface that this one stands before: the wall behind a cupboard.
bool stands_before_wall(const UprightSurface& surface, std::span<const UprightSurface> others) {
    constexpr double min_overlap = 0.6;
    for (const UprightSurface& other : others) {
        if (&other == &surface || other.top < surface.top + cupboard_clearance) continue;
        const double cosine = other.plane.normal.dot(surface.plane.normal);
        if (std::abs(cosine) < std::cos(max_lean)) continue;
        const Eigen::Vector3d middle = 0.5 * (surface.start + surface.end) * surface.along +
                                       surface.plane.offset * surface.plane.normal;
        const double distance = other.plane.signed_distance(middle);
        if (std::abs(distance) > max_cupboard_depth) continue;
        // Where the surface lies as seen from the other's plane, in terms of its own normal.
        const double before = cosine > 0.0 ? distance : -distance;
        if (before * surface.back_side > 0.0) continue;
        const double sign = other.along.dot(surface.along) < 0.0 ? -1.0 : 1.0;
        const double start = sign * (sign > 0.0 ? surface.start : surface.end);
        const double end = sign * (sign > 0.0 ? surface.end : surface.start);
        const double overlap = std::min(end, other.end) - std::max(start, other.start);
        if (overlap >= min_overlap * surface.width()) return true;
    }
    return false;
}

}  // namespace

std::vector<UprightSurface> find_upright_surfaces(const SurfaceSample& sample,
                                                  std::span<const PlanarPatch> patches,
                                                  const Eigen::Vector3d& up, double from, double to,
                                                  const RoomSurfacesSettings& settings) {
    WallJoiner joiner(sample, patches, up, settings);
    for (std::uint32_t i = 0; i < patches.size(); ++i) {
        if (std::abs(patches[i].plane.normal.dot(up)) > std::sin(max_lean)) continue;
        const double height = patches[i].centroid.dot(up);
        if (height >= from && height < to) joiner.add(i);
    }
    std::vector<UprightSurface> surfaces = std::move(joiner).take();
    std::stable_sort(surfaces.begin(), surfaces.end(),
                     [](const auto& a, const auto& b) { return a.area > b.area; });
    for (UprightSurface& surface : surfaces)
        compare_sides(sample, surface);
    return surfaces;
}

WallJudgement judge_wall(const UprightSurface& surface, std::span<const UprightSurface> others,
                         const Storey& storey, const RoomSurfacesSettings& settings) {
    WallJudgement judgement;
    const auto ceiling = storey.ceiling_height();
    judgement.reaches_floor = storey.floor && surface.bottom <= storey.floor->height + floor_reach;
    judgement.reaches_ceiling = ceiling && surface.top >= *ceiling - settings.ceiling_reach;
    const bool touches_ceiling = ceiling && surface.top >= *ceiling - cupboard_clearance;
    const bool closes_room = storey.floor && surface.share_behind <= max_share_behind &&
                             surface.area >= min_closing_area;
    const bool is_tall = surface.height() >= settings.min_free_wall_height;
    const bool is_wall =
        ceiling ? judgement.reaches_ceiling || (closes_room && is_tall) : closes_room || is_tall;

    if (surface.height() < settings.min_wall_height) return judgement;
    if (!is_wall) return judgement;
    if (!touches_ceiling && stands_before_wall(surface, others)) return judgement;

    judgement.is_wall = true;
    judgement.rule = judgement.reaches_ceiling ? "upright surface that reaches the ceiling"
                     : closes_room             ? "upright surface that closes the room"
                                   : "upright surface taller than furniture; no ceiling seen";
    judgement.confidence = 0.5 + (judgement.reaches_ceiling ? 0.25 : 0.0) +
                           (judgement.reaches_floor ? 0.15 : 0.0) + (closes_room ? 0.15 : 0.0) +
                           (surface.area >= min_closing_area ? 0.1 : 0.0);
    judgement.confidence = std::min(judgement.confidence, 0.99);
    // Under a ceiling, what stops short of it may be furniture at the edge of what was seen.
    if (!judgement.reaches_ceiling && (ceiling || !judgement.reaches_floor)) {
        judgement.alternative = "front or side of a tall piece of furniture";
    }
    return judgement;
}

}  // namespace roomscribe
