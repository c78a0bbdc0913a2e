// SPDX-License-Identifier: MIT
#include "roomscribe/io/png_depth.hpp"

#include <algorithm>
#include <bit>
#include <csetjmp>
#include <cstring>
#include <new>
#include <string>

#include <fmt/format.h>
#include <png.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/io/byte_reader.hpp"

namespace roomscribe {
namespace {

constexpr std::string_view cure = "give a PNG of one channel of 16 bits, 0 where there is no depth";
/// What deflate makes of one byte at most.
constexpr std::size_t largest_unpacking = 1032;
constexpr std::size_t signature_bytes = 8;

/// What libpng's callbacks share. It jumps out of an error, so nothing here has a destructor that
/// matters to it.
struct Source {
    std::span<const std::byte> bytes;
    std::size_t position = 0;
    char message[80] = {};
};

void take_bytes(png_structp png, png_bytep target, std::size_t size) {
    auto& source = *static_cast<Source*>(png_get_io_ptr(png));
    if (size > source.bytes.size() - source.position) png_error(png, "it is cut off");
    std::memcpy(target, source.bytes.data() + source.position, size);
    source.position += size;
}

[[noreturn]] void keep_message(png_structp png, png_const_charp message) {
    auto& source = *static_cast<Source*>(png_get_error_ptr(png));
    const std::size_t size = std::min(std::strlen(message), sizeof(source.message) - 1);
    std::memcpy(source.message, message, size);
    png_longjmp(png, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

struct Reader {
    png_structp png = nullptr;
    png_infop info = nullptr;
    explicit Reader(Source& source)
        : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, keep_message, ignore_warning)),
          info(png != nullptr ? png_create_info_struct(png) : nullptr) {}
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;
    ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

/// False if libpng found an error, which is in the source then.
bool read_header(const Reader& reader, Source& source) {
    if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
    png_set_read_fn(reader.png, &source, take_bytes);
    png_read_info(reader.png, reader.info);
    return true;
}

bool read_pixels(const Reader& reader, png_bytep pixels, std::size_t rows, int passes,
                 std::size_t row_bytes) {
    if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
    for (int pass = 0; pass < passes; ++pass) {
        for (std::size_t row = 0; row < rows; ++row)
            png_read_row(reader.png, pixels + row * row_bytes, nullptr);
    }
    png_read_end(reader.png, nullptr);
    return true;
}

}  // namespace

DepthPixels read_depth_png(const std::filesystem::path& path) {
    const MappedFile file(path, "depth image");
    Source source{file.bytes()};
    const auto fail = [&](const std::string& reason) {
        throw IoError(file.path(), "depth image", {.byte = source.position, .line = {}}, reason,
                      std::string(cure));
    };
    const auto* const first = reinterpret_cast<png_const_bytep>(file.bytes().data());
    if (file.bytes().size() < signature_bytes || png_sig_cmp(first, 0, signature_bytes) != 0) {
        fail("it does not begin as a PNG does");
    }
    const Reader reader(source);
    if (reader.info == nullptr) throw std::bad_alloc();
    if (!read_header(reader, source)) fail(source.message);
    DepthPixels image;
    image.rows = png_get_image_height(reader.png, reader.info);
    image.columns = png_get_image_width(reader.png, reader.info);
    const unsigned bits = png_get_bit_depth(reader.png, reader.info);
    if (bits != 16 || png_get_color_type(reader.png, reader.info) != PNG_COLOR_TYPE_GRAY) {
        fail(fmt::format("it has {} channels of {} bits", png_get_channels(reader.png, reader.info),
                         bits));
    }
    if (image.rows * image.columns * 2 > largest_unpacking * file.bytes().size()) {
        fail(fmt::format("its {} bytes cannot hold {} x {} pixels", file.bytes().size(),
                         image.columns, image.rows));
    }
    if (std::endian::native == std::endian::little) png_set_swap(reader.png);
    const int passes = png_set_interlace_handling(reader.png);
    image.depths.resize(image.rows * image.columns);
    if (!read_pixels(reader, reinterpret_cast<png_bytep>(image.depths.data()), image.rows, passes,
                     2 * image.columns)) {
        fail(source.message);
    }
    return image;
}

}  // namespace roomscribe
