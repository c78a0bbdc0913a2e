// SPDX-License-Identifier: MIT
#include "support/test_data.hpp"

#include <atomic>
#include <cstdlib>

#include <unistd.h>

namespace roomscribe::test {

TemporaryFolder::TemporaryFolder() {
    static std::atomic<int> counter = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("roomscribe-test-" + std::to_string(::getpid()) + "-" + std::to_string(counter++));
    std::filesystem::create_directories(path_);
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path real_scan(const std::string& relative_path) {
    const char* folder = std::getenv("ROOMSCRIBE_DATA");
    const std::filesystem::path data =
        folder != nullptr ? folder : ROOMSCRIBE_SOURCE_DIR "/../shared/data";
    const std::filesystem::path path = data / relative_path;
    return std::filesystem::exists(path) ? path : std::filesystem::path();
}

}  // namespace roomscribe::test
