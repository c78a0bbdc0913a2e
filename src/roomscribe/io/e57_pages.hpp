// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/io/atomic_file.hpp"
#include "roomscribe/io/byte_reader.hpp"

namespace roomscribe {

// An E57 file is pages of 1024 bytes, the last 4 of which are the checksum of the others. The bytes
// without the checksums, one behind another, are the logical file. Places are physical in headers
// and XML, lengths are logical.
// Source: ASTM E2807-11, section 6.

inline constexpr std::size_t e57_page_bytes = 1024;
inline constexpr std::size_t e57_page_content = e57_page_bytes - 4;

/// CRC-32C (Castagnoli).
std::uint32_t crc32c(std::span<const std::byte> bytes);

std::uint64_t e57_physical(std::uint64_t logical);

/// The logical file.
class E57Pages {
  public:
    /// Throws IoError, which names the damaged pages, unless the checksums of all are right.
    E57Pages(const MappedFile& file, const Context& context);

    std::uint64_t size() const { return size_; }
    /// Throws IoError for a place outside the file or in a checksum.
    std::uint64_t logical(std::uint64_t physical) const;
    /// Copies the bytes from `logical` on. Throws IoError if there are not as many.
    void read(std::uint64_t logical, std::span<std::byte> target) const;
    template <typename Value>
    Value read_value(std::uint64_t logical) const {
        Value value;
        read(logical, std::as_writable_bytes(std::span(&value, 1)));
        return std::endian::native == std::endian::little ? value : swap_bytes(value);
    }
    /// Gives the memory back that what stands from `first` to `last` takes.
    void let_go(std::uint64_t first, std::uint64_t last) const;
    [[noreturn]] void fail(std::uint64_t logical, std::string_view reason) const;

  private:
    const MappedFile& file_;
    std::uint64_t size_ = 0;
};

/// Writes the logical file from front to back.
class E57PageWriter {
  public:
    explicit E57PageWriter(AtomicFile& file) : file_(file) {}
    void write(std::span<const std::byte> bytes);
    void write(std::string_view text);
    /// Fills the last page with zeros.
    void finish();

  private:
    void write_page();

    AtomicFile& file_;
    std::vector<std::byte> page_;
};

}  // namespace roomscribe
