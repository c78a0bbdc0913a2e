// SPDX-License-Identifier: MIT
#include "cli/man_command.hpp"

#include <string>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/command_tree.hpp"

namespace roomscribe::cli {
namespace {

/// Text that roff shows as it is: no request at the start of a line, no escape, true dashes.
std::string roff(std::string_view text) {
    std::string safe;
    bool at_start = true;
    for (const char c : text) {
        if (at_start && (c == '.' || c == '\'')) safe += "\\&";
        if (c == '\\') {
            safe += "\\e";
        } else if (c == '-') {
            safe += "\\-";
        } else {
            safe += c;
        }
        at_start = c == '\n';
    }
    return safe;
}

std::string option_page(const OptionFacts& option) {
    std::string head = roff(fmt::format("{}", fmt::join(option.names, ", ")));
    if (!option.is_positional && !option.type.empty())
        head += fmt::format("\\fR \\fI{}", roff(option.type));
    return fmt::format(".TP\n\\fB{}\\fR\n{}\n", head, roff(option.description));
}

std::string synopsis(const VerbFacts& verb) {
    std::string line = fmt::format("\\fBroomscribe {}\\fR [options]", roff(verb.name));
    for (const OptionFacts& option : verb.options)
        if (option.is_positional) line += fmt::format(" \\fI{}\\fR", roff(option.names.front()));
    return line;
}

std::string manual_page(const CLI::App& program) {
    const std::vector<VerbFacts> verbs = describe_verbs(program);
    std::string page = fmt::format(
        ".TH ROOMSCRIBE 1 \"\" \"roomscribe {}\" \"User Commands\"\n"
        ".SH NAME\nroomscribe \\- scans of an indoor place in, a described room out\n"
        ".SH SYNOPSIS\n",
        ROOMSCRIBE_VERSION);
    for (const VerbFacts& verb : verbs)
        page += synopsis(verb) + "\n.br\n";
    page += fmt::format(".SH DESCRIPTION\n{}\n.SH VERBS\n",
                        roff("Registers scans that come unlevelled and without poses, labels every "
                             "point and makes a model of rooms, walls, doors, windows, furniture "
                             "and handles. No option is needed: `roomscribe settings` lists all "
                             "settings, which --set and --config overrule."));
    for (const VerbFacts& verb : verbs) {
        page += fmt::format(".SS {}\n{}\n", roff(verb.name), roff(verb.description));
        for (const OptionFacts& option : verb.options)
            page += option_page(option);
    }
    return page + fmt::format(".SH EXIT STATUS\n{}\n", roff(program.get_footer()));
}

}  // namespace

void add_man_command(CLI::App& program, Action& action) {
    program.add_subcommand("man", "Print the manual page: roomscribe man | man -l -")
        ->callback([&program, &action] {
            action = [&program](const std::atomic<bool>&) {
                fmt::print("{}", manual_page(program));
                return ExitCode::done;
            };
        });
}

}  // namespace roomscribe::cli
