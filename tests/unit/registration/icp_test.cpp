// SPDX-License-Identifier: MIT
#include "roomscribe/registration/alignment/icp.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/registration/alignment/closest_points.hpp"
#include "roomscribe/registration/alignment/robust_kernel.hpp"
#include "support/contexts.hpp"
#include "support/matchers.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

using test::TransformNear;

constexpr std::array all_methods{IcpMethod::point_to_point, IcpMethod::point_to_plane,
                                 IcpMethod::generalized};

/// Points with exact normals, and a tree.
struct Surface {
    std::vector<Eigen::Vector3f> positions;
    std::vector<Eigen::Vector3f> normals;
    SearchTree tree{{}};

    void add_rectangle(Random& random, std::size_t count, const Eigen::Vector3d& corner,
                       const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
        const Eigen::Vector3d normal = u.cross(v).normalized();
        for (std::size_t i = 0; i < count; ++i) {
            const Eigen::Vector3d point = corner + random.uniform() * u + random.uniform() * v;
            positions.emplace_back(point.cast<float>());
            normals.emplace_back(normal.cast<float>());
        }
        tree = SearchTree(positions);
    }
    IcpTarget as_target() const { return {positions, normals, tree}; }
    IcpSource as_source() const { return {positions, normals}; }
    IcpTarget without_normals() const { return {positions, {}, tree}; }
};

/// Floor and two walls, which hold every motion.
Surface corner_of_room(Random& random) {
    Surface surface;
    surface.add_rectangle(random, 4000, {0, 0, 0}, {3, 0, 0}, {0, 4, 0});
    surface.add_rectangle(random, 4000, {0, 0, 0}, {0, 4, 0}, {0, 0, 2.5});
    surface.add_rectangle(random, 4000, {0, 0, 0}, {0, 0, 2.5}, {3, 0, 0});
    return surface;
}

/// Floor and two parallel walls: nothing holds the shift along y.
Surface corridor(Random& random) {
    Surface surface;
    surface.add_rectangle(random, 6000, {0, 0, 0}, {2, 0, 0}, {0, 12, 0});
    surface.add_rectangle(random, 6000, {0, 0, 0}, {0, 12, 0}, {0, 0, 2.5});
    surface.add_rectangle(random, 6000, {2, 0, 0}, {0, 0, 2.5}, {0, 12, 0});
    return surface;
}

Surface moved(const Surface& surface, const Transform& motion) {
    Surface result;
    result.positions = test::transformed(surface.positions, motion);
    for (const Eigen::Vector3f& normal : surface.normals) {
        result.normals.push_back(motion.linear().cast<float>() * normal);
    }
    result.tree = SearchTree(result.positions);
    return result;
}

TEST(AlignIcp, RecoversAMotionExactlyFromTheSamePoints) {
    Random random(1);
    const Surface target = corner_of_room(random);
    for (const IcpMethod method : all_methods) {
        const Transform motion = test::small_transform(random, radians(1.0), 0.02);
        const Surface source = moved(target, motion.inverse());
        const IcpResult result =
            align_icp(source.as_source(), target.as_target(), Transform::Identity(),
                      {.method = method, .max_iterations = 300, .min_error_change = 1e-9});
        EXPECT_THAT(result.target_from_source, TransformNear(motion, 1e-5, 1e-5));
        EXPECT_LT(result.rmse, 1e-5);
        EXPECT_EQ(result.num_pairs, source.positions.size());
        EXPECT_EQ(result.stop, IcpStop::converged);
    }
}

TEST(AlignIcp, RecoversAMotionFromOtherPointsOfTheSurface) {
    Random random(2);
    for (int run = 0; run < 3; ++run) {
        const Surface target = corner_of_room(random);
        const Transform motion = test::random_transform(random, 3.0);
        const Surface source = moved(corner_of_room(random), motion.inverse());
        const Transform guess = motion * test::small_transform(random, radians(4.0), 0.1);
        const IcpResult plane = align_icp(source.as_source(), target.as_target(), guess);
        EXPECT_THAT(plane.target_from_source, TransformNear(motion, 1e-3, radians(0.02)));
        EXPECT_EQ(plane.stop, IcpStop::converged);
        const IcpResult point = align_icp(source.as_source(), target.as_target(), guess,
                                          {.method = IcpMethod::point_to_point});
        EXPECT_THAT(point.target_from_source, TransformNear(motion, 0.02, radians(0.5)));
    }
}

