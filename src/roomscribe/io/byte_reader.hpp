// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace roomscribe {

/// The bytes of a regular file, mapped into memory and read when touched. The file must not be
/// shortened by others meanwhile (files replaced by a rename, as AtomicFile does, are safe).
class MappedFile {
  public:
    /// Throws IoError if the file is missing, unreadable, empty, or no regular file.
    MappedFile(const std::filesystem::path& path, std::string_view format);
    ~MappedFile();
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    std::span<const std::byte> bytes() const { return {data_, size_}; }
    std::string_view text() const { return {reinterpret_cast<const char*>(data_), size_}; }
    const std::string& path() const { return path_; }

  private:
    std::string path_;
    const std::byte* data_ = nullptr;
    std::size_t size_ = 0;
};

/// Who walks through a MappedFile lets go of what lies behind in pieces of so many bytes: each time
/// has its price.
inline constexpr std::size_t bytes_let_go_at_once = 1U << 24U;

/// Gives the memory back that bytes of a MappedFile take once they were touched: a file may be
/// larger than memory. They may be touched again, and are then read again.
void let_go(std::span<const std::byte> mapped);

/// `value` with its bytes in the other order.
template <typename Value>
Value swap_bytes(Value value) {
    std::byte bytes[sizeof(Value)];
    std::memcpy(bytes, &value, sizeof(Value));
    for (std::size_t i = 0; i < sizeof(Value) / 2; ++i) {
        const std::byte low = bytes[i];
        bytes[i] = bytes[sizeof(Value) - 1 - i];
        bytes[sizeof(Value) - 1 - i] = low;
    }
    std::memcpy(&value, bytes, sizeof(Value));
    return value;
}

/// Walks a file from front to back and never past its end, and lets go of what lies far behind.
/// Everything that is asked for and not
/// there throws IoError with path, format and place.
class ByteReader {
  public:
    ByteReader(const MappedFile& file, std::string_view format)
        : bytes_(file.bytes()), path_(file.path()), format_(format) {}

    std::size_t position() const { return position_; }
    std::size_t remaining() const { return bytes_.size() - position_; }
    bool at_end() const { return remaining() == 0; }

    /// The next `size` bytes.
    std::span<const std::byte> take(std::size_t size);

    /// The next value, which stands in the file in the given byte order.
    template <typename Value>
    Value read(std::endian order = std::endian::little) {
        Value value;
        std::memcpy(&value, take(sizeof(Value)).data(), sizeof(Value));
        return order == std::endian::native ? value : swap_bytes(value);
    }

    /// The next line without its end ("\n" or "\r\n"); the last one may lack the end. Headers are
    /// read with this: a line of more than 64 KiB is refused.
    std::string_view read_line();

    /// The whole file as text.
    std::string_view whole_text() const {
        return {reinterpret_cast<const char*>(bytes_.data()), bytes_.size()};
    }
    /// All that is left, as text; leaves the position alone.
    std::string_view remaining_text() const;
    /// Goes on behind `size` bytes of what is left. Precondition: size <= remaining().
    void skip(std::size_t size) { pass(size); }

    /// Throws IoError that names the present byte, the line that was read last, or the line in
    /// which the byte at `position` stands.
    [[noreturn]] void fail_at_byte(std::string_view reason, std::string_view cure) const;
    [[noreturn]] void fail_at_line(std::string_view reason, std::string_view cure) const;
    [[noreturn]] void fail_at_line_of(std::size_t position, std::string_view reason,
                                      std::string_view cure) const;

    /// Throws IoError at the last line read if `count` items of at least `min_bytes` bytes (>= 1)
    /// cannot stand in what is left of the file, or exceed 2^32 - 1: a header that promises more
    /// than there is must not make anyone allocate.
    void require_backed(std::uint64_t count, std::uint64_t min_bytes, std::string_view what) const;
    /// The same for headers that are no text: the error names the present byte.
    void require_backed_at_byte(std::uint64_t count, std::uint64_t min_bytes,
                                std::string_view what) const;

  private:
    void pass(std::size_t size);
    /// Why that is refused; empty if nothing is wrong.
    std::string unbacked(std::uint64_t count, std::uint64_t min_bytes, std::string_view what) const;

    std::span<const std::byte> bytes_;
    std::string path_;
    std::string format_;
    std::size_t position_ = 0;
    std::size_t held_ = 0;       ///< what lies before was let go
    std::size_t last_line_ = 0;  ///< where the line begins that was read last
};

}  // namespace roomscribe
