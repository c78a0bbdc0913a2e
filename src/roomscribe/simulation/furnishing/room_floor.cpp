// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/furnishing/room_floor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "roomscribe/core/units.hpp"
#include "roomscribe/geometry/polygon.hpp"
#include "roomscribe/simulation/furnishing/item_kinds.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector2d;

constexpr double wall_margin = 0.002;
constexpr double item_margin = 0.004;
constexpr double door_space = 0.95;  // before every door, whether it opens into the room or not
constexpr double view_depth = 0.45;
constexpr double board_depth = 0.13;  // of the board below a window
constexpr double max_wall_thickness = 0.6;
constexpr double door_margin = 0.1;
constexpr double entry_distance = 0.5;
constexpr double head_height = 2.0;
constexpr double step_height = 0.05;

/// The space before an item.
Footprint space_before(const ItemPlan& item, double space) {
    Eigen::AlignedBox3d extent;
    extent.extend(Eigen::Vector3d(item.size.x() / 2.0, -item.size.y() / 2.0, 0.0));
    extent.extend(Eigen::Vector3d(item.size.x() / 2.0 + space, item.size.y() / 2.0, head_height));
    return footprint_of(item, extent);
}

}  // namespace

RoomFloor::RoomFloor(const RoomPlan& room, std::span<const OpeningPlan> openings, double free_share)
    : room_(room),
      walls_(wall_faces(std::span(&room, 1))),
      area_(signed_area(room.outline)),
      free_share_(free_share) {
    note_openings(openings);
    std::vector<Vector2d> entries;
    for (const OpeningInRoom& opening : openings_) {
        if (opening.kind == OpeningKind::window || opening.kind == OpeningKind::niche) continue;
        const BuiltWallFace& wall = walls_[opening.wall];
        entries.emplace_back(wall.start + opening.along * wall.along() +
                             entry_distance * wall.inward());
    }
    grid_.emplace(room_, walls_, entries);
}

void RoomFloor::note_openings(std::span<const OpeningPlan> openings) {
    for (const OpeningPlan& opening : openings) {
        const bool is_own = opening.room == room_.name;
        // Windows and niches belong to one room; a door is seen from both of its sides.
        const bool has_two_sides =
            opening.kind == OpeningKind::door || opening.kind == OpeningKind::passage;
        if (!is_own && !has_two_sides) continue;
        for (std::size_t i = 0; i < walls_.size(); ++i) {
            const Vector2d offset = opening.at - walls_[i].start;
            const double along = offset.dot(walls_[i].along());
            const double behind = -offset.dot(walls_[i].inward());
            if (along < 0.0 || along > walls_[i].length()) continue;
            if (is_own ? std::abs(behind) > 0.05 : behind < 0.0 || behind > max_wall_thickness) {
                continue;
            }
            note_opening(opening, i, along, is_own);
        }
    }
}

void RoomFloor::note_opening(const OpeningPlan& opening, std::size_t wall_index, double along,
                             bool is_own) {
    const BuiltWallFace& wall = walls_[wall_index];
    const double floor = room_.floor_height;
    OpeningInRoom seen{.kind = opening.kind,
                       .wall = wall_index,
                       .along = along,
                       .half_width = hole_half_width(opening) + opening.frame_width,
                       .low = floor + opening.sill,
                       .high = floor + opening.sill + opening.height + opening.frame_width,
                       .is_latch_at_start = opening.is_hinged_left == is_own};
    openings_.push_back(seen);
    double low = along - seen.half_width - door_margin;
    double high = along + seen.half_width + door_margin;
    if (opening.kind == OpeningKind::window || opening.kind == OpeningKind::niche) {
        Footprint view = before_wall(wall, low + 0.05, high - 0.05, view_depth);
        view.low = seen.low;
        view.high = seen.high;
        views_.push_back(view);
        Footprint board = before_wall(wall, low + 0.05, high - 0.05, board_depth);
        board.low = seen.low - 0.04;
        board.high = seen.low + 0.02;
        kept_free_.push_back(board);
        return;
    }
    Footprint doorway = before_wall(wall, low + 0.06, high - 0.06, door_space);
    doorway.low = floor;
    doorway.high = seen.high + 0.05;
    kept_free_.push_back(doorway);

    const double leaf = opening.is_double ? opening.width / 2.0 : opening.width;
    const bool swings_in = opening.kind == OpeningKind::door && opening.opens_into_room == is_own;
    if (swings_in && opening.leaf_angle > 85.0) {
        // The leaf, its thickness and its handle reach past the hinges.
        const double past = 0.15 + leaf * std::max(0.0, -std::cos(radians(opening.leaf_angle)));
        if (opening.is_double || !seen.is_latch_at_start) low -= past;
        if (opening.is_double || seen.is_latch_at_start) high += past;
    }
    const double depth = swings_in ? std::max(door_space, leaf + opening.recess + 0.1) : door_space;
    Footprint swing = before_wall(wall, low, high, depth);
    swing.low = floor;
    swing.high = doorway.high;
    swings_.push_back(swing);
}

