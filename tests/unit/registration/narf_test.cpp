// SPDX-License-Identifier: MIT
#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

#include "range_scene.hpp"
#include "roomscribe/core/error.hpp"
#include "roomscribe/registration/features/narf_descriptor.hpp"
#include "roomscribe/registration/features/narf_keypoints.hpp"
#include "support/contexts.hpp"
#include "support/matchers.hpp"

namespace roomscribe {
namespace {

RangeImage image_of(const Scan& scan) {
    return make_range_image(scan, test::scene_settings());
}

std::vector<std::uint32_t> pixels_of(const std::vector<NarfKeypoint>& keypoints) {
    std::vector<std::uint32_t> pixels;
    for (const NarfKeypoint& keypoint : keypoints)
        pixels.push_back(keypoint.pixel);
    return pixels;
}

TEST(DetectNarfKeypoints, FindsNoneOnAPlane) {
    EXPECT_TRUE(detect_narf_keypoints(image_of(test::wall_scene())).empty());
}

TEST(DetectNarfKeypoints, FindsTheCornersOfAPanel) {
    const RangeImage image = image_of(test::panel_scene());
    const NarfKeypointSettings settings{.support_size = 0.4};
    const std::vector<NarfKeypoint> keypoints = detect_narf_keypoints(image, settings);
    ASSERT_GE(keypoints.size(), 4U);
    int corners_found = 0;
    for (const float y : {-0.5F, 0.5F}) {
        for (const float z : {-0.5F, 0.5F}) {
            corners_found += std::any_of(keypoints.begin(), keypoints.end(), [&](const auto& k) {
                return (k.position - Eigen::Vector3f(2.0F, y, z)).norm() < 0.2F;
            });
        }
    }
    EXPECT_EQ(corners_found, 4);
    for (std::size_t i = 0; i < keypoints.size(); ++i) {
        const NarfKeypoint& keypoint = keypoints[i];
        // Where only one border is near, the surface changes in one direction alone.
        EXPECT_GT(std::abs(keypoint.position.y()), 0.29F);
        EXPECT_GT(std::abs(keypoint.position.z()), 0.29F);
        EXPECT_EQ(keypoint.position, image.points[keypoint.pixel]);
        EXPECT_GE(keypoint.interest, settings.min_interest);
        EXPECT_TRUE(i == 0 || keypoint.interest <= keypoints[i - 1].interest);
        for (std::size_t j = 0; j < i; ++j) {
            EXPECT_GE((keypoint.position - keypoints[j].position).norm(), 0.1F);
        }
    }
}

TEST(DetectNarfKeypoints, KeepsTheBest) {
    const RangeImage image = image_of(test::panel_scene());
    const auto all = detect_narf_keypoints(image, {.support_size = 0.4});
    const auto best = detect_narf_keypoints(image, {.support_size = 0.4, .max_keypoints = 2});
    ASSERT_EQ(best.size(), 2U);
    EXPECT_EQ(best[0].pixel, all[0].pixel);
    EXPECT_EQ(best[1].pixel, all[1].pixel);
}

TEST(DetectNarfKeypoints, HasTheSameBitsOnAnyThreads) {
    const RangeImage image = image_of(test::panel_scene());
    const RangeImageBorders borders = find_range_image_borders(image);
    const auto one = compute_narf_interest(image, borders, {}, test::with_threads(1));
    EXPECT_EQ(compute_narf_interest(image, borders, {}, test::with_threads(3)), one);
    EXPECT_EQ(pixels_of(detect_narf_keypoints(image, {}, test::with_threads(1))),
              pixels_of(detect_narf_keypoints(image, {}, test::with_threads(3))));
}

TEST(DetectNarfKeypoints, FindsNoneInNothing) {
    EXPECT_TRUE(detect_narf_keypoints({}).empty());
    Scan scan;
    scan.cloud.positions.assign(50, Eigen::Vector3f::Constant(NAN));
    EXPECT_TRUE(detect_narf_keypoints(make_range_image(scan)).empty());
    EXPECT_THROW(detect_narf_keypoints({}, {.support_size = 0.0}), InvalidArgument);
}

TEST(ComputeNarf, OfAPlaneIsZero) {
    const RangeImage image = image_of(test::wall_scene());
    const std::vector<std::uint32_t> pixels = {test::pixel_at(image, {4, 0.3, 0.2})};
    const NarfDescriptors upright = compute_narf(image, pixels, {.rotation_invariant = false});
    ASSERT_EQ(upright.values.cols(), 1);
    EXPECT_LT(upright.values.cwiseAbs().maxCoeff(), 1e-3F);
}

TEST(ComputeNarf, SaysWhereTheSurfaceEnds) {
    // 0.1 m from the right border of the panel: the beams to the right fall off it.
    const RangeImage image = image_of(test::panel_scene());
    const std::vector<std::uint32_t> pixels = {test::pixel_at(image, {2, -0.4, 0.0})};
    const NarfDescriptors narf = compute_narf(image, pixels, {.rotation_invariant = false});
    ASSERT_EQ(narf.keypoints, std::vector<std::uint32_t>{0});
    EXPECT_EQ(narf.orientations[0], 0.0F);
    for (Eigen::Index beam = 0; beam < narf_size; ++beam) {
        const double angle = static_cast<double>(beam) * std::numbers::pi / 18.0;
        // The right border is at 0.1 m, the patch ends at 0.25 m; beams that graze are let be.
        const double along = 0.1 / std::max(std::sin(angle), 1e-9);
        if (along < 0.2) {
            EXPECT_GT(narf.values(beam, 0), 0.15F) << beam;
        } else if (along > 0.35) {
            EXPECT_LT(std::abs(narf.values(beam, 0)), 0.02F) << beam;
        }
    }
    const NarfDescriptors turned = compute_narf(image, pixels);
    ASSERT_GE(turned.orientations.size(), 1U);
    EXPECT_NEAR(turned.orientations[0], std::numbers::pi / 2.0, radians(10.5));
}

TEST(ComputeNarf, HasAColumnForEachDominantOrientation) {
    // A pillar falls off to both sides.
    const RangeImage image = image_of(test::panel_scene(0.12, 1.0));
    const std::vector<std::uint32_t> pixels = {test::pixel_at(image, {2, 0.0, 0.0})};
    const NarfDescriptors narf = compute_narf(image, pixels);
    EXPECT_EQ(narf.keypoints, (std::vector<std::uint32_t>{0, 0}));
    std::vector<float> orientations = narf.orientations;
    std::sort(orientations.begin(), orientations.end());
    ASSERT_EQ(orientations.size(), 2U);
    EXPECT_NEAR(orientations[0], 0.5 * std::numbers::pi, radians(10.5));
    EXPECT_NEAR(orientations[1], 1.5 * std::numbers::pi, radians(10.5));
}

TEST(ComputeNarf, IsInvariantToATurnAboutTheNormal) {
    Scan scan = test::panel_scene();
    const Eigen::Vector3d place(2.0, 0.38, 0.42);
    const auto describe = [](const Scan& s, const Eigen::Vector3d& at, bool rotation_invariant) {
        const RangeImage image = image_of(s);
        const std::vector<std::uint32_t> pixels = {test::pixel_at(image, at)};
        return compute_narf(image, pixels, {.rotation_invariant = rotation_invariant});
    };
    const NarfDescriptors before = describe(scan, place, true);
    const NarfDescriptors upright_before = describe(scan, place, false);
    ASSERT_GE(before.values.cols(), 1);
    for (const double angle : {30.0, 90.0, 180.0}) {
        const Transform turn(Eigen::AngleAxisd(radians(angle), Eigen::Vector3d::UnitX()));
        Scan turned = scan;
        transform_in_place(turned.cloud, turn);
        const NarfDescriptors after = describe(turned, turn * place, true);
        ASSERT_GE(after.values.cols(), 1);
        const auto difference = [](const auto& a, const auto& b) {
            return (a.values.col(0) - b.values.col(0)).template lpNorm<1>() / narf_size;
        };
        EXPECT_LT(difference(before, after), 0.025F) << angle;
        // An upright one sees the panel's corner elsewhere.
        EXPECT_GT(difference(upright_before, describe(turned, turn * place, false)),
                  angle < 45.0 ? 0.03F : 0.08F);
    }
}

TEST(ComputeNarf, LeavesOutPixelsWithoutSurface) {
    const Scan scan = test::scan_scene([](const Eigen::Vector3d& direction) {
        return direction.y() > 0.2 && direction.z() > 0.2 ? NAN : test::range_to_wall(direction);
    });
    const RangeImage image = image_of(scan);
    const std::vector<std::uint32_t> pixels = {test::pixel_at(image, {4, 1.6, 1.6}),
                                               test::pixel_at(image, {4, 0.0, 0.0})};
    const NarfDescriptors narf = compute_narf(image, pixels, {.rotation_invariant = false});
    EXPECT_EQ(narf.keypoints, std::vector<std::uint32_t>{1});
    EXPECT_EQ(compute_narf(image, {}).values.cols(), 0);
}

TEST(ComputeNarf, HasTheSameBitsOnAnyThreads) {
    const RangeImage image = image_of(test::panel_scene());
    std::vector<std::uint32_t> pixels;
    for (std::uint32_t i = 0; i < image.size(); i += 37)
        pixels.push_back(i);
    const NarfDescriptors one = compute_narf(image, pixels, {}, test::with_threads(1));
    const NarfDescriptors many = compute_narf(image, pixels, {}, test::with_threads(3));
    EXPECT_EQ(one.values, many.values);
    EXPECT_EQ(one.keypoints, many.keypoints);
    EXPECT_EQ(one.orientations, many.orientations);
}

}  // namespace
}  // namespace roomscribe
