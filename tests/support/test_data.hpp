// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace roomscribe::test {

/// A folder of its own for one test, gone when the object is.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  private:
    std::filesystem::path path_;
};

/// Where a real scan lies, or an empty path where the folder of real scans is absent. It is
/// $ROOMSCRIBE_DATA, else ../shared/data beside the checkout.
std::filesystem::path real_scan(const std::string& relative_path);

}  // namespace roomscribe::test

/// Skips the running test, with a message, where a real scan is absent.
#define ROOMSCRIBE_REQUIRE_REAL_SCAN(path) \
    if ((path).empty()) GTEST_SKIP() << "the folder of real scans is absent"
