// SPDX-License-Identifier: MIT
#include "roomscribe/registration/range_image/range_image.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "range_scene.hpp"
#include "roomscribe/core/error.hpp"
#include "support/contexts.hpp"
#include "support/matchers.hpp"

namespace roomscribe {
namespace {

TEST(RangeProjection, PixelOfADirectionIsThePixelThatLooksThere) {
    RangeProjection projection{.first_x = -1.1, .step_x = 0.02, .first_y = -0.7, .step_y = 0.015};
    projection.cloud_from_polar << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    for (const auto kind :
         {RangeProjection::Kind::sinusoidal, RangeProjection::Kind::longitude_by_column,
          RangeProjection::Kind::longitude_by_row}) {
        projection.kind = kind;
        for (const Eigen::Vector2d& pixel :
             {Eigen::Vector2d(0, 0), Eigen::Vector2d(31.5, 7.25), Eigen::Vector2d(90, 80)}) {
            const Eigen::Vector3d direction = projection.direction(pixel.x(), pixel.y());
            EXPECT_NEAR(direction.norm(), 1.0, 1e-12);
            EXPECT_THAT(projection.pixel(3.0 * direction), test::VectorNear(pixel, 1e-9));
        }
    }
}

/// The outermost pixels may only repeat the ranges beside them.
bool is_inside(const RangeImage& image, std::size_t pixel) {
    const int x = image.column(pixel);
    const int y = image.row(pixel);
    return std::min(x, y) > 12 && x < image.width - 13 && y < image.height - 13;
}

TEST(MakeRangeImage, HasTheRangesOfTheScene) {
    const RangeImage image = make_range_image(test::panel_scene(), test::scene_settings());
    EXPECT_NEAR(image.width, 122, 1);
    EXPECT_NEAR(image.height, 122, 1);
    for (std::size_t i = 0; i < image.size(); ++i) {
        if (!is_inside(image, i)) continue;
        ASSERT_TRUE(image.has_range(i));
        EXPECT_NEAR(image.points[i].norm(), image.ranges[i], 1e-5);
        const float x = image.points[i].x();
        EXPECT_NEAR(x, x < 3.0F ? 2.0F : 4.0F, 1e-4);
    }
    EXPECT_NEAR(image.points[test::pixel_at(image, {2, 0.3, 0.3})].x(), 2.0F, 1e-4);
    EXPECT_NEAR(image.points[test::pixel_at(image, {4, 1.5, 1.5})].x(), 4.0F, 1e-4);
    // The first row is the upper one, the first column on the left.
    EXPECT_GT(image.points.front().z(), 1.0F);
    EXPECT_GT(image.points.front().y(), 1.0F);
}

TEST(MakeRangeImage, NearestPointOfAPixelCounts) {
    Scan scan = test::wall_scene();
    const std::size_t count = scan.cloud.size();
    for (std::size_t i = 0; i < count; ++i) {
        scan.cloud.positions.emplace_back(0.5F * scan.cloud.positions[i]);
        scan.cloud.positions.emplace_back(2.0F * scan.cloud.positions[i]);
    }
    const RangeImage image = make_range_image(scan, test::scene_settings());
    for (std::size_t i = 0; i < image.size(); ++i) {
        if (is_inside(image, i)) {
            EXPECT_NEAR(image.points[i].x(), 2.0F, 1e-4);
        }
    }
}

TEST(MakeRangeImage, KeepsUnseenPixelsApart) {
    const Scan scan = test::scan_scene([](const Eigen::Vector3d& direction) {
        return direction.y() > 0.2 && direction.z() > 0.2 ? NAN : test::range_to_wall(direction);
    });
    const RangeImage image = make_range_image(scan, test::scene_settings());
    const std::uint32_t unseen = test::pixel_at(image, {4, 1.6, 1.6});
    EXPECT_EQ(image.ranges[unseen], RangeImage::unobserved);
    EXPECT_TRUE(image.points[unseen].hasNaN());
    EXPECT_FALSE(image.has_range(-1, 0));
    EXPECT_FALSE(image.has_range(image.width, 0));
}

TEST(MakeRangeImage, StandsWhereTheSensorStood) {
    Scan scan = test::panel_scene();
    const RangeImage expected = make_range_image(scan, test::scene_settings());
    const Transform pose = Transform(Eigen::Translation3d(3, -2, 1)) *
                           Eigen::AngleAxisd(1.0, Eigen::Vector3d(1, 2, 3).normalized());
    scan.cloud.sensor_pose = Transform::Identity();
    transform_in_place(scan.cloud, pose);
    const RangeImage image = make_range_image(scan, test::scene_settings());
    for (const Eigen::Vector3d& point :
         {Eigen::Vector3d(2, 0.3, -0.2), Eigen::Vector3d(4, 1.4, 0.5),
          Eigen::Vector3d(4, -1, -1)}) {
        const std::uint32_t before = test::pixel_at(expected, point);
        const std::uint32_t after = test::pixel_at(image, pose * point);
        EXPECT_NEAR(image.ranges[after], expected.ranges[before], 1e-4);
        EXPECT_THAT(image.points[after].cast<double>(),
                    test::VectorNear(pose * expected.points[before].cast<double>(), 1e-4));
    }
}

TEST(MakeRangeImage, FindsAResolutionWithoutHoles) {
    const RangeImage image = make_range_image(test::wall_scene());
    EXPECT_GE(image.projection.step_x, 0.95 * test::scene_resolution);
    EXPECT_LE(image.projection.step_x, 1.6 * test::scene_resolution);
    for (std::size_t i = 0; i < image.size(); ++i)
        EXPECT_TRUE(image.has_range(i) || image.row(i) == 0 || image.row(i) == image.height - 1 ||
                    image.column(i) < 12 || image.column(i) > image.width - 13);
}

/// A scan with its grid: rows are elevations from above, columns azimuths from the left.
Scan grid_scan(double row_warp) {
    Scan scan;
    scan.cloud.grid = ScanGrid{60, 100};
    for (int row = 0; row < 60; ++row) {
        for (int column = 0; column < 100; ++column) {
            const double elevation = radians(15.0 - 0.5 * row + row_warp * row * row);
            const double azimuth = radians(25.0 - 0.5 * column);
            const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                            std::cos(elevation) * std::sin(azimuth),
                                            std::sin(elevation));
            const bool is_sky = row > 20 && row < 30 && column > 40 && column < 60;
            const bool is_dropout = row == 5 && column == 5;
            scan.cloud.positions.emplace_back(
                is_sky || is_dropout
                    ? Eigen::Vector3f::Constant(NAN)
                    : Eigen::Vector3f((4.0 / direction.x() * direction).cast<float>()));
        }
    }
    return scan;
}

TEST(MakeRangeImage, TakesTheScannersOwnGrid) {
    const Scan scan = grid_scan(0.0);
    const RangeImage image = make_range_image(scan, {.source = RangeImageSource::grid});
    ASSERT_EQ(image.source, RangeImageSource::grid);
    ASSERT_EQ(image.width, 100);
    ASSERT_EQ(image.height, 60);
    EXPECT_EQ(image.ranges[image.index(50, 25)], RangeImage::far);
    EXPECT_EQ(image.ranges[image.index(5, 5)], RangeImage::unobserved);
    for (std::size_t i = 0; i < image.size(); ++i) {
        if (!image.has_range(i)) continue;
        EXPECT_EQ(image.points[i], scan.cloud.positions[i]);
        const Eigen::Vector3d ray = image.projection.direction(image.column(i), image.row(i));
        EXPECT_THAT(ray, test::VectorNear(image.points[i].cast<double>().normalized(), 1e-4));
    }
    const RangeImage halved = make_range_image(
        scan, {.source = RangeImageSource::grid, .angular_resolution = radians(1.0)});
    EXPECT_EQ(halved.width, 50);
    EXPECT_EQ(halved.height, 30);
}

TEST(MakeRangeImage, TakesThePointsOfAnUnevenGrid) {
    const RangeImage image = make_range_image(grid_scan(0.004), {.source = RangeImageSource::grid});
    EXPECT_EQ(image.source, RangeImageSource::cloud);
    EXPECT_GT(image.size(), 0U);
    EXPECT_EQ(make_range_image(grid_scan(0.0)).source, RangeImageSource::cloud);
}

TEST(MakeRangeImage, OfNothingIsEmpty) {
    Scan scan;
    EXPECT_EQ(make_range_image(scan).size(), 0U);
    scan.cloud.positions.assign(100, Eigen::Vector3f::Constant(NAN));
    EXPECT_EQ(make_range_image(scan).size(), 0U);
    scan.cloud.grid = ScanGrid{10, 10};
    EXPECT_EQ(make_range_image(scan, {.source = RangeImageSource::grid}).size(), 0U);
    EXPECT_THROW(make_range_image(scan, {.angular_resolution = 0.0}), InvalidArgument);
}

}  // namespace
}  // namespace roomscribe
