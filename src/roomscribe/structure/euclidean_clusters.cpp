// SPDX-License-Identifier: MIT
#include "roomscribe/structure/euclidean_clusters.hpp"

#include <algorithm>

#include "roomscribe/geometry/search_tree.hpp"

namespace roomscribe {

std::vector<std::vector<std::uint32_t>> euclidean_clusters(
    std::span<const Eigen::Vector3f> positions, std::span<const std::uint32_t> points,
    double tolerance) {
    std::vector<Eigen::Vector3f> places;
    places.reserve(points.size());
    for (const std::uint32_t point : points)
        places.push_back(positions[point]);
    const SearchTree tree(places);
    std::vector<bool> is_reached(places.size(), false);
    std::vector<std::vector<std::uint32_t>> clusters;
    std::vector<std::uint32_t> stack;
    std::vector<Neighbor> neighbors;
    for (std::uint32_t seed = 0; seed < places.size(); ++seed) {
        if (is_reached[seed]) continue;
        std::vector<std::uint32_t>& cluster = clusters.emplace_back();
        is_reached[seed] = true;
        stack.push_back(seed);
        while (!stack.empty()) {
            const std::uint32_t at = stack.back();
            stack.pop_back();
            cluster.push_back(points[at]);
            tree.within_radius(places[at], tolerance, neighbors);
            for (const Neighbor& neighbor : neighbors) {
                if (is_reached[neighbor.index]) continue;
                is_reached[neighbor.index] = true;
                stack.push_back(neighbor.index);
            }
        }
        std::sort(cluster.begin(), cluster.end());
    }
    return clusters;
}

}  // namespace roomscribe
