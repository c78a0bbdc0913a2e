// SPDX-License-Identifier: MIT
#include "roomscribe/report/cloud_picture.hpp"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/random.hpp"

namespace roomscribe {
namespace {

constexpr Pixel red{255, 0, 0, 255};
constexpr Pixel blue{0, 0, 255, 255};

CloudView square_view(std::size_t width) {
    CloudView view;
    view.low = {0, 0, 0};
    view.high = {10, 5, 2};
    view.width = width;
    return view;
}

bool is_empty(const Pixel& pixel) {
    return pixel[3] == 0;
}

TEST(DrawCloud, PutsAPointWhereItBelongs) {
    const std::vector<Eigen::Vector3f> points{{0.5F, 4.5F, 2.0F}, {9.5F, 0.5F, 2.0F}};
    const Image image = draw_cloud(
        points, [](std::size_t i) { return i == 0 ? red : blue; }, square_view(10));
    ASSERT_EQ(image.width, 10U);
    ASSERT_EQ(image.height, 5U);
    EXPECT_EQ(image.at(0, 0), red);  // y runs up
    EXPECT_EQ(image.at(4, 9), blue);
    EXPECT_TRUE(is_empty(image.at(2, 5)));
}

TEST(DrawCloud, ShowsTheNearestAndOnEqualDepthTheFirst) {
    const std::vector<Eigen::Vector3f> points{
        {5.5F, 2.5F, 0.5F}, {5.5F, 2.5F, 2.0F}, {1.5F, 2.5F, 1.0F}, {1.5F, 2.5F, 1.0F}};
    const Image image = draw_cloud(
        points, [](std::size_t i) { return i == 1 || i == 2 ? blue : red; }, square_view(10));
    EXPECT_EQ(image.at(2, 5)[2], 255);
    EXPECT_EQ(image.at(2, 1)[2], 255);
}

TEST(DrawCloud, LeavesOutWhatIsNotToBeSeen) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr float inf = std::numeric_limits<float>::infinity();
    const std::vector<Eigen::Vector3f> points{
        {nan, 1, 1}, {inf, 1, 1}, {-inf, nan, 1}, {5, 2, 2.5F}, {5, 2, -1}, {11, 2, 1}, {5, 2, 1}};
    for (const PictureStyle style : {PictureStyle::surface, PictureStyle::density}) {
        const Image image = draw_cloud(
            points, [](std::size_t i) { return i == 6 ? Pixel{} : red; }, square_view(20), style);
        for (const Pixel& pixel : image.pixels)
            EXPECT_TRUE(is_empty(pixel));
    }
}

TEST(DrawCloud, ClosesTheGapsOfASurfaceButNotItsSurroundings) {
    std::vector<Eigen::Vector3f> points;  // every third pixel of the left half
    for (int x = 0; x < 50; x += 3) {
        for (int y = 0; y < 50; y += 3) {
            points.emplace_back(0.1F * (static_cast<float>(x) + 0.5F),
                                0.1F * (static_cast<float>(y) + 0.5F), 1.0F);
        }
    }
    const Image image = draw_cloud(
        points, [](std::size_t) { return red; }, square_view(100));
    for (std::size_t row = 5; row < 45; ++row) {
        for (std::size_t column = 5; column < 45; ++column) {
            EXPECT_FALSE(is_empty(image.at(row, column))) << row << ", " << column;
        }
        EXPECT_TRUE(is_empty(image.at(row, 55)));
    }
}

TEST(DrawCloud, MakesDensePlacesMoreOpaqueAndMixesColors) {
    std::vector<Eigen::Vector3f> points(200, Eigen::Vector3f(2.5F, 2.5F, 1.0F));
    points.emplace_back(7.5F, 2.5F, 1.0F);
    const Image image = draw_cloud(
        points, [](std::size_t i) { return i % 2 == 0 ? red : blue; }, square_view(10),
        PictureStyle::density);
    EXPECT_GT(image.at(2, 2)[3], image.at(2, 7)[3]);
    EXPECT_GT(image.at(2, 7)[3], 0);
    EXPECT_EQ(image.at(2, 2)[0], image.at(2, 2)[2]);
}

TEST(DrawCloud, GivesTheSameBitsOnAnyNumberOfThreads) {
    Random random(3);
    std::vector<Eigen::Vector3f> points;
    for (int i = 0; i < 300'000; ++i) {
        points.emplace_back(static_cast<float>(random.uniform(0, 10)),
                            static_cast<float>(random.uniform(0, 5)),
                            static_cast<float>(random.below(8)) / 4.0F);
    }
    const PointColor color = [](std::size_t i) {
        return Pixel{static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i >> 8U), 9, 255};
    };
    Context one_thread;
    one_thread.num_threads = 1;
    Context four_threads;
    four_threads.num_threads = 4;
    for (const PictureStyle style : {PictureStyle::surface, PictureStyle::density}) {
        const Image one = draw_cloud(points, color, square_view(400), style, one_thread);
        const Image four = draw_cloud(points, color, square_view(400), style, four_threads);
        EXPECT_EQ(one.pixels, four.pixels);
    }
}

TEST(DrawCloud, RefusesAViewWithoutExtent) {
    CloudView flat = square_view(10);
    flat.high.z() = flat.low.z();
    EXPECT_THROW(draw_cloud({}, {}, flat), InvalidArgument);
    EXPECT_THROW(draw_cloud({}, {}, square_view(0)), InvalidArgument);
    CloudView tall = square_view(1000);
    tall.high.y() = 1e6;
    EXPECT_THROW(draw_cloud({}, {}, tall), InvalidArgument);
}

}  // namespace
}  // namespace roomscribe
