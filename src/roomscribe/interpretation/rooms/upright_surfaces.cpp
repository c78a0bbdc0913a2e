// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/rooms/upright_surfaces.hpp"

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
    return surfaces;
}

}  // namespace roomscribe
