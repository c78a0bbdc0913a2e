// SPDX-License-Identifier: MIT
#include "cli/explain_command.hpp"

#include <memory>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/explain_result.hpp"
#include "cli/job.hpp"
#include "cli/scan_unit.hpp"
#include "cli/text_table.hpp"
#include "roomscribe/preprocessing/line_center.hpp"

namespace roomscribe::cli {
namespace {

std::string derived_table(const std::vector<DerivedValue>& values) {
    TextTable table("lrll");
    table.add_row({"value", "", "", "why"});
    for (const DerivedValue& value : values) {
        table.add_row({value.name, fmt::format("{:.4g}", value.value), value.unit, value.reason});
    }
    return table.to_text();
}

std::string derived_json(const std::vector<DerivedValue>& values) {
    using Json = nlohmann::ordered_json;
    Json list = Json::array();
    for (const DerivedValue& value : values) {
        list.push_back({{"name", value.name},
                        {"value", value.value},
                        {"unit", value.unit},
                        {"reason", value.reason}});
    }
    return list.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

ExitCode explain(const JobOptions& options, const std::atomic<bool>& cancel) {
    if (is_result_folder(options.inputs.front())) {
        const std::span<const std::string> ids(options.inputs.begin() + 1, options.inputs.end());
        fmt::print("{}", explain_result(options.inputs.front(), ids, options.as_json));
        return ExitCode::done;
    }
    const PipelineSettings settings = resolve_settings(options);
    std::vector<DerivedValue> values;
    {
        ProgressDisplay display(options.progress);
        const Context context = make_context(options, cancel, display);
        JobInput input = load_scans(options.inputs, context);
        const ScanUnit unit = convert_to_metres(input.scans, input.paths, options.unit, context);
        for (Scan& scan : input.scans)
            locate_scanner(scan);
        values = reconstruct(std::move(input.scans), settings, context).derived_values;
        if (const auto value = unit_as_derived_value(unit)) values.insert(values.begin(), *value);
    }
    fmt::print("{}", options.as_json ? derived_json(values) : derived_table(values));
    return ExitCode::done;
}

}  // namespace

void add_explain_command(CLI::App& program, Action& action) {
    const auto options = std::make_shared<JobOptions>();
    CLI::App& verb = *program.add_subcommand(
        "explain",
        "Tell why: of a result, what was found; of scans, every value derived from them");
    verb.add_option("OUT [ID...] | SCANS", options->inputs,
                    "The folder of a result, and what to explain of it (door-2, room-1, 003.ply; "
                    "all in a line each if nothing is named); or scans, to print the values that a "
                    "run would derive from them")
        ->type_name("")
        ->required();
    add_job_options(verb, *options);
    verb.callback([options, &action] {
        action = [options](const std::atomic<bool>& cancel) { return explain(*options, cancel); };
    });
}

}  // namespace roomscribe::cli
