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

struct MatchSettings {
    MatchMethod method = MatchMethod::back_and_forth;

    void visit(SettingVisitor& visitor) {
        visitor(method,
                {.name = "method", .unit = "", .doc = "Nearest in one direction, or in both."});
    }
};

/// Source and target are numbers of descriptors (columns).
struct Correspondence {
    std::uint32_t source = 0;
    std::uint32_t target = 0;
    float distance = 0.0F;  ///< between the descriptors, Euclidean
};

/// Matches descriptors, one per column, by Euclidean distance; sorted by source. Among equally near
/// ones the lower number wins. Empty if either side is.
/// Precondition: source.rows() == target.rows().
std::vector<Correspondence> match_descriptors(const Eigen::Ref<const Eigen::MatrixXf>& source,
                                              const Eigen::Ref<const Eigen::MatrixXf>& target,
                                              const MatchSettings& settings = {},
                                              const Context& context = {});

}  // namespace roomscribe
