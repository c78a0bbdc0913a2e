// SPDX-License-Identifier: MIT
#include "roomscribe/reproduction/paper_pair.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/geometry/bounding_box.hpp"
#include "roomscribe/preprocessing/normal_estimation.hpp"
#include "roomscribe/preprocessing/voxel_grid.hpp"

namespace roomscribe {
namespace {

double extent_of(const Scan& scan) {
    constexpr std::size_t min_points = 100;
    const std::vector<std::uint32_t> finite = finite_points(scan.cloud);
    if (finite.size() < min_points) {
        throw InvalidArgument("scan", fmt::format("{} finite points", finite.size()),
                              fmt::format("at least {}", min_points));
    }
    return bounding_box(select_points(scan.cloud, finite).positions).sizes().maxCoeff();
}

/// The voxel that leaves about so many points in each scan, halving the range that it can lie in.
double choose_voxel(const Scan& source, const Scan& target, int num_points,
                    const Context& context) {
    constexpr int num_halvings = 12;
    double low = 1e-3;
    double high = std::max({extent_of(source), extent_of(target), 2.0 * low});
    double voxel = low;
    for (int i = 0; i < num_halvings; ++i) {
        voxel = std::sqrt(low * high);
        std::size_t count = 0;
        for (const Scan* scan : {&source, &target})
            count +=
                downsample_voxel_grid(scan->cloud, {.voxel_size = voxel}, context).cloud.size();
        const double excess = 0.5 * static_cast<double>(count) / num_points;
        if (std::abs(excess - 1.0) < 0.02) break;
        (excess > 1.0 ? low : high) = voxel;
    }
    return voxel;
}

PaperScan thin_scan(const Scan& scan, double voxel, const Context& context) {
    std::vector<Eigen::Vector3f> positions =
        downsample_voxel_grid(scan.cloud, {.voxel_size = voxel}, context).cloud.positions;
    SearchTree tree(positions);
    PointNormals fit = estimate_normals(positions, tree, scan.sensor_position(), {}, context);
    return {std::move(positions), std::move(fit.normals), std::move(tree), {}};
}

}  // namespace

PaperPair make_paper_pair(const Scan& source, const Scan& target, const PaperPairSettings& settings,
                          const Context& context) {
    check_settings(settings);
    const double voxel = choose_voxel(source, target, settings.num_points, context);
    PaperPair pair{thin_scan(source, voxel, context), thin_scan(target, voxel, context), voxel};
    // Plain scenes have hardly a keypoint of PCL's least interest, 0.45.
    NarfKeypointSettings keypoints{.min_interest = 0.3, .max_keypoints = settings.num_keypoints};
    const auto fewest = [](const NarfView& a, const NarfView& b) {
        return std::min(a.keypoints.size(), b.keypoints.size());
    };
    for (const double support_size : {1.0, 0.7, 0.5, 0.35, 0.2}) {
        keypoints.support_size = support_size;
        NarfView source_view = find_narf_view(source, keypoints, context);
        NarfView target_view = find_narf_view(target, keypoints, context);
        const std::size_t num_found = fewest(source_view, target_view);
        const bool is_first = pair.support_size <= 0.0;
        if (!is_first && num_found <= fewest(pair.source.view, pair.target.view)) continue;
        pair.source.view = std::move(source_view);
        pair.target.view = std::move(target_view);
        pair.support_size = support_size;
        if (num_found >= static_cast<std::size_t>(settings.num_keypoints)) break;
    }
    return pair;
}

}  // namespace roomscribe
