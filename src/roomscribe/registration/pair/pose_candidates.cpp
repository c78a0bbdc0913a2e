// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/pose_candidates.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>

#include <Eigen/Geometry>

#include "roomscribe/core/parallel.hpp"

namespace roomscribe {
namespace {

/// Which matches could belong to one rigid motion, pair by pair: a symmetric matrix of bits.
class CompatibilityGraph {
  public:
    explicit CompatibilityGraph(std::size_t size)
        : words_per_row_((size + 63) / 64), bits_(size * words_per_row_, 0) {}

    void connect(std::size_t row, std::size_t column) {
        bits_[row * words_per_row_ + column / 64] |= std::uint64_t{1} << (column % 64);
    }
    bool connected(std::size_t row, std::size_t column) const {
        return (bits_[row * words_per_row_ + column / 64] >> (column % 64) & 1U) != 0;
    }
    std::uint32_t degree(std::size_t row) const { return common(row, row); }
    /// Matches compatible with both.
    std::uint32_t common(std::size_t a, std::size_t b) const {
        std::uint32_t count = 0;
        for (std::size_t word = 0; word < words_per_row_; ++word) {
            count += static_cast<std::uint32_t>(
                std::popcount(bits_[a * words_per_row_ + word] & bits_[b * words_per_row_ + word]));
        }
        return count;
    }

  private:
    std::size_t words_per_row_;
    std::vector<std::uint64_t> bits_;
};

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::acos(std::clamp(a.dot(b), -1.0, 1.0));
}

bool compatible(const PointMatch& a, const PointMatch& b, const CompatibilitySettings& settings) {
    const Eigen::Vector3d source_edge = b.source - a.source;
    const Eigen::Vector3d target_edge = b.target - a.target;
    const double source_length = source_edge.norm();
    const double target_length = target_edge.norm();
    if (std::abs(source_length - target_length) > settings.length_tolerance) return false;
    // So short an edge has no direction to speak of, and such a pair fixes no motion.
    if (std::min(source_length, target_length) < 2.0 * settings.length_tolerance) return false;
    const Eigen::Vector3d source_direction = source_edge / source_length;
    const Eigen::Vector3d target_direction = target_edge / target_length;
    const auto agree = [&settings](double source_angle, double target_angle) {
        return std::abs(source_angle - target_angle) <= settings.angle_tolerance;
    };
    return agree(angle_between(a.source_normal, b.source_normal),
                 angle_between(a.target_normal, b.target_normal)) &&
           agree(angle_between(a.source_normal, source_direction),
                 angle_between(a.target_normal, target_direction)) &&
           agree(angle_between(b.source_normal, source_direction),
                 angle_between(b.target_normal, target_direction));
}

CompatibilityGraph build_graph(std::span<const PointMatch> matches,
                               const CompatibilitySettings& settings, const Context& context) {
    CompatibilityGraph graph(matches.size());
    parallel_for(context, matches.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            for (std::size_t j = 0; j < matches.size(); ++j) {
                if (i != j && compatible(matches[i], matches[j], settings)) graph.connect(i, j);
            }
        }
    });
    return graph;
}

/// Matches to start from: most compatible partners first. A true pose has many matches, each of
/// which leads to it, so that some hundred starts miss none.
std::vector<std::uint32_t> choose_seeds(const CompatibilityGraph& graph, std::size_t num_matches) {
    constexpr std::size_t max_seeds = 400;
    std::vector<std::uint32_t> degrees(num_matches);
    for (std::size_t i = 0; i < num_matches; ++i)
        degrees[i] = graph.degree(i);
    std::vector<std::uint32_t> seeds(num_matches);
    std::iota(seeds.begin(), seeds.end(), 0U);
    std::stable_sort(seeds.begin(), seeds.end(), [&degrees](std::uint32_t a, std::uint32_t b) {
        return degrees[a] > degrees[b];
    });
    seeds.resize(std::min(seeds.size(), max_seeds));
    return seeds;
}

