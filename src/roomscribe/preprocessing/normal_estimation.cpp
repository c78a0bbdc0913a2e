// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/normal_estimation.hpp"

#include <cmath>
#include <limits>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/geometry/plane.hpp"

namespace roomscribe {

PointNormals estimate_normals(std::span<const Eigen::Vector3f> positions, const SearchTree& tree,
                              const Eigen::Vector3d& sensor_position,
                              const NormalSettings& settings, const Context& context) {
    check_settings(settings);
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    PointNormals result;
    result.normals.assign(positions.size(), Eigen::Vector3f(nan, nan, nan));
    result.residuals.assign(positions.size(), nan);

    parallel_for(context, positions.size(), 1024, [&](std::size_t begin, std::size_t end) {
        std::vector<Neighbor> neighbors;
        for (std::size_t i = begin; i < end; ++i) {
            tree.nearest(positions[i], static_cast<std::size_t>(settings.num_neighbors), neighbors);
            PlaneMoments moments;
            for (const Neighbor& neighbor : neighbors) {
                moments.add(positions[neighbor.index].cast<double>());
            }
            const auto fit = moments.fit();
            if (!fit) continue;
            const Eigen::Vector3d to_sensor = sensor_position - positions[i].cast<double>();
            const double sign = fit->plane.normal.dot(to_sensor) < 0.0 ? -1.0 : 1.0;
            result.normals[i] = (sign * fit->plane.normal).cast<float>();
            result.residuals[i] = static_cast<float>(fit->rms);
        }
    });
    return result;
}

}  // namespace roomscribe
