// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/scanning/scanner.hpp"

#include <cmath>
#include <cstring>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/simulation/scanning/scanner_model.hpp"
#include "simple_worlds.hpp"
#include "support/contexts.hpp"
#include "support/matchers.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr std::array all_scanners{ScannerKind::sick_lms200, ScannerKind::hokuyo_utm30lx,
                                  ScannerKind::terrestrial, ScannerKind::structured_light,
                                  ScannerKind::spinning_lidar};

std::string name_of(ScannerKind kind) {
    return std::string(scanner_kind_names[static_cast<std::size_t>(kind)]);
}

double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double deviation(const std::vector<double>& values) {
    const double center = mean(values);
    double sum = 0.0;
    for (const double value : values)
        sum += (value - center) * (value - center);
    return std::sqrt(sum / static_cast<double>(values.size()));
}

/// Depths x of the returns within a few degrees of straight ahead on a screen at `distance`,
/// without outliers, which are nobody's.
std::vector<double> depths_ahead(ScannerKind kind, double distance) {
    SimulatedWorld world;
    test::add_screen(world, distance, Material::paint);
    const SimulatedScan scan = scan_world(RayCaster(world), kind, 1.0, {}, 7);
    std::vector<double> depths;
    for (std::size_t i = 0; i < scan.labels.size(); ++i) {
        if (scan.labels[i] != Label::wall) continue;
        const Vector3d at = scan.world_from_scan * scan.scan.cloud.positions[i].cast<double>();
        if (std::abs(at.y()) < 0.1 * distance && std::abs(at.z()) < 0.1 * distance)
            depths.push_back(at.x());
    }
    return depths;
}

double share_of_returns(const SimulatedScan& scan) {
    std::size_t count = 0;
    for (const Vector3f& point : scan.scan.cloud.positions)
        if (is_finite(point)) ++count;
    return static_cast<double>(count) / static_cast<double>(scan.labels.size());
}

class EveryScanner : public testing::TestWithParam<ScannerKind> {};
INSTANTIATE_TEST_SUITE_P(Scanner, EveryScanner, testing::ValuesIn(all_scanners),
                         [](const auto& kind) { return name_of(kind.param); });

TEST_P(EveryScanner, SeesABoxRoomWhereItIs) {
    const SimulatedWorld world = test::box_room(2.0, 1.8, 1.5);
    const Station station{.at = {0.3, -0.2, 0.1}, .heading = 30.0, .pitch = 2.0, .roll = -1.0};
    const SimulatedScan scan = scan_world(RayCaster(world), GetParam(), 4.0, station, 1);
    const std::size_t count = scan.scan.cloud.grid->rows * scan.scan.cloud.grid->columns;
    ASSERT_EQ(scan.scan.cloud.size(), count);
    ASSERT_EQ(scan.labels.size(), count);
    ASSERT_EQ(scan.instances.size(), count);
    ASSERT_EQ(scan.acceptable.size(), count);
    EXPECT_GT(share_of_returns(scan), 0.9);
    std::size_t right = 0;
    std::size_t returns = 0;
    for (std::size_t i = 0; i < count; ++i) {
        EXPECT_TRUE(scan.acceptable[i] & label_bit(scan.labels[i]));
        if (!is_finite(scan.scan.cloud.positions[i])) {
            EXPECT_EQ(scan.labels[i], Label::unknown);
            EXPECT_EQ(scan.instances[i], -1);
            continue;
        }
        ++returns;
        const Vector3d at = scan.world_from_scan * scan.scan.cloud.positions[i].cast<double>();
        const double off = (at.cwiseAbs() - Vector3d(2.0, 1.8, 1.5)).maxCoeff();
        const bool is_on_its_side = scan.labels[i] == Label::wall      ? std::abs(at.z()) < 1.6
                                    : scan.labels[i] == Label::floor   ? at.z() < -1.35
                                    : scan.labels[i] == Label::ceiling ? at.z() > 1.35
                                                                       : false;
        if (std::abs(off) < 0.1 && is_on_its_side) ++right;
    }
    EXPECT_GT(static_cast<double>(right), 0.99 * static_cast<double>(returns));
}

