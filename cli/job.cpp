// SPDX-License-Identifier: MIT
#include "cli/job.hpp"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <new>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "cli/job_result.hpp"
#include "cli/output_folder.hpp"
#include "cli/scan_unit.hpp"
#include "roomscribe/core/error.hpp"
#include "roomscribe/export/json.hpp"
#include "roomscribe/geometry/bounding_box.hpp"
#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "roomscribe/io/poses_io.hpp"
#include "roomscribe/pipeline/corrections.hpp"
#include "roomscribe/pipeline/scoring.hpp"
#include "roomscribe/pipeline/stage_folder.hpp"
#include "roomscribe/pipeline/truth_folder.hpp"
#include "roomscribe/pipeline/workspace.hpp"
#include "roomscribe/preprocessing/line_center.hpp"
#include "roomscribe/report/html_report.hpp"

namespace roomscribe::cli {
namespace {

/// Fewer points show no surface.
constexpr std::size_t min_points = 100;

void require_usable(const std::string& path, const PointCloud& cloud) {
    const std::size_t num_finite = finite_points(cloud).size();
    if (num_finite < min_points) {
        throw IoError(path, "", {},
                      fmt::format("holds {} points with finite coordinates", num_finite),
                      fmt::format("a scan needs at least {}", min_points));
    }
    if (bounding_box(cloud.positions).sizes().maxCoeff() <= 0.0F) {
        throw IoError(path, "", {}, "all points lie in one place",
                      "export the scan again, with its coordinates");
    }
}

RunRecord make_record(std::string_view verb, const JobOptions& options,
                      const PipelineSettings& settings) {
    RunRecord record;
    record.version = ROOMSCRIBE_VERSION;
    record.command = verb;
    record.settings = list_settings(settings);
    for (const std::string& path : options.inputs)
        record.inputs.push_back(describe_input(path, FileRole::scan));
    for (const std::string& path : options.pose_files)
        record.inputs.push_back(describe_input(path, FileRole::poses));
    record.num_threads = options.num_threads > 0
                             ? options.num_threads
                             : static_cast<int>(std::thread::hardware_concurrency());
    return record;
}

std::string_view unit_word(const std::optional<LengthUnit>& unit) {
    return unit ? length_unit_name(*unit) : "auto";
}

/// True if the points of two maps lie in the same places, to the rounding of files.
bool lie_in_one_frame(const ScanMap& a, const ScanMap& b) {
    constexpr float tolerance = 0.01F;
    for (std::size_t i = 0; i < a.cloud.size(); ++i) {
        const Eigen::Vector3f& point = a.cloud.positions[i];
        if (is_finite(point) && !((point - b.cloud.positions[i]).norm() < tolerance)) return false;
    }
    return true;
}

/// How the result compares with truth, where somebody knows it.
std::optional<EvaluationSummary> score(const JobOptions& options,
                                       const Reconstruction& reconstruction,
                                       const Context& context) {
    if (options.truth.empty()) return std::nullopt;
    const GroundTruth truth = read_truth_folder(options.truth, context);
    if (truth.map.cloud.size() != reconstruction.map.cloud.size()) {
        throw IoError(options.truth, "truth folder", {},
                      fmt::format("is of {} points, the scans have {}", truth.map.cloud.size(),
                                  reconstruction.map.cloud.size()),
                      "give the truth of these scans, in their order");
    }
    if (!reconstruction.registration && !lie_in_one_frame(truth.map, reconstruction.map)) {
        throw UsageError("the map is not in the frame of " + options.truth +
                         ": interpret its map.ply, or its scans with its truth/poses.txt");
    }
    const Evaluation evaluation = score_reconstruction(truth, reconstruction, context);
    return summarize({&evaluation, 1});
}

/// Maps that could not be joined to the first have folders of their own in its folder. Returns
/// where the report lies.
std::filesystem::path write_results(const std::filesystem::path& folder,
                                    const Reconstruction& reconstruction, ReportInfo info,
                                    const Context& context) {
    for (std::size_t i = 0; i < reconstruction.apart.size(); ++i) {
        const std::filesystem::path own = folder / folder_of_apart(i);
        prepare_output_folder(own);
        ReportInfo own_info{.title = info.title, .run = info.run, .score = {}};
        write_results(own, reconstruction.apart[i], own_info, context);
    }
    remove_apart_from(folder, reconstruction.apart.size());
    if (reconstruction.registration) write_registration(folder, reconstruction, context);
    if (!reconstruction.labels.labels.empty()) {
        write_interpretation(folder, reconstruction, context);
    }
    info.run.results = describe_results(folder);
    write_run_record(folder, info.run, reconstruction);
    std::filesystem::path report = folder / "report.html";
    write_html_report(report, reconstruction, info, context);
    return report;
}

/// Where corrections are, if there are any.
std::optional<std::string> find_corrections(const JobOptions& options) {
    if (!options.corrections.empty()) return options.corrections;
    const auto beside = std::filesystem::path(options.output) / "corrections.json";
    return std::filesystem::exists(beside) ? std::optional(beside.string()) : std::nullopt;
}

std::vector<Correction> read_corrections(const std::filesystem::path& path) {
    const MappedFile file(path, "corrections JSON");
    return corrections_from_json(file.text(), path.string());
}

/// Those of the map, then those of each map apart that an earlier run left, from its own folder:
/// read before the work starts, so that a long run does not end on a wrong file.
std::vector<std::vector<Correction>> read_all_corrections(const JobOptions& options,
                                                          RunRecord& record) {
    std::vector<std::vector<Correction>> corrections(1);
    const auto read = [&](const std::filesystem::path& path) {
        corrections.back() = read_corrections(path);
        record.inputs.push_back(describe_input(path, FileRole::corrections));
    };
    if (const auto path = find_corrections(options)) read(*path);
    const std::filesystem::path output = options.output;
    for (std::size_t i = 0; exists(output / folder_of_apart(i)); ++i) {
        corrections.emplace_back();
        const std::filesystem::path path = output / folder_of_apart(i) / "corrections.json";
        if (exists(path)) read(path);
    }
    return corrections;
}

/// Corrections come in the coordinates of files. Returns what is to be said, in one line.
std::string correct(Reconstruction& reconstruction, std::vector<Correction> corrections) {
    if (corrections.empty() || reconstruction.labels.labels.empty()) return {};
    for (Correction& correction : corrections) {
        Scene alone;
        alone.components = {correction.element};
        alone = transformed_scene(
            alone, Transform(Eigen::Translation3d(-reconstruction.map.cloud.global_shift)));
        correction.element = alone.components.front();
    }
    const CorrectionOutcome outcome = apply_corrections(reconstruction, corrections);
    std::string text =
        fmt::format("{} of {} corrections are applied", outcome.num_applied, corrections.size());
    for (const std::string& line : outcome.unmatched)
        text += "; " + line;
    reconstruction.derived_values.push_back(
        {"corrections", static_cast<double>(outcome.num_applied), "", text});
    return text;
}

/// The same for the map and the maps apart.
std::string correct_all(Reconstruction& reconstruction,
                        std::vector<std::vector<Correction>> corrections) {
    std::string text = correct(reconstruction, std::move(corrections.front()));
    for (std::size_t i = 1; i < corrections.size(); ++i) {
        if (corrections[i].empty()) continue;
        const std::string own =
            i <= reconstruction.apart.size()
                ? correct(reconstruction.apart[i - 1], std::move(corrections[i]))
                : "its corrections are left alone: there is no such map";
        text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", folder_of_apart(i - 1), own);
    }
    return text;
}

/// What is to be said of the unit, in run.json too.
void note_unit(JobSummary& summary, Reconstruction& reconstruction) {
    auto& values = reconstruction.derived_values;
    if (const auto unit = unit_as_derived_value(summary.unit)) values.insert(values.begin(), *unit);
    summary.doubt = doubt_about_feet(reconstruction);
    if (!summary.doubt.empty()) {
        values.push_back({"interpretation.feet", metres_per(LengthUnit::foot), "m", summary.doubt});
    }
}

/// The job itself; run_job minds its memory.
ExitCode run_job_within(const MemoryLimit& memory, std::string_view verb, const JobOptions& options,
                        const std::atomic<bool>& cancel, const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    const PipelineSettings settings = resolve_settings(options);
    const OutputFolder output(options.output);
    Reconstruction reconstruction;
    JobSummary summary;
    summary.output = output.path().string();
    {
        ProgressDisplay display(options.progress);
        Context context = make_context(options, cancel, display);
        ReportInfo info;
        info.run = make_record(verb, options, settings);
        StageFolder stages(output.path(), hash_of_job(info.run, unit_word(options.unit)),
                           options.resume ? RunStart::resumed : RunStart::afresh,
                           context.on_message);
        context.results = &stages;
        std::vector<std::vector<Correction>> corrections = read_all_corrections(options, info.run);
        JobInput input = load_scans(options.inputs, context, memory);
        load_poses(input, options, context);
        summary.unit = convert_to_metres(input.scans, input.paths, options.unit, context);
        convert_to_metres(input.given_poses, summary.unit);
        convert_to_metres(input.stored_poses, summary.unit);
        input.map_shift *= metres_per(summary.unit.unit);
        for (Scan& scan : input.scans)
            locate_scanner(scan);
        reconstruction = work(input, settings, context);
        context.throw_if_cancelled();
        note_unit(summary, reconstruction);
        summary.corrections = correct_all(reconstruction, std::move(corrections));
        info.score = summary.score = score(options, reconstruction, context);
        summary.report = write_results(output.path(), reconstruction, info, context);
        stages.remove();
    }
    summary.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

    fmt::print("{}", options.as_json ? result_json(reconstruction, summary)
                                     : result_tables(reconstruction, summary));
    const std::string missing = missing_result(reconstruction);
    if (missing.empty()) return ExitCode::done;
    std::fflush(stdout);
    fmt::print(stderr, "roomscribe: {}\n", missing);
    return ExitCode::no_result;
}

}  // namespace

Context make_context(const JobOptions& options, const std::atomic<bool>& cancel,
                     ProgressDisplay& display) {
    Context context;
    context.num_threads = options.num_threads;
    context.cancel = &cancel;
    context.on_progress = [&display](std::string_view stage, double fraction) {
        display.show(stage, fraction);
    };
    context.on_message = [&display](std::string_view message) { display.show_message(message); };
    return context;
}

JobInput load_scans(std::span<const std::string> paths, const Context& context,
                    const MemoryLimit& memory) {
    JobInput input;
    for (const std::string& path : paths) {
        context.throw_if_cancelled();
        for (StoredScan& stored : read_scans(path, context)) {
            const bool several = stored.scan.name != std::filesystem::path(path).filename();
            require_usable(several ? path + " (" + stored.scan.name + ")" : path,
                           stored.scan.cloud);
            // One shift serves all files.
            if (input.scans.empty()) input.map_shift = stored.map_shift;
            if (stored.map_from_scan) {
                stored.map_from_scan->translation() += stored.map_shift - input.map_shift;
            }
            input.scans.push_back(std::move(stored.scan));
            input.stored_poses.push_back(stored.map_from_scan);
            input.paths.push_back(path);
        }
        memory.require_room(input.scans);
    }
    return input;
}

void load_poses(JobInput& input, const JobOptions& options, const Context& context) {
    if (options.pose_files.empty()) return;
    auto& poses = input.given_poses;
    for (const std::string& path : options.pose_files) {
        const auto more = read_poses(path, context);
        poses.insert(poses.end(), more.begin(), more.end());
    }
    if (poses.size() != input.scans.size()) {
        throw IoError(
            options.pose_files.back(), "poses", {},
            fmt::format("there are {} poses for {} scans", poses.size(), input.scans.size()),
            "give one pose per scan, in the order of the scans");
    }
}

ExitCode run_job(std::string_view verb, const JobOptions& options, const std::atomic<bool>& cancel,
                 const Work& work) {
    const MemoryLimit memory(
        options.memory.empty() ? std::nullopt : std::optional(parse_memory_size(options.memory)));
    try {
        return run_job_within(memory, verb, options, cancel, work);
    } catch (const std::bad_alloc&) {
        if (options.memory.empty()) throw;
        throw UsageError(memory.exceeded_message());
    }
}

}  // namespace roomscribe::cli
