// SPDX-License-Identifier: MIT
#include "cli/view_command.hpp"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/report_server.hpp"
#include "roomscribe/core/error.hpp"
#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/pipeline/result_folder.hpp"
#include "roomscribe/report/point_octree.hpp"
#include "roomscribe/report/viewer_points.hpp"

namespace roomscribe::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct ViewOptions {
    std::string result;
    int port = 0;
};

/// All is in memory before the server starts.
struct ViewedResult {
    std::string page;
    Reconstruction reconstruction;
    GriddedPoints points;
    PointOctree octree;
};

constexpr std::string_view points_begin = "<script type=\"text/plain\" id=\"viewer-points\">";
constexpr std::string_view model_begin = "<script type=\"application/json\" id=\"viewer-model\">";
constexpr std::string_view script_end = "</script>";

/// Place and size of what stands in a script element of the page.
std::pair<std::size_t, std::size_t> find_script(const std::string& page, std::string_view begin,
                                                const fs::path& path) {
    const std::size_t at = page.find(begin);
    const std::size_t end = at == std::string::npos ? at : page.find(script_end, at);
    if (end == std::string::npos) {
        throw IoError(path.string(), "report", {}, "has no 3D view",
                      "write it anew with a roomscribe that `roomscribe version` says has one");
    }
    return {at + begin.size(), end - at - begin.size()};
}

Eigen::Vector3d vector_from(const Json& json) {
    return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

std::string nodes_to_json(const PointOctree& octree) {
    Json nodes = Json::array();
    for (std::size_t i = 0; i < octree.nodes.size(); ++i) {
        const OctreeNode& node = octree.nodes[i];
        nodes.push_back({{"number", i},
                         {"depth", node.depth},
                         {"place", node.place},
                         {"count", node.points.size()}});
    }
    return Json({{"cells", PointOctree::cells}, {"nodes", nodes}}).dump();
}

/// The page asks for points instead of holding them; they are those of labels.ply or map.ply.
ViewedResult read_viewed_result(const fs::path& folder, const Context& context) {
    ViewedResult result;
    const fs::path path = folder / "report.html";
    if (!fs::exists(path)) {
        throw IoError(folder.string(), "result", {}, "holds no report.html",
                      "give the output folder of roomscribe run, register or interpret");
    }
    result.page = MappedFile(path, "report").text();
    const auto [model_at, model_size] = find_script(result.page, model_begin, path);
    const Json model =
        Json::parse(result.page.substr(model_at, model_size), nullptr, /*allow_exceptions=*/false);
    result.reconstruction = read_reconstruction(folder, context);
    try {
        const Eigen::Vector3d low = vector_from(model.at("cube").at("low"));
        const Eigen::Vector3d size = vector_from(model.at("cube").at("size"));
        for (const Json& scan : model.at("scans")) {
            result.reconstruction.map.sections.push_back(
                {scan.at("name").get<std::string>(), scan.at("first").get<std::uint32_t>(),
                 scan.at("count").get<std::uint32_t>(), std::nullopt});
        }
        result.points =
            grid_points(result.reconstruction, Eigen::AlignedBox3d(low, low + size), context);
    } catch (const Json::exception&) {
        throw IoError(path.string(), "report", {}, "holds a 3D view of another version",
                      "write it anew");
    }
    result.octree = build_point_octree(result.points);
    const auto [points_at, points_size] = find_script(result.page, points_begin, path);
    result.page.replace(points_at, points_size, "");
    result.page.insert(points_at - 1, " data-stream=\"points\"");
    return result;
}

ExitCode view(const ViewOptions& options, const std::atomic<bool>& cancel) {
    Context context;
    context.cancel = &cancel;
    const ViewedResult result = read_viewed_result(options.result, context);
    const auto pack_node = [&result](std::size_t node) {
        return pack_points(result.reconstruction, result.points, result.octree.nodes[node].points);
    };
    serve_report({result.page, nodes_to_json(result.octree), result.octree.nodes.size(), pack_node},
                 options.port, cancel, [&result](int port) {
                     fmt::print("http://127.0.0.1:{}/\n", port);
                     std::fflush(stdout);
                     fmt::print(stderr, "{} points; Ctrl-C ends it\n", result.points.size());
                 });
    return ExitCode::done;
}

}  // namespace

void add_view_command(CLI::App& program, Action& action) {
    const auto options = std::make_shared<ViewOptions>();
    CLI::App& verb = *program.add_subcommand(
        "view", "Serve the report of a result on this machine, with all its points");
    verb.add_option("OUT", options->result, "Folder that run, register or interpret wrote")
        ->type_name("")
        ->required();
    verb.add_option("--port", options->port, "Port on 127.0.0.1; 0: any that is free")
        ->type_name("N")
        ->check(CLI::Range(0, 65535).description(""))
        ->capture_default_str();
    verb.footer(
        "Open the address that it prints. Only this machine reaches it, and nothing can be "
        "written.\nCtrl-C ends it.\n");
    verb.callback([options, &action] {
        action = [options](const std::atomic<bool>& cancel) { return view(*options, cancel); };
    });
}

}  // namespace roomscribe::cli
