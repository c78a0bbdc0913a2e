// SPDX-License-Identifier: MIT
#include "cli/explanation.hpp"

#include <cmath>

#include <fmt/format.h>

#include "cli/text_table.hpp"
#include "roomscribe/export/json.hpp"

namespace roomscribe::cli {

std::string explanations_to_text(std::span<const Explanation> explanations) {
    std::string text;
    for (const Explanation& explanation : explanations) {
        if (!text.empty()) text += "\n";
        text += explanation.title + "\n";
        TextTable table("ll");
        for (const auto& [topic, words] : explanation.lines)
            table.add_row({"  " + topic, words});
        text += table.to_text();
    }
    return text;
}

std::string explanations_to_json(std::span<const Explanation> explanations) {
    using Json = nlohmann::ordered_json;
    Json list = Json::array();
    for (const Explanation& explanation : explanations)
        list.push_back(explanation.facts);
    return lay_out_json(list.dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::string length_text(double metres) {
    const double size = std::abs(metres);
    if (size < 0.00995) return fmt::format("{:.1f} mm", 1000.0 * metres);
    if (size < 0.0995) return fmt::format("{:.0f} mm", 1000.0 * metres);
    return fmt::format("{:.2f} m", metres);
}

std::string share_text(double share) {
    return fmt::format("{:.0f} %", 100.0 * share);
}

std::string joined(std::span<const std::string> words) {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (i > 0) text += i + 1 == words.size() ? " and " : ", ";
        text += words[i];
    }
    return text;
}

}  // namespace roomscribe::cli
