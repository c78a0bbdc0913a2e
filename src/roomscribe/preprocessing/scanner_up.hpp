// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <Eigen/Core>

#include "roomscribe/geometry/transform.hpp"

namespace roomscribe {

/// Which way is up for a scanner that is mounted as most are. Nobody is bound to it: a scanner may
/// lie on its side.
struct UsualUp {
    Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< unit vector
    bool is_camera = false;
};

/// That of a scanner at `sensor` whose axes are the columns of `axes`, in the frame of these and of
/// `positions`. A robot, a tripod or a vehicle has z up and looks along x (ROS REP 103); a camera
/// looks along z and has y down (REP 103, "optical"), or along -z and has y up (OpenGL, and what
/// PCL writes for Kinects). A camera is told by its field of view: all points lie within 60 degrees
/// of the way it looks, half of what the widest depth cameras see. Points that are not finite do
/// not count; of many some thousand are looked at.
UsualUp usual_up(std::span<const Eigen::Vector3f> positions,
                 const Eigen::Vector3d& sensor = Eigen::Vector3d::Zero(),
                 const Eigen::Matrix3d& axes = Eigen::Matrix3d::Identity());

/// Whether a pose, target from source, turns one scanner on its side against the other: by more
/// than 60 degrees, 30 for each.
bool is_tilted(const UsualUp& source, const UsualUp& target, const Transform& target_from_source);

/// What those of all scanners of a map, in its frame, say together. The length says how much they
/// are to be trusted: 1 for cameras, whose frames are told by what they see and which see little;
/// 0.2 for other scanners that agree, as those do that are mounted alike, be it upside down; 0.1
/// for a single one, since nothing confirms it; 0 where they disagree by more than 30 degrees or
/// so, or there is none.
Eigen::Vector3d common_up(std::span<const UsualUp> ups);

}  // namespace roomscribe
