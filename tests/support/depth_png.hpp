// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace roomscribe::test {

/// The bytes of a PNG of one channel of 16 bits. Precondition: rows * columns values.
std::string depth_png(std::size_t rows, std::size_t columns, std::span<const std::uint16_t> values);

}  // namespace roomscribe::test
