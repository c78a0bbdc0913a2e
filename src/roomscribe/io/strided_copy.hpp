// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace roomscribe {

/// Copies `count` groups of `values_per_group` values of `value_size` bytes, from one every
/// `source_stride` bytes to one every `target_stride`, and turns the bytes of each value round if
/// `swap`. Strides are at least a group; ranges do not overlap.
void copy_values(std::byte* target, std::size_t target_stride, const std::byte* source,
                 std::size_t source_stride, std::size_t value_size, std::size_t values_per_group,
                 std::size_t count, bool swap);

}  // namespace roomscribe
