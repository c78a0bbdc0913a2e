// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace roomscribe::fuzz {

/// Something that reads bytes from strangers.
struct Target {
    std::string_view name;  ///< of the reader, and of its folder in fuzz/corpus
    /// Reads the bytes as a file. Returns if they are read or refused with the error that is meant
    /// for it; anything else that is thrown is a fault.
    void (*read)(std::span<const std::byte> bytes);
    /// Small files to begin with, made by our writers.
    std::vector<std::string> (*make_seeds)();
};

/// The readers of files and of our own JSON.
std::span<const Target> targets();

/// The settings file. Apart, because it needs the whole library and the others do not.
const Target& settings_target();

/// Throws std::out_of_range if there is none.
const Target& target_of(std::string_view name);

/// The kept inputs of a target, each of which was a fault once: fuzz/corpus/<name>/*.hex, the bytes
/// in hexadecimal with any blanks between them.
std::vector<std::string> kept_inputs(std::string_view name);

/// The path of a file of this process alone, in memory where the machine has such a folder; the
/// second writes it.
std::filesystem::path scratch_file(std::string_view name);
std::filesystem::path scratch_file(std::string_view name, std::span<const std::byte> bytes);

}  // namespace roomscribe::fuzz
