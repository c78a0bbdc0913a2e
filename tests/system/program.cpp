// SPDX-License-Identifier: MIT
#include "system/program.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/io/point_cloud_io.hpp"
#include "support/simulated_rooms.hpp"

namespace roomscribe::test {

ProgramResult roomscribe(const std::vector<std::string>& arguments, const ProgramOptions& options) {
    return run_program(ROOMSCRIBE_PROGRAM, arguments, options);
}

void expect_error(const ProgramResult& result, int exit_code,
                  const std::vector<std::string>& words) {
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, testing::StartsWith("roomscribe: "));
    EXPECT_THAT(result.err, testing::EndsWith("\n"));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    for (const std::string& word : words)
        EXPECT_THAT(result.err, testing::HasSubstr(word));
}

std::vector<std::string> write_room_scans(const std::filesystem::path& folder, std::size_t count) {
    const std::vector<Scan> scans = scan_furnished_room(1);
    std::vector<std::string> paths;
    for (std::size_t i = 0; i < count; ++i) {
        paths.push_back((folder / scans.at(i).name).string());
        write_point_cloud(paths.back(), scans[i].cloud);
    }
    return paths;
}

nlohmann::json read_json(const std::filesystem::path& path) {
    auto json = nlohmann::json::parse(read_bytes(path), nullptr, false);
    EXPECT_FALSE(json.is_discarded()) << path << " is no JSON";
    return json.is_discarded() ? nlohmann::json() : json;
}

std::size_t count_components(const nlohmann::json& scene, const std::string& label) {
    const auto& components = scene.at("components");
    return static_cast<std::size_t>(
        std::count_if(components.begin(), components.end(),
                      [&](const auto& component) { return component.at("label") == label; }));
}

}  // namespace roomscribe::test
