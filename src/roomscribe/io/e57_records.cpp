// SPDX-License-Identifier: MIT
#include "roomscribe/io/e57_records.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "roomscribe/io/byte_reader.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t word_bytes = sizeof(std::uint64_t);

template <typename Value>
Value load_little(const std::byte* bytes) {
    Value value;
    std::memcpy(&value, bytes, sizeof(Value));
    return std::endian::native == std::endian::little ? value : swap_bytes(value);
}

}  // namespace

unsigned E57Element::bits() const {
    switch (kind) {
        case Kind::float32:
            return 32;
        case Kind::float64:
            return 64;
        case Kind::integer:
        case Kind::scaled_integer:
            break;
    }
    const auto range = static_cast<std::uint64_t>(maximum) - static_cast<std::uint64_t>(minimum);
    return static_cast<unsigned>(std::bit_width(range));
}

void E57Stream::append(std::span<const std::byte> bytes) {
    if (!bytes_.empty()) bytes_.resize(bytes_.size() - word_bytes);
    // What is decoded is dropped.
    const std::size_t used = position_ / 8;
    bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(used));
    position_ -= 8 * used;
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    bytes_.resize(bytes_.size() + word_bytes);
}

void E57Stream::decode(std::vector<double>& values, std::size_t max_count) {
    const unsigned bits = element_.bits();
    if (bits == 0) {
        values.insert(values.end(), max_count,
                      static_cast<double>(element_.minimum) * element_.scale + element_.offset);
        return;
    }
    if (bytes_.empty()) return;
    const std::size_t arrived = 8 * (bytes_.size() - word_bytes) - position_;
    const std::size_t count = std::min(max_count, arrived / bits);
    if (element_.kind == E57Element::Kind::float32 || element_.kind == E57Element::Kind::float64) {
        decode_floats(values, count);
    } else {
        decode_integers(values, count);
    }
    position_ += count * bits;
}

void E57Stream::decode_floats(std::vector<double>& values, std::size_t count) {
    const std::byte* const first = bytes_.data() + position_ / 8;
    const bool single = element_.kind == E57Element::Kind::float32;
    for (std::size_t i = 0; i < count; ++i) {
        values.push_back(single ? static_cast<double>(load_little<float>(first + 4 * i))
                                : load_little<double>(first + 8 * i));
    }
}

void E57Stream::decode_integers(std::vector<double>& values, std::size_t count) {
    const unsigned bits = element_.bits();
    const std::uint64_t mask = bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
    const auto minimum = static_cast<std::uint64_t>(element_.minimum);
    std::size_t position = position_;
    for (std::size_t i = 0; i < count; ++i, position += bits) {
        const std::byte* const place = bytes_.data() + position / 8;
        const unsigned skipped = position % 8;
        std::uint64_t word = load_little<std::uint64_t>(place) >> skipped;
        if (skipped + bits > 64) {
            word |= std::to_integer<std::uint64_t>(place[word_bytes]) << (64 - skipped);
        }
        const auto value = static_cast<std::int64_t>((word & mask) + minimum);
        values.push_back(static_cast<double>(value) * element_.scale + element_.offset);
    }
}

}  // namespace roomscribe
