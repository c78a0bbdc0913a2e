// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <vector>

#include "roomscribe/core/random.hpp"
#include "roomscribe/simulation/furnishing/room_floor.hpp"
#include "roomscribe/simulation/scenario.hpp"

namespace roomscribe {

/// The moves of somebody who furnishes a room. Each tries some places and returns the item that
/// was placed, or nothing if none would do.
class Furnisher {
  public:
    Furnisher(RoomFloor& floor, Random& random) : floor_(floor), random_(random) {}

    RoomFloor& floor() { return floor_; }
    bool chance(double share) { return random_.uniform() < share; }
    double pick(double low, double high) { return random_.uniform(low, high); }
    int count(int low, int high) {
        return low + static_cast<int>(random_.below(static_cast<std::uint32_t>(high - low + 1)));
    }
    std::string_view one_of(std::initializer_list<std::string_view> kinds);

    /// An item of the kind with its sizes, somewhere; sizes that are given stay. One of a set
    /// shares the style of the others.
    ItemPlan make(std::string_view kind, const Eigen::Vector3d& size = Eigen::Vector3d::Zero());
    ItemPlan make_of_style(std::string_view kind, std::uint64_t style,
                           const Eigen::Vector3d& size = Eigen::Vector3d::Zero());

    std::optional<ItemPlan> place(const ItemPlan& item, const Demands& demands = {});
    /// With its back to some wall, often in a corner; `gap` to it, or 16 to 35 mm,
    /// as skirting boards ask.
    std::optional<ItemPlan> place_along_wall(const ItemPlan& item, const Demands& demands = {},
                                             double gap = 0.0);
    /// With its back to this wall at this place along it.
    std::optional<ItemPlan> place_at_wall(ItemPlan item, std::size_t wall, double along, double gap,
                                          const Demands& demands = {});
    /// On a wall where nothing else is; 3 mm off it.
    std::optional<ItemPlan> hang(const ItemPlan& item);
    /// Anywhere on the floor, at any angle or along a wall.
    std::optional<ItemPlan> place_freely(const ItemPlan& item, const Demands& demands = {});
    /// In the middle part of the room, along its walls.
    std::optional<ItemPlan> place_in_the_middle(ItemPlan item, const Demands& demands = {});
    /// At a place of another item's frame (x to its front, y to its left), turned against it.
    std::optional<ItemPlan> place_by(const ItemPlan& host, ItemPlan item, double x, double y,
                                     double turn, const Demands& demands = {});
    /// On top of another item at a place of its frame.
    std::optional<ItemPlan> put_on(const ItemPlan& host, ItemPlan item, double x, double y,
                                   double turn = 0.0);
    /// Somewhere on its top.
    void strew_on(const ItemPlan& host, std::initializer_list<std::string_view> kinds, int count);

  private:
    std::size_t pick_wall(double min_length);

    RoomFloor& floor_;
    Random& random_;
};

/// Furnishes by the room's use. `density` is in [0, 1]: sparse to crowded.
void furnish_by_use(Furnisher& furnisher, std::string_view use, double density);

}  // namespace roomscribe
