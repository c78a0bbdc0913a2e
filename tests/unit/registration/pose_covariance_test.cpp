// SPDX-License-Identifier: MIT
#include "roomscribe/registration/alignment/pose_covariance.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "support/contexts.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

struct Surface {
    std::vector<Eigen::Vector3f> positions;
    std::vector<Eigen::Vector3f> normals;

    /// Points `spacing` apart.
    void add_rectangle(const Eigen::Vector3d& corner, const Eigen::Vector3d& u,
                       const Eigen::Vector3d& v, double spacing) {
        const Eigen::Vector3f normal = u.cross(v).normalized().cast<float>();
        for (double a = 0.5 * spacing; a < u.norm(); a += spacing) {
            for (double b = 0.5 * spacing; b < v.norm(); b += spacing) {
                const Eigen::Vector3d point = corner + a * u.normalized() + b * v.normalized();
                positions.emplace_back(point.cast<float>());
                normals.push_back(normal);
            }
        }
    }
    IcpSource as_source() const { return {positions, normals}; }
};

/// Floor and two walls, away from the origin.
Surface corner_of_room(double spacing) {
    Surface surface;
    surface.add_rectangle({2, 1, 0}, {3, 0, 0}, {0, 4, 0}, spacing);
    surface.add_rectangle({2, 1, 0}, {0, 4, 0}, {0, 0, 2.5}, spacing);
    surface.add_rectangle({2, 1, 0}, {0, 0, 2.5}, {3, 0, 0}, spacing);
    return surface;
}

Surface moved(Surface surface, const Transform& motion) {
    surface.positions = test::transformed(surface.positions, motion);
    for (Eigen::Vector3f& normal : surface.normals)
        normal = motion.linear().cast<float>() * normal;
    return surface;
}

PoseCovariance covariance_of(const Surface& source, const Surface& target, const Transform& pose,
                             const IcpSettings& icp, double noise, CovarianceMethod method,
                             const Context& context = {}) {
    const SearchTree tree(target.positions);
    return estimate_pose_covariance(source.as_source(), {target.positions, target.normals, tree},
                                    pose, icp, noise, {.method = method}, context);
}

/// The twist that leads from a pose to the truth, as PoseCovariance::covariance has it.
Vector6d error_of(const Transform& truth, const Transform& pose) {
    const Transform difference = truth * pose.inverse();
    const Eigen::AngleAxisd turn(difference.linear());
    Vector6d twist;
    twist << turn.angle() * turn.axis(), difference.translation();
    return twist;
}

/// How an error (rotation vector, translation) looks in a frame that moves.
Matrix6d adjoint(const Transform& motion) {
    const Eigen::Vector3d t = motion.translation();
    Eigen::Matrix3d skew;
    skew << 0.0, -t.z(), t.y(), t.z(), 0.0, -t.x(), -t.y(), t.x(), 0.0;
    Matrix6d matrix = Matrix6d::Zero();
    matrix.topLeftCorner<3, 3>() = motion.linear();
    matrix.bottomRightCorner<3, 3>() = motion.linear();
    matrix.bottomLeftCorner<3, 3>() = skew * motion.linear();
    return matrix;
}

/// Mean of e^T covariance^-1 e over the alignments of noisy copies, which is 6 on average.
double mean_nees(IcpMethod method, CovarianceMethod covariance_method, bool target_is_noisy) {
    Random random(1);
    constexpr double noise = 0.003;
    const Surface exact = corner_of_room(0.1);
    const SearchTree exact_tree(exact.positions);
    const Transform truth = Transform::Identity();
    // Far less than the spacing: everyone finds its own partner, as the closed forms assume.
    const IcpSettings settings{.method = method,
                               .max_correspondence_distance = 0.05,
                               .max_iterations = 30,
                               .min_error_change = 1e-9};
    constexpr int runs = 100;
    double sum = 0.0;
    for (int run = 0; run < runs; ++run) {
        Surface source = exact;
        Surface target = exact;
        test::add_noise(source.positions, noise, random);
        if (target_is_noisy) test::add_noise(target.positions, noise, random);
        const SearchTree tree(target.positions);
        const IcpTarget icp_target{target.positions, target.normals, tree};
        const IcpResult result = align_icp(source.as_source(), icp_target, truth, settings);
        const PoseCovariance covariance =
            estimate_pose_covariance(source.as_source(), icp_target, result.target_from_source,
                                     settings, noise, {.method = covariance_method});
        const Vector6d error = error_of(truth, result.target_from_source);
        sum += error.dot(covariance.covariance.ldlt().solve(error));
    }
    return sum / runs;
}

