// SPDX-License-Identifier: MIT
#include "roomscribe/registration/features/fpfh_descriptor.hpp"

#include <cmath>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "support/contexts.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

struct Oriented {
    std::vector<Eigen::Vector3f> positions;
    std::vector<Eigen::Vector3f> normals;

    FpfhDescriptors describe(double radius, const Context& context = {}) const {
        std::vector<std::uint32_t> all(positions.size());
        std::iota(all.begin(), all.end(), 0U);
        return compute_fpfh(positions, normals, SearchTree(positions), all, {.radius = radius},
                            context);
    }
};

Oriented random_surface(Random& random, std::size_t count) {
    Oriented surface;
    surface.positions = test::random_points(random, count);
    for (std::size_t i = 0; i < count; ++i) {
        surface.normals.emplace_back(test::random_direction(random).cast<float>());
    }
    return surface;
}

int bin_of(double value, double low, double high) {
    return static_cast<int>(11.0 * (value - low) / (high - low));
}

TEST(ComputeFpfh, OfTwoPointsInClosedForm) {
    // The connection is d = x. The first normal is nearer to it, so it spans the frame:
    // u = n1, v = d x n1 / |d x n1| = (0, 0, 1) and w = u x v.
    const Eigen::Vector3d n1(std::cos(0.4), std::sin(0.4), 0.0);
    const Eigen::Vector3d n2 = Eigen::Vector3d(0.1, 0.8, 0.5).normalized();
    const Eigen::Vector3d v(0.0, 0.0, 1.0);
    const Eigen::Vector3d w = n1.cross(v);
    Oriented pair;
    pair.positions = {{0, 0, 0}, {0.3F, 0, 0}};
    pair.normals = {n1.cast<float>(), n2.cast<float>()};
    const FpfhDescriptors descriptors = pair.describe(1.0);

    constexpr double pi = std::numbers::pi;
    Eigen::VectorXf expected = Eigen::VectorXf::Zero(fpfh_size);
    expected[bin_of(std::atan2(w.dot(n2), n1.dot(n2)), -pi, pi)] = 100.0F;
    expected[11 + bin_of(v.dot(n2), -1.0, 1.0)] = 100.0F;
    expected[22 + bin_of(n1.x(), -1.0, 1.0)] = 100.0F;
    // Each point's only neighbour is the other, and the angles of a pair are the pair's.
    EXPECT_TRUE(descriptors.col(0).isApprox(expected, 1e-5F));
    EXPECT_TRUE(descriptors.col(1).isApprox(expected, 1e-5F));
}

TEST(ComputeFpfh, EachAngleSumsTo100) {
    Random random(1);
    const FpfhDescriptors descriptors = random_surface(random, 500).describe(0.5);
    for (Eigen::Index i = 0; i < descriptors.cols(); ++i) {
        for (Eigen::Index angle = 0; angle < 3; ++angle) {
            EXPECT_NEAR(descriptors.col(i).segment<11>(11 * angle).sum(), 100.0F, 1e-3F);
        }
        EXPECT_GE(descriptors.col(i).minCoeff(), 0.0F);
    }
}

TEST(ComputeFpfh, IsInvariantToRigidMotion) {
    Random random(2);
    const Oriented surface = random_surface(random, 400);
    const FpfhDescriptors expected = surface.describe(0.5);
    for (int run = 0; run < 3; ++run) {
        const Transform motion = test::random_transform(random, 2.0);
        Oriented moved = surface;
        moved.positions = test::transformed(surface.positions, motion);
        for (Eigen::Vector3f& normal : moved.normals) {
            normal = motion.linear().cast<float>() * normal;
        }
        const FpfhDescriptors descriptors = moved.describe(0.5);
        // Rounding may move a pair to the next bin, or over the radius; that is a rare event.
        const auto changes = (descriptors - expected).cwiseAbs().colwise().maxCoeff().eval();
        EXPECT_LT((changes.array() > 0.1F).count(), 0.1 * static_cast<double>(changes.size()));
        EXPECT_LT(changes.maxCoeff(), 5.0F);
    }
}

TEST(ComputeFpfh, TellsShapesApart) {
    // A plane has all pairs in one bin per angle; at the fold of two planes there are others.
    Oriented shape;
    for (const Eigen::Vector3f& point : test::grid_points(21, 21, 0.1)) {
        shape.positions.push_back(point);
        shape.normals.emplace_back(0.0F, 0.0F, 1.0F);
        if (point.x() == 0.0F) continue;
        shape.positions.emplace_back(0.0F, point.y(), point.x());
        shape.normals.emplace_back(1.0F, 0.0F, 0.0F);
    }
    const FpfhDescriptors descriptors = shape.describe(0.25);
    for (std::size_t i = 0; i < shape.positions.size(); ++i) {
        const Eigen::Vector3f& point = shape.positions[i];
        const auto num_bins =
            (descriptors.col(static_cast<Eigen::Index>(i)).array() > 0.0F).count();
        if (point.x() + point.z() > 0.55F) {
            EXPECT_EQ(num_bins, 3);
        }
        if (point.x() + point.z() < 0.15F) {
            EXPECT_GT(num_bins, 3);
        }
    }
}

TEST(ComputeFpfh, PointsWithoutNormalCountForNothing) {
    Random random(3);
    const Oriented surface = random_surface(random, 300);
    const FpfhDescriptors expected = surface.describe(0.6);
    Oriented with_nan = surface;
    for (const Eigen::Vector3f& point : test::random_points(random, 200)) {
        with_nan.positions.push_back(point);
        with_nan.normals.emplace_back(NAN, NAN, NAN);
    }
    const FpfhDescriptors descriptors = with_nan.describe(0.6);
    EXPECT_LT((descriptors.leftCols(300) - expected).cwiseAbs().maxCoeff(), 1e-3F);
}

TEST(ComputeFpfh, IsZeroWithoutNeighbours) {
    Oriented lonely;
    lonely.positions = {{0, 0, 0}, {0, 0, 0}, {5, 0, 0}, {5.1F, 0, 0}};
    lonely.normals = {{0, 0, 1}, {0, 1, 0}, {0, 0, 1}, {NAN, NAN, NAN}};
    EXPECT_TRUE(lonely.describe(1.0).isZero());
    EXPECT_EQ(Oriented{}.describe(1.0).cols(), 0);
}

TEST(ComputeFpfh, DescribesTheKeypointsAlone) {
    Random random(4);
    const Oriented surface = random_surface(random, 300);
    const FpfhDescriptors all = surface.describe(0.5);
    const std::vector<std::uint32_t> keypoints = {250, 3, 17};
    const FpfhDescriptors some =
        compute_fpfh(surface.positions, surface.normals, SearchTree(surface.positions), keypoints);
    ASSERT_EQ(some.cols(), 3);
    for (Eigen::Index i = 0; i < 3; ++i) {
        EXPECT_EQ(some.col(i), all.col(keypoints[static_cast<std::size_t>(i)]));
    }
}

TEST(ComputeFpfh, HasTheSameBitsOnAnyThreads) {
    Random random(5);
    const Oriented surface = random_surface(random, 800);
    const FpfhDescriptors one = surface.describe(0.4, test::with_threads(1));
    EXPECT_EQ(surface.describe(0.4, test::with_threads(2)), one);
    EXPECT_EQ(surface.describe(0.4, test::with_threads(7)), one);
    EXPECT_THROW(surface.describe(0.0), InvalidArgument);
}

}  // namespace
}  // namespace roomscribe
