// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/pose_screening.hpp"

#include <algorithm>
#include <cmath>

#include "roomscribe/core/parallel.hpp"

namespace roomscribe {
namespace {

/// The mean over about so many witnesses of 1 for each that is confirmed, and of so much less for
/// each contradicted one.
double screen_witnesses(const OrientedPoints& witnesses, const PreparedScan& judge,
                        const Eigen::Isometry3f& judge_from_seen, const Screening& screening,
                        const RegistrationScale& scale) {
    // As in PoseSupport::evidence, and less because a guess may be off by half a voxel.
    constexpr double contradicted = -4.0;
    const std::size_t num_wanted = std::max<std::size_t>(1, screening.num_witnesses / 2);
    const std::size_t stride = std::max<std::size_t>(1, witnesses.positions.size() / num_wanted);
    const auto max_off_plane = static_cast<float>(0.5 * scale.coarse_voxel);
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < witnesses.positions.size(); i += stride) {
        const Eigen::Vector3f place = judge_from_seen * witnesses.positions[i];
        ++count;
        if (const auto near = judge.coarse_grid.near(place)) {
            const Eigen::Vector3f& normal = judge.coarse.normals[*near];
            const bool agrees =
                (judge_from_seen.linear() * witnesses.normals[i]).dot(normal) >=
                    static_cast<float>(same_surface_cosine) &&
                std::abs(normal.dot(place - judge.coarse.positions[*near])) <= max_off_plane;
            sum += agrees ? 1.0 : 0.0;
        } else if (judge.free_space_is_valid &&
                   judge.free_space.look_at(place.cast<double>(), scale.coarse_voxel) ==
                       Visibility::free) {
            sum += contradicted;
        }
    }
    return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

double screen_one_way(const PreparedScan& seen, const PreparedScan& judge,
                      const Transform& judge_from_seen, const Screening& screening,
                      const RegistrationScale& scale) {
    constexpr double detail_weight = 0.7;
    const Eigen::Isometry3f motion = judge_from_seen.cast<float>();
    const auto screen = [&](const WitnessSet& witnesses) {
        return screen_witnesses(witnesses.points, judge, motion, screening, scale);
    };
    return (1.0 - detail_weight) * screen(seen.witnesses.shell) +
           detail_weight * screen(seen.witnesses.detail);
}

}  // namespace

std::vector<double> screen_poses(const PreparedScan& source, const PreparedScan& target,
                                 std::span<const Transform> poses, const RegistrationScale& scale,
                                 const Screening& screening, const Context& context) {
    std::vector<double> scores(poses.size());
    parallel_for(context, poses.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            scores[i] = screen_one_way(source, target, poses[i], screening, scale);
            if (screening.both_ways)
                scores[i] += screen_one_way(target, source, poses[i].inverse(), screening, scale);
        }
    });
    return scores;
}

}  // namespace roomscribe
