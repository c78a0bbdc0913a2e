// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roomscribe/evaluation/evaluation_summary.hpp"

namespace roomscribe {

enum class ScoreUnit : std::uint8_t { count, share, metre, degree };

/// One number of a summary: row `item`, column `measure` of the table `group`. All ways to print a
/// summary print this list.
struct Score {
    std::string_view group;    ///< "detection"
    std::string item;          ///< "door_frame"
    std::string_view measure;  ///< "precision"
    ScoreUnit unit = ScoreUnit::count;
    std::optional<double> value;  ///< empty where it is not defined
};

/// In the order in which they are printed: detection, decoys, openings, rooms, room_sizes, points,
/// axes, registration, recall, links, confidence. A group about which the results said nothing is
/// left out.
std::vector<Score> list_scores(const EvaluationSummary& summary);

}  // namespace roomscribe