// The mean of 100 chi-squared values with 6 degrees of freedom is 6 with standard deviation 0.35.
constexpr double nees_tolerance = 1.0;

TEST(PoseCovariance, EquationTwoMatchesTheScatterOfAlignments) {
    // Its noise is that of the residuals: of the source, where the target is exact.
    for (const IcpMethod method : {IcpMethod::point_to_point, IcpMethod::point_to_plane}) {
        EXPECT_NEAR(mean_nees(method, CovarianceMethod::fisher_information, false), 6.0,
                    nees_tolerance);
    }
}

TEST(PoseCovariance, NoisePropagationMatchesTheScatterOfAlignments) {
    for (const IcpMethod method : {IcpMethod::point_to_point, IcpMethod::point_to_plane}) {
        EXPECT_NEAR(mean_nees(method, CovarianceMethod::noise_propagation, true), 6.0,
                    nees_tolerance);
    }
}

TEST(PoseCovariance, CorrelatedResidualsMatchTheScatterWhereTheyAreIndependent) {
    EXPECT_NEAR(mean_nees(IcpMethod::point_to_plane, CovarianceMethod::correlated_residuals, true),
                6.0, 2.0 * nees_tolerance);
}

TEST(PoseCovariance, EquationTwoIsTheMatrixOfThePaper) {
    const Surface surface = corner_of_room(0.2);
    constexpr double noise = 0.01;
    Matrix6d information = Matrix6d::Zero();
    for (const Eigen::Vector3f& point : surface.positions) {
        const Eigen::Vector3d p = point.cast<double>();
        Eigen::Matrix3d a;
        a << 0.0, -p.z(), p.y(), p.z(), 0.0, -p.x(), -p.y(), p.x(), 0.0;
        Matrix6d term;
        term << -a * a, a, -a, Eigen::Matrix3d::Identity();
        information += term / (noise * noise);
    }
    const PoseCovariance covariance = covariance_of(surface, surface, Transform::Identity(),
                                                    {.method = IcpMethod::point_to_point}, noise,
                                                    CovarianceMethod::fisher_information);
    const Matrix6d expected = information.inverse();
    EXPECT_TRUE(covariance.covariance.isApprox(expected, 1e-6));
    EXPECT_TRUE(covariance.unobservable.empty());
}

TEST(PoseCovariance, NamesTheAxisOfACorridor) {
    Random random(2);
    const Transform pose = test::random_transform(random, 3.0);
    const Eigen::Vector3d axis = pose.linear() * Eigen::Vector3d::UnitY();
    for (const double normal_noise : {0.0, 0.05}) {
        Surface corridor;
        corridor.add_rectangle({0, 0, 0}, {2, 0, 0}, {0, 12, 0}, 0.1);
        corridor.add_rectangle({0, 0, 0}, {0, 12, 0}, {0, 0, 2.5}, 0.1);
        corridor.add_rectangle({2, 0, 0}, {0, 0, 2.5}, {0, 12, 0}, 0.1);
        Surface target = moved(corridor, pose);
        for (Surface* surface : {&corridor, &target}) {
            test::add_noise(surface->positions, 0.003, random);
            for (Eigen::Vector3f& normal : surface->normals) {
                normal += static_cast<float>(normal_noise) *
                          Eigen::Vector3d(random.normal(), random.normal(), random.normal())
                              .cast<float>();
                normal.normalize();
            }
        }
        const PoseCovariance free =
            covariance_of(corridor, target, pose, {.max_correspondence_distance = 0.2}, 0.003,
                          CovarianceMethod::correlated_residuals);
        ASSERT_EQ(free.unobservable.size(), 1U);
        const Vector6d& twist = free.unobservable.front();
        EXPECT_NEAR(twist.norm(), 1.0, 1e-9);
        EXPECT_GT(std::abs(twist.tail<3>().dot(axis)), 0.99);
        EXPECT_GT(axis.dot(free.covariance.bottomRightCorner<3, 3>() * axis), 1.0);

        // An end wall holds it.
        Surface closed = corridor;
        closed.add_rectangle({0, 12, 0}, {2, 0, 0}, {0, 0, 2.5}, 0.1);
        const PoseCovariance held =
            covariance_of(closed, moved(closed, pose), pose, {.max_correspondence_distance = 0.2},
                          0.003, CovarianceMethod::correlated_residuals);
        EXPECT_TRUE(held.unobservable.empty());
    }
}

