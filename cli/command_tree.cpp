// SPDX-License-Identifier: MIT
#include "cli/command_tree.hpp"

#include <sstream>

namespace roomscribe::cli {
namespace {

/// "auto|none|json" names all words that are allowed.
std::vector<std::string> choices_of(const std::string& type) {
    std::vector<std::string> choices;
    if (type.find('|') == std::string::npos) return choices;
    std::istringstream words(type);
    for (std::string word; std::getline(words, word, '|');)
        choices.push_back(word);
    return choices;
}

}  // namespace

std::vector<OptionFacts> describe_options(const CLI::App& verb) {
    std::vector<OptionFacts> options;
    for (const CLI::Option* option : verb.get_options()) {
        OptionFacts facts;
        for (const std::string& name : option->get_lnames())
            facts.names.push_back("--" + name);
        for (const std::string& name : option->get_snames())
            facts.names.push_back("-" + name);
        if (facts.names.empty()) {
            facts.is_positional = true;
            facts.names.push_back(option->get_name());
        }
        facts.takes_value = option->get_items_expected_max() > 0;
        if (facts.takes_value) facts.type = option->get_type_name();
        facts.choices = choices_of(facts.type);
        facts.description = option->get_description();
        options.push_back(std::move(facts));
    }
    return options;
}

std::vector<VerbFacts> describe_verbs(const CLI::App& program) {
    std::vector<VerbFacts> verbs;
    for (const CLI::App* verb : program.get_subcommands({}))
        verbs.push_back({verb->get_name(), verb->get_description(), describe_options(*verb)});
    return verbs;
}

}  // namespace roomscribe::cli
