// SPDX-License-Identifier: MIT
#include "cli/info_command.hpp"

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/text_table.hpp"
#include "roomscribe/core/context.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/io/point_cloud_io.hpp"

namespace roomscribe::cli {
namespace {

struct InfoOptions {
    std::vector<std::string> files;
    bool as_json = false;
};

std::string describe(const Field& field) {
    const std::string count = field.count == 1 ? "" : fmt::format("[{}]", field.count);
    return fmt::format("{} {}{}", field.name, scalar_type_name(field.type), count);
}

std::string describe(const Eigen::Vector3d& v) {
    return fmt::format("{:.3f} {:.3f} {:.3f}", v.x(), v.y(), v.z());
}

/// "file.e57", or "file.e57, scan 2 of 3: hall".
std::string title(const std::string& path, std::span<const FileSummary> all, std::size_t i) {
    if (all.size() == 1 && all[i].name.empty()) return path;
    const std::string place =
        all.size() == 1 ? path : fmt::format("{}, scan {} of {}", path, i + 1, all.size());
    return all[i].name.empty() ? place : fmt::format("{}: {}", place, all[i].name);
}

std::string summary_text(const std::string& title, const FileSummary& summary) {
    std::vector<std::string> fields;
    for (const Field& field : summary.fields)
        fields.push_back(describe(field));
    TextTable table("ll");
    table.add_row({"  format", fmt::format("{}, {}", summary.format, summary.encoding)});
    table.add_row({"  points", fmt::format("{}", summary.num_points)});
    table.add_row({"  without finite coordinates", fmt::format("{}", summary.num_non_finite)});
    if (!summary.bounds.isEmpty()) {
        table.add_row({"  from", describe(summary.bounds.min())});
        table.add_row({"  to", describe(summary.bounds.max())});
        table.add_row({"  size", describe(summary.bounds.sizes()) + " m"});
    }
    if (summary.grid) {
        table.add_row({"  scan grid", fmt::format("{} rows x {} columns", summary.grid->rows,
                                                  summary.grid->columns)});
    }
    if (summary.sensor_pose) {
        table.add_row({"  scanner at", describe(summary.sensor_pose->translation())});
    }
    if (summary.map_from_scan) {
        const Eigen::AngleAxisd turn(summary.map_from_scan->linear());
        table.add_row({"  stands at", describe(summary.map_from_scan->translation())});
        table.add_row({"  turned by", fmt::format("{:.3f} degrees about {}", degrees(turn.angle()),
                                                  describe(turn.axis()))});
    }
    table.add_row({"  fields", fmt::format("{}", fmt::join(fields, ", "))});
    for (const std::string& warning : summary.warnings)
        table.add_row({"  note", warning});
    return title + "\n" + table.to_text();
}

nlohmann::ordered_json summary_json(const std::string& path, const FileSummary& summary) {
    using Json = nlohmann::ordered_json;
    const auto list = [](const auto& v) { return Json{v.x(), v.y(), v.z()}; };
    Json json{{"path", path},
              {"scan", summary.name},
              {"format", summary.format},
              {"encoding", summary.encoding},
              {"points", summary.num_points},
              {"non_finite", summary.num_non_finite},
              {"fields", Json::array()},
              {"warnings", summary.warnings}};
    for (const Field& field : summary.fields) {
        json["fields"].push_back(
            {{"name", field.name}, {"type", scalar_type_name(field.type)}, {"count", field.count}});
    }
    if (!summary.bounds.isEmpty()) {
        json["bounds"] = {{"min", list(summary.bounds.min())}, {"max", list(summary.bounds.max())}};
    }
    if (summary.grid) {
        json["grid"] = {{"rows", summary.grid->rows}, {"columns", summary.grid->columns}};
    }
    if (summary.sensor_pose) {
        json["sensor_position"] = list(summary.sensor_pose->translation());
    }
    if (summary.map_from_scan) {
        json["pose"] = Json::array();
        for (Eigen::Index row = 0; row < 3; ++row) {
            const Eigen::Vector4d numbers = summary.map_from_scan->matrix().row(row);
            json["pose"].push_back({numbers[0], numbers[1], numbers[2], numbers[3]});
        }
    }
    return json;
}

ExitCode print_info(const InfoOptions& options, const std::atomic<bool>& cancel) {
    using Json = nlohmann::ordered_json;
    Context context;
    context.cancel = &cancel;
    Json all = Json::array();
    for (const std::string& path : options.files) {
        const std::vector<FileSummary> scans = summarize_file(path, context);
        for (std::size_t i = 0; i < scans.size(); ++i) {
            if (options.as_json) {
                all.push_back(summary_json(path, scans[i]));
            } else {
                fmt::print("{}", summary_text(title(path, scans, i), scans[i]));
            }
        }
    }
    if (options.as_json) {
        fmt::print("{}\n", all.dump(2, ' ', false, Json::error_handler_t::replace));
    }
    return ExitCode::done;
}

}  // namespace

void add_info_command(CLI::App& program, Action& action) {
    const auto options = std::make_shared<InfoOptions>();
    CLI::App& verb = *program.add_subcommand("info", "Say what is in files");
    verb.add_option("FILE", options->files, "Clouds of any format that is read")
        ->type_name("")
        ->required();
    verb.add_flag("--json", options->as_json, "Print JSON");
    verb.callback([options, &action] {
        action = [options](const std::atomic<bool>& cancel) {
            return print_info(*options, cancel);
        };
    });
}

}  // namespace roomscribe::cli
