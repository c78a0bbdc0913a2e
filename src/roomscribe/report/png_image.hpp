// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace roomscribe {

/// Red, green, blue, opacity (not premultiplied).
using Pixel = std::array<std::uint8_t, 4>;

/// Rows from the top, each from the left. A new image is transparent.
struct Image {
    std::size_t width = 0;
    std::size_t height = 0;
    std::vector<Pixel> pixels;

    Image() = default;
    Image(std::size_t image_width, std::size_t image_height)
        : width(image_width), height(image_height), pixels(image_width * image_height) {}

    Pixel& at(std::size_t row, std::size_t column) { return pixels[row * width + column]; }
    const Pixel& at(std::size_t row, std::size_t column) const {
        return pixels[row * width + column];
    }
};

/// The image as a PNG file in memory. Throws InvalidArgument for an image without pixels.
std::vector<std::byte> encode_png(const Image& image);

/// Writes a PNG file, whole or not at all. Throws IoError if it cannot be written.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace roomscribe
