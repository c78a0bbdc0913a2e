// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "roomscribe/model/scan.hpp"

namespace roomscribe::cli {

/// "8G", "500M", "1.5GiB": G and M are 2^30 and 2^20 bytes. Throws UsageError for anything else, or
/// less than 512M.
std::size_t parse_memory_size(std::string_view text);

/// Keeps the memory of the process under a size for as long as it lives: what would go beyond
/// throws std::bad_alloc (RLIMIT_DATA, less what program and open files take).
class MemoryLimit {
  public:
    /// Nothing is limited where `size` is empty.
    explicit MemoryLimit(std::optional<std::size_t> size);
    ~MemoryLimit();
    MemoryLimit(const MemoryLimit&) = delete;
    MemoryLimit& operator=(const MemoryLimit&) = delete;

    /// Throws UsageError, which says how much is needed, if a job with these scans would go beyond.
    /// Told while scans are read, before long work.
    void require_room(std::span<const Scan> scans) const;

    /// What is said when the memory did not do all the same.
    std::string exceeded_message() const;

  private:
    std::optional<std::size_t> size_;
    std::size_t before_ = 0;
};

}  // namespace roomscribe::cli
