// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace roomscribe {

/// XXH64 with seed 0 (xxHash specification, Y. Collet): tells files apart at the speed of memory,
/// and `xxh64sum FILE` gives the same number. It is no protection against forgery.
std::uint64_t hash_bytes(std::span<const std::byte> bytes);

/// The same of a file's content, read in pieces. Throws IoError if the file cannot be read.
std::uint64_t hash_file(const std::filesystem::path& path);

}  // namespace roomscribe
