// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/furniture/shelf_contents.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "roomscribe/interpretation/furniture/plan_rectangle.hpp"

namespace roomscribe {
namespace {

/// m: one voxel and a bit, within which a voxel is part of a board, side or back.
constexpr double thickness = 0.05;
/// m: of the marks along the shelf in which a board shows.
constexpr double mark = 0.08;
/// Share of the marks that a board shows in; the rest things hide.
constexpr double min_board_share = 0.55;

/// Heights of the boards, ascending.
std::vector<double> find_boards(const FurnitureVoxels& all, const PieceDraft& draft,
                                const PlanRectangle& rectangle) {
    constexpr double step = 0.03;
    const auto num_marks = static_cast<std::size_t>(rectangle.length / mark) + 1;
    std::vector<std::pair<std::int32_t, std::size_t>> seen;  // height, mark
    for (const std::uint32_t i : draft.voxels) {
        const FurnitureVoxel& voxel = all.voxels[i];
        if (!voxel.is_level) continue;
        const double along =
            (voxel.place.head<2>() - rectangle.center).dot(rectangle.axis) + 0.5 * rectangle.length;
        const auto number = static_cast<std::size_t>(std::max(along, 0.0) / mark);
        const auto level = static_cast<std::int32_t>(std::floor(voxel.height / step));
        // A board may lie on the border of two steps.
        seen.emplace_back(level, std::min(number, num_marks - 1));
        seen.emplace_back(level + 1, std::min(number, num_marks - 1));
    }
    std::sort(seen.begin(), seen.end());
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    std::vector<double> boards;
    for (std::size_t begin = 0, end = 0; begin < seen.size(); begin = end) {
        while (end < seen.size() && seen[end].first == seen[begin].first)
            ++end;
        const double share = static_cast<double>(end - begin) / static_cast<double>(num_marks);
        const double height = step * seen[begin].first;
        if (share < min_board_share) continue;
        if (!boards.empty() && height - boards.back() < 2.5 * step) {
            boards.back() = 0.5 * (boards.back() + height);
        } else {
            boards.push_back(height);
        }
    }
    return boards;
}

/// Places along the shelf of the uprights between its bays: what fills most of the height within
/// its depth, as books do not, which show their backs in front and their sides at the ends of rows.
std::vector<double> find_dividers(const FurnitureVoxels& all, const PieceDraft& draft,
                                  const PlanRectangle& rectangle, double top) {
    constexpr double step = 0.03;
    constexpr double rim = 0.05;  // m, in front and behind
    const auto num_marks = static_cast<std::size_t>(top / mark) + 1;
    std::vector<std::pair<std::int32_t, std::size_t>> seen;  // place, mark
    for (const std::uint32_t i : draft.voxels) {
        const FurnitureVoxel& voxel = all.voxels[i];
        const Eigen::Vector2d from_center = voxel.place.head<2>() - rectangle.center;
        if (!voxel.is_upright ||
            std::abs(from_center.dot(rectangle.across())) > 0.5 * rectangle.width - rim)
            continue;
        const auto level = static_cast<std::int32_t>(
            std::floor((from_center.dot(rectangle.axis) + 0.5 * rectangle.length) / step));
        const auto number = std::min(static_cast<std::size_t>(voxel.height / mark), num_marks - 1);
        seen.emplace_back(level, number);
        seen.emplace_back(level + 1, number);
    }
    std::sort(seen.begin(), seen.end());
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    std::vector<double> dividers;
    for (std::size_t begin = 0, end = 0; begin < seen.size(); begin = end) {
        while (end < seen.size() && seen[end].first == seen[begin].first)
            ++end;
        const double share = static_cast<double>(end - begin) / static_cast<double>(num_marks);
        if (share < min_board_share) continue;
        dividers.push_back(step * seen[begin].first - 0.5 * rectangle.length);
    }
    return dividers;
}

}  // namespace

void drop_shelf_contents(const FurnitureVoxels& all, const PieceForm& form, PieceDraft& draft) {
    std::vector<Eigen::Vector2d> places;
    double top = 0.0;
    for (const std::uint32_t i : draft.voxels) {
        places.emplace_back(all.voxels[i].place.head<2>());
        top = std::max(top, all.voxels[i].height);
    }
    const PlanRectangle rectangle = smallest_rectangle(places);
    const std::vector<double> boards = find_boards(all, draft, rectangle);
    constexpr double lowest = 0.2;
    const auto inner = std::count_if(boards.begin(), boards.end(), [&](double height) {
        return height > lowest && height < top - 0.15;
    });
    if (inner < 2) return;
    const std::vector<double> dividers = find_dividers(all, draft, rectangle, top);
    // The back stands a skirting board's thickness off the wall, and books before it.
    constexpr double max_back = 0.08;
    const double front =
        form.off_wall.dot(form.rectangle.center) +
        0.5 * form.rectangle.length * std::abs(form.rectangle.axis.dot(form.off_wall)) +
        0.5 * form.rectangle.width * std::abs(form.rectangle.across().dot(form.off_wall));
    const auto is_back = [&](const FurnitureVoxel& voxel) {
        return form.is_at_wall &&
               form.off_wall.dot(voxel.place.head<2>()) <= front - form.depth + max_back;
    };
    const auto is_part = [&](std::uint32_t i) {
        const FurnitureVoxel& voxel = all.voxels[i];
        const Eigen::Vector2d from_center = voxel.place.head<2>() - rectangle.center;
        const double to_side = 0.5 * rectangle.length - std::abs(from_center.dot(rectangle.axis));
        if (to_side <= thickness || voxel.is_near_wall || is_back(voxel)) return true;
        const double along = from_center.dot(rectangle.axis);
        const bool is_divider = std::any_of(dividers.begin(), dividers.end(), [&](double at) {
            return std::abs(along - at) <= thickness;
        });
        if (is_divider) return true;
        return std::any_of(boards.begin(), boards.end(), [&](double height) {
            return std::abs(voxel.height - height) <= thickness;
        });
    };
    draft.voxels.erase(std::remove_if(draft.voxels.begin(), draft.voxels.end(),
                                      [&](std::uint32_t i) { return !is_part(i); }),
                       draft.voxels.end());
}

}  // namespace roomscribe
