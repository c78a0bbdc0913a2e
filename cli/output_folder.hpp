// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

namespace roomscribe::cli {

/// The folder that a job writes to. It is made before the work starts, so that a job never fails at
/// its end for want of a place; folders that it made and that stayed empty go when the job ends.
class OutputFolder {
  public:
    /// Throws IoError if the folder cannot be made or written.
    explicit OutputFolder(std::filesystem::path path);
    ~OutputFolder();
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

  private:
    void remove_empty_folders();

    std::filesystem::path path_;
    std::vector<std::filesystem::path> missing_;  ///< before the job; outermost first
};

}  // namespace roomscribe::cli
