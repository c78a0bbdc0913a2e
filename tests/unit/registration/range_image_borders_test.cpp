// SPDX-License-Identifier: MIT
#include "roomscribe/registration/range_image/range_image_borders.hpp"

#include <algorithm>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "range_scene.hpp"
#include "roomscribe/registration/range_image/symmetric_matrix.hpp"
#include "support/contexts.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

TEST(SymmetricMatrix, AgreesWithAGeneralSolver) {
    Random random(1);
    for (int run = 0; run < 300; ++run) {
        SymmetricMatrix matrix;
        // Of very different lengths: surfaces are flat.
        for (const float length : {1.0F, 0.3F, run % 2 == 0 ? 0.01F : 0.2F}) {
            matrix.add_square(length * test::random_direction(random).cast<float>());
        }
        Eigen::Matrix3d full;
        full << matrix.xx, matrix.xy, matrix.xz, matrix.xy, matrix.yy, matrix.yz, matrix.xz,
            matrix.yz, matrix.zz;
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(full);
        EXPECT_NEAR(matrix.smallest_eigenvalue(), solver.eigenvalues()[0], 1e-5);
        EXPECT_NEAR(matrix.largest_eigenvalue(), solver.eigenvalues()[2], 1e-5);
        const Eigen::Vector3d largest =
            matrix.eigenvector(matrix.largest_eigenvalue()).cast<double>();
        if (solver.eigenvalues()[2] - solver.eigenvalues()[1] > 0.05) {
            EXPECT_NEAR(std::abs(largest.dot(solver.eigenvectors().col(2))), 1.0, 1e-3);
        }
    }
    EXPECT_NEAR(SymmetricMatrix{}.eigenvector(0.0F).norm(), 1.0F, 1e-6F);
}

class PanelBorders : public testing::Test {
  protected:
    bool is_panel(int x, int y) const {
        return image_.contains(x, y) && image_.points[image_.index(x, y)].x() < 3.0F;
    }
    /// True if a pixel of the panel, or of the wall, is so near in the row or the column.
    bool is_near(int x, int y, bool of_panel, int reach) const {
        for (int i = -reach; i <= reach; ++i) {
            if (image_.contains(x + i, y) && is_panel(x + i, y) == of_panel) return true;
            if (image_.contains(x, y + i) && is_panel(x, y + i) == of_panel) return true;
        }
        return false;
    }

    RangeImage image_ = make_range_image(test::panel_scene(), test::scene_settings());
    RangeImageBorders borders_ = find_range_image_borders(image_);
};

// A score looks at the mean of the next three pixels, so on a scene without noise the border may
// be a pixel inside of the panel's end.
TEST_F(PanelBorders, AreWhereThePanelEnds) {
    int num_borders = 0;
    for (std::size_t i = 0; i < image_.size(); ++i) {
        const int x = image_.column(i);
        const int y = image_.row(i);
        if ((borders_.traits[i] & obstacle_border) != 0) {
            ++num_borders;
            EXPECT_TRUE(is_panel(x, y) && is_near(x, y, false, 2)) << x << ' ' << y;
        }
        if ((borders_.traits[i] & shadow_border) != 0) {
            EXPECT_TRUE(!is_panel(x, y) && is_near(x, y, true, 3)) << x << ' ' << y;
        }
        if ((borders_.traits[i] & veil_point) != 0) {
            EXPECT_TRUE(is_near(x, y, !is_panel(x, y), 2)) << x << ' ' << y;
        }
    }
    // The panel is 57 pixels wide and high.
    EXPECT_GT(num_borders, 190);
    EXPECT_LT(num_borders, 260);
}

TEST_F(PanelBorders, AreTwoInARow) {
    const int y = image_.row(test::pixel_at(image_, {2, 0, 0}));
    int num_obstacle = 0;
    int num_shadow = 0;
    for (int x = 0; x < image_.width; ++x) {
        const std::uint8_t traits = borders_.traits[image_.index(x, y)];
        num_obstacle += (traits & obstacle_border) != 0 ? 1 : 0;
        num_shadow += (traits & shadow_border) != 0 ? 1 : 0;
    }
    EXPECT_EQ(num_obstacle, 2);
    EXPECT_EQ(num_shadow, 2);
}

