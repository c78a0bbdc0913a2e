// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "roomscribe/io/file_contents.hpp"
#include "roomscribe/io/ros_message.hpp"
#include "roomscribe/io/tf_tree.hpp"

namespace roomscribe {

/// A planar scan, as it was recorded.
struct LaserScan {
    double time = 0.0;
    std::string frame;
    double start = 0.0;
    double step = 0.0;
    double ray_time = 0.0;
    double min_range = 0.0;
    double max_range = 0.0;
    double angle = 0.0;  ///< of the scanner, in whatever unit
    std::vector<float> ranges;
    std::vector<float> intensities;
};

/// The planar scans of a topic, and what tells how the scanner was turned.
struct LaserTopic {
    std::string topic;
    std::string angle;  ///< field of the messages that says it; empty: the transforms do
    std::vector<LaserScan> scans;
};

/// Adds the LaserScan that a message holds, if it holds one.
void add_laser_scan(const RosMessage& message, LaserTopic& laser);

/// One cloud of all planar scans, see rosbag.hpp. Throws Error, with the reason, if nothing says
/// how the scanner was turned. Precondition: there is a scan.
FileContents assemble_laser_scans(const LaserTopic& laser, const TfTree& transforms);

}  // namespace roomscribe
