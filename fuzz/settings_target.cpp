// SPDX-License-Identifier: MIT
#include "cli/command.hpp"
#include "cli/settings_file.hpp"
#include "fuzz/targets.hpp"
#include "roomscribe/core/error.hpp"

namespace roomscribe::fuzz {
namespace {

void read_settings(std::span<const std::byte> bytes) {
    PipelineSettings settings;
    try {
        cli::apply_settings_file(settings, scratch_file("settings.toml", bytes).string());
    } catch (const IoError&) {
    } catch (const cli::UsageError&) {
    }
}

std::vector<std::string> make_seeds() {
    return {"seed = 3\n# c\n[registration]\nsequence = \"sequential\"\n"};
}

constexpr Target target{"settings", read_settings, make_seeds};

}  // namespace

const Target& settings_target() {
    return target;
}

}  // namespace roomscribe::fuzz
