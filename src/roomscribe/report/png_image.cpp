// SPDX-License-Identifier: MIT
#include "roomscribe/report/png_image.hpp"

#include <fmt/format.h>
#include <png.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/io/atomic_file.hpp"

namespace roomscribe {

std::vector<std::byte> encode_png(const Image& image) {
    if (image.pixels.empty() || image.pixels.size() != image.width * image.height) {
        throw InvalidArgument("image", fmt::format("{} x {}", image.width, image.height),
                              "an image with width x height pixels");
    }
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    header.width = static_cast<png_uint_32>(image.width);
    header.height = static_cast<png_uint_32>(image.height);
    header.format = PNG_FORMAT_RGBA;

    std::vector<std::byte> file(PNG_IMAGE_PNG_SIZE_MAX(header));
    png_alloc_size_t size = file.size();
    const int done =
        png_image_write_to_memory(&header, file.data(), &size, 0, image.pixels.data(), 0, nullptr);
    if (done == 0) throw InvalidArgument("image", header.message, "an image that PNG can hold");
    file.resize(size);
    return file;
}

void write_png(const std::filesystem::path& path, const Image& image) {
    const std::vector<std::byte> content = encode_png(image);
    AtomicFile file(path, "PNG");
    file.write(content);
    file.commit();
}

}  // namespace roomscribe
