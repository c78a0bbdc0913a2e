// SPDX-License-Identifier: MIT
#include "roomscribe/io/strided_copy.hpp"

#include <cstdint>
#include <cstring>

#include "roomscribe/io/byte_reader.hpp"

namespace roomscribe {
namespace {

/// A size known to the compiler makes each copy one or two moves.
template <std::size_t size>
void copy_groups(std::byte* target, std::size_t target_stride, const std::byte* source,
                 std::size_t source_stride, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        std::memcpy(target + i * target_stride, source + i * source_stride, size);
    }
}

template <typename Bits>
void copy_swapped(std::byte* target, std::size_t target_stride, const std::byte* source,
                  std::size_t source_stride, std::size_t values_per_group, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t k = 0; k < values_per_group; ++k) {
            Bits bits;
            std::memcpy(&bits, source + i * source_stride + k * sizeof(Bits), sizeof(Bits));
            bits = swap_bytes(bits);
            std::memcpy(target + i * target_stride + k * sizeof(Bits), &bits, sizeof(Bits));
        }
    }
}

}  // namespace

void copy_values(std::byte* target, std::size_t target_stride, const std::byte* source,
                 std::size_t source_stride, std::size_t value_size, std::size_t values_per_group,
                 std::size_t count, bool swap) {
    const std::size_t size = value_size * values_per_group;
    if (swap && value_size > 1) {
        const auto copy = value_size == 2   ? copy_swapped<std::uint16_t>
                          : value_size == 4 ? copy_swapped<std::uint32_t>
                                            : copy_swapped<std::uint64_t>;
        copy(target, target_stride, source, source_stride, values_per_group, count);
        return;
    }
    if (target_stride == size && source_stride == size) {
        if (count > 0) std::memcpy(target, source, size * count);
        return;
    }
    switch (size) {
        case 1:
            return copy_groups<1>(target, target_stride, source, source_stride, count);
        case 2:
            return copy_groups<2>(target, target_stride, source, source_stride, count);
        case 3:
            return copy_groups<3>(target, target_stride, source, source_stride, count);
        case 4:
            return copy_groups<4>(target, target_stride, source, source_stride, count);
        case 8:
            return copy_groups<8>(target, target_stride, source, source_stride, count);
        case 12:
            return copy_groups<12>(target, target_stride, source, source_stride, count);
        case 24:
            return copy_groups<24>(target, target_stride, source, source_stride, count);
        default:
            break;
    }
    for (std::size_t i = 0; i < count; ++i) {
        std::memcpy(target + i * target_stride, source + i * source_stride, size);
    }
}

}  // namespace roomscribe
