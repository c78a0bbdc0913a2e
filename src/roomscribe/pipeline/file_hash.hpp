// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace roomscribe {

/// The streaming form of XXH64 with seed 0; step numbers are those of the specification.
class Xxh64 {
  public:
    Xxh64();
    void add(std::span<const std::byte> bytes);
    std::uint64_t finish() const;

  private:
    static constexpr std::size_t stripe = 32;

    void add_stripe(const std::byte* bytes);
    std::uint64_t converged() const;

    std::array<std::uint64_t, 4> accumulators_;
    std::array<std::byte, stripe> pending_{};
    std::size_t num_pending_ = 0;
    std::uint64_t total_ = 0;
};

/// XXH64 with seed 0 (xxHash specification, Y. Collet): tells files apart at the speed of memory,
/// and `xxh64sum FILE` gives the same number. It is no protection against forgery.
std::uint64_t hash_bytes(std::span<const std::byte> bytes);

/// The same of a file's content, read in pieces. Throws IoError if the file cannot be read.
std::uint64_t hash_file(const std::filesystem::path& path);

}  // namespace roomscribe
