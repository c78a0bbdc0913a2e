// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/scan_origin.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <vector>

#include "roomscribe/geometry/search_tree.hpp"
#include "roomscribe/preprocessing/false_returns.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t min_points = 1000;
/// Points that directions are taken of, and of these the ones that are looked at.
constexpr std::size_t max_points = 400'000;
constexpr std::size_t max_looks = 10'000;
/// Of the distance. Neighbouring rays on a surface differ by less: at a degree between them and 20
/// degrees to the surface, by 5 %.
constexpr double min_jump = 0.05;
/// Most single scans have 0.3 to 6 % of jumps at the edges of things; scans that were moved by a
/// metre, and two in one cloud, 7 % and more; maps of several 14 % (an empty corridor) to 50 %.
/// Tilting scanners whose lines lie far apart may have as many as maps, to 28 %.
constexpr double max_share = 0.06;
/// Of the one scan of a run: rather no scanner than that of a map.
constexpr double max_lone_share = 0.125;
/// Of one of several, which are seldom maps: rather a map's scanner than none.
constexpr double max_share_of_several = 0.35;

OriginTest test_section(const ScanMap& map, const MapSection& section, const Context& context) {
    const Eigen::Vector3f sensor =
        section.sensor_position.value_or(Eigen::Vector3d::Zero()).cast<float>();
    Scan scan;
    const auto first = map.cloud.positions.begin() + section.first;
    std::transform(first, first + section.count, std::back_inserter(scan.cloud.positions),
                   [&](const Eigen::Vector3f& point) { return Eigen::Vector3f(point - sensor); });
    // Its ends of the range would be jumps everywhere.
    const std::optional<Scan> cleaned = without_false_returns(scan, context);
    return test_scan_origin(cleaned ? cleaned->cloud : scan.cloud);
}

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

std::vector<std::pair<std::size_t, OriginTest>> settle_assumed_scanners(ScanMap& map,
                                                                        const Context& context) {
    std::vector<std::pair<std::size_t, OriginTest>> tests;
    for (std::size_t i = 0; i < map.sections.size(); ++i) {
        MapSection& section = map.sections[i];
        const bool is_alone = map.sections.size() == 1;
        const bool is_silent =
            is_alone && !section.sensor_position && map.cloud.global_shift.isZero();
        if (!section.sensor_is_assumed && !is_silent) continue;
        OriginTest test = test_section(map, section, context);
        const bool tells_nothing = test.share_of_jumps == 1.0;
        if (section.sensor_is_assumed && tells_nothing) continue;
        test.is_scanner = test.share_of_jumps <= (is_silent  ? max_share
                                                  : is_alone ? max_lone_share
                                                             : max_share_of_several);
        tests.emplace_back(i, test);
        if (!test.is_scanner) {
            section.sensor_position.reset();
            section.sensor_axes.reset();
        } else if (is_silent) {
            section.sensor_position = Eigen::Vector3d::Zero();
            section.sensor_axes = Eigen::Matrix3d::Identity();
        }
    }
    return tests;
}

}  // namespace roomscribe
