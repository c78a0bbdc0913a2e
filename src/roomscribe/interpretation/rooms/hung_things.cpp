// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/rooms/hung_things.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <utility>

#include "roomscribe/core/quantile.hpp"
#include "roomscribe/core/units.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

/// Standard deviations of the noise: nearer layers cannot be told apart (find_relief_layers).
constexpr double min_deviations = 2.0;
/// m. Frames and screens are no thicker; shelves and wall units are.
constexpr double max_step = 0.1;
/// From the wall's direction: noise turns small patches.
constexpr double max_turn = radians(10.0);
/// m2. A whiteboard has 2.4 x 1.2 m.
constexpr double max_area = 3.0;
/// m. Smaller ones are switches, and few voxels.
constexpr double min_size = 0.15;
/// Of its rectangle. Round clocks fill 0.79.
constexpr double min_fill = 0.6;
/// Of the strip beside each side, in which the wall shows.
constexpr double min_wall_share = 0.5;
/// m, of the strips beside it.
constexpr double strip_width = 0.15;

/// A voxel near a face: m along the face, along up and before its plane.
struct FaceVoxel {
    std::uint32_t voxel = 0;
    double along = 0.0;
    double above = 0.0;
    double before = 0.0;
};

class FaceRelief {
  public:
    FaceRelief(const SurfaceSample& sample, const WallFace& face, const Vector3d& up)
        : sample_(sample), face_(face), up_(up), cell_size_(2.0 * sample.spacing) {
        for (std::uint32_t voxel = 0; voxel < sample.cloud.size(); ++voxel) {
            const FaceVoxel place = place_of(voxel);
            if (std::abs(place.before) > 2.0 * max_step) continue;
            if (place.along < face.start || place.along > face.end) continue;
            if (place.above < face.bottom || place.above > face.top) continue;
            voxels_.push_back(place);
        }
    }

    void mark(const PlanarPatch& patch, std::vector<bool>& is_hung) const;

  private:
    FaceVoxel place_of(std::uint32_t voxel) const {
        const Vector3d position = sample_.cloud.positions[voxel].cast<double>();
        return {voxel, position.dot(face_.along), position.dot(up_),
                face_.plane.signed_distance(position)};
    }

    const SurfaceSample& sample_;
    const WallFace& face_;
    Vector3d up_;
    double cell_size_;
    std::vector<FaceVoxel> voxels_;
};

void FaceRelief::mark(const PlanarPatch& patch, std::vector<bool>& is_hung) const {
    constexpr double stray_share = 0.02;
    std::vector<double> alongs;
    std::vector<double> aboves;
    std::vector<double> befores;
    for (const std::uint32_t voxel : patch.points) {
        const FaceVoxel place = place_of(voxel);
        alongs.push_back(place.along);
        aboves.push_back(place.above);
        befores.push_back(place.before);
    }
    const WallRectangle extent{quantile(alongs, stray_share), quantile(alongs, 1.0 - stray_share),
                               quantile(aboves, stray_share), quantile(aboves, 1.0 - stray_share)};
    if (std::min(extent.width(), extent.height()) < min_size || extent.area() > max_area) return;
    if (patch.area < min_fill * extent.area()) return;
    const double height = median(befores);
    const double least = std::max(least_wall_step, min_deviations * sample_.noise);

    // What lies beside each side a step deeper, and in how many places along the side it shows.
    const WallRectangle inner = extent.grown(cell_size_, cell_size_, cell_size_);
    const WallRectangle outer =
        inner.grown(strip_width + cell_size_, strip_width + cell_size_, strip_width + cell_size_);
    std::array<std::set<int>, 4> shown;
    std::vector<double> wall;
    for (const FaceVoxel& place : voxels_) {
        const bool is_level = place.above >= extent.bottom && place.above <= extent.top;
        const bool is_over = place.along >= extent.start && place.along <= extent.end;
        const double depth = height - place.before;
        if (is_level == is_over || depth < least || depth > max_step) continue;
        if (place.along < outer.start || place.along > outer.end) continue;
        if (place.above < outer.bottom || place.above > outer.top) continue;
        std::size_t side = 0;
        if (is_level) {
            if (place.along > inner.start && place.along < inner.end) continue;
            side = place.along < extent.start ? 0 : 1;
        } else {
            if (place.above > inner.bottom && place.above < inner.top) continue;
            side = place.above < extent.bottom ? 2 : 3;
        }
        const double position = is_level ? place.above - extent.bottom : place.along - extent.start;
        shown[side].insert(static_cast<int>(position / cell_size_));
        wall.push_back(place.before);
    }
    for (std::size_t side = 0; side < shown.size(); ++side) {
        const double length = side < 2 ? extent.height() : extent.width();
        if (static_cast<double>(shown[side].size()) < min_wall_share * length / cell_size_) return;
    }
    // With its rim, whose voxels hold points of the wall too.
    const double middle = 0.5 * (height + median(wall));
    for (const FaceVoxel& place : voxels_) {
        const bool is_in = place.along >= extent.start && place.along <= extent.end &&
                           place.above >= extent.bottom && place.above <= extent.top;
        if (is_in && place.before > middle && place.before < height + max_step)
            is_hung[place.voxel] = true;
    }
}

}  // namespace

void mark_hung_things(const SurfaceSample& sample, std::span<const PlanarPatch> patches,
                      std::span<const WallFace> faces, const Vector3d& up,
                      std::vector<bool>& is_hung) {
    for (const WallFace& face : faces) {
        std::vector<const PlanarPatch*> candidates;
        for (const PlanarPatch& patch : patches) {
            if (patch.area > max_area) continue;
            const double cosine = patch.plane.normal.dot(face.plane.normal);
            if ((sample.normals_face_scanner ? cosine : std::abs(cosine)) < std::cos(max_turn))
                continue;
            const double along = patch.centroid.dot(face.along);
            const double above = patch.centroid.dot(up);
            const double before = face.plane.signed_distance(patch.centroid);
            if (std::abs(before) > max_step || along < face.start || along > face.end) continue;
            if (above > face.bottom && above < face.top) candidates.push_back(&patch);
        }
        if (candidates.empty()) continue;
        const FaceRelief relief(sample, face, up);
        for (const PlanarPatch* patch : candidates)
            relief.mark(*patch, is_hung);
    }
}

}  // namespace roomscribe
