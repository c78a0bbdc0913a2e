// SPDX-License-Identifier: MIT
#include "roomscribe/registration/features/narf_descriptor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/registration/features/narf_patch.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t num_beams = narf_size;
constexpr std::size_t num_steps = narf_patch_side / 2;
constexpr float beam_angle = 2.0F * std::numbers::pi_v<float> / narf_size;

using Narf = std::array<float, num_beams>;

/// The cells of a patch along each beam, from its middle to its edge.
class Star {
  public:
    explicit Star(float support_size) {
        const float cell_size = support_size / static_cast<float>(narf_patch_side);
        const float middle = 0.5F * (support_size - cell_size);
        const float step = middle / static_cast<float>(num_steps);
        for (std::size_t beam = 0; beam < num_beams; ++beam) {
            const float angle = static_cast<float>(beam) * beam_angle;
            const float step_x = std::sin(angle) * step;
            const float step_y = -std::cos(angle) * step;
            for (std::size_t i = 0; i <= num_steps; ++i) {
                cells_[beam][i] =
                    cell(step_y * static_cast<float>(i), cell_size, middle) * narf_patch_side +
                    cell(step_x * static_cast<float>(i), cell_size, middle);
            }
        }
    }

    /// Along each beam the change of depth, twice as much of it in the middle as at the edge.
    Narf describe(const NarfPatch& patch, float support_size) const {
        Narf values;
        for (std::size_t beam = 0; beam < num_beams; ++beam) {
            float change = 0.0F;
            for (std::size_t i = 0; i < num_steps; ++i) {
                const float weight = 4.0F / 3.0F - 2.0F / 3.0F * static_cast<float>(i) /
                                                       static_cast<float>(num_steps - 1);
                change += weight * (patch[cells_[beam][i + 1]] - patch[cells_[beam][i]]);
            }
            values[beam] = std::atan2(change, 0.5F * support_size) / std::numbers::pi_v<float>;
        }
        return values;
    }

  private:
    static std::size_t cell(float offset, float cell_size, float middle) {
        return static_cast<std::size_t>(std::lrint(1.0F / cell_size * (offset + middle)));
    }

    std::array<std::array<std::size_t, num_steps + 1>, num_beams> cells_{};
};

std::size_t beams_between(std::size_t a, std::size_t b) {
    const std::size_t difference = a > b ? a - b : b - a;
    return std::min(difference, num_beams - difference);
}

/// The beams around which the surface falls off most, the most first.
std::vector<std::size_t> dominant_beams(const Narf& values) {
    std::array<float, num_beams> scores{};
    for (std::size_t beam = 0; beam < num_beams; ++beam) {
        for (std::size_t other = 0; other < num_beams; ++other) {
            const float nearness = 1.0F - static_cast<float>(beams_between(beam, other)) /
                                              (0.5F * static_cast<float>(num_beams));
            scores[beam] += values[other] * nearness * nearness;
        }
    }
    const auto [least, most] = std::minmax_element(scores.begin(), scores.end());
    const float enough = *most - 0.2F * (*most - *least);
    std::vector<std::size_t> candidates;
    for (std::size_t beam = 0; beam < num_beams; ++beam) {
        if (scores[beam] > enough) candidates.push_back(beam);
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [&](std::size_t a, std::size_t b) { return scores[a] > scores[b]; });
    constexpr std::size_t min_distance = 7;  // beams, 70 degrees
    std::vector<std::size_t> dominant;
    for (const std::size_t beam : candidates) {
        if (std::all_of(dominant.begin(), dominant.end(), [&](std::size_t better) {
                return beams_between(beam, better) >= min_distance;
            })) {
            dominant.push_back(beam);
        }
    }
    return dominant;
}

/// A keypoint's values with what beams its columns begin.
struct Description {
    Narf values{};
    std::vector<std::size_t> first_beams;
};

Description describe(const RangeImage& image, std::size_t pixel, const Star& star,
                     const NarfSettings& settings) {
    Description description;
    const auto support_size = static_cast<float>(settings.support_size);
    const auto frame = narf_frame(image, pixel, support_size);
    if (!frame) return description;
    description.values =
        star.describe(narf_patch(image, pixel, *frame, support_size), support_size);
    if (settings.rotation_invariant) {
        description.first_beams = dominant_beams(description.values);
    } else {
        description.first_beams.push_back(0);
    }
    return description;
}

}  // namespace

NarfDescriptors compute_narf(const RangeImage& image, std::span<const std::uint32_t> pixels,
                             const NarfSettings& settings, const Context& context) {
    check_settings(settings);
    const Star star(static_cast<float>(settings.support_size));
    std::vector<Description> descriptions(pixels.size());
    parallel_for(context, pixels.size(), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            descriptions[i] = describe(image, pixels[i], star, settings);
    });

    NarfDescriptors result;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        for (const std::size_t beam : descriptions[i].first_beams) {
            result.keypoints.push_back(static_cast<std::uint32_t>(i));
            result.orientations.push_back(static_cast<float>(beam) * beam_angle);
        }
    }
    result.values.resize(narf_size, static_cast<Eigen::Index>(result.keypoints.size()));
    Eigen::Index column = 0;
    for (const Description& description : descriptions) {
        for (const std::size_t first : description.first_beams) {
            // Turning the star by whole beams only renumbers them.
            for (std::size_t beam = 0; beam < num_beams; ++beam) {
                result.values(static_cast<Eigen::Index>(beam), column) =
                    description.values[(first + beam) % num_beams];
            }
            ++column;
        }
    }
    return result;
}

}  // namespace roomscribe
