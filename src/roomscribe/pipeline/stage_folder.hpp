// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string_view>

#include "roomscribe/core/result_store.hpp"
#include "roomscribe/pipeline/workspace.hpp"

namespace roomscribe {

/// Whether a run goes on where one before it was stopped.
enum class RunStart { afresh, resumed };

/// What results of stages belong to: inputs by name and content, settings, verb, unit and the very
/// program. `unit` is what was said of the scans' unit.
std::uint64_t hash_of_job(const RunRecord& record, std::string_view unit);

/// Results of stages as files of a folder within the output folder, each written whole or not at
/// all, with the hash of its job and a checksum. A file that is of another job or damaged is as
/// good as none. The folder appears with its first file.
class StageFolder final : public ResultStore {
  public:
    using Tell = std::function<void(std::string_view message)>;

    /// Afresh: what an earlier run left is removed. Resumed: files that are no good are removed,
    /// and `tell` hears what there is to go on from.
    StageFolder(const std::filesystem::path& output, std::uint64_t job, RunStart start, Tell tell);

    void keep(std::string_view name, const std::function<void(const Write&)>& give) override;
    bool recall(std::string_view name,
                const std::function<void(std::span<const std::byte>)>& take) override;

    /// At the end of a run whose results are written.
    void remove() const;

  private:
    void check_files() const;

    std::filesystem::path folder_;
    std::uint64_t job_;
    Tell tell_;
};

}  // namespace roomscribe
