// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/furniture/piece_form.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "roomscribe/core/quantile.hpp"
#include "roomscribe/interpretation/furniture/row_cuts.hpp"

namespace roomscribe {
namespace {

/// m: pieces stand 16 to 35 mm off the wall for its skirting board, and voxels are 4 cm.
constexpr double wall_reach = 0.12;
/// m: no cabinet is deeper.
constexpr double max_hidden_depth = 0.7;

/// Share of a side that flat upright surface closes, of the one that is closed most: the others may
/// not have been seen. Legs are not flat, stand at corners, and rungs run low, so a side counts in
/// columns, which are closed if most of their height is.
double closed_share(const FurnitureVoxels& all, const PieceDraft& draft,
                    const PlanRectangle& rectangle, double below) {
    // m: worktops overhang by 20 to 40 mm, plinths are set back 50; of a stool it is no leg's
    // place.
    const double rim = std::min(0.12, 0.15 * rectangle.width);
    constexpr double lowest = 0.1;  // m: plinths and castors
    constexpr double column_width = 0.1;
    constexpr double min_fill = 0.6;
    const std::size_t columns =
        std::max<std::size_t>(3, static_cast<std::size_t>(rectangle.length / column_width));
    const auto rows = static_cast<std::size_t>(std::max(1.0, (below - lowest) / all.reach));
    // The short sides only of what is nearly square.
    const bool has_short = rectangle.width >= 0.7 * rectangle.length;
    std::array<std::vector<bool>, 4> is_filled;
    is_filled.fill(std::vector<bool>(columns * rows, false));
    const auto bin = [](double share, std::size_t bins) {
        return static_cast<std::size_t>(
            std::clamp(share * static_cast<double>(bins), 0.0, static_cast<double>(bins) - 1.0));
    };
    for (const std::uint32_t i : draft.voxels) {
        const FurnitureVoxel& voxel = all.voxels[i];
        if (!voxel.is_upright || !voxel.is_planar || voxel.height < lowest || voxel.height >= below)
            continue;
        const Eigen::Vector2d from_center = voxel.place.head<2>() - rectangle.center;
        const double u = from_center.dot(rectangle.axis);
        const double v = from_center.dot(rectangle.across());
        const std::size_t row = columns * bin((voxel.height - lowest) / (below - lowest), rows);
        if (0.5 * rectangle.width - std::abs(v) < rim)
            is_filled[v < 0.0 ? 0 : 1][row + bin(u / rectangle.length + 0.5, columns)] = true;
        if (has_short && 0.5 * rectangle.length - std::abs(u) < rim)
            is_filled[u < 0.0 ? 2 : 3][row + bin(v / rectangle.width + 0.5, columns)] = true;
    }
    std::size_t most = 0;
    for (const std::vector<bool>& side : is_filled) {
        std::size_t closed = 0;
        for (std::size_t column = 0; column < columns; ++column) {
            std::size_t filled = 0;
            for (std::size_t row = 0; row < rows; ++row)
                filled += side[row * columns + column] ? 1U : 0U;
            closed += static_cast<double>(filled) >= min_fill * static_cast<double>(rows) ? 1U : 0U;
        }
        most = std::max(most, closed);
    }
    return static_cast<double>(most) / static_cast<double>(columns);
}

struct WallBehind {
    double depth = 0.0;        ///< m, from the wall to the front
    Eigen::Vector2d off_wall;  ///< unit vector
};

/// The wall that the piece stands at, if it does.
std::optional<WallBehind> wall_behind(const RoomSurfaces& surfaces, const FurnitureVoxel& voxel,
                                      const PlanRectangle& rectangle) {
    const StoreyLayout& storey = surfaces.storeys[voxel.storey];
    const Eigen::Matrix3d axes = surfaces.room_from_map.linear();
    std::optional<WallBehind> least;
    for (const WallFace& face : storey.faces) {
        if (face.room != voxel.room) continue;
        const Eigen::Vector2d normal = (axes * face.plane.normal).head<2>();
        const double to_center = normal.dot(rectangle.center) - face.plane.offset;
        const double half = 0.5 * (rectangle.length * std::abs(rectangle.axis.dot(normal)) +
                                   rectangle.width * std::abs(rectangle.across().dot(normal)));
        // Of a cabinet before a wall only the front may have been seen.
        if (to_center - half > max_hidden_depth || to_center < -wall_reach) continue;
        const Eigen::Vector2d along = (axes * face.along).head<2>();
        const double at = along.dot(rectangle.center);
        if (at < face.start || at > face.end) continue;
        const double depth = to_center + half;
        if (!least || depth < least->depth) least = WallBehind{depth, normal};
    }
    return least;
}

}  // namespace

PieceForm measure_form(const FurnitureVoxels& all, std::span<const LevelSlab> slabs,
                       const PieceDraft& draft, const RoomSurfaces& surfaces) {
    PieceForm form;
    form.num_voxels = draft.voxels.size();
    form.num_slabs = draft.slabs.size();
    form.is_chair = draft.is_chair;
    form.is_under_top = draft.is_under_top;
    if (draft.voxels.empty()) return form;
    std::vector<double> heights;
    std::vector<double> noise;
    std::vector<Eigen::Vector2d> places;
    std::size_t num_level = 0;
    std::size_t num_upright = 0;
    std::size_t num_planar = 0;
    std::vector<std::uint32_t> of_patches;
    for (const std::uint32_t i : draft.voxels) {
        const FurnitureVoxel& voxel = all.voxels[i];
        heights.push_back(voxel.height);
        noise.push_back(voxel.noise);
        places.emplace_back(voxel.place.head<2>());
        num_level += voxel.is_level ? 1U : 0U;
        num_upright += voxel.is_upright ? 1U : 0U;
        num_planar += voxel.is_planar ? 1U : 0U;
        if (voxel.patch != off_patch) of_patches.push_back(voxel.patch);
    }
    const auto share = [&](std::size_t count) {
        return static_cast<double>(count) / static_cast<double>(draft.voxels.size());
    };
    form.level = share(num_level);
    form.upright = share(num_upright);
    form.rectangle = smallest_rectangle(places);
    form.bottom = quantile(heights, 0.01);
    form.top = quantile(heights, 0.99);
    form.front_top = front_top(all, draft.voxels);
    const FurnitureVoxel& some = all.voxels[draft.voxels.front()];
    form.blur = 4.0 * median(noise);  // two deviations on either side
    form.planar = share(num_planar);
    std::sort(of_patches.begin(), of_patches.end());
    std::size_t largest = 0;
    for (std::size_t begin = 0, end = 0; begin < of_patches.size(); begin = end) {
        while (end < of_patches.size() && of_patches[end] == of_patches[begin])
            ++end;
        largest = std::max(largest, end - begin);
    }
    const double voxel_area = 0.25 * all.reach * all.reach;
    form.surface = voxel_area * static_cast<double>(draft.voxels.size());
    form.face = voxel_area * static_cast<double>(largest);
    if (const auto wall = wall_behind(surfaces, some, form.rectangle)) {
        form.depth = wall->depth;
        form.off_wall = wall->off_wall;
        form.is_at_wall = wall->depth - form.rectangle.width <= wall_reach;
    }
    const PlanRoom& room =
        surfaces.storeys[some.storey].plan.rooms[static_cast<std::size_t>(some.room)];
    form.reaches_ceiling =
        room.ceiling_height && form.top > *room.ceiling_height - room.floor_height - 0.2;
    if (!draft.slabs.empty()) {
        const LevelSlab& main = slabs[draft.slabs.front()];
        form.seat = main.height;
        form.seat_area = main.area;
        for (const std::size_t slab : draft.slabs)
            form.highest_slab = std::max(form.highest_slab, slabs[slab].height);
        form.closed = closed_share(all, draft, main.rectangle, main.height - 0.1);
    }
    return form;
}

}  // namespace roomscribe
