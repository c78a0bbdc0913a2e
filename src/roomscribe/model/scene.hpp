// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/model/label.hpp"

namespace roomscribe {

enum class Verdict : std::uint8_t { accepted, doubtful, rejected };
std::string_view verdict_name(Verdict verdict);

/// Why a component is what it is said to be: a label without training must explain itself.
struct Evidence {
    std::string rule;                ///< the rule that fired, in words
    std::uint64_t points = 0;        ///< input points that support it
    std::optional<double> coverage;  ///< share of the polygon that points cover, in [0, 1]
    std::optional<double> occluded;  ///< share that something hides from every scanner, in [0, 1]
    std::optional<double> rms;       ///< m, distance of the points to the component's plane
    std::string alternative;         ///< the rival reading; not empty when doubtful
    std::uint64_t scans = 0;         ///< that the points come from, 0 if not counted
};

/// A box turned in any way: `axes` are unit vectors, `size` the full extents along them.
struct OrientedBox {
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    std::array<Eigen::Vector3d, 3> axes{Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(),
                                        Eigen::Vector3d::UnitZ()};
    Eigen::Vector3d size = Eigen::Vector3d::Zero();
};

/// How a gripper takes hold of a fixture. Geometry is in the map's frame.
struct Grasp {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Vector3d axis = Eigen::Vector3d::UnitX();      ///< along which the fingers close
    Eigen::Vector3d approach = Eigen::Vector3d::UnitZ();  ///< in which the gripper moves in
    double opening = 0.0;                                 ///< m, of the fingers
};

enum class MotionKind : std::uint8_t {
    hinged,  ///< turns about an axis
    pull,    ///< moves straight, as drawers do
};
std::string_view motion_kind_name(MotionKind kind);

/// How a door or drawer opens. Geometry is in the map's frame.
struct OpeningMotion {
    MotionKind kind = MotionKind::hinged;
    /// On the hinge's axis, beside the fixture; of a pull, where it is taken hold of.
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    /// Unit vector. About it a hinged face turns as a right hand's fingers do; a pull moves along
    /// it.
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
    double confidence = 0.0;  ///< in [0, 1]
};

/// One thing that was found: a floor, a wall, a door. Geometry is in the map's frame.
struct Component {
    std::string id;  ///< "wall-3"
    Label label = Label::unknown;
    std::string kind;                      ///< finer class, or empty
    std::int32_t instance = -1;            ///< what labels.ply calls it
    std::string parent;                    ///< id of a room or component, or empty
    std::vector<Eigen::Vector3d> polygon;  ///< corners in order, on the component's plane
    std::optional<OrientedBox> box;
    std::optional<Grasp> grasp;
    std::optional<OpeningMotion> opens;  ///< of doors and of the doors and drawers of furniture
    /// Of truth alone: the share of the component that the scans saw, in [0, 1].
    std::optional<double> visible;
    double confidence = 0.0;  ///< in [0, 1]
    Verdict verdict = Verdict::doubtful;
    Evidence evidence;
};

struct RoomNeighbor {
    std::string room;
    std::string through;  ///< id of the door or opening
};

struct Room {
    std::string id;
    std::vector<Eigen::Vector3d> polygon;
    double floor_height = 0.0;  ///< m, z in the room frame
    double ceiling_height = 0.0;
    double area = 0.0;    ///< m2
    double volume = 0.0;  ///< m3
    std::vector<std::string> walls;
    std::vector<RoomNeighbor> neighbors;
};

/// What is there. Flat tables with ids, no pointers.
struct Scene {
    /// Map frame -> room frame: z up, floor at z = 0, x and y along the dominant walls.
    Transform room_from_map = Transform::Identity();
    std::vector<Component> components;
    std::vector<Room> rooms;
};

/// The scene in another frame: polygons, boxes, grasps, rooms and the way to the room frame.
Scene transformed_scene(Scene scene, const Transform& target_from_source);

/// For every point of the map, in its order.
struct PointLabels {
    std::vector<Label> labels;
    std::vector<std::int32_t> instances;  ///< Component::instance, -1 where none
    std::vector<float> confidences;       ///< in [0, 1]; 0 for unknown
};

}  // namespace roomscribe
