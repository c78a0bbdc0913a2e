// SPDX-License-Identifier: MIT
#include "roomscribe/registration/features/fpfh_descriptor.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "roomscribe/core/parallel.hpp"

namespace roomscribe {
namespace {

using Histogram = Eigen::Matrix<float, fpfh_size, 1>;

/// The three angles between two oriented points in the Darboux frame of the one whose normal is
/// closer to their connection; the same whichever of the two comes first.
struct PairAngles {
    float phi;    ///< atan2, in [-pi, pi]
    float alpha;  ///< cosine, in [-1, 1]
    float theta;  ///< cosine, in [-1, 1]
};

std::optional<PairAngles> pair_angles(const Eigen::Vector3f& point_a, Eigen::Vector3f normal_a,
                                      const Eigen::Vector3f& point_b, Eigen::Vector3f normal_b) {
    Eigen::Vector3f connection = point_b - point_a;
    const float distance = connection.norm();
    if (distance == 0.0F) return std::nullopt;
    const float cosine_a = normal_a.dot(connection) / distance;
    const float cosine_b = normal_b.dot(connection) / distance;
    float theta = cosine_a;
    if (std::abs(cosine_a) < std::abs(cosine_b)) {
        std::swap(normal_a, normal_b);
        connection = -connection;
        theta = -cosine_b;
    }
    Eigen::Vector3f v = connection.cross(normal_a);
    const float v_norm = v.norm();
    if (!(v_norm > 0.0F)) return std::nullopt;
    v /= v_norm;
    const Eigen::Vector3f w = normal_a.cross(v);
    return PairAngles{std::atan2(w.dot(normal_b), normal_a.dot(normal_b)), v.dot(normal_b), theta};
}

int bin_of(float share) {
    return std::clamp(static_cast<int>(std::floor(share * fpfh_bins_per_angle)), 0,
                      fpfh_bins_per_angle - 1);
}

void add_to(Histogram& histogram, const PairAngles& angles) {
    constexpr float pi = std::numbers::pi_v<float>;
    histogram[bin_of((angles.phi + pi) / (2.0F * pi))] += 1.0F;
    histogram[fpfh_bins_per_angle + bin_of((angles.alpha + 1.0F) * 0.5F)] += 1.0F;
    histogram[2 * fpfh_bins_per_angle + bin_of((angles.theta + 1.0F) * 0.5F)] += 1.0F;
}

using Neighborhoods = std::vector<std::vector<Neighbor>>;

void find_neighborhoods(std::span<const Eigen::Vector3f> positions, const SearchTree& tree,
                        std::span<const std::uint32_t> points, double radius,
                        const Context& context, Neighborhoods& neighborhoods) {
    parallel_for(context, points.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            tree.within_radius(positions[points[i]], radius, neighborhoods[points[i]]);
        }
    });
}

/// The neighbours of the keypoints that are no keypoints themselves. (A point that was searched
/// around has at least itself as a neighbour.)
std::vector<std::uint32_t> points_around(std::span<const std::uint32_t> keypoints,
                                         const Neighborhoods& neighborhoods) {
    std::vector<bool> needed(neighborhoods.size(), false);
    for (const std::uint32_t keypoint : keypoints) {
        for (const Neighbor& neighbor : neighborhoods[keypoint])
            needed[neighbor.index] = true;
    }
    std::vector<std::uint32_t> points;
    for (std::uint32_t i = 0; i < neighborhoods.size(); ++i) {
        if (needed[i] && neighborhoods[i].empty()) points.push_back(i);
    }
    return points;
}

Histogram simplified_histogram(std::span<const Eigen::Vector3f> positions,
                               std::span<const Eigen::Vector3f> normals, std::uint32_t point,
                               const std::vector<Neighbor>& neighborhood) {
    Histogram histogram = Histogram::Zero();
    if (neighborhood.size() < 2 || !normals[point].allFinite()) return histogram;
    std::size_t num_partners = 0;
    for (const Neighbor& neighbor : neighborhood) {
        if (neighbor.index == point || !normals[neighbor.index].allFinite()) continue;
        ++num_partners;
        const auto angles = pair_angles(positions[point], normals[point], positions[neighbor.index],
                                        normals[neighbor.index]);
        if (angles) add_to(histogram, *angles);
    }
    if (num_partners > 0) histogram *= 100.0F / static_cast<float>(num_partners);
    return histogram;
}

/// The neighbours' histograms, nearer ones weighing more; each of the three angles sums to 100.
Histogram weighted_histogram(const std::vector<Neighbor>& neighborhood,
                             std::span<const Histogram> histograms) {
    Histogram sum = Histogram::Zero();
    for (const Neighbor& neighbor : neighborhood) {
        if (neighbor.squared_distance == 0.0F) continue;
        sum += histograms[neighbor.index] / neighbor.squared_distance;
    }
    for (int angle = 0; angle < 3; ++angle) {
        auto part = sum.segment<fpfh_bins_per_angle>(angle * fpfh_bins_per_angle);
        const float total = part.sum();
        if (total > 0.0F) part *= 100.0F / total;
    }
    return sum;
}

}  // namespace

FpfhDescriptors compute_fpfh(std::span<const Eigen::Vector3f> positions,
                             std::span<const Eigen::Vector3f> normals, const SearchTree& tree,
                             std::span<const std::uint32_t> keypoints, const FpfhSettings& settings,
                             const Context& context) {
    check_settings(settings);
    Neighborhoods neighborhoods(positions.size());
    find_neighborhoods(positions, tree, keypoints, settings.radius, context, neighborhoods);
    find_neighborhoods(positions, tree, points_around(keypoints, neighborhoods), settings.radius,
                       context, neighborhoods);

    std::vector<Histogram> histograms(positions.size());
    parallel_for(context, positions.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            histograms[i] = simplified_histogram(positions, normals, static_cast<std::uint32_t>(i),
                                                 neighborhoods[i]);
        }
    });

    FpfhDescriptors descriptors(fpfh_size, static_cast<Eigen::Index>(keypoints.size()));
    parallel_for(context, keypoints.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            descriptors.col(static_cast<Eigen::Index>(i)) =
                weighted_histogram(neighborhoods[keypoints[i]], histograms);
        }
    });
    return descriptors;
}

}  // namespace roomscribe
