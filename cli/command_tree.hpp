// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace roomscribe::cli {

/// What a verb, or the program itself, understands: read from what is declared for the command
/// line, so that manual and completion cannot lag behind.
struct OptionFacts {
    std::vector<std::string> names;  ///< "--output", "-o"; one word without dashes of a positional
    bool is_positional = false;
    bool takes_value = false;
    std::string type;                  ///< "FOLDER", or empty
    std::vector<std::string> choices;  ///< where only these words are allowed
    std::string description;
};

struct VerbFacts {
    std::string name;
    std::string description;
    std::vector<OptionFacts> options;
};

/// The verbs in the order of their declaration.
std::vector<VerbFacts> describe_verbs(const CLI::App& program);

std::vector<OptionFacts> describe_options(const CLI::App& verb);

}  // namespace roomscribe::cli