bool RoomFloor::is_within_walls(const Footprint& footprint) const {
    return contains(room_.outline, footprint.center) &&
           std::none_of(walls_.begin(), walls_.end(), [&](const BuiltWallFace& wall) {
               return touches(wall, footprint, wall_margin);
           });
}

bool RoomFloor::is_clear_of_openings(const Footprint& footprint, const Demands& demands) const {
    const auto is_hit = [&](const Footprint& zone) { return overlap(footprint, zone, 0.0); };
    if (std::any_of(kept_free_.begin(), kept_free_.end(), is_hit)) return false;
    if (demands.avoids_doors && std::any_of(swings_.begin(), swings_.end(), is_hit)) return false;
    return !demands.avoids_windows || std::none_of(views_.begin(), views_.end(), is_hit);
}

bool RoomFloor::is_clear_of_items(const Placed& item) const {
    return std::none_of(placed_.begin(), placed_.end(), [&](const Placed& other) {
        // Rugs lie under furniture.
        if (item.is_rug != other.is_rug) return false;
        if (overlap(item.front, other.outline, 0.0) || overlap(item.outline, other.front, 0.0)) {
            return true;
        }
        if (!overlap(item.outline, other.outline, item_margin)) return false;
        return std::any_of(item.shapes.begin(), item.shapes.end(), [&](const Footprint& a) {
            return overlap(a, other.outline, item_margin) &&
                   std::any_of(other.shapes.begin(), other.shapes.end(),
                               [&](const Footprint& b) { return overlap(a, b, item_margin); });
        });
    });
}

bool RoomFloor::place(const ItemPlan& item, const Demands& demands) {
    Placed candidate;
    candidate.is_rug = item.kind == "rug";
    Eigen::AlignedBox3d whole;
    for (const Eigen::AlignedBox3d& shape : measure_item(item)) {
        candidate.shapes.push_back(footprint_of(item, shape));
        whole.extend(shape);
    }
    candidate.outline = footprint_of(item, whole);
    if (demands.front_space > 0.0) {
        candidate.front = space_before(item, demands.front_space);
        candidate.front.low = room_.floor_height + step_height;
    }
    if (demands.is_checked) {
        if (candidate.outline.high > room_.ceiling_height - 0.0005) return false;
        if (!is_within_walls(candidate.outline)) return false;
        if (demands.front_space > 0.0 && !is_within_walls(candidate.front)) return false;
        if (!is_clear_of_openings(candidate.outline, demands)) return false;
        if (!is_clear_of_items(candidate)) return false;
    }
    if (candidate.outline.low < room_.floor_height + head_height &&
        candidate.outline.high > room_.floor_height + step_height) {
        obstacles_.push_back(candidate.outline);
        if (!demands.is_checked) {
            grid_->take(candidate.outline);
        } else if (!grid_->take_if_good(obstacles_, free_share_)) {
            obstacles_.pop_back();
            return false;
        }
    }
    items_.push_back(item);
    placed_.push_back(std::move(candidate));
    return true;
}

double RoomFloor::depth_at(std::size_t wall, double along) const {
    const BuiltWallFace& from = walls_[wall];
    const Vector2d start = from.start + along * from.along();
    const Vector2d ray = from.inward();
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < walls_.size(); ++i) {
        if (i == wall) continue;
        const Vector2d side = walls_[i].end - walls_[i].start;
        const double slope = cross(ray, side);
        if (std::abs(slope) < 1e-9) continue;
        const Vector2d offset = walls_[i].start - start;
        const double t = cross(offset, side) / slope;
        const double share = cross(offset, ray) / slope;
        if (t > 1e-6 && share >= -1e-9 && share <= 1.0 + 1e-9) nearest = std::min(nearest, t);
    }
    return nearest;
}

}  // namespace roomscribe
