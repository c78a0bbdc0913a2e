// SPDX-License-Identifier: MIT
#include "cli/job_options.hpp"

#include <fmt/format.h>

#include "cli/choice_option.hpp"
#include "cli/settings_file.hpp"

namespace roomscribe::cli {

void add_job_options(CLI::App& verb, JobOptions& options) {
    verb.add_option("--config", options.settings_file, "Read settings from this file")
        ->type_name("FILE");
    verb.add_option("--set", options.assignments, "Change one setting; may be repeated")
        ->type_name("NAME=VALUE")
        ->allow_extra_args(false);
    verb.add_option("--seed", options.seed, "Same as --set seed=N")->type_name("N");
    verb.add_option("--threads", options.num_threads,
                    "Threads to use, 0 for all of the machine; never changes a result")
        ->type_name("N")
        ->check(CLI::Range(0, 1024));
    verb.add_flag("--json", options.as_json, "Print the result as JSON instead of tables");
    add_choice_option<ProgressMode>(
        verb, "--progress", options.progress,
        {{"auto", ProgressMode::automatic},
         {"none", ProgressMode::none},
         {"json", ProgressMode::json}},
        "On stderr: a bar on a terminal (auto), nothing (none), JSON lines (json)")
        ->type_name("auto|none|json");
    verb.footer([] {
        return fmt::format("Settings, with their default, range and unit:\n{}\n{}\n",
                           settings_table(), settings_file_help);
    });
}

void add_scans(CLI::App& verb, JobOptions& options) {
    verb.add_option(
            "SCANS", options.inputs,
            "Scans: PCD, PLY, E57, LAS, PTX, PTS, XYZ, CSV, NPY, OBJ, UOS .3d, legacy VTK, depth "
            "PNG, planar scans .tilt, ROS .bag, a TUM RGB-D folder; all scans of a file are taken")
        ->type_name("")
        ->required();
    add_unit(verb, options.unit);
}

void add_unit(CLI::App& verb, std::optional<LengthUnit>& unit) {
    std::map<std::string, std::optional<LengthUnit>> words{{"auto", std::nullopt}};
    for (std::size_t i = 0; i < length_unit_names.size(); ++i)
        words.emplace(length_unit_names[i], static_cast<LengthUnit>(i));
    add_choice_option<std::optional<LengthUnit>>(
        verb, "--unit", unit, words,
        "Unit of the coordinates in the files, poses too; auto: told by the size of the rooms. "
        "Results are in metres")
        ->type_name("auto|m|mm|cm|in|ft");
}

void add_poses(CLI::App& verb, JobOptions& options) {
    verb.add_option("--poses", options.pose_files,
                    "Where the scans stand: a line of 12 numbers (KITTI; nan where it is not "
                    "known) or 8 (TUM) each; may be repeated (UOS has a .pose file per scan)")
        ->type_name("FILE")
        ->allow_extra_args(false);
}

void add_output(CLI::App& verb, JobOptions& options) {
    verb.add_option("-o,--output", options.output, "Folder for the results, made if absent")
        ->type_name("FOLDER")
        ->required();
}

void add_memory(CLI::App& verb, JobOptions& options) {
    verb.add_option("--memory", options.memory,
                    "Memory to use at most: more is never taken; scans that need more are refused, "
                    "and how much they need is said")
        ->type_name("SIZE");
}

void add_resume(CLI::App& verb, JobOptions& options) {
    verb.add_flag("--resume", options.resume,
                  "Go on where a run into FOLDER with the same scans and settings was stopped");
}

void add_corrections(CLI::App& verb, JobOptions& options) {
    verb.add_option("--corrections", options.corrections,
                    "What is pinned, rejected, relabelled or of another size (docs/formats.md); "
                    "default: corrections.json in FOLDER, where it is there")
        ->type_name("FILE");
}

void add_truth(CLI::App& verb, JobOptions& options) {
    verb.add_option("--truth", options.truth,
                    "Truth folder of these scans, as simulate writes it: score the result")
        ->type_name("FOLDER");
}

PipelineSettings resolve_settings(const JobOptions& options) {
    PipelineSettings settings;
    if (!options.settings_file.empty()) apply_settings_file(settings, options.settings_file);
    for (const std::string& assignment : options.assignments) {
        apply_assignment(settings, assignment);
    }
    if (options.seed) set_setting(settings, "seed", *options.seed);
    return settings;
}

}  // namespace roomscribe::cli
