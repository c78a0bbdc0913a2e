// SPDX-License-Identifier: MIT
#include "roomscribe/report/png_image.hpp"

#include <filesystem>

#include <gtest/gtest.h>
#include <png.h>

#include "roomscribe/core/error.hpp"
#include "support/test_data.hpp"

namespace roomscribe {
namespace {

Image small_image() {
    Image image(3, 2);
    image.at(0, 0) = {255, 0, 0, 255};
    image.at(0, 2) = {1, 2, 3, 4};
    image.at(1, 1) = {9, 8, 7, 128};
    return image;
}

TEST(EncodePng, IsReadBackByLibpng) {
    const Image image = small_image();
    const std::vector<std::byte> file = encode_png(image);
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_memory(&header, file.data(), file.size()), 0);
    EXPECT_EQ(header.width, 3U);
    EXPECT_EQ(header.height, 2U);
    header.format = PNG_FORMAT_RGBA;
    std::vector<Pixel> pixels(6);
    ASSERT_NE(png_image_finish_read(&header, nullptr, pixels.data(), 0, nullptr), 0);
    EXPECT_EQ(pixels, image.pixels);
}

TEST(EncodePng, RefusesAnImageWithoutPixels) {
    EXPECT_THROW(encode_png({}), InvalidArgument);
    Image broken = small_image();
    broken.pixels.pop_back();
    EXPECT_THROW(encode_png(broken), InvalidArgument);
}

TEST(WritePng, WritesTheFileOrThrows) {
    const test::TemporaryFolder folder;
    write_png(folder / "a.png", small_image());
    EXPECT_EQ(std::filesystem::file_size(folder / "a.png"), encode_png(small_image()).size());
    EXPECT_THROW(write_png(folder / "absent/a.png", small_image()), IoError);
}

}  // namespace
}  // namespace roomscribe
