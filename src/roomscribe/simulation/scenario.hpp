// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace roomscribe {

// A scenario says in a small file what stands where and from where it is scanned. Angles are
// degrees here, as people write them; lengths metres; the frame has z up and z = 0 on the floor.
// Details that a person would not care to write (the size of a handle, what lies on a desk) follow
// from `style`, a number that seeds them.

/// A room by its finished inner surfaces. What lies between rooms is wall.
struct RoomPlan {
    std::string name;                      ///< "kitchen-1", unique
    std::string use;                       ///< "office", "kitchen", "corridor", ...
    std::vector<Eigen::Vector2d> outline;  ///< corners, counter-clockwise
    double floor_height = 0.0;
    double ceiling_height = 2.6;  ///< z of the ceiling
};

enum class OpeningKind : std::uint8_t { door, passage, window, niche };
enum class LeafState : std::uint8_t { closed, ajar, open };

/// A hole in a wall. It goes through to the room on the other side if one has a parallel wall face
/// there, else outdoors; a niche ends at its depth.
struct OpeningPlan {
    OpeningKind kind = OpeningKind::door;
    std::string room;                              ///< on whose wall face `at` lies
    Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< middle of the opening on that wall face
    /// Door: of the leaf, or of both leaves together. Window, niche, passage: of the hole.
    double width = 0.9;
    double height = 2.0;
    double sill = 0.0;  ///< height of the lower edge above the room's floor

    double frame_width = 0.06;       ///< as seen; 0 for none
    double frame_protrusion = 0.01;  ///< out of the wall face towards the room
    double recess = 0.0;             ///< of leaf, frame of a window, or back of a niche

    LeafState leaf = LeafState::closed;
    double leaf_angle = 0.0;  ///< degrees from closed
    bool opens_into_room = true;
    bool is_hinged_left = true;  ///< as seen from the room
    bool is_double = false;
    bool is_glazed = false;     ///< a door with a pane in its leaf
    int mullions = 0;           ///< vertical bars that divide a window
    double blind = 0.0;         ///< share of the window that a blind covers, from the top
    double transparency = 0.9;  ///< share of rays that the glass lets through
    std::uint64_t style = 0;
};

/// A thing in a room: "desk", "kitchen_base", "radiator", "picture", "column", "beam", ...
/// (furnishing.hpp lists them). Its front looks along `turn`.
struct ItemPlan {
    std::string kind;
    Eigen::Vector2d at = Eigen::Vector2d::Zero();    ///< middle of its footprint
    double turn = 0.0;                               ///< degrees from x to where its front looks
    Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< depth (along its front), width, height
    double elevation = 0.0;                          ///< z of its underside
    std::uint64_t style = 0;
};

enum class ScannerKind : std::uint8_t {
    sick_lms200,       ///< tilting, as in the paper
    hokuyo_utm30lx,    ///< tilting, on a PR2
    terrestrial,       ///< surveyor's, nearly the full sphere
    structured_light,  ///< depth frames of 640 x 480
    spinning_lidar     ///< 16 to 64 beams
};
inline constexpr std::array<std::string_view, 5> scanner_kind_names{
    "sick_lms200", "hokuyo_utm30lx", "terrestrial", "structured_light", "spinning_lidar"};

/// Where the scanner stood and where it looked.
struct Station {
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    double heading = 0.0;  ///< degrees from x
    double pitch = 0.0;    ///< degrees, nose down
    double roll = 0.0;     ///< degrees
};

struct Scenario {
    std::string name;
    std::uint64_t seed = 1;  ///< of noise, losses and the world frame
    double outer_wall_thickness = 0.35;
    double storey_height = 3.0;  ///< of this floor above the ground outdoors
    std::vector<RoomPlan> rooms;
    std::vector<OpeningPlan> openings;
    std::vector<ItemPlan> items;
    ScannerKind scanner = ScannerKind::terrestrial;
    /// Of the scanner's angular steps; 2 means every other ray.
    double coarseness = 1.0;
    std::vector<Station> stations;
};

}  // namespace roomscribe
