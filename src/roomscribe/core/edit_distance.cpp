// SPDX-License-Identifier: MIT
#include "roomscribe/core/edit_distance.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace roomscribe {

std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (const char letter : a) {
        std::size_t diagonal = row[0]++;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t substitution = diagonal + (letter == b[j] ? 0U : 1U);
            diagonal = row[j + 1];
            row[j + 1] = std::min({row[j + 1] + 1, row[j] + 1, substitution});
        }
    }
    return row.back();
}

}  // namespace roomscribe