TEST_F(PanelBorders, PointAwayFromThePanel) {
    for (std::size_t i = 0; i < image_.size(); ++i) {
        if (borders_.surface_change_scores[i] < 1.0F) continue;
        EXPECT_NE(borders_.traits[i] & obstacle_border, 0);
        const Eigen::Vector3f& direction = borders_.surface_change_directions[i];
        EXPECT_NEAR(direction.norm(), 1.0F, 1e-5F);
        EXPECT_NEAR(direction.x(), 0.0F, 0.02F);
        const Eigen::Vector3f& point = image_.points[i];
        if (std::abs(point.z()) < 0.4F) {
            EXPECT_GT(direction.y() * std::copysign(1.0F, point.y()), 0.9F);
        }
        if (std::abs(point.y()) < 0.4F) {
            EXPECT_GT(direction.z() * std::copysign(1.0F, point.z()), 0.9F);
        }
    }
}

TEST_F(PanelBorders, SurfaceDoesNotChangeElsewhere) {
    for (std::size_t i = 0; i < image_.size(); ++i) {
        const int x = image_.column(i);
        const int y = image_.row(i);
        // The outermost pixels only repeat the ranges beside them.
        const bool is_outside =
            std::min(x, y) < 12 || x > image_.width - 13 || y > image_.height - 13;
        if (!is_outside && !is_near(x, y, !is_panel(x, y), 8)) {
            // Less than counts for a keypoint.
            EXPECT_LT(borders_.surface_change_scores[i], 0.2F);
        }
        if (borders_.is_background(i)) {
            EXPECT_EQ(borders_.surface_change_scores[i], 0.0F);
        }
    }
}

TEST(FindRangeImageBorders, FindsVeilPoints) {
    // A blurred border: one pixel hits halfway between panel and wall.
    const Scan scan = test::scan_scene([](const Eigen::Vector3d& direction) {
        const double angle = std::atan2(direction.y(), direction.x());
        if (angle > 0.5 * test::scene_resolution) return test::range_to_wall(direction, 2.0);
        return test::range_to_wall(direction, angle > -0.5 * test::scene_resolution ? 3.0 : 4.0);
    });
    const RangeImage image = make_range_image(scan, test::scene_settings());
    const RangeImageBorders borders = find_range_image_borders(image);
    int num_veil = 0;
    for (std::size_t i = 0; i < image.size(); ++i) {
        const bool is_between = std::abs(image.points[i].x() - 3.0F) < 0.1F;
        if (is_between && (borders.traits[i] & veil_point) != 0) ++num_veil;
    }
    EXPECT_GT(num_veil, image.height / 2);
}

TEST(FindRangeImageBorders, SurfaceChangesAcrossAnEdge) {
    // Two walls that meet at 90 degrees on the line x = 3, y = 0.
    const Scan scan = test::scan_scene([](const Eigen::Vector3d& direction) {
        return 3.0 / (direction.x() + std::abs(direction.y()));
    });
    const RangeImage image = make_range_image(scan, test::scene_settings());
    const RangeImageBorders borders = find_range_image_borders(image);
    const std::uint32_t edge = test::pixel_at(image, {3, 0, 0});
    EXPECT_EQ(borders.traits[edge], 0);
    // Normals that differ by 90 degrees have a spread of 1/2 or half of it along one axis.
    EXPECT_GT(borders.surface_change_scores[edge], 0.45F);
    EXPECT_GT(std::abs(borders.surface_change_directions[edge].y()), 0.99F);
    EXPECT_EQ(borders.surface_change_scores[test::pixel_at(image, {2, 1, 0})], 0.0F);
}

TEST(FindRangeImageBorders, HasTheSameBitsOnAnyThreads) {
    const RangeImage image = make_range_image(test::panel_scene(), test::scene_settings());
    const RangeImageBorders one = find_range_image_borders(image, {}, test::with_threads(1));
    const RangeImageBorders many = find_range_image_borders(image, {}, test::with_threads(3));
    EXPECT_EQ(one.traits, many.traits);
    EXPECT_EQ(one.surface_change_scores, many.surface_change_scores);
    EXPECT_EQ(one.surface_change_directions, many.surface_change_directions);
}

TEST(FindRangeImageBorders, OfNothingAreNone) {
    EXPECT_TRUE(find_range_image_borders({}).traits.empty());
}

}  // namespace
}  // namespace roomscribe