TEST(AlignIcp, ErrorsFallAndEndAtTheResult) {
    Random random(3);
    const Surface target = corner_of_room(random);
    const Surface source = moved(corner_of_room(random), test::small_transform(random, 0.05, 0.1));
    const IcpResult result =
        align_icp(source.as_source(), target.without_normals(), Transform::Identity(),
                  {.method = IcpMethod::point_to_point, .max_correspondence_distance = 100.0});
    // With every point paired, neither of the two alternating steps can raise the error.
    for (std::size_t i = 1; i < result.errors.size(); ++i) {
        EXPECT_LE(result.errors[i], result.errors[i - 1] + 1e-9);
    }
    EXPECT_EQ(result.errors.back(), result.rmse);
    double sum = 0.0;
    for (const Eigen::Vector3f& point : source.positions) {
        const Eigen::Vector3d place = result.target_from_source * point.cast<double>();
        sum += target.tree.nearest(place.cast<float>()).squared_distance;
    }
    EXPECT_NEAR(result.rmse, std::sqrt(sum / static_cast<double>(source.positions.size())), 1e-6);
}

TEST(AlignIcp, StopsAtMaxIterations) {
    Random random(4);
    const Surface target = corner_of_room(random);
    const Surface source = moved(target, test::small_transform(random, 0.1, 0.2));
    const IcpResult result = align_icp(source.as_source(), target.as_target(),
                                       Transform::Identity(), {.max_iterations = 2});
    EXPECT_EQ(result.stop, IcpStop::max_iterations);
    EXPECT_EQ(result.errors.size(), 3U);
    EXPECT_EQ(icp_stop_name(result.stop), "max_iterations");
}

TEST(AlignIcp, SaysWhenTooFewPairsAreWithinReach) {
    Random random(5);
    const Surface target = corner_of_room(random);
    const Transform guess(Eigen::Translation3d(0, 0, 50));
    const IcpResult far = align_icp(target.as_source(), target.as_target(), guess);
    EXPECT_EQ(far.stop, IcpStop::too_few_pairs);
    EXPECT_EQ(far.num_pairs, 0U);
    EXPECT_THAT(far.target_from_source, TransformNear(guess, 0.0, 0.0));

    const std::vector<Eigen::Vector3f> few(5, target.positions.front());
    EXPECT_EQ(align_icp({few, {}}, target.as_target(), Transform::Identity()).stop,
              IcpStop::too_few_pairs);
    EXPECT_EQ(align_icp({}, target.as_target(), Transform::Identity()).stop,
              IcpStop::too_few_pairs);
    const Surface empty;
    EXPECT_EQ(align_icp(target.as_source(), empty.without_normals(), Transform::Identity(),
                        {.method = IcpMethod::point_to_point})
                  .stop,
              IcpStop::too_few_pairs);
}

TEST(AlignIcp, PointsThatFaceAnotherWayTakeNoPart) {
    Random random(6);
    const Surface target = corner_of_room(random);
    Surface turned = moved(target, Transform::Identity());
    for (Eigen::Vector3f& normal : turned.normals)
        normal = -normal;
    EXPECT_EQ(align_icp(turned.as_source(), target.as_target(), Transform::Identity()).stop,
              IcpStop::too_few_pairs);
    EXPECT_EQ(align_icp({turned.positions, {}}, target.as_target(), Transform::Identity()).stop,
              IcpStop::converged);
    for (Eigen::Vector3f& normal : turned.normals)
        normal.setConstant(NAN);
    EXPECT_EQ(align_icp(turned.as_source(), target.as_target(), Transform::Identity()).num_pairs,
              0U);
}

