// SPDX-License-Identifier: MIT
#include "cli/evaluate_command.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "roomscribe/core/context.hpp"
#include "roomscribe/evaluation/evaluate.hpp"
#include "roomscribe/evaluation/label_conventions.hpp"
#include "roomscribe/evaluation/results_table.hpp"
#include "roomscribe/pipeline/result_folder.hpp"
#include "roomscribe/pipeline/truth_folder.hpp"

namespace roomscribe::cli {
namespace {

struct EvaluateOptions {
    std::string truth;
    std::string result;
    std::string convention;
    bool as_json = false;
    bool as_csv = false;
};

Evaluation evaluate(const EvaluateOptions& options, const Context& context) {
    const auto compare = [&](const GroundTruth& truth, LabelSet labels) {
        const Prediction prediction = read_result_folder(options.result, truth, context);
        return evaluate_result(truth, prediction, labels, context);
    };
    if (options.convention.empty()) {
        return compare(read_truth_folder(options.truth, context), protocol::every_label);
    }
    const std::optional<LabelConvention> convention = find_label_convention(options.convention);
    if (!convention)
        throw UsageError("--convention must be s3dis or nyu40, not " + options.convention);
    const GroundTruth truth = read_labelled_cloud(options.truth, *convention, context);
    const bool has_instances = std::any_of(truth.instances.begin(), truth.instances.end(),
                                           [](std::int32_t instance) { return instance >= 0; });
    return compare(truth, has_instances ? convention->detected_labels : LabelSet{0});
}

ExitCode print_evaluation(const EvaluateOptions& options, const std::atomic<bool>& cancel) {
    if (options.convention.empty() && std::filesystem::is_regular_file(options.truth)) {
        throw UsageError(options.truth +
                         " is a file: give a truth folder, or say with --convention what the "
                         "labels of the cloud mean");
    }
    Context context;
    context.cancel = &cancel;
    const Evaluation evaluation = evaluate(options, context);
    if (options.as_json) {
        fmt::print("{}", evaluation_to_json(evaluation));
        return ExitCode::done;
    }
    const EvaluationSummary summary = summarize({&evaluation, 1});
    fmt::print("{}", options.as_csv ? summary_to_csv(summary) : summary_to_text(summary));
    return ExitCode::done;
}

}  // namespace

void add_evaluate_command(CLI::App& program, Action& action) {
    const auto options = std::make_shared<EvaluateOptions>();
    CLI::App& verb = *program.add_subcommand("evaluate", "Score a result against known truth");
    verb.add_option("TRUTH", options->truth,
                    "A truth folder, or with --convention a cloud that was labelled by hand")
        ->type_name("")
        ->required();
    verb.add_option("RESULT", options->result, "The output folder of run, register or interpret")
        ->type_name("")
        ->required();
    verb.add_option("--convention", options->convention,
                    "What the labels of the cloud mean: s3dis or nyu40")
        ->type_name("NAME");
    CLI::Option* json = verb.add_flag("--json", options->as_json,
                                      "Print JSON, with every component, scan and link");
    verb.add_flag("--csv", options->as_csv, "Print CSV, one line a value")->excludes(json);
    verb.callback([options, &action] {
        action = [options](const std::atomic<bool>& cancel) {
            return print_evaluation(*options, cancel);
        };
    });
}

}  // namespace roomscribe::cli
