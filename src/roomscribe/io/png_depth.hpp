// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace roomscribe {

/// The pixels of a depth image, row after row from the top.
struct DepthPixels {
    std::size_t rows = 0;
    std::size_t columns = 0;
    std::vector<std::uint16_t> depths;
};

/// Reads a PNG of one channel of 16 bits. Throws IoError for any other, a damaged one, and one that
/// claims more pixels than its bytes can unpack to.
DepthPixels read_depth_png(const std::filesystem::path& path);

}  // namespace roomscribe