TEST(AlignIcp, PointsBeyondTheEdgeOfTheTargetTakeNoPart) {
    Random random(13);
    Surface target;
    target.add_rectangle(random, 10'000, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    Surface source;  // half of it over the target, the other half beyond
    source.add_rectangle(random, 2000, {0.5, 0, 0.02}, {1, 0, 0}, {0, 1, 0});
    const auto inside =
        static_cast<double>(std::count_if(source.positions.begin(), source.positions.end(),
                                          [](const auto& point) { return point.x() <= 1.0F; }));
    for (const IcpMethod method : {IcpMethod::point_to_plane, IcpMethod::generalized}) {
        IcpSettings settings{.method = method, .max_iterations = 1};
        EXPECT_EQ(align_icp(source.as_source(), target.as_target(), Transform::Identity(), settings)
                      .num_pairs,
                  source.positions.size());
        settings.max_offset_along_surface = 0.03;
        EXPECT_NEAR(static_cast<double>(align_icp(source.as_source(), target.as_target(),
                                                  Transform::Identity(), settings)
                                            .num_pairs),
                    inside, 0.08 * inside);
    }
}

TEST(AlignIcp, DoesNotRunAwayAlongACorridor) {
    Random random(7);
    Surface target = corridor(random);
    Surface source = corridor(random);
    for (const double noise : {0.0, 0.005}) {
        test::add_noise(target.positions, noise, random);
        test::add_noise(source.positions, noise, random);
        target.tree = SearchTree(target.positions);
        const Transform guess = test::small_transform(random, radians(2.0), 0.05);
        const IcpResult result =
            align_icp(source.as_source(), target.as_target(), guess,
                      {.max_correspondence_distance = 0.3, .max_iterations = 200});
        Transform expected = Transform::Identity();
        expected.translation().y() = result.target_from_source.translation().y();
        EXPECT_THAT(result.target_from_source, TransformNear(expected, 5e-3, radians(0.1)));
        EXPECT_LT(std::abs(expected.translation().y()), 0.15);

        // What is known of the pose says so: next to nothing along the corridor.
        const double along = result.information(4, 4);
        EXPECT_LT(along, 1e-6 * result.information(3, 3));
    }
}

TEST(AlignIcp, InformationIsThatOfTheResiduals) {
    // Of n points on the plane z = 0 about the origin: n for z, sum y^2 and sum x^2 for the tilts.
    Surface target;
    target.positions = test::grid_points(11, 11, 0.1);
    for (Eigen::Vector3f& point : target.positions)
        point -= Eigen::Vector3f(0.5F, 0.5F, 0.0F);
    target.normals.assign(target.positions.size(), Eigen::Vector3f::UnitZ());
    target.tree = SearchTree(target.positions);
    const IcpResult result =
        align_icp(target.as_source(), target.as_target(), Transform::Identity());
    double sum_of_squares = 0.0;
    for (const Eigen::Vector3f& point : target.positions) {
        sum_of_squares += static_cast<double>(point.x()) * static_cast<double>(point.x());
    }
    Eigen::Matrix<double, 6, 1> diagonal;
    diagonal << sum_of_squares, sum_of_squares, 0.0, 0.0, 0.0, 121.0;
    const Eigen::Matrix<double, 6, 6> expected = diagonal.asDiagonal();
    EXPECT_LT((result.information - expected).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(AlignIcp, WantsNormalsForPointToPlane) {
    Random random(8);
    const Surface target = corner_of_room(random);
    EXPECT_THROW(align_icp(target.as_source(), target.without_normals(), Transform::Identity()),
                 InvalidArgument);
    EXPECT_THROW(align_icp({target.positions, {}}, target.as_target(), Transform::Identity(),
                           {.method = IcpMethod::generalized}),
                 InvalidArgument);
    EXPECT_THROW(align_icp(target.as_source(), target.as_target(), Transform::Identity(),
                           {.max_iterations = 0}),
                 InvalidArgument);
}

TEST(AlignIcp, HasTheSameBitsOnAnyThreads) {
    Random random(9);
    const Surface target = corner_of_room(random);
    const Surface source = moved(corner_of_room(random), test::small_transform(random, 0.05, 0.1));
    for (const IcpMethod method : all_methods) {
        const auto align = [&](int num_threads) {
            return align_icp(source.as_source(), target.as_target(), Transform::Identity(),
                             {.method = method,
                              .kernel = RobustKernel::tukey,
                              .trimmed_share = 0.1,
                              .reach_shrink = 0.8},
                             test::with_threads(num_threads));
        };
        const IcpResult one = align(1);
        for (const int num_threads : {2, 7}) {
            const IcpResult many = align(num_threads);
            EXPECT_EQ(many.target_from_source.matrix(), one.target_from_source.matrix());
            EXPECT_EQ(many.errors, one.errors);
            EXPECT_EQ(many.information, one.information);
        }
    }
}

/// A corner whose source has 15 % of its points 0.1 m in front of the surface: things that moved.
struct Cluttered {
    Surface target;
    Surface source;
    Transform motion;

    explicit Cluttered(Random& random)
        : target(corner_of_room(random)),
          motion(test::small_transform(random, radians(2.0), 0.05)) {
        Surface other = corner_of_room(random);
        test::add_noise(other.positions, 0.003, random);
        for (std::size_t i = 0; i < other.positions.size(); ++i) {
            if (i % 20 < 3) other.positions[i] += 0.1F * other.normals[i];
        }
        source = moved(other, motion.inverse());
    }
    double error(const IcpSettings& settings) const {
        const IcpResult result =
            align_icp(source.as_source(), target.as_target(), Transform::Identity(), settings);
        return (result.target_from_source * motion.inverse()).translation().norm();
    }
};

TEST(AlignIcp, KernelsAndTrimmingLeaveOutWhatMoved) {
    Random random(10);
    const Cluttered scene(random);
    const double plain = scene.error({.max_correspondence_distance = 0.3});
    EXPECT_GT(plain, 0.015);
    for (const RobustKernel kernel :
         {RobustKernel::huber, RobustKernel::tukey, RobustKernel::cauchy}) {
        EXPECT_LT(scene.error({.max_correspondence_distance = 0.3, .kernel = kernel}), 0.3 * plain);
    }
    EXPECT_LT(scene.error({.max_correspondence_distance = 0.3,
                           .kernel = RobustKernel::huber,
                           .kernel_scale = 0.003}),
              0.3 * plain);
    EXPECT_LT(scene.error({.max_correspondence_distance = 0.3, .kernel = RobustKernel::tukey}),
              1e-3);
    EXPECT_LT(scene.error({.max_correspondence_distance = 0.3, .trimmed_share = 0.2}), 1e-3);
}

TEST(AlignIcp, PointsThatAreLessSureCountLess) {
    Random random(11);
    const Cluttered scene(random);
    std::vector<float> deviations(scene.source.positions.size(), 0.003F);
    for (std::size_t i = 0; i < deviations.size(); ++i) {
        if (i % 20 < 3) deviations[i] = 0.1F;
    }
    const auto error = [&](std::span<const float> source_deviations) {
        const IcpSource source{scene.source.positions, scene.source.normals, source_deviations};
        const IcpResult result = align_icp(source, scene.target.as_target(), Transform::Identity(),
                                           {.max_correspondence_distance = 0.3});
        return (result.target_from_source * scene.motion.inverse()).translation().norm();
    };
    EXPECT_LT(error(deviations), 0.1 * error({}));
}

TEST(AlignIcp, ReachShrinksToTheDistancesOfThePairs) {
    Random random(12);
    const Surface target = corner_of_room(random);
    const Surface source = moved(corner_of_room(random), test::small_transform(random, 0.05, 0.1));
    const IcpResult fixed =
        align_icp(source.as_source(), target.as_target(), Transform::Identity());
    EXPECT_EQ(fixed.reach, 1.0);
    const IcpResult shrunk = align_icp(source.as_source(), target.as_target(),
                                       Transform::Identity(), {.reach_shrink = 0.7});
    // 4000 points on some 10 m2 are about 2.5 cm from their nearest.
    EXPECT_LT(shrunk.reach, 0.2);
    EXPECT_GT(shrunk.reach, 0.05);
    EXPECT_EQ(shrunk.stop, IcpStop::converged);
    EXPECT_THAT(shrunk.target_from_source, TransformNear(fixed.target_from_source, 1e-3, 1e-3));
}

TEST(RobustWeight, FallsAsTheKernelSays) {
    for (const double x : {0.0, 1.0, -2.0, 10.0}) {
        EXPECT_EQ(robust_weight(RobustKernel::none, x), 1.0);
    }
    EXPECT_EQ(robust_weight(RobustKernel::huber, -1.3), 1.0);
    EXPECT_DOUBLE_EQ(robust_weight(RobustKernel::huber, 2.69), 0.5);
    EXPECT_DOUBLE_EQ(robust_weight(RobustKernel::cauchy, 2.385), 0.5);
    EXPECT_DOUBLE_EQ(robust_weight(RobustKernel::tukey, 4.685 * std::sqrt(0.5)), 0.25);
    EXPECT_EQ(robust_weight(RobustKernel::tukey, 5.0), 0.0);
}

TEST(ClosestPoints, AnswersAsASearchWouldHoweverTheQueriesMove) {
    Random random(13);
    const std::vector<Eigen::Vector3f> points = test::random_points(random, 2000);
    const SearchTree tree(points);
    std::vector<Eigen::Vector3f> queries = test::random_points(random, 500);
    ClosestPoints closest(points, tree, queries.size());
    for (const float step : {0.0F, 0.001F, 0.01F, 0.0005F, 0.1F, 0.002F, 0.002F}) {
        for (const float reach : {0.05F, 0.08F, 0.04F}) {
            for (std::size_t i = 0; i < queries.size(); ++i) {
                queries[i] += step * test::random_direction(random).cast<float>();
                const Neighbor nearest = tree.nearest(queries[i]);
                const bool within = nearest.squared_distance <= reach * reach;
                EXPECT_EQ(closest.find(i, queries[i], reach),
                          within ? nearest.index : ClosestPoints::none);
            }
        }
    }
}

}  // namespace
}  // namespace roomscribe
