// SPDX-License-Identifier: MIT
#include "cli/export_command.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "cli/output_folder.hpp"
#include "roomscribe/core/error.hpp"
#include "roomscribe/export/building.hpp"
#include "roomscribe/export/floor_plan_dxf.hpp"
#include "roomscribe/export/floor_plan_svg.hpp"
#include "roomscribe/export/gltf.hpp"
#include "roomscribe/export/ifc.hpp"
#include "roomscribe/export/json.hpp"
#include "roomscribe/export/labelled_points.hpp"
#include "roomscribe/export/scene_graph.hpp"
#include "roomscribe/export/schedules.hpp"
#include "roomscribe/io/atomic_file.hpp"
#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "roomscribe/pipeline/labelled_inputs.hpp"

namespace roomscribe::cli {
namespace {

namespace fs = std::filesystem;

struct ExportOptions {
    std::string result;
    std::vector<std::string> targets;
    std::string output;
};

/// A result as it was read, and where it lies.
struct Result {
    Building building;
    fs::path scene_path;
    Transform room_from_map;
};

Result read_result(const fs::path& folder) {
    const fs::path path = folder / "scene.json";
    if (!fs::exists(path)) {
        throw IoError(folder.string(), "result", {}, "holds no scene.json",
                      "give the output folder of roomscribe run or interpret");
    }
    const MappedFile file(path, "scene JSON");
    const Scene scene = scene_from_json(file.text(), path.string());
    return {describe_building(scene), path, scene.room_from_map};
}

void write_glb(const Result& result, const fs::path& path) {
    write_file(path, "glTF", building_to_glb(result.building));
}

void write_svg(const Result& result, const fs::path& path) {
    write_file(path, "SVG", plans_to_svg(draw_floor_plans(result.building)));
}

void write_dxf(const Result& result, const fs::path& path) {
    write_file(path, "DXF", plans_to_dxf(draw_floor_plans(result.building)));
}

/// When the result was written, so that the same result gives the same file.
std::string time_of(const fs::path& path) {
    using std::chrono::system_clock;
    const auto since_epoch =
        fs::last_write_time(path).time_since_epoch() -
        fs::file_time_type::clock::from_sys(system_clock::time_point()).time_since_epoch();
    const auto seconds = std::chrono::floor<std::chrono::seconds>(since_epoch).count();
    return fmt::format("{:%Y-%m-%dT%H:%M:%S}", fmt::gmtime(static_cast<std::time_t>(seconds)));
}

void write_ifc(const Result& result, const fs::path& path) {
    IfcOrigin origin;
    origin.file_name = path.filename().string();
    origin.time_stamp = time_of(result.scene_path);
    origin.version = ROOMSCRIBE_VERSION;
    write_file(path, "IFC", building_to_ifc(result.building, origin));
}

void write_csv(const Result& result, const fs::path& folder) {
    const OutputFolder output(folder);
    for (const Schedule& schedule : building_to_schedules(result.building))
        write_file(output.path() / schedule.file_name, "CSV", schedule.csv);
}

void write_graph(const Result& result, const fs::path& path) {
    write_file(path, "JSON", building_to_graph(result.building));
}

LabelledPoints read_points(const Result& result) {
    const fs::path path = result.scene_path.parent_path() / "labels.ply";
    return labelled_points(read_scan(path).cloud, result.room_from_map);
}

void write_scannet(const Result& result, const fs::path& path) {
    write_point_cloud(path, scannet_cloud(read_points(result), result.building));
}

void write_s3dis(const Result& result, const fs::path& folder) {
    const LabelledPoints points = read_points(result);
    for (const S3disFile& file : s3dis_files(points, result.building)) {
        const fs::path path = folder / file.path;
        const OutputFolder output(path.parent_path());
        write_file(path, "S3DIS", s3dis_text(points.cloud, file.points));
    }
}

void write_labelled(const Result& result, const fs::path& folder) {
    const OutputFolder output(folder);
    write_labelled_inputs(result.scene_path.parent_path(), output.path());
}

struct Target {
    std::string_view name;
    std::string_view place;  ///< in the result's folder, unless told otherwise
    void (*write)(const Result& result, const fs::path& path);
};

constexpr std::array<Target, 9> targets{{
    {"glb", "model.glb", write_glb},
    {"svg", "plan.svg", write_svg},
    {"dxf", "plan.dxf", write_dxf},
    {"ifc", "model.ifc", write_ifc},
    {"csv", "schedules", write_csv},
    {"graph", "graph.json", write_graph},
    {"s3dis", "s3dis", write_s3dis},
    {"scannet", "scannet.ply", write_scannet},
    {"labelled", "labelled", write_labelled},
}};

ExitCode export_result(const ExportOptions& options, const std::atomic<bool>& cancel) {
    const Result result = read_result(options.result);
    std::vector<const Target*> wanted;
    for (const Target& target : targets) {
        if (std::find(options.targets.begin(), options.targets.end(), target.name) !=
            options.targets.end()) {
            wanted.push_back(&target);
        }
    }
    const bool is_folder = options.output.empty() || wanted.size() > 1;
    const OutputFolder folder(options.output.empty() ? fs::path(options.result)
                              : is_folder            ? fs::path(options.output)
                                                     : fs::absolute(options.output).parent_path());
    for (const Target* target : wanted) {
        if (cancel) throw Cancelled();
        const fs::path path = is_folder ? folder.path() / target->place : fs::path(options.output);
        target->write(result, path);
        fmt::print("{}\n", path.string());
    }
    return ExitCode::done;
}

}  // namespace

void add_export_command(CLI::App& program, Action& action) {
    const auto options = std::make_shared<ExportOptions>();
    CLI::App& verb = *program.add_subcommand(
        "export", "Write the model of a result for other programs: glTF, IFC, plans, tables");
    verb.add_option("OUT", options->result, "Folder that run or interpret wrote")
        ->type_name("")
        ->required();
    std::vector<std::string> names;
    names.reserve(targets.size());
    for (const Target& target : targets)
        names.emplace_back(target.name);
    verb.add_option(
            "--to", options->targets,
            "glb (3D model, glTF), svg and dxf (floor plans), ifc (IFC4), csv (schedules of "
            "rooms, walls, doors, windows, furniture, handles), graph (JSON), s3dis and scannet "
            "(labelled points), labelled (your own scans, with a label per point); several may be "
            "given")
        ->type_name("FORMAT")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::IsMember(names).description(""))
        ->required();
    verb.add_option("-o,--output", options->output,
                    "File to write (csv, s3dis, labelled: folder); folder, where several formats "
                    "are given. "
                    "Else OUT/model.glb, plan.svg, plan.dxf, model.ifc, schedules/, graph.json, "
                    "s3dis/, scannet.ply, labelled/")
        ->type_name("PATH");
    verb.footer(
        "All is in metres in the room frame: z up, floor at z = 0, x and y along the "
        "dominant walls.\nglTF has y up: (x, y, z) becomes (x, z, -y). SVG is at 1:50 in "
        "millimetres of paper.\nLabelled scans stay in their own frame and unit.\n");
    verb.callback([options, &action] {
        action = [options](const std::atomic<bool>& cancel) {
            return export_result(*options, cancel);
        };
    });
}

}  // namespace roomscribe::cli
