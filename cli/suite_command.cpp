// SPDX-License-Identifier: MIT
#include "cli/suite_command.hpp"

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/choice_option.hpp"
#include "cli/scorecard.hpp"
#include "cli/text_table.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/evaluation/results_table.hpp"
#include "roomscribe/pipeline/suite.hpp"

namespace roomscribe::cli {
namespace {

struct SuiteOptions {
    SuiteName suite = SuiteName::quick;
    std::uint64_t series = 0;
    std::string scorecard;
    bool as_json = false;
    bool as_csv = false;
    int num_threads = 0;
};

/// What there is to say of one scene in one line; the first row is the heading.
using Row = std::vector<std::string>;

std::string percent(const std::optional<double>& share) {
    return share ? fmt::format("{:.0f} %", 100.0 * *share) : "-";
}

std::string up_error(const Evaluation& evaluation) {
    return evaluation.axes ? fmt::format("{:.2f}", degrees(evaluation.axes->up)) : "-";
}

std::string mean_iou(const Evaluation& evaluation) {
    return percent(evaluation.points ? evaluation.points->mean_iou() : std::nullopt);
}

Row scene_heading() {
    return {"scene", "scans",   "M points",         "s",      "in place",
            "mIoU",  "up, deg", "mIoU, true poses", "up, deg"};
}

Row scene_row(const SuiteScene& scene, const SuiteSceneResult& result) {
    const Evaluation& run = result.from_scans;
    const std::optional<double> recall =
        run.registration ? registration_recall(run.registration->scans, protocol::strict_pose)
                         : std::nullopt;
    return {suite_scene_name(scene),
            fmt::format("{}", result.num_scans),
            fmt::format("{:.2f}", 1e-6 * static_cast<double>(result.num_points)),
            fmt::format("{:.1f}", result.run_seconds),
            percent(recall),
            mean_iou(run),
            up_error(run),
            result.from_true_poses ? mean_iou(*result.from_true_poses) : "-",
            result.from_true_poses ? up_error(*result.from_true_poses) : "-"};
}

struct SuiteResult {
    std::vector<Row> scenes{scene_heading()};
    std::vector<Evaluation> from_scans;
    std::vector<Evaluation> from_true_poses;
};

SuiteResult run_suite(const SuiteOptions& options, const Context& context) {
    const std::vector<SuiteScene> scenes = suite_scenes(options.suite, options.series);
    SuiteResult result;
    for (const SuiteScene& scene : scenes) {
        const bool registers_only = options.suite == SuiteName::registration;
        SuiteSceneResult one = run_suite_scene(scene, registers_only, {}, context);
        result.scenes.push_back(scene_row(scene, one));
        fmt::print(stderr, "{}/{}  {}\n", result.scenes.size() - 1, scenes.size(),
                   fmt::join(result.scenes.back(), "  "));
        result.from_scans.push_back(std::move(one.from_scans));
        if (one.from_true_poses) result.from_true_poses.push_back(std::move(*one.from_true_poses));
    }
    return result;
}

std::string markdown_row(const Row& row) {
    return fmt::format("| {} |\n", fmt::join(row, " | "));
}

std::string markdown_table(const std::vector<Row>& rows) {
    std::string text = markdown_row(rows.front());
    text += markdown_row(Row(rows.front().size(), "---"));
    for (std::size_t i = 1; i < rows.size(); ++i)
        text += markdown_row(rows[i]);
    return text + "\n";
}

std::string scorecard_part(const SuiteOptions& options, const SuiteResult& result) {
    std::string part = fmt::format("## {}\n\nVersion {}, {}.\n\n",
                                   suite_names[static_cast<std::size_t>(options.suite)],
                                   ROOMSCRIBE_VERSION, describe_machine());
    part += "From the scans alone, as `run` does it:\n\n";
    part += summary_to_markdown(summarize(result.from_scans)) + "\n";
    if (!result.from_true_poses.empty()) {
        part += "With true poses given, as `interpret --poses` does it:\n\n";
        part += summary_to_markdown(summarize(result.from_true_poses)) + "\n";
    }
    return part + "Scene by scene:\n\n" + markdown_table(result.scenes);
}

std::string suite_text(const SuiteResult& result) {
    TextTable table("lrrrrrrrr");
    for (const Row& row : result.scenes)
        table.add_row(row);
    std::string text = table.to_text() + "\nfrom the scans alone\n\n" +
                       summary_to_text(summarize(result.from_scans));
    if (!result.from_true_poses.empty()) {
        text += "\nwith true poses given\n\n" + summary_to_text(summarize(result.from_true_poses));
    }
    return text;
}

ExitCode suite(const SuiteOptions& options, const std::atomic<bool>& cancel) {
    Context context;
    context.num_threads = options.num_threads;
    context.cancel = &cancel;
    const SuiteResult result = run_suite(options, context);
    if (options.as_json) {
        fmt::print("{}", summary_to_json(summarize(result.from_scans)));
    } else if (options.as_csv) {
        fmt::print("{}", summary_to_csv(summarize(result.from_scans)));
    } else {
        fmt::print("{}", suite_text(result));
    }
    if (!options.scorecard.empty()) {
        update_scorecard(options.scorecard, scorecard_part(options, result));
    }
    return ExitCode::done;
}

}  // namespace

void add_suite_command(CLI::App& program, Action& action) {
    const auto options = std::make_shared<SuiteOptions>();
    CLI::App& verb = *program.add_subcommand(
        "suite", "Make, run and score the simulated scenes of a suite, without options");
    add_choice_option<SuiteName>(verb, "SUITE", options->suite, words_of<SuiteName>(suite_names),
                                 fmt::format("{}", fmt::join(suite_names, ", ")))
        ->type_name("")
        ->required();
    verb.add_option("--series", options->series, "Another series has buildings never seen before")
        ->type_name("N")
        ->capture_default_str();
    verb.add_option("--scorecard", options->scorecard,
                    "Markdown file whose part of this suite is replaced")
        ->type_name("FILE");
    CLI::Option* json = verb.add_flag("--json", options->as_json, "Print JSON");
    verb.add_flag("--csv", options->as_csv, "Print CSV, one line a value")->excludes(json);
    verb.add_option("--threads", options->num_threads, "0: all of the machine's")
        ->type_name("N")
        ->capture_default_str()
        ->check(CLI::Range(0, 1024));
    verb.callback([options, &action] {
        action = [options](const std::atomic<bool>& cancel) { return suite(*options, cancel); };
    });
}

}  // namespace roomscribe::cli