TEST_P(EveryScanner, GivesTheSameBitsOnAnyNumberOfThreads) {
    const SimulatedWorld world = test::box_room(2.0, 1.8, 1.5);
    const RayCaster caster(world);
    const SimulatedScan a = scan_world(caster, GetParam(), 4.0, {}, 3, test::with_threads(1));
    const SimulatedScan b = scan_world(caster, GetParam(), 4.0, {}, 3, test::with_threads(2));
    ASSERT_EQ(a.labels.size(), b.labels.size());
    EXPECT_EQ(std::memcmp(a.scan.cloud.positions.data(), b.scan.cloud.positions.data(),
                          a.labels.size() * sizeof(Vector3f)),
              0);
    EXPECT_EQ(a.scan.cloud.intensities, b.scan.cloud.intensities);
    EXPECT_EQ(a.labels, b.labels);
    EXPECT_EQ(a.acceptable, b.acceptable);
    const SimulatedScan other = scan_world(caster, GetParam(), 4.0, {}, 4);
    EXPECT_NE(std::memcmp(a.scan.cloud.positions.data(), other.scan.cloud.positions.data(),
                          a.labels.size() * sizeof(Vector3f)),
              0);
}

TEST_P(EveryScanner, SendsItsRaysWhereItSaysThatItLooks) {
    const ScannerModel model = scanner_model(GetParam(), 4.0);
    for (std::size_t row = 0; row < model.num_rows(); ++row) {
        for (std::size_t column = 0; column < model.num_columns; column += 7) {
            const Vector3d direction = ray_direction(model, row, column);
            ASSERT_NEAR(direction.norm(), 1.0, 1e-12);
            ASSERT_TRUE(is_in_view(model, (1.0 - 1e-9) * 2.0 * direction) || row == 0 ||
                        row + 1 == model.num_rows())
                << row << " " << column;
        }
    }
}

TEST(Scanner, NoiseIsAsStated) {
    for (const auto& [kind, sigma] : {std::pair{ScannerKind::terrestrial, 0.002},
                                      std::pair{ScannerKind::hokuyo_utm30lx, 0.008}}) {
        const std::vector<double> depths = depths_ahead(kind, 4.0);
        ASSERT_GT(depths.size(), 500U);
        EXPECT_NEAR(mean(depths), 4.0, 0.1 * sigma) << name_of(kind);
        EXPECT_NEAR(deviation(depths), sigma, 0.1 * sigma) << name_of(kind);
    }
    // The SICK rounds to centimetres, which adds 1/12 of their square to the variance.
    EXPECT_NEAR(deviation(depths_ahead(ScannerKind::sick_lms200, 4.0)),
                std::hypot(0.005, 0.01 / std::sqrt(12.0)), 0.0008);
    // Each beam of the spinning lidar has its own constant error.
    EXPECT_NEAR(deviation(depths_ahead(ScannerKind::spinning_lidar, 4.0)), 0.03, 0.008);
}

TEST(Scanner, NoiseOfTheDepthCameraGrowsWithTheSquareOfRange) {
    const double near = deviation(depths_ahead(ScannerKind::structured_light, 1.5));
    const double far = deviation(depths_ahead(ScannerKind::structured_light, 4.5));
    EXPECT_NEAR(near, 0.00135 * 1.5 * 1.5, 0.0008);
    EXPECT_NEAR(far / near, 9.0, 3.0);
}

TEST(Scanner, DepthsOfTheCameraComeInSteps) {
    // Neighbouring depths near 3 m: z^2 / (f b) times an eighth of a pixel.
    std::vector<double> depths = depths_ahead(ScannerKind::structured_light, 3.0);
    std::sort(depths.begin(), depths.end());
    std::vector<double> steps;
    for (std::size_t i = 1; i < depths.size(); ++i)
        if (depths[i] - depths[i - 1] > 1e-4) steps.push_back(depths[i] - depths[i - 1]);
    ASSERT_GE(steps.size(), 2U);
    EXPECT_NEAR(mean(steps), 9.0 / (580.0 * 0.075) * 0.125, 0.002);
}

