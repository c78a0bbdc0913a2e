// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "roomscribe/simulation/building/wall_layout.hpp"
#include "roomscribe/simulation/furnishing/footprint.hpp"
#include "roomscribe/simulation/furnishing/walking_grid.hpp"
#include "roomscribe/simulation/scenario.hpp"

namespace roomscribe {

/// An opening as one room sees it.
struct OpeningInRoom {
    OpeningKind kind = OpeningKind::door;
    std::size_t wall = 0;
    double along = 0.0;              ///< of its middle, from the wall's start
    double half_width = 0.0;         ///< with its frame
    double low = 0.0;                ///< z
    double high = 0.0;               ///< z
    bool is_latch_at_start = false;  ///< of a door: the hinges are away from the wall's start
};

/// What an item asks of its surroundings.
struct Demands {
    double front_space = 0.0;    ///< m before it that no furniture takes
    bool avoids_windows = true;  ///< false for what people put before them
    bool avoids_doors = true;    ///< false for flat things beside a door
    bool is_checked = true;      ///< false for what is there already
};

/// What stands in a room, and whether something more may. Keeps the swing of doors free, tall
/// things away from windows, everything within the walls and off each other, and the free floor in
/// one piece (walking_grid.hpp).
class RoomFloor {
  public:
    /// `openings` may be those of all rooms. `free_share` of the walkable floor stays walkable.
    RoomFloor(const RoomPlan& room, std::span<const OpeningPlan> openings, double free_share);

    const RoomPlan& room() const { return room_; }
    const std::vector<BuiltWallFace>& walls() const { return walls_; }
    const std::vector<OpeningInRoom>& openings() const { return openings_; }
    const std::vector<ItemPlan>& items() const { return items_; }
    double area() const { return area_; }

    /// Adds the item, whose sizes are set, if it fits; false if it does not.
    bool place(const ItemPlan& item, const Demands& demands = {});

    /// Chord of the room from a point of a wall straight across, along the wall's inner normal.
    double depth_at(std::size_t wall, double along) const;

  private:
    struct Placed {
        bool is_rug = false;
        Footprint outline;
        std::vector<Footprint> shapes;
        Footprint front;  ///< the space before it; half extents 0 if none
    };

    void note_openings(std::span<const OpeningPlan> openings);
    void note_opening(const OpeningPlan& opening, std::size_t wall, double along, bool is_own);
    bool is_within_walls(const Footprint& footprint) const;
    bool is_clear_of_openings(const Footprint& footprint, const Demands& demands) const;
    bool is_clear_of_items(const Placed& item) const;

    RoomPlan room_;
    std::vector<BuiltWallFace> walls_;
    std::vector<OpeningInRoom> openings_;
    std::vector<Footprint> swings_;     ///< floor that doors need
    std::vector<Footprint> kept_free_;  ///< doorways, window boards: whatever the demands
    std::vector<Footprint> views_;      ///< before windows and niches
    std::vector<Placed> placed_;
    std::vector<Footprint> obstacles_;  ///< of those placed, what a walker has to go around
    std::vector<ItemPlan> items_;
    double area_ = 0.0;
    double free_share_ = 0.5;
    std::optional<WalkingGrid> grid_;  ///< always there once constructed
};

}  // namespace roomscribe
