// SPDX-License-Identifier: MIT
#include "cli/convert_command.hpp"

#include <memory>
#include <string>

#include "cli/choice_option.hpp"
#include "roomscribe/core/context.hpp"
#include "roomscribe/core/length_unit.hpp"
#include "roomscribe/io/point_cloud_io.hpp"

namespace roomscribe::cli {
namespace {

struct ConvertOptions {
    std::string input;
    std::string output;
    Encoding encoding = Encoding::automatic;
    LengthUnit unit = LengthUnit::metre;
};

ExitCode convert(const ConvertOptions& options, const std::atomic<bool>& cancel) {
    Context context;
    context.cancel = &cancel;
    Scan scan = read_scan(options.input, context);
    if (options.unit != LengthUnit::metre) scale_in_place(scan.cloud, metres_per(options.unit));
    write_point_cloud(options.output, scan.cloud, {options.encoding}, context);
    return ExitCode::done;
}

}  // namespace

void add_convert_command(CLI::App& program, Action& action) {
    const auto options = std::make_shared<ConvertOptions>();
    CLI::App& verb = *program.add_subcommand("convert", "Write a cloud in another format");
    verb.add_option("IN", options->input,
                    "Any file that is read; several scans become one map by their poses")
        ->type_name("")
        ->required();
    verb.add_option("OUT", options->output,
                    "PCD, PLY, E57, LAS, XYZ, TXT, CSV or UOS .3d, as the name ends")
        ->type_name("")
        ->required();
    add_choice_option<Encoding>(
        verb, "--encoding", options->encoding,
        {{"auto", Encoding::automatic},
         {"ascii", Encoding::ascii},
         {"binary", Encoding::binary},
         {"binary_compressed", Encoding::binary_compressed},
         {"binary_big_endian", Encoding::binary_big_endian}},
        "auto, ascii, binary, binary_compressed (PCD) or binary_big_endian (PLY)")
        ->type_name("NAME");
    add_choice_option<LengthUnit>(verb, "--unit", options->unit,
                                  words_of<LengthUnit>(length_unit_names),
                                  "Unit of IN's coordinates; OUT has metres")
        ->type_name("m|mm|cm|in|ft");
    verb.callback([options, &action] {
        action = [options](const std::atomic<bool>& cancel) { return convert(*options, cancel); };
    });
}

}  // namespace roomscribe::cli
