// SPDX-License-Identifier: MIT
#include "cli/reproduce_command.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/choice_option.hpp"
#include "cli/job.hpp"
#include "cli/reproduce_text.hpp"
#include "roomscribe/io/atomic_file.hpp"
#include "roomscribe/pipeline/suite.hpp"
#include "roomscribe/reproduction/correspondence_figure.hpp"

namespace roomscribe::cli {
namespace {

struct ReproduceOptions {
    std::array<std::vector<std::string>, 3> rows;  ///< two scans for each of table 1, or none
    JobOptions job;                                ///< scans, threads, JSON
    std::uint64_t seed = 1;
    std::size_t num_pairs = 12;
    std::size_t num_scenes = 13;
    std::uint64_t series = 0;
    PairFeatures features = PairFeatures::fpfh_at_narf;
    std::string output;
};

Context make_context(const ReproduceOptions& options, const std::atomic<bool>& cancel) {
    Context context;
    context.num_threads = options.job.num_threads;
    context.cancel = &cancel;
    return context;
}

ScanPair load_pair(const std::vector<std::string>& paths, const Context& context) {
    std::vector<Scan> scans = load_scans(paths, context).scans;
    if (scans.size() != 2) throw UsageError("a pair is two scans");
    return {std::move(scans[0]), std::move(scans[1]), {}};
}

std::string name_of(const std::vector<std::string>& paths) {
    return fmt::format("{}", fmt::join(paths, ", "));
}

ExitCode reproduce_table_1(const ReproduceOptions& options, const std::atomic<bool>& cancel) {
    const Context context = make_context(options, cancel);
    constexpr std::array simulate{simulate_cluttered_pair, simulate_plane_pair,
                                  simulate_outdoor_pair};
    RowSources sources{"simulated, a furnished office", "simulated, a corridor",
                       "simulated, a street of plain houses, bins and posts"};
    TableOne table;
    for (std::size_t i = 0; i < table.size(); ++i) {
        const std::vector<std::string>& paths = options.rows[i];
        const bool is_given = !paths.empty();
        if (is_given) sources[i] = name_of(paths);
        table[i] = compare_descriptors(
            is_given ? load_pair(paths, context) : simulate[i](options.seed, context), context);
    }
    fmt::print("{}",
               options.job.as_json ? table_1_json(table, sources) : table_1_text(table, sources));
    return ExitCode::done;
}

/// Each scan with the one before.
std::vector<ScanPair> load_pairs(const JobOptions& job, const Context& context) {
    JobInput input = load_scans(job.inputs, context);
    load_poses(input, job, context);
    const std::vector<Scan>& scans = input.scans;
    const auto& poses = input.given_poses;
    std::vector<ScanPair> pairs;
    for (std::size_t i = 1; i < scans.size(); ++i) {
        if (!poses[i - 1] || !poses[i]) continue;
        pairs.push_back({scans[i - 1], scans[i], poses[i - 1]->inverse() * *poses[i]});
    }
    return pairs;
}

ExitCode reproduce_table_2(const ReproduceOptions& options, const std::atomic<bool>& cancel) {
    const Context context = make_context(options, cancel);
    const bool is_given = !options.job.inputs.empty();
    if (is_given && options.job.pose_files.empty()) {
        throw UsageError("--scans needs --poses: the errors are held against them");
    }
    const std::vector<ScanPair> pairs =
        is_given ? load_pairs(options.job, context)
                 : simulate_pairs(options.num_pairs, options.seed, context);
    if (pairs.empty()) throw UsageError("--scans needs two scans in a row with known poses");
    const std::string source =
        is_given
            ? fmt::format("{} given scans, each with the one before", pairs.size() + 1)
            : fmt::format("{} simulated, of furnished offices, kitchens and rooms", pairs.size());
    const TableTwo table = compare_alignments(pairs, context);
    fmt::print("{}",
               options.job.as_json ? table_2_json(table, source) : table_2_text(table, source));
    return ExitCode::done;
}

ExitCode reproduce_table_4(const ReproduceOptions& options, const std::atomic<bool>& cancel) {
    const Context context = make_context(options, cancel);
    constexpr std::array methods{InterpretationMethod::paper, InterpretationMethod::standard};
    std::vector<SuiteScene> scenes = suite_scenes(SuiteName::paper, options.series);
    scenes.resize(std::min(scenes.size(), options.num_scenes));
    TableFour table;
    for (const SuiteScene& scene : scenes) {
        const std::vector<Evaluation> found = compare_interpretations(scene, methods, context);
        for (std::size_t label = 0; label < num_labels; ++label) {
            table.by_paper[label] += found[0].detections->per_label[label];
            table.by_default[label] += found[1].detections->per_label[label];
        }
        fmt::print(stderr, "{}/{}  {}\n", ++table.num_scenes, scenes.size(),
                   suite_scene_name(scene));
    }
    fmt::print("{}", options.job.as_json ? table_4_json(table) : table_4_text(table));
    return ExitCode::done;
}

ExitCode reproduce_figure_1(const ReproduceOptions& options, const std::atomic<bool>& cancel) {
    const Context context = make_context(options, cancel);
    const ScanPair scans = options.job.inputs.empty() ? simulate_turned_pair(options.seed, context)
                                                      : load_pair(options.job.inputs, context);
    const PaperPair pair = make_paper_pair(scans.source, scans.target, {}, context);
    const FilteredMatches matches = match_as_paper(pair, options.features, options.seed, context);
    write_file(options.output, "SVG",
               draw_correspondences(pair, matches, scans.target_from_source));
    fmt::print("{}: {} correspondences, {} after filtering\n", options.output,
               matches.matches.size(), matches.rejection.inliers.size());
    return ExitCode::done;
}

using Work = ExitCode (*)(const ReproduceOptions&, const std::atomic<bool>&);

CLI::App& add_target(CLI::App& verb, const char* name, const char* doc,
                     const std::shared_ptr<ReproduceOptions>& options, Action& action, Work work) {
    CLI::App& target = *verb.add_subcommand(name, doc);
    target.add_option("--seed", options->seed, "Of the made-up scans and of random draws")
        ->type_name("N")
        ->capture_default_str();
    target.add_option("--threads", options->job.num_threads, "0: all of the machine's")
        ->type_name("N")
        ->capture_default_str()
        ->check(CLI::Range(0, 1024));
    target.callback([options, &action, work] {
        action = [options, work](const std::atomic<bool>& cancel) {
            return work(*options, cancel);
        };
    });
    return target;
}

CLI::Option* add_pair(CLI::App& target, const char* name, std::vector<std::string>& paths,
                      const char* doc) {
    return target.add_option(name, paths, doc)->type_name("FILE")->expected(2);
}

}  // namespace

void add_reproduce_command(CLI::App& program, Action& action) {
    const auto options = std::make_shared<ReproduceOptions>();
    CLI::App& verb =
        *program.add_subcommand("reproduce", "Do the paper's experiments: its figures beside ours");
    verb.require_subcommand(1);

    CLI::App& table_1 = add_target(verb, "table1", "Table 1: time and fitness of NARF and FPFH",
                                   options, action, reproduce_table_1);
    add_pair(table_1, "--cluttered", options->rows[0], "Two scans of a cluttered room");
    add_pair(table_1, "--plane", options->rows[1], "Two scans of a place with little but planes");
    add_pair(table_1, "--outdoor", options->rows[2], "Two scans outdoors");
    table_1.add_flag("--json", options->job.as_json, "Print JSON");

    CLI::App& table_2 =
        add_target(verb, "table2", "Table 2: errors of ICP with NARF, FPFH and both", options,
                   action, reproduce_table_2);
    table_2.add_option("--scans", options->job.inputs, "Scans, each registered to the one before")
        ->type_name("FILE");
    add_poses(table_2, options->job);
    table_2.add_option("--pairs", options->num_pairs, "How many pairs of scans are made up")
        ->type_name("N")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000));
    table_2.add_flag("--json", options->job.as_json, "Print JSON");

    CLI::App& table_4 =
        add_target(verb, "table4", "Table 4: labels found, by the paper's rules and by default",
                   options, action, reproduce_table_4);
    table_4.add_option("--scenes", options->num_scenes, "Only the first of the 13 scenes")
        ->type_name("N")
        ->capture_default_str()
        ->check(CLI::Range(1, 13));
    table_4
        .add_option("--series", options->series, "Another series has buildings never seen before")
        ->type_name("N")
        ->capture_default_str();
    table_4.add_flag("--json", options->job.as_json, "Print JSON");

    CLI::App& figure_1 = add_target(verb, "figure1", "Fig. 1: correspondences before and after",
                                    options, action, reproduce_figure_1);
    add_pair(figure_1, "--scans", options->job.inputs, "Two scans of one place");
    std::map<std::string, PairFeatures> words;
    for (const std::string_view name : enumerator_names(PairFeatures()))
        words.emplace(name, static_cast<PairFeatures>(words.size()));
    add_choice_option<PairFeatures>(figure_1, "--features", options->features, words,
                                    "fpfh, fpfh_at_narf (default), narf or combined")
        ->type_name("NAME");
    figure_1.add_option("-o,--output", options->output, "Picture that is written")
        ->type_name("FILE.svg")
        ->required();
}

}  // namespace roomscribe::cli