TEST(PoseCovariance, OfOnePlaneThreeDirectionsAreFree) {
    Surface plane;
    plane.add_rectangle({1, 2, 3}, {2, 0, 0}, {0, 2, 0}, 0.05);
    for (const CovarianceMethod method :
         {CovarianceMethod::fisher_information, CovarianceMethod::noise_propagation,
          CovarianceMethod::correlated_residuals}) {
        const PoseCovariance result =
            covariance_of(plane, plane, Transform::Identity(), {}, 0.01, method);
        EXPECT_EQ(result.unobservable.size(), 3U);
        for (const Vector6d& twist : result.unobservable) {
            // None lifts or tilts the plane: every point stays in it.
            for (const Eigen::Vector3f& point : plane.positions) {
                const Eigen::Vector3d p = point.cast<double>();
                EXPECT_NEAR((twist.head<3>().cross(p) + twist.tail<3>()).z(), 0.0, 1e-5);
            }
        }
    }
    const PoseCovariance nothing = covariance_of({}, plane, Transform::Identity(), {}, 0.01,
                                                 CovarianceMethod::correlated_residuals);
    EXPECT_EQ(nothing.unobservable.size(), 6U);
}

TEST(PoseCovariance, TurnsWithTheFrames) {
    Random random(3);
    Surface source = corner_of_room(0.1);
    Surface target = source;
    test::add_noise(source.positions, 0.004, random);
    test::add_noise(target.positions, 0.004, random);
    const IcpSettings settings{.max_correspondence_distance = 0.1, .kernel = RobustKernel::cauchy};
    for (const CovarianceMethod method :
         {CovarianceMethod::fisher_information, CovarianceMethod::noise_propagation,
          CovarianceMethod::correlated_residuals}) {
        const Matrix6d expected =
            covariance_of(source, target, Transform::Identity(), settings, 0.004, method)
                .covariance;
        const Transform a = test::random_transform(random, 2.0);
        const Transform b = test::random_transform(random, 2.0);
        const Matrix6d turned = covariance_of(moved(source, b), moved(target, a), a * b.inverse(),
                                              settings, 0.004, method)
                                    .covariance;
        // Rounding moves a few points to the next patch.
        EXPECT_TRUE(turned.isApprox(adjoint(a) * expected * adjoint(a).transpose(), 0.03));
    }
}

TEST(PoseCovariance, ErrorsThatNeighboursShareCountForLess) {
    Random random(4);
    Surface source = corner_of_room(0.1);
    const Surface target = source;
    Surface wavy = source;
    // Both have the same variance: one point by point, the other over half metres.
    constexpr double amplitude = 0.005;
    for (std::size_t i = 0; i < source.positions.size(); ++i) {
        const Eigen::Vector3f p = wavy.positions[i];
        const double wave = 2.0 * std::sin(6.0 * static_cast<double>(p.x() + p.y())) *
                            std::cos(6.0 * static_cast<double>(p.z() - p.y() + 2.0F * p.x()));
        wavy.positions[i] += static_cast<float>(amplitude * wave) * wavy.normals[i];
        source.positions[i] += static_cast<float>(amplitude * random.normal()) * source.normals[i];
    }
    const auto spread = [&](const Surface& surface) {
        return covariance_of(surface, target, Transform::Identity(),
                             {.max_correspondence_distance = 0.1}, 0.0,
                             CovarianceMethod::correlated_residuals)
            .covariance.trace();
    };
    EXPECT_GT(spread(wavy), 3.0 * spread(source));
}

TEST(PoseCovariance, HasTheSameBitsOnAnyThreadsAndWantsSense) {
    Random random(5);
    Surface source = corner_of_room(0.1);
    const Surface target = source;
    test::add_noise(source.positions, 0.004, random);
    const auto covariance = [&](double noise, int num_threads) {
        return covariance_of(source, target, Transform::Identity(), {}, noise,
                             CovarianceMethod::correlated_residuals,
                             test::with_threads(num_threads))
            .covariance;
    };
    EXPECT_EQ(covariance(0.01, 1), covariance(0.01, 7));
    EXPECT_THROW(covariance(-0.01, 1), InvalidArgument);
}

}  // namespace
}  // namespace roomscribe