TEST(Scanner, ReturnsNothingBeyondItsRange) {
    SimulatedWorld world;
    test::add_screen(world, 31.0, Material::paint);
    const RayCaster caster(world);
    EXPECT_EQ(share_of_returns(scan_world(caster, ScannerKind::hokuyo_utm30lx, 4.0, {}, 1)), 0.0);
    EXPECT_GT(share_of_returns(scan_world(caster, ScannerKind::terrestrial, 8.0, {}, 1)), 0.1);
    EXPECT_EQ(share_of_returns(scan_world(caster, ScannerKind::structured_light, 4.0, {}, 1)), 0.0);
}

TEST(Scanner, LosesGrazingRaysOnDarkSurfaces) {
    SimulatedWorld world;
    test::add_surface(world, Label::floor, Material::carpet,
                      {{-30, -30, -0.8}, {30, -30, -0.8}, {30, 30, -0.8}, {-30, 30, -0.8}});
    const SimulatedScan scan = scan_world(RayCaster(world), ScannerKind::sick_lms200, 1.0, {}, 2);
    std::array<double, 2> sent{};
    std::array<double, 2> returned{};
    const ScannerModel model = scanner_model(ScannerKind::sick_lms200);
    for (std::size_t row = 0; row < model.num_rows(); ++row) {
        for (std::size_t column = 0; column < model.num_columns; ++column) {
            const double down = -ray_direction(model, row, column).z();
            if (down < 0.08) continue;  // ahead at less than 10 m
            const std::size_t band = down < 0.12 ? 0 : 1;
            sent[band] += 1.0;
            if (is_finite(scan.scan.cloud.positions[row * model.num_columns + column]))
                returned[band] += 1.0;
        }
    }
    EXPECT_LT(returned[0] / sent[0], 0.5);
    EXPECT_GT(returned[1] / sent[1], 0.9);
}

TEST(Scanner, MostRaysPassGlassAndAFewComeBack) {
    SimulatedWorld world;
    const std::uint32_t pane = test::add_screen(world, 2.0, Material::glass, 50.0, Label::window);
    world.parts[pane].transparency = 0.9;
    test::add_screen(world, 5.0, Material::paint, 50.0);
    const SimulatedScan scan =
        scan_world(RayCaster(world), ScannerKind::hokuyo_utm30lx, 2.0, {}, 3);
    std::array<double, num_labels> count{};
    double all = 0.0;
    for (std::size_t i = 0; i < scan.labels.size(); ++i) {
        const Vector3f direction =
            ray_direction(scanner_model(ScannerKind::hokuyo_utm30lx, 2.0),
                          i / scan.scan.cloud.grid->columns, i % scan.scan.cloud.grid->columns)
                .cast<float>();
        if (direction.x() < 0.9F) continue;
        all += 1.0;
        if (is_finite(scan.scan.cloud.positions[i]))
            count[static_cast<std::size_t>(scan.labels[i])] += 1;
    }
    EXPECT_NEAR(count[static_cast<std::size_t>(Label::wall)] / all, 0.9, 0.02);
    const double returned = count[static_cast<std::size_t>(Label::window)] / all;
    EXPECT_GT(returned, 0.01);
    EXPECT_LT(returned, 0.08);
}

TEST(Scanner, PutsWhatAMirrorShowsBehindIt) {
    SimulatedWorld world;
    add_quad(world, add_clutter_part(world, Material::mirror), {2, -9, -9}, {2, 9, -9}, {2, 9, 9},
             {2, -9, 9});
    test::add_screen(world, -1.0, Material::paint, 60.0);
    const SimulatedScan scan = scan_world(RayCaster(world), ScannerKind::terrestrial, 8.0, {}, 4);
    std::size_t ghosts = 0;
    std::size_t elsewhere = 0;
    for (std::size_t i = 0; i < scan.labels.size(); ++i) {
        const Vector3f& point = scan.scan.cloud.positions[i];
        if (!is_finite(point) || point.x() < 2.2F) continue;
        ++ghosts;
        if (std::abs(point.x() - 5.0F) > 0.03F) ++elsewhere;  // than the screen's mirror image
        EXPECT_EQ(scan.labels[i], Label::unknown);
        EXPECT_EQ(scan.instances[i], -1);
        EXPECT_EQ(scan.acceptable[i], label_bit(Label::unknown));
    }
    EXPECT_GT(ghosts, 1000U);
    EXPECT_LT(elsewhere, ghosts / 1000 + 1);  // outliers
}

