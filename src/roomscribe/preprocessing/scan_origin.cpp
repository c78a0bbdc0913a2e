// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/scan_origin.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "roomscribe/geometry/search_tree.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t min_points = 1000;
/// Points that directions are taken of, and of these the ones that are looked at.
constexpr std::size_t max_points = 400'000;
constexpr std::size_t max_looks = 10'000;
/// Of the distance. Neighbouring rays on a surface differ by less: at a degree between them and 20
/// degrees to the surface, by 5 %.
constexpr double min_jump = 0.05;
/// Most single scans have 0.3 to 8 % of jumps at the edges of things, maps of several 10 % (an
/// empty corridor) to 50 %; tilting scanners whose lines lie far apart have as many as maps. Rather
/// no scanner than a wrong one.
constexpr double max_share = 0.06;

}  // namespace

OriginTest test_scan_origin(const PointCloud& cloud) {
    std::vector<Eigen::Vector3f> directions;
    std::vector<float> ranges;
    const std::size_t stride = cloud.size() / max_points + 1;
    for (std::size_t i = 0; i < cloud.size(); i += stride) {
        const Eigen::Vector3f& point = cloud.positions[i];
        const float range = point.norm();
        if (!std::isfinite(range) || range <= 0.0F) continue;
        directions.emplace_back(point / range);
        ranges.push_back(range);
    }
    OriginTest test;
    if (directions.size() < min_points) return test;
    const SearchTree tree(directions);
    std::vector<Neighbor> neighbors;
    std::size_t looks = 0;
    std::size_t jumps = 0;
    const std::size_t step = directions.size() / max_looks + 1;
    for (std::size_t i = 0; i < directions.size(); i += step) {
        tree.nearest(directions[i], 2, neighbors);
        const std::size_t other = neighbors[0].index == i ? neighbors[1].index : neighbors[0].index;
        const auto range = static_cast<double>(std::max(ranges[i], ranges[other]));
        ++looks;
        jumps +=
            static_cast<double>(std::abs(ranges[i] - ranges[other])) > min_jump * range ? 1 : 0;
    }
    test.share_of_jumps = static_cast<double>(jumps) / static_cast<double>(looks);
    test.is_scanner = test.share_of_jumps <= max_share;
    return test;
}

}  // namespace roomscribe
