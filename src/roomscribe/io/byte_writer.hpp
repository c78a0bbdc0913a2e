// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <string>
#include <string_view>

#include "roomscribe/io/byte_reader.hpp"

namespace roomscribe {

/// Bytes of a header, put one value behind another, little endian.
class ByteWriter {
  public:
    template <typename Value>
    void add(Value value) {
        if constexpr (std::endian::native == std::endian::big) value = swap_bytes(value);
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof(Value));
    }
    /// Text that fills `size` bytes: cut off, or with zeros behind it.
    void add_text(std::string_view text, std::size_t size) {
        bytes_ += text.substr(0, size);
        bytes_.append(size - std::min(size, text.size()), '\0');
    }
    const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
};

}  // namespace roomscribe
