// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/prepared_scan.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

#include "roomscribe/preprocessing/normal_estimation.hpp"
#include "roomscribe/preprocessing/outlier_removal.hpp"
#include "roomscribe/preprocessing/voxel_grid.hpp"

namespace roomscribe {
namespace {

SurfacePoints clean_surface(const PointCloud& thinned, const Eigen::Vector3d& sensor_position,
                            const Context& context) {
    const SearchTree all(thinned.positions);
    const std::vector<std::uint32_t> kept = remove_outliers(thinned.positions, all, {}, context);
    std::vector<Eigen::Vector3f> positions = select_points(thinned, kept).positions;
    SearchTree tree(positions);
    PointNormals fit = estimate_normals(positions, tree, sensor_position, {}, context);
    return {std::move(positions), std::move(fit.normals), std::move(fit.residuals),
            std::move(tree)};
}

void append_point(const SurfacePoints& points, std::size_t index, OrientedPoints& sample) {
    sample.positions.push_back(points.positions[index]);
    sample.normals.push_back(points.normals[index]);
    sample.deviations.push_back(points.deviations[index]);
}

/// Every n-th point with a normal, about so many.
OrientedPoints sample_surface(const SurfacePoints& points, std::size_t sample_size) {
    const std::size_t stride = std::max<std::size_t>(1, points.positions.size() / sample_size);
    OrientedPoints sample;
    for (std::size_t i = 0; i < points.positions.size(); i += stride) {
        if (points.normals[i].allFinite()) append_point(points, i, sample);
    }
    return sample;
}

void number_pieces(WitnessSet& witnesses, double piece_size) {
    std::map<std::array<int, 3>, std::uint32_t> numbers;
    for (const Eigen::Vector3f& position : witnesses.points.positions) {
        const Eigen::Vector3i cube =
            (position.cast<double>() / piece_size).array().floor().cast<int>();
        const auto next = static_cast<std::uint32_t>(numbers.size());
        const auto [number, is_new] = numbers.try_emplace({cube.x(), cube.y(), cube.z()}, next);
        if (is_new) witnesses.cubes.push_back(cube);
        witnesses.pieces.push_back(number->second);
    }
    witnesses.cube_size = piece_size;
}

Witnesses choose_witnesses(const SurfacePoints& fine, const SurfacePoints& coarse,
                           std::span<const SurfaceDirection> directions,
                           const RegistrationScale& scale) {
    // Shares of a sample of this size are good to one per cent.
    constexpr std::size_t num_witnesses = 4000;
    constexpr double min_shell_area = 1.5;  // m2, of a door leaf
    const std::vector<ShellPlane> shell = find_shell(coarse.positions, coarse.normals, directions,
                                                     scale.coarse_voxel, min_shell_area);
    const std::size_t stride = std::max<std::size_t>(1, fine.positions.size() / num_witnesses);
    Witnesses witnesses;
    for (std::size_t i = 0; i < fine.positions.size(); i += stride) {
        if (!fine.normals[i].allFinite()) continue;
        const bool is_shell =
            is_on_shell(shell, fine.positions[i], fine.normals[i], 0.75 * scale.coarse_voxel);
        append_point(fine, i, (is_shell ? witnesses.shell : witnesses.detail).points);
    }
    const double piece_size = std::max(0.3, 3.0 * scale.coarse_voxel);
    number_pieces(witnesses.shell, piece_size);
    number_pieces(witnesses.detail, piece_size);
    return witnesses;
}

/// Points whose histogram differs most from the scan's mean histogram: on bare walls and floors all
/// histograms are alike and say nothing (persistence analysis, Rusu et al. 2008).
std::vector<std::uint32_t> choose_distinctive(const Eigen::MatrixXf& descriptors) {
    // More matches cost more than they tell: pairs of matches are compared with each other.
    constexpr std::size_t max_keypoints = 2500;
    std::vector<std::uint32_t> order(static_cast<std::size_t>(descriptors.cols()));
    std::iota(order.begin(), order.end(), 0U);
    if (order.size() <= max_keypoints) return order;
    const Eigen::VectorXf mean = descriptors.rowwise().mean();
    const Eigen::VectorXf distances = (descriptors.colwise() - mean).colwise().squaredNorm();
    std::stable_sort(order.begin(), order.end(), [&distances](std::uint32_t a, std::uint32_t b) {
        return distances[a] > distances[b];
    });
    order.resize(max_keypoints);
    std::sort(order.begin(), order.end());
    return order;
}

DescribedPoints select_described(const DescribedPoints& all,
                                 std::span<const std::uint32_t> indices) {
    DescribedPoints selected;
    selected.descriptors.resize(all.descriptors.rows(), static_cast<Eigen::Index>(indices.size()));
    for (std::size_t i = 0; i < indices.size(); ++i) {
        selected.positions.push_back(all.positions[indices[i]]);
        selected.normals.push_back(all.normals[indices[i]]);
        selected.descriptors.col(static_cast<Eigen::Index>(i)) = all.descriptors.col(indices[i]);
    }
    return selected;
}

DescribedPoints describe_distinctive(const SurfaceView& surface, double radius,
                                     const Context& context) {
    std::vector<std::uint32_t> candidates(surface.positions.size());
    std::iota(candidates.begin(), candidates.end(), 0U);
    const DescribedPoints all = describe_by_fpfh(surface, candidates, radius, context);
    return select_described(all, choose_distinctive(all.descriptors));
}

struct ScanFeatures {
    DescribedPoints fpfh;
    DescribedPoints narf;
};

ScanFeatures describe_scan(const Scan& scan, const SurfaceView& surface,
                           const RegistrationScale& scale, PairFeatures features,
                           const Context& context) {
    NarfView view;
    if (uses_narf_keypoints(features))
        view = find_narf_view(scan, {.support_size = scale.narf_support}, context);
    ScanFeatures described;
    if (uses_narf(features)) {
        described.narf = describe_by_narf(view, surface, scale.narf_support, context);
    }
    described.fpfh = features == PairFeatures::fpfh_at_narf
                         ? describe_by_fpfh(surface, nearest_points(surface, view.keypoints),
                                            scale.fpfh_radius, context)
                         : describe_distinctive(surface, scale.fpfh_radius, context);
    return described;
}

}  // namespace

bool are_cameras(const PreparedScan& a, const PreparedScan& b) {
    return a.usual_up.is_camera && b.usual_up.is_camera;
}

RegistrationScale joint_scale(const PreparedScan& a, const PreparedScan& b) {
    RegistrationScale scale = a.scale;
    scale.fine_voxel = std::max(scale.fine_voxel, b.scale.fine_voxel);
    scale.noise = std::max(scale.noise, b.scale.noise);
    return scale;
}

PreparedScan prepare_scan(const Scan& scan, const RegistrationScale& scale, PairFeatures features,
                          const Context& context) {
    const Eigen::Vector3d sensor_position = scan.sensor_position();
    const PointCloud fine_points =
        downsample_voxel_grid(scan.cloud, {.voxel_size = scale.fine_voxel}, context).cloud;
    const PointCloud coarse_points =
        downsample_voxel_grid(fine_points, {.voxel_size = scale.coarse_voxel}, context).cloud;
    SurfacePoints fine = clean_surface(fine_points, sensor_position, context);
    SurfacePoints coarse = clean_surface(coarse_points, sensor_position, context);
    ScanFeatures described = describe_scan(scan, {coarse.positions, coarse.normals, coarse.tree},
                                           scale, features, context);

    // Rims contradict up to a fifth of an honest but thin scan, a merged cloud a third of itself.
    constexpr double max_self_contradiction = 0.2;
    const bool free_space_is_valid =
        self_contradiction(scan.cloud.positions, sensor_position, 0.5 * scale.coarse_voxel) <
        max_self_contradiction;
    // Shares of a sample of this size are good to two per cent, and a pose from so many pairs to
    // less than a hundredth of the noise: more points cost time alone.
    constexpr std::size_t coarse_sample_size = 1500;
    constexpr std::size_t fine_sample_size = 15'000;
    const PointSpread spread = measure_spread(coarse.positions);
    OrientedPoints coarse_sample = sample_surface(coarse, coarse_sample_size);
    OrientedPoints fine_sample = sample_surface(fine, fine_sample_size);
    SurfaceGrid coarse_grid(coarse.positions, scale.coarse_voxel);
    std::vector<SurfaceDirection> directions = find_surface_directions(coarse.normals);
    Witnesses witnesses = choose_witnesses(fine, coarse, directions, scale);
    return {scale,
            std::move(coarse),
            std::move(fine),
            std::move(coarse_sample),
            std::move(fine_sample),
            std::move(witnesses),
            std::move(described.fpfh),
            std::move(described.narf),
            spread,
            FreeSpace(scan.cloud.positions, sensor_position, 2.5),
            free_space_is_valid,
            std::move(coarse_grid),
            std::move(directions),
            usual_up(scan.cloud.positions, sensor_position, scan.sensor_axes())};
}

}  // namespace roomscribe