TEST(Scanner, MixesDepthsWhereABeamMeetsAnEdge) {
    SimulatedWorld world;
    // A cupboard's side ends at y = 0; the wall is 0.4 m behind.
    test::add_surface(world, Label::furniture, Material::paint,
                      {{3, -50, -50}, {3, 0.003, -50}, {3, 0.003, 50}, {3, -50, 50}});
    test::add_screen(world, 3.4, Material::paint);
    const SimulatedScan scan = scan_world(RayCaster(world), ScannerKind::sick_lms200, 1.0, {}, 5);
    const LabelSet both =
        label_bit(Label::furniture) | label_bit(Label::wall) | label_bit(Label::unknown);
    std::size_t mixed = 0;
    std::size_t between = 0;
    for (std::size_t i = 0; i < scan.labels.size(); ++i) {
        const Vector3d at = scan.scan.cloud.positions[i].cast<double>();
        if (!at.allFinite() || scan.labels[i] == Label::unknown || std::abs(at.z()) > 1.0 ||
            std::abs(at.y()) > 1.0) {
            continue;
        }
        EXPECT_GT(at.x(), 2.95);
        EXPECT_LT(at.x(), 3.45);
        const bool is_between = at.x() > 3.06 && at.x() < 3.34;
        if (is_between) ++between;
        if (scan.acceptable[i] == both) ++mixed;
        EXPECT_TRUE(!is_between || scan.acceptable[i] == both);
        if (std::abs(at.y()) > 0.05) {
            EXPECT_EQ(scan.acceptable[i], label_bit(scan.labels[i]));
            EXPECT_EQ(scan.labels[i], at.y() < 0.0 ? Label::furniture : Label::wall);
        }
    }
    // About 70 rows cross that stretch of edge.
    EXPECT_GT(mixed, 40U);
    EXPECT_GT(between, 15U);
}

TEST(Scanner, KeepsDepthsApartThatAPulseResolves) {
    SimulatedWorld world;
    test::add_surface(world, Label::furniture, Material::paint,
                      {{3, -50, -50}, {3, 0.003, -50}, {3, 0.003, 50}, {3, -50, 50}});
    test::add_screen(world, 6.0, Material::paint);
    const SimulatedScan scan = scan_world(RayCaster(world), ScannerKind::sick_lms200, 1.0, {}, 5);
    for (std::size_t i = 0; i < scan.labels.size(); ++i) {
        const Vector3f& at = scan.scan.cloud.positions[i];
        if (scan.labels[i] == Label::unknown || std::abs(at.z()) > 0.5F) continue;
        EXPECT_TRUE(at.x() < 3.1F || at.x() > 5.9F) << at.x();
    }
}

TEST(Scanner, DepthCameraSeesNothingWhereItsProjectorDoesNot) {
    SimulatedWorld world;
    test::add_surface(world, Label::furniture, Material::paint,
                      {{1, -0.1, -9}, {1, 0.1, -9}, {1, 0.1, 9}, {1, -0.1, 9}});
    test::add_screen(world, 3.0, Material::paint);
    const SimulatedScan scan =
        scan_world(RayCaster(world), ScannerKind::structured_light, 1.0, {}, 6);
    // The projector is to the right, so the shadow falls to the left of the board: from its left
    // edge at x = -0.1 m, z = 1 m, to x = -0.1 - (3 - 1) / 1 * (0.075 + 0.1) = -0.45 m at z = 3 m.
    const auto pixel = [](double x, double z) {
        return static_cast<std::size_t>(319.5 + 580.0 * x / z);
    };
    const auto is_seen = [&](std::size_t column) {
        return is_finite(scan.scan.cloud.positions[240 * 640 + column]);
    };
    const std::size_t edge = pixel(-0.1, 1.0);
    const std::size_t end = pixel(-0.45, 3.0);
    ASSERT_LT(end, edge);
    for (std::size_t column = end + 4; column < edge - 4; ++column)
        EXPECT_FALSE(is_seen(column)) << column;
    EXPECT_TRUE(is_seen(end - 6));
    EXPECT_TRUE(is_seen(edge + 6));
    EXPECT_TRUE(is_seen(pixel(0.1, 1.0) + 6));
}

