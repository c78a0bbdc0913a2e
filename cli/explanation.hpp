// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace roomscribe::cli {

/// What is told of one thing that a run found, in words and as data.
struct Explanation {
    std::string title;  ///< "door-2: door, 0.86 m wide, 2.03 m high"
    /// Topic and words: {"residual", "3.1 mm"}.
    std::vector<std::array<std::string, 2>> lines;
    nlohmann::ordered_json facts;
};

/// Titles, each with its lines indented below.
std::string explanations_to_text(std::span<const Explanation> explanations);

/// A list of the facts, one element a thing.
std::string explanations_to_json(std::span<const Explanation> explanations);

/// "0.86 m", and below 10 cm "35 mm" or "3.1 mm".
std::string length_text(double metres);

/// "84 %"
std::string share_text(double share);

/// "a", "a and b", "a, b and c"
std::string joined(std::span<const std::string> words);

}  // namespace roomscribe::cli