/// The seed's partners that share the most partners with it, and the seed.
std::vector<std::uint32_t> grow_set(const CompatibilityGraph& graph, std::uint32_t seed,
                                    std::size_t num_matches) {
    constexpr std::size_t set_size = 24;  // well above the 3 that fix a motion
    std::vector<std::pair<std::uint32_t, std::uint32_t>> partners;  // (common partners, match)
    for (std::uint32_t i = 0; i < num_matches; ++i) {
        if (graph.connected(seed, i)) partners.emplace_back(graph.common(seed, i), i);
    }
    std::stable_sort(partners.begin(), partners.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    partners.resize(std::min(partners.size(), set_size));
    std::vector<std::uint32_t> members{seed};
    for (const auto& [common, match] : partners)
        members.push_back(match);
    return members;
}

std::vector<PointMatch> pick(std::span<const PointMatch> matches,
                             const std::vector<std::uint32_t>& indices) {
    std::vector<PointMatch> picked;
    picked.reserve(indices.size());
    for (const std::uint32_t index : indices)
        picked.push_back(matches[index]);
    return picked;
}

std::vector<std::uint32_t> find_inliers(std::span<const PointMatch> matches,
                                        const Transform& target_from_source,
                                        const CompatibilitySettings& settings) {
    const double squared_limit = settings.length_tolerance * settings.length_tolerance;
    const double min_cosine = std::cos(std::min(settings.angle_tolerance, 3.1415));
    std::vector<std::uint32_t> inliers;
    for (std::uint32_t i = 0; i < matches.size(); ++i) {
        const PointMatch& match = matches[i];
        if ((target_from_source * match.source - match.target).squaredNorm() <= squared_limit &&
            (target_from_source.linear() * match.source_normal).dot(match.target_normal) >=
                min_cosine) {
            inliers.push_back(i);
        }
    }
    return inliers;
}

PoseCandidate grow_candidate(std::span<const PointMatch> matches, const CompatibilityGraph& graph,
                             std::uint32_t seed, const CompatibilitySettings& settings) {
    PoseCandidate best;
    std::vector<std::uint32_t> members = grow_set(graph, seed, matches.size());
    constexpr int max_refinements = 5;
    for (int i = 0; i < max_refinements; ++i) {
        const auto pose = fit_transform(pick(matches, members));
        if (!pose) break;
        members = find_inliers(matches, *pose, settings);
        if (members.size() <= best.num_inliers) break;
        best = {*pose, members.size()};
    }
    return best;
}

}  // namespace

std::vector<PoseCandidate> propose_poses(std::span<const PointMatch> matches,
                                         const CompatibilitySettings& settings,
                                         const Context& context) {
    check_settings(settings);
    const CompatibilityGraph graph = build_graph(matches, settings, context);
    const std::vector<std::uint32_t> seeds = choose_seeds(graph, matches.size());
    std::vector<PoseCandidate> grown(seeds.size());
    parallel_for(context, seeds.size(), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            grown[i] = grow_candidate(matches, graph, seeds[i], settings);
        }
    });
    std::stable_sort(grown.begin(), grown.end(),
                     [](const auto& a, const auto& b) { return a.num_inliers > b.num_inliers; });

    std::vector<Eigen::Vector3f> sources;
    for (const PointMatch& match : matches)
        sources.emplace_back(match.source.cast<float>());
    const PointSpread spread = measure_spread(sources);
    std::vector<PoseCandidate> candidates;
    for (const PoseCandidate& candidate : grown) {
        if (candidate.num_inliers < 3) break;
        const bool is_new =
            std::none_of(candidates.begin(), candidates.end(), [&](const PoseCandidate& other) {
                return rms_displacement(spread, candidate.target_from_source,
                                        other.target_from_source) < settings.min_difference;
            });
        if (is_new) candidates.push_back(candidate);
        if (static_cast<int>(candidates.size()) == settings.max_candidates) break;
    }
    return candidates;
}

}  // namespace roomscribe
