// SPDX-License-Identifier: MIT
#include "cli/output_folder.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include "roomscribe/pipeline/workspace.hpp"

namespace roomscribe::cli {

OutputFolder::OutputFolder(std::filesystem::path path) : path_(std::move(path)) {
    std::error_code error;
    std::filesystem::path part;
    for (const std::filesystem::path& name : path_) {
        part /= name;
        if (!std::filesystem::exists(part, error)) missing_.push_back(part);
    }
    try {
        prepare_output_folder(path_);
    } catch (...) {
        remove_empty_folders();
        throw;
    }
}

OutputFolder::~OutputFolder() {
    remove_empty_folders();
}

void OutputFolder::remove_empty_folders() {
    std::error_code not_empty;
    std::for_each(missing_.rbegin(), missing_.rend(), [&](const std::filesystem::path& folder) {
        std::filesystem::remove(folder, not_empty);
    });
}

}  // namespace roomscribe::cli
