// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pose_support.hpp"

#include <cmath>
#include <cstdint>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/core/units.hpp"

namespace roomscribe {

double PoseSupport::overlap() const {
    return total == 0 ? 0.0
                      : static_cast<double>(confirmed + displaced) / static_cast<double>(total);
}

double PoseSupport::agreement() const {
    const std::size_t judged = confirmed + displaced + contradicted;
    return judged == 0 ? 0.0 : static_cast<double>(confirmed) / static_cast<double>(judged);
}

double PoseSupport::score() const {
    if (total == 0) return 0.0;
    return (static_cast<double>(confirmed) - static_cast<double>(contradicted)) /
           static_cast<double>(total);
}

namespace {

enum class PointFate : std::uint8_t { unknown, confirmed, displaced, contradicted };

/// What becomes of one oriented point in the frame of the scan that judges it.
PointFate judge_point(const PreparedScan& judge, const Eigen::Vector3d& place,
                      const Eigen::Vector3d& normal, const RegistrationScale& scale) {
    // Centroids of the same surface in two voxel grids lie within one and a half voxels, and within
    // a quarter of a voxel of each other's plane.
    const double reach = 1.5 * scale.coarse_voxel;
    const double max_off_plane = 0.25 * scale.coarse_voxel;
    const double min_cosine = std::cos(radians(45.0));
    const auto [index, squared_distance] = judge.coarse.tree.nearest(place.cast<float>());
    if (squared_distance <= reach * reach) {
        const Eigen::Vector3d judge_normal = judge.coarse.normals[index].cast<double>();
        if (!(normal.dot(judge_normal) >= min_cosine)) return PointFate::unknown;
        const double off_plane =
            judge_normal.dot(place - judge.coarse.positions[index].cast<double>());
        return std::abs(off_plane) <= max_off_plane ? PointFate::confirmed : PointFate::displaced;
    }
    const bool passed_through =
        judge.free_space_is_valid &&
        judge.free_space.look_at(place, 3.0 * scale.coarse_voxel) == Visibility::free;
    return passed_through ? PointFate::contradicted : PointFate::unknown;
}

PoseSupport add(PoseSupport sum, const PoseSupport& part) {
    sum.total += part.total;
    sum.confirmed += part.confirmed;
    sum.displaced += part.displaced;
    sum.contradicted += part.contradicted;
    return sum;
}

/// One way: the points of `seen` as judged by `judge`.
PoseSupport measure_one_way(const PreparedScan& seen, const PreparedScan& judge,
                            const Transform& judge_from_seen, const RegistrationScale& scale,
                            const Context& context) {
    const auto judge_points = [&](std::size_t begin, std::size_t end) {
        PoseSupport support;
        for (std::size_t i = begin; i < end; ++i) {
            const PointFate fate = judge_point(
                judge, judge_from_seen * seen.coarse_sample.positions[i].cast<double>(),
                judge_from_seen.linear() * seen.coarse_sample.normals[i].cast<double>(), scale);
            ++support.total;
            if (fate == PointFate::confirmed) ++support.confirmed;
            if (fate == PointFate::displaced) ++support.displaced;
            if (fate == PointFate::contradicted) ++support.contradicted;
        }
        return support;
    };
    return parallel_reduce(context, seen.coarse_sample.positions.size(), 256, PoseSupport{},
                           judge_points, add);
}

}  // namespace

PoseSupport measure_support(const PreparedScan& source, const PreparedScan& target,
                            const Transform& target_from_source, const RegistrationScale& scale,
                            const Context& context) {
    PoseSupport support =
        add(measure_one_way(source, target, target_from_source, scale, context),
            measure_one_way(target, source, target_from_source.inverse(), scale, context));
    support.free_space_is_known = source.free_space_is_valid && target.free_space_is_valid;
    return support;
}

}  // namespace roomscribe
