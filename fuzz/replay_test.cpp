// SPDX-License-Identifier: MIT
// The fuzz targets in the ordinary build: seeds, kept inputs, and changes of both.
#include <gtest/gtest.h>

#include "fuzz/targets.hpp"
#include "roomscribe/core/random.hpp"

namespace roomscribe::fuzz {
namespace {

class Replay : public testing::TestWithParam<Target> {};

void read(const Target& target, const std::string& bytes) {
    EXPECT_NO_THROW(target.read(std::as_bytes(std::span(bytes.data(), bytes.size()))))
        << target.name << ", " << bytes.size() << " bytes: " << testing::PrintToString(bytes);
}

std::vector<std::string> inputs_of(const Target& target) {
    std::vector<std::string> inputs = target.make_seeds();
    for (const std::string& kept : kept_inputs(target.name))
        inputs.push_back(kept);
    return inputs;
}

TEST_P(Replay, InputsAreReadOrRefused) {
    read(GetParam(), "");
    for (const std::string& input : inputs_of(GetParam()))
        read(GetParam(), input);
}

TEST_P(Replay, CutInputsAreReadOrRefused) {
    constexpr std::size_t num_cuts = 60;
    for (const std::string& input : inputs_of(GetParam())) {
        for (std::size_t i = 0; i < num_cuts; ++i)
            read(GetParam(), input.substr(0, i * input.size() / num_cuts));
    }
}

TEST_P(Replay, ChangedInputsAreReadOrRefused) {
    Random random(7);
    const auto below = [&](std::size_t bound) {
        return random.below(static_cast<std::uint32_t>(bound));
    };
    for (const std::string& input : inputs_of(GetParam())) {
        for (int i = 0; i < 150 && !input.empty(); ++i) {
            std::string changed = input;
            for (std::size_t k = 0; k <= below(4); ++k)
                changed[below(changed.size())] = static_cast<char>(below(256));
            read(GetParam(), changed);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Settings, Replay, testing::Values(settings_target()),
                         [](const auto& tested) { return std::string(tested.param.name); });
INSTANTIATE_TEST_SUITE_P(Targets, Replay, testing::ValuesIn(targets().begin(), targets().end()),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace roomscribe::fuzz
