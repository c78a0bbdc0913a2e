// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "roomscribe/simulation/furnishing/item_builder.hpp"
#include "roomscribe/simulation/scenario.hpp"

namespace roomscribe {

/// The item with what its plan leaves open: sizes that are 0, and for what hangs on a wall an
/// elevation that is 0, take a usual value for the kind, drawn by the style. Throws InvalidArgument
/// for a kind that is not known and for a size or position that is negative or not finite.
ItemPlan resolve_item(const ItemPlan& item);

/// Boxes around all that the item is made of, open doors and handles included, in its own frame
/// (x to the front, the origin in the middle of the footprint at the underside).
std::vector<Eigen::AlignedBox3d> measure_item(const ItemPlan& item);

// One function a kind, by the unit that builds it. The sizes of the item are set.

// cabinets.cpp
void build_cabinet(ItemBuilder& builder);
void build_wardrobe(ItemBuilder& builder);
void build_office_cupboard(ItemBuilder& builder);
void build_drawer_unit(ItemBuilder& builder);
void build_chest_of_drawers(ItemBuilder& builder);
void build_nightstand(ItemBuilder& builder);
void build_tv_unit(ItemBuilder& builder);
void build_shelf(ItemBuilder& builder);
void build_wall_shelf(ItemBuilder& builder);

// kitchen.cpp
void build_kitchen_base(ItemBuilder& builder);
void build_wall_unit(ItemBuilder& builder);
void build_tall_unit(ItemBuilder& builder);
void build_fridge(ItemBuilder& builder);

// bathroom.cpp
void build_vanity(ItemBuilder& builder);
void build_washing_machine(ItemBuilder& builder);
void build_toilet(ItemBuilder& builder);
void build_bathtub(ItemBuilder& builder);

// tables.cpp
void build_desk(ItemBuilder& builder);
void build_table(ItemBuilder& builder);
void build_round_table(ItemBuilder& builder);
void build_coffee_table(ItemBuilder& builder);
void build_counter(ItemBuilder& builder);

// seating.cpp
void build_chair(ItemBuilder& builder);
void build_office_chair(ItemBuilder& builder);
void build_occupied_chair(ItemBuilder& builder);
void build_stool(ItemBuilder& builder);
void build_bench(ItemBuilder& builder);
void build_armchair(ItemBuilder& builder);
void build_sofa(ItemBuilder& builder);
void build_bed(ItemBuilder& builder);

// clutter.cpp: what stands and lies about, without component but for plants, people and lamps
void build_box(ItemBuilder& builder);
void build_bag(ItemBuilder& builder);
void build_ball(ItemBuilder& builder);
void build_bin(ItemBuilder& builder);
void build_papers(ItemBuilder& builder);
void build_books(ItemBuilder& builder);
void build_monitor(ItemBuilder& builder);
void build_keyboard(ItemBuilder& builder);
void build_laptop(ItemBuilder& builder);
void build_kettle(ItemBuilder& builder);
void build_microwave(ItemBuilder& builder);
void build_dishes(ItemBuilder& builder);
void build_bottle(ItemBuilder& builder);
void build_plant(ItemBuilder& builder);
void build_person(ItemBuilder& builder);
void build_floor_lamp(ItemBuilder& builder);
void build_desk_lamp(ItemBuilder& builder);

// fittings.cpp: what is fixed to walls and ceilings and is no furniture
void build_picture(ItemBuilder& builder);
void build_whiteboard(ItemBuilder& builder);
void build_notice_board(ItemBuilder& builder);
void build_mirror(ItemBuilder& builder);
void build_tv_screen(ItemBuilder& builder);
void build_radiator(ItemBuilder& builder);
void build_curtain(ItemBuilder& builder);
void build_coat_rack(ItemBuilder& builder);
void build_clock(ItemBuilder& builder);
void build_fire_extinguisher(ItemBuilder& builder);
void build_switch_plate(ItemBuilder& builder);
void build_ceiling_lamp(ItemBuilder& builder);
void build_pendant_lamp(ItemBuilder& builder);
void build_smoke_detector(ItemBuilder& builder);
void build_rug(ItemBuilder& builder);

// building_parts.cpp: parts of the building that are given as items
void build_column(ItemBuilder& builder);
void build_round_column(ItemBuilder& builder);
void build_beam(ItemBuilder& builder);
void build_soffit(ItemBuilder& builder);
void build_pipe(ItemBuilder& builder);

/// The lower body, torso, arms and head of somebody who sits on a seat at this height, with the
/// back at x = `back`: a component of its own.
void add_sitting_person(ItemBuilder& builder, double seat_height, double back);

}  // namespace roomscribe
