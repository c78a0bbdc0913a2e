// SPDX-License-Identifier: MIT
#include "roomscribe/io/tf_tree.hpp"

#include <algorithm>

namespace roomscribe {
namespace {

/// Longer chains are rings.
constexpr int max_depth = 64;
/// Transforms are published ten times a second or more; a scan may come a little before the first.
constexpr double max_gap = 0.25;

}  // namespace

Transform between(const Transform& a, const Transform& b, double share) {
    Transform pose = Transform::Identity();
    const Eigen::Quaterniond from(a.linear());
    pose.linear() = from.slerp(share, Eigen::Quaterniond(b.linear())).toRotationMatrix();
    pose.translation() = (1.0 - share) * a.translation() + share * b.translation();
    return pose;
}

void TfTree::add(const std::string& parent, const std::string& child, double time,
                 const Transform& parent_from_child) {
    Frame& frame = frames_[child];
    if (frame.parent != parent) frame.poses.clear();
    frame.parent = parent;
    frame.poses.emplace_back(time, parent_from_child);
}

void TfTree::finish() {
    for (auto& [name, frame] : frames_) {
        std::stable_sort(frame.poses.begin(), frame.poses.end(),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
    }
}

std::string TfTree::root_of(std::string frame) const {
    for (int depth = 0; depth < max_depth; ++depth) {
        const auto found = frames_.find(frame);
        if (found == frames_.end()) break;
        frame = found->second.parent;
    }
    return frame;
}

std::optional<Transform> TfTree::root_from(std::string frame, double time) const {
    Transform pose = Transform::Identity();
    for (int depth = 0; depth < max_depth; ++depth) {
        const auto found = frames_.find(frame);
        if (found == frames_.end()) return pose;
        const auto& poses = found->second.poses;
        const auto after =
            std::lower_bound(poses.begin(), poses.end(), time,
                             [](const auto& known, double wanted) { return known.first < wanted; });
        if (poses.size() == 1) {
            pose = poses.front().second * pose;
        } else if (after == poses.begin()) {
            if (after->first - time > max_gap) return std::nullopt;
            pose = after->second * pose;
        } else if (after == poses.end()) {
            if (time - poses.back().first > max_gap) return std::nullopt;
            pose = poses.back().second * pose;
        } else {
            const auto before = after - 1;
            const double length = after->first - before->first;
            const double share = length > 0.0 ? (time - before->first) / length : 1.0;
            pose = between(before->second, after->second, share) * pose;
        }
        frame = found->second.parent;
    }
    return std::nullopt;
}

}  // namespace roomscribe
