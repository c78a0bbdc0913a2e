// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roomscribe/evaluation/prediction.hpp"

namespace roomscribe {

/// What looks like a window, or like a door, and is none.
enum class DecoyKind : std::uint8_t { picture, board, mirror, screen, niche };
inline constexpr std::array<std::string_view, 5> decoy_kind_names{"picture", "board", "mirror",
                                                                  "screen", "niche"};

/// By Component::kind of what has no label: "whiteboard" is a board.
std::optional<DecoyKind> decoy_kind_from(std::string_view component_kind);

struct DecoyCounts {
    std::uint64_t there = 0;  ///< of which enough was seen
    std::uint64_t taken = 0;  ///< of those, taken for a door or window

    std::optional<double> share() const;  ///< taken / there
    DecoyCounts& operator+=(const DecoyCounts& other);
};

/// What a detected door or window really lies on.
enum class OpeningGround : std::uint8_t {
    opening,      ///< a true door, window, or passage
    decoy,        ///< a picture, board, mirror, screen or niche
    hidden_wall,  ///< wall that no scanner saw there
    seen_wall,    ///< wall that a scanner saw there
    elsewhere     ///< no wall: furniture, a curtain, nothing
};
inline constexpr std::array<std::string_view, 5> opening_ground_names{
    "opening", "decoy", "hidden_wall", "seen_wall", "elsewhere"};
/// How many detections lie on which ground.
using OpeningGrounds = std::array<std::uint64_t, opening_ground_names.size()>;

/// A detected door or window.
struct DetectedOpening {
    std::string predicted_id;
    OpeningGround ground = OpeningGround::elsewhere;
    std::string true_id;  ///< of what it lies on, empty elsewhere
};

struct DecoyError {
    std::array<DecoyCounts, decoy_kind_names.size()> per_kind{};
    std::vector<DetectedOpening> openings;  ///< in the order of the result
};

/// Asks of every detected door and window what it lies on (docs/evaluation.md): that which covers
/// at least half of its rectangle, planes compared as for rectangles; the first that fits of: a
/// true door, window, frame or passage; a decoy, or one half of which it covers; a wall. There it
/// lies on hidden wall if points on the wall fill less than half of its cells. A decoy without
/// polygon is the broad side of its box.
///
/// Precondition: the prediction has a scene.
DecoyError evaluate_decoys(const GroundTruth& truth, const Prediction& prediction);

}  // namespace roomscribe
