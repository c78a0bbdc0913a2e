// SPDX-License-Identifier: MIT
#include "cli/explain_result.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "cli/command.hpp"
#include "cli/explain_scans.hpp"
#include "cli/explain_scene.hpp"
#include "roomscribe/core/edit_distance.hpp"
#include "roomscribe/io/byte_reader.hpp"

namespace roomscribe::cli {
namespace {

struct Result {
    std::optional<Scene> scene;
    std::optional<RegistrationRecord> registration;
};

Result read_result(const std::filesystem::path& folder) {
    Result result;
    if (const auto path = folder / "scene.json"; std::filesystem::exists(path))
        result.scene = scene_from_json(MappedFile(path, "scene JSON").text(), path.string());
    if (const auto path = folder / "registration.json"; std::filesystem::exists(path)) {
        result.registration =
            registration_from_json(MappedFile(path, "registration JSON").text(), path.string());
    }
    return result;
}

std::vector<std::string> known_ids(const Result& result) {
    std::vector<std::string> ids;
    if (result.scene) {
        for (const Room& room : result.scene->rooms)
            ids.push_back(room.id);
        for (const Component& component : result.scene->components)
            ids.push_back(component.id);
    }
    if (result.registration) {
        for (const ScanRecord& scan : result.registration->scans)
            ids.push_back(scan.name);
    }
    return ids;
}

[[noreturn]] void refuse(const Result& result, const std::string& id) {
    constexpr std::size_t num_suggestions = 3;
    std::vector<std::string> ids = known_ids(result);
    std::stable_sort(ids.begin(), ids.end(), [&](const std::string& a, const std::string& b) {
        return edit_distance(a, id) < edit_distance(b, id);
    });
    ids.resize(std::min(ids.size(), num_suggestions));
    throw UsageError(
        ids.empty() ? fmt::format("no {} there: the result is empty", id)
                    : fmt::format("no {} there (did you mean {}?)", id, fmt::join(ids, " or ")));
}

Explanation explain(const Result& result, const std::string& id) {
    if (result.scene) {
        for (const Room& room : result.scene->rooms) {
            if (room.id == id) return explain_room(*result.scene, room);
        }
        for (const Component& component : result.scene->components) {
            if (component.id == id) return explain_component(*result.scene, component);
        }
    }
    if (result.registration) {
        const auto& scans = result.registration->scans;
        for (std::size_t i = 0; i < scans.size(); ++i) {
            if (scans[i].name == id) return explain_scan(*result.registration, i);
        }
    }
    refuse(result, id);
}

std::string list_all(const Result& result) {
    std::string text;
    if (result.scene) text += scene_table(*result.scene);
    if (result.registration) {
        if (!text.empty()) text += "\n";
        text += registration_table(*result.registration);
    }
    return text;
}

}  // namespace

bool is_result_folder(const std::filesystem::path& path) {
    return std::filesystem::exists(path / "scene.json") ||
           std::filesystem::exists(path / "registration.json");
}

std::string explain_result(const std::filesystem::path& folder, std::span<const std::string> ids,
                           bool as_json) {
    const Result result = read_result(folder);
    if (ids.empty() && !as_json) return list_all(result);
    std::vector<std::string> wanted(ids.begin(), ids.end());
    if (wanted.empty()) wanted = known_ids(result);
    std::vector<Explanation> explanations;
    explanations.reserve(wanted.size());
    for (const std::string& id : wanted)
        explanations.push_back(explain(result, id));
    return as_json ? explanations_to_json(explanations) : explanations_to_text(explanations);
}

}  // namespace roomscribe::cli
