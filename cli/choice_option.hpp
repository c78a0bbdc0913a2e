// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

#include <CLI/App.hpp>

namespace roomscribe::cli {

/// Declares an option whose value is one of the words; another word is refused with the list.
template <typename Enum>
CLI::Option* add_choice_option(CLI::App& verb, const std::string& name, Enum& value,
                               const std::map<std::string, Enum>& words, const std::string& doc) {
    const auto assign = [&value, words](const std::string& word) { value = words.at(word); };
    return verb.add_option_function<std::string>(name, assign, doc)
        ->check(CLI::IsMember(words).description(""));
}

}  // namespace roomscribe::cli
