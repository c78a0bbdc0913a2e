// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "roomscribe/geometry/transform.hpp"

namespace roomscribe {

/// Frames that move against each other, as ROS publishes them on /tf: each but the root has a
/// parent, and its pose in that at some times.
class TfTree {
  public:
    /// The last parent of a child is its parent. Times are seconds.
    void add(const std::string& parent, const std::string& child, double time,
             const Transform& parent_from_child);

    /// Sorts the times; call it once, between the last add() and the first question.
    void finish();

    bool has(const std::string& frame) const { return frames_.count(frame) > 0; }

    /// The frame that no other holds, up from this one.
    std::string root_of(std::string frame) const;

    /// The pose of a frame in its root, between the times that are known; a frame with one time
    /// alone never moves. Empty more than a quarter of a second before or after all of them.
    std::optional<Transform> root_from(std::string frame, double time) const;

  private:
    struct Frame {
        std::string parent;
        std::vector<std::pair<double, Transform>> poses;  ///< by time
    };

    std::map<std::string, Frame> frames_;
};

/// The pose at a share of the way from one to another, in [0, 1].
Transform between(const Transform& a, const Transform& b, double share);

}  // namespace roomscribe
