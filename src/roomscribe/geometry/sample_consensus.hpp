// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "roomscribe/core/random.hpp"
#include "roomscribe/core/settings.hpp"

namespace roomscribe {

/// What sample_consensus needs of a problem: correspondences to a pose, points to a plane, a line,
/// a circle. `propose` draws a minimal sample and returns a model, or nothing if the sample is
/// degenerate; `score` is the (possibly soft) number of inliers.
template <typename Problem>
concept ConsensusProblem = requires(const Problem& problem, Random& random,
                                    const typename Problem::Model& model) {
    { problem.propose(random) } -> std::same_as<std::optional<typename Problem::Model>>;
    { problem.score(model) } -> std::convertible_to<double>;
    { problem.num_data() } -> std::convertible_to<std::size_t>;
    { problem.sample_size() } -> std::convertible_to<int>;
};

struct ConsensusSettings {
    int max_iterations = 1000;
    double confidence = 0.999;

    void visit(SettingVisitor& visitor) {
        visitor(max_iterations, {.name = "max_iterations",
                                 .unit = "",
                                 .min = 1,
                                 .max = 10'000'000,
                                 .doc = "Most samples that are drawn."});
        visitor(
            confidence,
            {.name = "confidence",
             .unit = "",
             .min = 0.0,
             .max = 1.0,
             .doc = "Probability of having drawn one sample of inliers alone before stopping."});
    }
};

enum class ConsensusStop : std::uint8_t {
    confident,       ///< iterations >= log(1 - confidence) / log(1 - inlier_ratio^sample_size)
    max_iterations,  ///< iterations = max_iterations
    no_model         ///< every sample was degenerate, or there is less data than one sample
};

template <typename Model>
struct ConsensusResult {
    std::optional<Model> model;
    double score = 0.0;
    int iterations = 0;
    ConsensusStop stop = ConsensusStop::no_model;
};

/// Iterations after which, at the given inlier ratio, a sample of inliers alone has been drawn with
/// the given confidence (Fischler and Bolles 1981). Infinite for a ratio of 0.
inline double consensus_iterations(double inlier_ratio, int sample_size, double confidence) {
    const double all_inliers = std::pow(inlier_ratio, sample_size);
    if (all_inliers >= 1.0) return 1.0;
    return std::log1p(-confidence) / std::log1p(-all_inliers);
}

/// RANSAC (Fischler and Bolles 1981), the one loop behind planes, lines, circles, axes and
/// correspondence rejection. Iteration i draws from stream i of the seed, so that the result
/// depends on seed and data alone. The earliest of equally good models is kept.
template <ConsensusProblem Problem>
ConsensusResult<typename Problem::Model> sample_consensus(const Problem& problem,
                                                          std::uint64_t seed,
                                                          const ConsensusSettings& settings = {}) {
    check_settings(settings);
    ConsensusResult<typename Problem::Model> result;
    const auto num_data = static_cast<double>(problem.num_data());
    if (num_data < problem.sample_size()) return result;

    double needed = settings.max_iterations;
    while (result.iterations < settings.max_iterations && result.iterations < needed) {
        Random random(seed, static_cast<std::uint64_t>(result.iterations++));
        const auto model = problem.propose(random);
        if (!model) continue;
        const double score = problem.score(*model);
        if (result.model && score <= result.score) continue;
        result.model = model;
        result.score = score;
        needed = consensus_iterations(score / num_data, problem.sample_size(), settings.confidence);
    }
    if (!result.model) return result;
    result.stop =
        result.iterations >= needed ? ConsensusStop::confident : ConsensusStop::max_iterations;
    return result;
}

}  // namespace roomscribe
