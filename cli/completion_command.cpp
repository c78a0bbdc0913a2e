// SPDX-License-Identifier: MIT
#include "cli/completion_command.hpp"

#include <algorithm>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/command_tree.hpp"

namespace roomscribe::cli {
namespace {

std::string bash_verb(const VerbFacts& verb) {
    std::vector<std::string> words;
    std::string choices;
    for (const OptionFacts& option : verb.options) {
        if (option.is_positional) continue;
        words.insert(words.end(), option.names.begin(), option.names.end());
        if (option.choices.empty()) continue;
        choices += fmt::format("                {}) words='{}' ;;\n",
                               fmt::join(option.names, " | "), fmt::join(option.choices, " "));
    }
    return fmt::format(
        "        {})\n            options='{}'\n            case $before in\n{}"
        "                *) ;;\n            esac\n            ;;\n",
        verb.name, fmt::join(words, " "), choices);
}

std::string bash_completion(const std::vector<VerbFacts>& verbs) {
    std::vector<std::string> names;
    std::string cases;
    for (const VerbFacts& verb : verbs) {
        names.push_back(verb.name);
        cases += bash_verb(verb);
    }
    return fmt::format(
        "# bash completion of roomscribe, made by `roomscribe completion bash`\n"
        "_roomscribe() {{\n"
        "    local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}}\n"
        "    local verb=${{COMP_WORDS[1]}} options='' words=''\n"
        "    COMPREPLY=()\n"
        "    if ((COMP_CWORD == 1)); then\n"
        "        mapfile -t COMPREPLY < <(compgen -W '{} --help --version' -- \"$word\")\n"
        "        return\n"
        "    fi\n"
        "    case $verb in\n{}        *) ;;\n    esac\n"
        "    if [[ -n $words ]]; then\n"
        "        mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n"
        "    elif [[ $word == -* ]]; then\n"
        "        mapfile -t COMPREPLY < <(compgen -W \"$options\" -- \"$word\")\n"
        "    else\n"
        "        mapfile -t COMPREPLY < <(compgen -f -- \"$word\")\n"
        "        compopt -o filenames 2>/dev/null\n"
        "    fi\n"
        "}}\n"
        "complete -F _roomscribe roomscribe\n",
        fmt::join(names, " "), cases);
}

/// Inside quotes and brackets of a zsh specification.
std::string zsh_text(const std::string& text) {
    std::string safe;
    for (const char c : text) {
        if (c == '\n') {
            safe += ' ';
        } else if (c == '\'') {
            safe += "'\\''";
        } else {
            if (c == '[' || c == ']' || c == ':' || c == '\\') safe += '\\';
            safe += c;
        }
    }
    return safe;
}

std::string zsh_value(const OptionFacts& option) {
    if (!option.takes_value) return {};
    const std::string what = option.type.empty() ? "value" : zsh_text(option.type);
    if (!option.choices.empty())
        return fmt::format(":{}:({})", what, fmt::join(option.choices, " "));
    return fmt::format(":{}:_files", what);
}

std::string zsh_verb(const VerbFacts& verb) {
    std::string lines;
    for (const OptionFacts& option : verb.options) {
        if (option.is_positional) continue;
        for (const std::string& name : option.names) {
            lines += fmt::format(" \\\n                '*{}[{}]{}'", name,
                                 zsh_text(option.description), zsh_value(option));
        }
    }
    return fmt::format(
        "        {})\n            _arguments{} \\\n                '*:file:_files'\n            "
        ";;\n",
        verb.name, lines);
}

std::string zsh_completion(const std::vector<VerbFacts>& verbs) {
    std::string names;
    std::string cases;
    for (const VerbFacts& verb : verbs) {
        names += fmt::format("        '{}:{}'\n", verb.name, zsh_text(verb.description));
        cases += zsh_verb(verb);
    }
    return fmt::format(
        "#compdef roomscribe\n"
        "# zsh completion of roomscribe, made by `roomscribe completion zsh`\n"
        "_roomscribe() {{\n"
        "    local -a verbs=(\n{}    )\n"
        "    if ((CURRENT == 2)); then\n"
        "        _describe verb verbs\n"
        "        return\n"
        "    fi\n"
        "    local verb=$words[2]\n"
        "    shift words\n"
        "    ((CURRENT--))\n"
        "    case $verb in\n{}    esac\n"
        "}}\n"
        "_roomscribe \"$@\"\n",
        names, cases);
}

}  // namespace

void add_completion_command(CLI::App& program, Action& action) {
    const auto shell = std::make_shared<std::string>();
    CLI::App& verb = *program.add_subcommand(
        "completion", "Print what completes roomscribe's command lines in a shell");
    verb.add_option("SHELL", *shell, "bash or zsh")
        ->type_name("")
        ->check(CLI::IsMember({"bash", "zsh"}).description(""))
        ->required();
    verb.footer(
        "For this shell: eval \"$(roomscribe completion bash)\"\n`cmake --install` puts both where "
        "shells look for them.\n");
    verb.callback([shell, &program, &action] {
        action = [shell, &program](const std::atomic<bool>&) {
            const std::vector<VerbFacts> verbs = describe_verbs(program);
            fmt::print("{}", *shell == "bash" ? bash_completion(verbs) : zsh_completion(verbs));
            return ExitCode::done;
        };
    });
}

}  // namespace roomscribe::cli
