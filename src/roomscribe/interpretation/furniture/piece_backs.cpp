// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/furniture/piece_backs.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "roomscribe/core/quantile.hpp"

namespace roomscribe {
namespace {

/// m off the wall's face: skirting boards (16 to 35 mm), the back's thickness and noise.
constexpr double max_offset = 0.08;
/// m: skirting boards are 16 mm thick at least.
constexpr double min_offset = 0.010;
/// m: the wall beside and above, that the back is held against.
constexpr double margin = 0.06;
constexpr double around = 0.6;
/// Voxels; fewer tell no median to millimetres.
constexpr std::size_t min_voxels = 30;

}  // namespace

std::vector<std::uint32_t> find_back_on_wall(const SurfaceSample& sample,
                                             const RoomSurfaces& surfaces, const PieceForm& form,
                                             const FurnitureVoxel& some) {
    const Eigen::Matrix3d axes = surfaces.room_from_map.linear();
    const double floor = some.place.z() - some.height;
    const PlanRectangle& plan = form.rectangle;
    std::vector<std::uint32_t> back;
    for (const WallFace& face : surfaces.storeys[some.storey].faces) {
        const Eigen::Vector2d normal = (axes * face.plane.normal).head<2>();
        if (face.room != some.room || normal.dot(form.off_wall) < 0.98) continue;
        const Eigen::Vector2d along = (axes * face.along).head<2>();
        const double middle = along.dot(plan.center);
        if (middle < face.start || middle > face.end) continue;
        const double half = 0.5 * (plan.length * std::abs(plan.axis.dot(along)) +
                                   plan.width * std::abs(plan.across().dot(along)));
        std::vector<double> inside;
        std::vector<double> outside;
        std::vector<std::uint32_t> voxels;
        for (std::uint32_t v = 0; v < sample.cloud.size(); ++v) {
            const Eigen::Vector3d position = sample.cloud.positions[v].cast<double>();
            const double offset = face.plane.signed_distance(position);
            if (std::abs(offset) > max_offset) continue;
            const Eigen::Vector3d place = axes * position;
            const double aside = std::abs(along.dot(place.head<2>()) - middle) - half;
            const double height = place.z() - floor;
            const double above = std::max(height - form.top, form.bottom - height);
            if (aside <= 0.0 && above <= 0.0) {
                inside.push_back(offset);
                voxels.push_back(v);
            } else if (std::max(aside, above) >= margin && std::max(aside, above) <= around) {
                outside.push_back(offset);
            }
        }
        if (inside.size() < min_voxels || outside.size() < min_voxels) continue;
        if (median(inside) - median(outside) >= min_offset)
            back.insert(back.end(), voxels.begin(), voxels.end());
    }
    std::sort(back.begin(), back.end());
    return back;
}

}  // namespace roomscribe
