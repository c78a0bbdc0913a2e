// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"

namespace roomscribe {

/// How descriptors are matched (paper, section 3.4).
enum class MatchMethod : std::uint8_t {
    one_to_one,      ///< every source descriptor to its nearest target descriptor
    back_and_forth,  ///< only matches that are nearest in both directions
};

inline std::span<const std::string_view> enumerator_names(MatchMethod) {
    static constexpr std::array<std::string_view, 2> names{"one_to_one", "back_and_forth"};
    return names;
}

/// How far apart two descriptors are.
enum class DescriptorMetric : std::uint8_t {
    euclidean,  ///< what FPFH is compared by
    manhattan,  ///< the sum of the differences: what NARF is compared by
};

inline std::span<const std::string_view> enumerator_names(DescriptorMetric) {
    static constexpr std::array<std::string_view, 2> names{"euclidean", "manhattan"};
    return names;
}

struct MatchSettings {
    MatchMethod method = MatchMethod::back_and_forth;
    DescriptorMetric metric = DescriptorMetric::euclidean;

    void visit(SettingVisitor& visitor) {
        visitor(method,
                {.name = "method", .unit = "", .doc = "Nearest in one direction, or in both."});
        visitor(metric, {.name = "metric",
                         .unit = "",
                         .doc = "Between descriptors: euclidean for FPFH, manhattan for NARF."});
    }
};

/// Source and target are numbers of descriptors (columns).
struct Correspondence {
    std::uint32_t source = 0;
    std::uint32_t target = 0;
    float distance = 0.0F;  ///< between the descriptors, by the metric
};

/// Matches descriptors, one per column, to the nearest by the metric; sorted by source. Among
/// equally near ones the lower number wins. Empty if either side is. Precondition: source.rows() ==
/// target.rows().
std::vector<Correspondence> match_descriptors(const Eigen::Ref<const Eigen::MatrixXf>& source,
                                              const Eigen::Ref<const Eigen::MatrixXf>& target,
                                              const MatchSettings& settings = {},
                                              const Context& context = {});

}  // namespace roomscribe
