// SPDX-License-Identifier: MIT
#include "support/depth_png.hpp"

#include <vector>

#include <png.h>

namespace roomscribe::test {

std::string depth_png(std::size_t rows, std::size_t columns,
                      std::span<const std::uint16_t> values) {
    std::string bytes;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    const auto append = [](png_structp writer, png_bytep data, std::size_t size) {
        static_cast<std::string*>(png_get_io_ptr(writer))
            ->append(reinterpret_cast<const char*>(data), size);
    };
    png_set_write_fn(png, &bytes, append, nullptr);
    png_set_IHDR(png, info, static_cast<png_uint_32>(columns), static_cast<png_uint_32>(rows), 16,
                 PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    for (std::size_t row = 0; row < rows; ++row) {
        std::vector<png_byte> line;
        for (const std::uint16_t value : values.subspan(row * columns, columns)) {
            line.push_back(static_cast<png_byte>(value >> 8U));
            line.push_back(static_cast<png_byte>(value & 0xffU));
        }
        png_write_row(png, line.data());
    }
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    return bytes;
}

}  // namespace roomscribe::test
