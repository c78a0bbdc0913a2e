// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/surface_directions.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace roomscribe {
namespace {

/// Normals of thinned points stray so far from their surface's, 25 degrees.
constexpr float shell_cosine = 0.906F;

/// Where many normals lie together: the normal among a thinned set with most others near it.
Eigen::Vector3f densest(std::span<const Eigen::Vector3f> normals, float min_cosine) {
    constexpr std::size_t num_seeds = 100;
    constexpr std::size_t num_voters = 1000;
    const std::size_t seed_stride = std::max<std::size_t>(1, normals.size() / num_seeds);
    const std::size_t voter_stride = std::max<std::size_t>(1, normals.size() / num_voters);
    Eigen::Vector3f best = normals.front();
    std::size_t most = 0;
    for (std::size_t i = 0; i < normals.size(); i += seed_stride) {
        std::size_t votes = 0;
        for (std::size_t j = 0; j < normals.size(); j += voter_stride)
            votes += normals[i].dot(normals[j]) >= min_cosine ? 1 : 0;
        if (votes <= most) continue;
        most = votes;
        best = normals[i];
    }
    return best;
}

}  // namespace

std::vector<SurfaceDirection> find_surface_directions(std::span<const Eigen::Vector3f> normals) {
    constexpr double min_share = 0.02;
    constexpr std::size_t max_directions = 12;
    constexpr int shifts = 5;
    const auto min_cosine = static_cast<float>(std::cos(same_direction_angle));
    std::vector<Eigen::Vector3f> free;
    free.reserve(normals.size());
    for (const Eigen::Vector3f& normal : normals) {
        if (normal.allFinite()) free.push_back(normal);
    }
    const auto total = static_cast<double>(free.size());
    std::vector<SurfaceDirection> directions;
    while (!free.empty() && directions.size() < max_directions) {
        Eigen::Vector3f mode = densest(free, min_cosine);
        for (int i = 0; i < shifts; ++i) {
            Eigen::Vector3d sum = Eigen::Vector3d::Zero();
            for (const Eigen::Vector3f& normal : free) {
                if (normal.dot(mode) >= min_cosine) sum += normal.cast<double>();
            }
            if (!(sum.norm() > 0.0)) break;
            mode = sum.normalized().cast<float>();
        }
        const std::size_t before = free.size();
        std::erase_if(
            free, [&](const Eigen::Vector3f& normal) { return normal.dot(mode) >= min_cosine; });
        const double share = static_cast<double>(before - free.size()) / total;
        if (share < min_share) break;
        directions.push_back({mode.cast<double>().normalized(), share});
    }
    std::stable_sort(directions.begin(), directions.end(),
                     [](const auto& a, const auto& b) { return a.share > b.share; });
    return directions;
}

std::vector<ShellPlane> find_shell(std::span<const Eigen::Vector3f> positions,
                                   std::span<const Eigen::Vector3f> normals,
                                   std::span<const SurfaceDirection> directions, double spacing,
                                   double min_area) {
    const auto bin = static_cast<float>(spacing / 2.0);
    const double min_count = min_area / (spacing * spacing);
    std::vector<ShellPlane> shell;
    for (const SurfaceDirection& direction : directions) {
        const Eigen::Vector3f along = direction.direction.cast<float>();
        std::vector<int> places;
        for (std::size_t i = 0; i < positions.size(); ++i) {
            if (normals[i].dot(along) >= shell_cosine)
                places.push_back(static_cast<int>(std::floor(positions[i].dot(along) / bin)));
        }
        if (places.empty()) continue;
        const auto [low, high] = std::minmax_element(places.begin(), places.end());
        std::vector<double> counts(static_cast<std::size_t>(*high - *low) + 3, 0.0);
        for (const int place : places)
            counts[static_cast<std::size_t>(place - *low) + 1] += 1.0;
        for (std::size_t i = 1; i + 1 < counts.size(); ++i) {
            const double held = counts[i - 1] + counts[i] + counts[i + 1];
            if (held < min_count || counts[i] < counts[i - 1] || counts[i] <= counts[i + 1])
                continue;
            const double middle = (counts[i + 1] - counts[i - 1]) / held;
            const double place = *low + static_cast<double>(i) - 0.5 + middle;
            shell.push_back({direction.direction, place * static_cast<double>(bin)});
        }
    }
    return shell;
}

bool is_on_shell(std::span<const ShellPlane> shell, const Eigen::Vector3f& position,
                 const Eigen::Vector3f& normal, double margin) {
    return std::any_of(shell.begin(), shell.end(), [&](const ShellPlane& plane) {
        const Eigen::Vector3f along = plane.direction.cast<float>();
        return normal.dot(along) >= shell_cosine &&
               std::abs(static_cast<double>(position.dot(along)) - plane.offset) <= margin;
    });
}

}  // namespace roomscribe