TEST(Scanner, StandsAndTurnsAsTheStationSays) {
    const Station station{.at = {1.0, 2.0, 3.0}, .heading = 90.0, .pitch = 30.0};
    const Transform lidar = scanner_pose(ScannerKind::terrestrial, station);
    EXPECT_THAT(lidar.translation(), test::VectorNear(Vector3d(1.0, 2.0, 3.0), 1e-12));
    const Vector3d ahead(0.0, std::cos(radians(30.0)), -0.5);  // nose down
    EXPECT_THAT(Vector3d(lidar.linear() * Vector3d::UnitX()), test::VectorNear(ahead, 1e-12));
    EXPECT_THAT(Vector3d(lidar.linear() * Vector3d::UnitY()),
                test::VectorNear(Vector3d(-Vector3d::UnitX()), 1e-12));
    const Transform camera = scanner_pose(ScannerKind::structured_light, station);
    EXPECT_THAT(Vector3d(camera.linear() * Vector3d::UnitZ()), test::VectorNear(ahead, 1e-12));
    EXPECT_THAT(Vector3d(camera.linear() * Vector3d::UnitX()),
                test::VectorNear(Vector3d::UnitX(), 1e-12));
}

TEST(Scanner, KnowsWhatIsInView) {
    EXPECT_TRUE(is_in_view(ScannerKind::sick_lms200, {1, 0, 1}));
    EXPECT_FALSE(is_in_view(ScannerKind::sick_lms200, {0.1, 0, 1}));  // above 60 degrees
    EXPECT_FALSE(is_in_view(ScannerKind::sick_lms200, {-1, 0, 0}));
    EXPECT_FALSE(is_in_view(ScannerKind::sick_lms200, {81, 0, 0}));
    EXPECT_TRUE(is_in_view(ScannerKind::hokuyo_utm30lx, {-1, 1.5, 0}));  // 124 degrees
    EXPECT_FALSE(is_in_view(ScannerKind::hokuyo_utm30lx, {-1, 0.5, 0}));
    EXPECT_TRUE(is_in_view(ScannerKind::terrestrial, {-1, 0, 5}));
    EXPECT_FALSE(is_in_view(ScannerKind::terrestrial, {0.5, 0, -1.5}));  // in the cone below
    EXPECT_TRUE(is_in_view(ScannerKind::structured_light, {0.5, 0.3, 1}));
    EXPECT_FALSE(is_in_view(ScannerKind::structured_light, {0.6, 0, 1}));
    EXPECT_FALSE(is_in_view(ScannerKind::structured_light, {0, 0, -1}));
    EXPECT_FALSE(is_in_view(ScannerKind::structured_light, {0, 0, 5.1}));
    EXPECT_FALSE(is_in_view(ScannerKind::spinning_lidar, {1, 0, 1}));
}

TEST(Scanner, CoarsenessSpreadsTheRays) {
    const ScannerModel fine = scanner_model(ScannerKind::terrestrial);
    const ScannerModel coarse = scanner_model(ScannerKind::terrestrial, 2.0);
    EXPECT_EQ(fine.num_columns, 2400U);
    EXPECT_EQ(coarse.num_columns, 1200U);
    EXPECT_EQ(scanner_model(ScannerKind::spinning_lidar, 1.0).num_rows(), 64U);
    EXPECT_EQ(scanner_model(ScannerKind::spinning_lidar, 2.0).num_rows(), 32U);
    EXPECT_EQ(scanner_model(ScannerKind::spinning_lidar, 4.0).num_rows(), 16U);
    EXPECT_EQ(scanner_model(ScannerKind::sick_lms200).num_columns, 721U);
    EXPECT_EQ(scanner_model(ScannerKind::hokuyo_utm30lx).num_columns, 1081U);
    EXPECT_THROW(scanner_model(ScannerKind::sick_lms200, 0.1), InvalidArgument);
}

}  // namespace
}  // namespace roomscribe
