// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string_view>

namespace roomscribe {

/// How many letters have to be put in, taken out or replaced to get from one word to the other
/// (Levenshtein 1966): which known name somebody may have meant.
std::size_t edit_distance(std::string_view a, std::string_view b);

}  // namespace roomscribe
