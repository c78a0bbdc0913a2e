// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace roomscribe {

/// A file that appears under its name whole or not at all: it is written under a temporary name in
/// the same folder and renamed by commit(). Without commit() nothing is left behind, and an older
/// file of that name stays. A symbolic link is followed, so that the file it names is replaced.
/// Every function throws IoError, with the system's reason, when the disk refuses.
class AtomicFile {
  public:
    /// `format` is for messages: "PLY". Throws IoError if the path is a folder, a device or the
    /// like, or lies in a folder that is not there or not writable.
    AtomicFile(std::filesystem::path path, std::string_view format);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(std::span<const std::byte> bytes);
    void write(std::string_view text);

    /// Flushes and renames. Call it once, last.
    void commit();

  private:
    void write_through(const std::byte* bytes, std::size_t size);
    void flush();
    [[noreturn]] void fail(std::string_view action) const;

    std::filesystem::path path_;
    std::filesystem::path temporary_;
    std::string format_;
    std::vector<std::byte> buffer_;
    int descriptor_ = -1;
};

/// The usual case: a whole file from memory.
void write_file(const std::filesystem::path& path, std::string_view format,
                std::string_view content);

/// Removes from a folder the temporary files of AtomicFile whose process was killed and is gone.
void remove_abandoned_files(const std::filesystem::path& folder);

}  // namespace roomscribe
