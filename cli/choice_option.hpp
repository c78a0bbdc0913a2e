// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>

#include <CLI/App.hpp>

namespace roomscribe::cli {

/// Words for the enumerators from value 0 on.
template <typename Enum, std::size_t Size>
std::map<std::string, Enum> words_of(const std::array<std::string_view, Size>& names) {
    std::map<std::string, Enum> words;
    for (std::size_t i = 0; i < Size; ++i)
        words.emplace(names[i], static_cast<Enum>(i));
    return words;
}

/// Declares an option whose value is one of the words; another word is refused with the list.
template <typename Enum>
CLI::Option* add_choice_option(CLI::App& verb, const std::string& name, Enum& value,
                               const std::map<std::string, Enum>& words, const std::string& doc) {
    const auto assign = [&value, words](const std::string& word) { value = words.at(word); };
    return verb.add_option_function<std::string>(name, assign, doc)
        ->check(CLI::IsMember(words).description(""));
}

}  // namespace roomscribe::cli
