// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include "roomscribe/model/registration_result.hpp"
#include "roomscribe/registration/pair/prepared_scan.hpp"
#include "support/simulated_rooms.hpp"

namespace roomscribe::test {

/// Two scans of the L-shaped room, and two more of it or of another room.
struct TwoSets {
    std::vector<Transform> poses;
    std::vector<PreparedScan> scans;
    std::vector<RegistrationLink> links;

    explicit TwoSets(const Scenario& second_room) {
        const RegistrationScale scale{
            .coarse_voxel = 0.1, .fine_voxel = 0.04, .fpfh_radius = 0.5, .noise = 0.002};
        const std::vector<Eigen::Vector3d> places = {
            {1.3, 2.2, 1.4}, {3.6, 2.0, 1.6}, {1.2, 3.0, 1.3}, {2.4, 1.6, 1.5}};
        for (std::size_t i = 0; i < places.size(); ++i) {
            Transform pose = Transform::Identity();
            pose.translation() = places[i];
            const Scenario room = i < 2 ? l_shaped_room() : second_room;
            poses.push_back(pose);
            scans.push_back(prepare_scan(simulate_scan(room, pose, i, 4.0), scale));
        }
        links = {link(1, 0, LinkVerdict::accepted), link(3, 2, LinkVerdict::accepted),
                 link(2, 1, LinkVerdict::ambiguous)};
    }

    Transform truth(std::size_t source, std::size_t target) const {
        return poses[target].inverse() * poses[source];
    }
    RegistrationLink link(std::size_t source, std::size_t target, LinkVerdict verdict) const {
        RegistrationLink result;
        result.source = source;
        result.target = target;
        result.target_from_source = truth(source, target);
        result.verdict = verdict;
        result.probability = verdict == LinkVerdict::accepted ? 0.99 : 0.6;
        return result;
    }
};

/// Half a turn about the middle of the room.
inline Transform turned(const Transform& target_from_source) {
    Transform turn = Transform::Identity();
    turn.linear() = Eigen::AngleAxisd(3.14159, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    turn.translation() = Eigen::Vector3d(-0.5, 0.5, 0.0);
    return turn * target_from_source;
}

}  // namespace roomscribe::test
