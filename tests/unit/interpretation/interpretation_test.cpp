// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/random.hpp"
#include "roomscribe/interpretation/point_labels.hpp"
#include "roomscribe/interpretation/rooms/room_surfaces.hpp"
#include "roomscribe/interpretation/upright/upright.hpp"
#include "roomscribe/preprocessing/scan_statistics.hpp"
#include "roomscribe/structure/plane_growing.hpp"
#include "roomscribe/structure/principal_axes.hpp"
#include "support/simulated_rooms.hpp"

namespace roomscribe {
namespace {

struct Interpretation {
    SurfaceSample sample;
    std::vector<PlanarPatch> patches;
    Upright upright;
    RoomSurfaces surfaces;
    Openings openings;
    PointLabels labels;
};

/// `known_upright` is taken instead of what find_upright would say.
Interpretation interpret(PointCloud cloud, const Context& context = {},
                         const std::optional<Upright>& known_upright = {}) {
    Interpretation result;
    const ScanMap map = map_of_cloud({"room", std::move(cloud)});
    const ScanStatistics statistics = estimate_scan_statistics(map.cloud, context);
    result.sample = sample_surface(map, statistics, {}, context);
    const PlaneGrowingSettings growing{.distance_tolerance = result.sample.tolerance,
                                       .cell_size = 2.0 * result.sample.spacing};
    result.patches = grow_planar_patches(result.sample.cloud, growing, context);
    const PrincipalAxes axes = estimate_principal_axes(result.patches, {}, context);
    result.upright = known_upright ? *known_upright
                                   : find_upright(result.sample, result.patches, axes, {}, context);
    result.surfaces = find_room_surfaces(sample_rays(map), result.sample, result.patches,
                                         result.upright, {}, context);
    result.openings =
        find_openings(map, sample_rays(map), result.sample, result.patches, result.surfaces,
                      result.upright.room_from_map, statistics.point_spacing, context);
    result.labels = label_points(map.cloud, result.sample, result.patches, result.surfaces,
                                 result.openings, {}, context);
    return result;
}

Context with_threads(int count) {
    Context context;
    context.num_threads = count;
    return context;
}

Transform random_pose(Random& random) {
    const Eigen::Quaterniond turn(random.normal(), random.normal(), random.normal(),
                                  random.normal());
    Transform pose = Transform::Identity();
    pose.linear() = turn.normalized().toRotationMatrix();
    pose.translation() = Eigen::Vector3d(random.normal(), random.normal(), random.normal());
    return pose;
}

double iou(const std::vector<Label>& truth, const std::vector<Label>& found, Label label) {
    std::size_t both = 0;
    std::size_t either = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        both += truth[i] == label && found[i] == label ? 1 : 0;
        either += truth[i] == label || found[i] == label ? 1 : 0;
    }
    return static_cast<double>(both) / static_cast<double>(either);
}

std::ptrdiff_t count(const RoomSurfaces& surfaces, Label label) {
    return std::count_if(surfaces.surfaces.begin(), surfaces.surfaces.end(),
                         [label](const auto& s) { return s.component.label == label; });
}

bool has_wall_at(const RoomSurfaces& surfaces, const Eigen::Vector3d& point) {
    return std::any_of(surfaces.surfaces.begin(), surfaces.surfaces.end(), [&](const auto& s) {
        return s.component.label == Label::wall && std::abs(s.plane.signed_distance(point)) < 0.01;
    });
}

TEST(Interpretation, LevelsAndLabelsAFurnishedRoomInAnyPose) {
    const test::LabelledCloud room = test::simulate_furnished_room(3);
    Random random(17);
    std::vector<Transform> poses{Transform::Identity(), Transform::Identity()};
    poses[1].linear() = Eigen::AngleAxisd(3.14159265, Eigen::Vector3d::UnitX()).toRotationMatrix();
    for (int i = 0; i < 3; ++i)
        poses.push_back(random_pose(random));
    for (const Transform& pose : poses) {
        PointCloud cloud = room.cloud;
        transform_in_place(cloud, pose);
        const Interpretation found = interpret(std::move(cloud));
        EXPECT_EQ(found.upright.stop, UprightStop::decided);
        EXPECT_GT(found.upright.up().dot(pose.linear().col(2)), std::cos(0.01));
        EXPECT_EQ(count(found.surfaces, Label::floor), 1);
        EXPECT_EQ(count(found.surfaces, Label::ceiling), 1);
        EXPECT_EQ(count(found.surfaces, Label::wall), 4);
        EXPECT_GE(iou(room.labels, found.labels.labels, Label::floor), 0.95);
        EXPECT_GE(iou(room.labels, found.labels.labels, Label::ceiling), 0.95);
        EXPECT_GE(iou(room.labels, found.labels.labels, Label::wall), 0.9);

        // The long walls run along x, the floor lies at z = 0, the surfaces begin at x = y = 0.
        const Transform room_from_room = found.surfaces.room_from_map * pose;
        const Eigen::Vector3d middle_of_floor = room_from_room * Eigen::Vector3d(2.5, 2.0, 0.0);
        EXPECT_NEAR(std::abs(room_from_room.linear()(0, 0)), 1.0, 1e-3);
        EXPECT_NEAR(middle_of_floor.x(), 2.5, 0.06);
        EXPECT_NEAR(middle_of_floor.z(), 0.0, 0.01);
        for (const Eigen::Vector3d& on_wall :
             {Eigen::Vector3d(0.0, 2.0, 1.5), Eigen::Vector3d(5.0, 2.0, 1.5),
              Eigen::Vector3d(2.5, 0.0, 1.5), Eigen::Vector3d(2.5, 4.0, 1.5)}) {
            EXPECT_TRUE(has_wall_at(found.surfaces, pose * on_wall)) << on_wall.transpose();
        }
        for (const RoomSurface& surface : found.surfaces.surfaces) {
            // Everything looks into the room.
            const Eigen::Vector3d middle = pose * Eigen::Vector3d(2.5, 2.0, 1.35);
            EXPECT_GT(surface.plane.signed_distance(middle), 0.0) << surface.component.id;
            EXPECT_FALSE(surface.component.evidence.rule.empty());
            if (surface.component.label == Label::wall) {
                EXPECT_EQ(surface.component.polygon.size(), 4U);
            }
        }
    }
}

TEST(Interpretation, ChoosesTheSameRoomFrameHoweverTheMapWasTurned) {
    const test::LabelledCloud room = test::simulate_furnished_room(5);
    const Interpretation first = interpret(room.cloud);
    Random random(23);
    const Transform pose = random_pose(random);
    PointCloud cloud = room.cloud;
    transform_in_place(cloud, pose);
    const Interpretation second = interpret(std::move(cloud));
    const Transform difference =
        second.surfaces.room_from_map * pose * first.surfaces.room_from_map.inverse();
    EXPECT_LT(rotation_angle(difference.linear()), 0.01);
    EXPECT_LT(difference.translation().norm(), 0.1);
}

TEST(Interpretation, GivesTheSameBitsOnOneAndTwoThreads) {
    const test::LabelledCloud room = test::simulate_furnished_room(7);
    const Interpretation one = interpret(room.cloud, with_threads(1));
    const Interpretation two = interpret(room.cloud, with_threads(2));
    EXPECT_EQ(one.labels.labels, two.labels.labels);
    EXPECT_EQ(one.labels.instances, two.labels.instances);
    EXPECT_EQ(one.labels.confidences, two.labels.confidences);
    EXPECT_EQ(one.surfaces.room_from_map.matrix(), two.surfaces.room_from_map.matrix());
}

/// A room 5 m wide under a roof: knee walls of 0.9 m, slopes of 45 degrees, level from 2.4 m.
double attic_ceiling(double x) {
    return 0.9 + std::min({x, 5.0 - x, 1.5});
}

constexpr double attic_length = 6.5;  // m, more than a storey is high: no gable to stand on

struct Attic {
    PointCloud cloud;
    std::vector<Label> truth;

    void add(const Eigen::Vector3d& point, Label label) {
        cloud.positions.push_back(point.cast<float>());
        truth.push_back(label);
    }
};

/// A window of 0.7 x 1 m in the first slope, its frame 0.15 m deep in a hole that is lined.
void add_roof_window(Attic& attic, double step) {
    const Eigen::Vector3d up = Eigen::Vector3d(1.0, 0.0, 1.0).normalized();
    const Eigen::Vector3d outwards = Eigen::Vector3d(-1.0, 0.0, 1.0).normalized();
    const Eigen::Vector3d corner = Eigen::Vector3d(0.0, 2.0, 0.9) + 0.6 * up;
    const auto place = [&](double along, double above, double depth) -> Eigen::Vector3d {
        return corner + along * Eigen::Vector3d::UnitY() + above * up + depth * outwards;
    };
    for (double along = 0.0; along <= 0.7; along += step) {
        for (double above = 0.0; above <= 1.0; above += step) {
            const double inside = std::min({along, 0.7 - along, above, 1.0 - above});
            if (inside < 0.06) attic.add(place(along, above, 0.15), Label::window_frame);
            for (double depth = step; inside < 0.5 * step && depth < 0.15; depth += step)
                attic.add(place(along, above, depth), Label::unknown);
        }
    }
}

bool is_in_roof_window(double x, double y) {
    const double above = std::sqrt(2.0) * x - 0.6;
    return y > 2.0 && y < 2.7 && above > 0.0 && above < 1.0;
}

Attic make_attic(bool has_window) {
    constexpr double step = 0.02;
    Attic attic;
    for (double y = 0.5 * step; y < attic_length; y += step) {
        for (double x = 0.5 * step; x < 5.0; x += step) {
            attic.add({x, y, 0.0}, Label::floor);
            if (!has_window || !is_in_roof_window(x, y))
                attic.add({x, y, attic_ceiling(x)}, Label::ceiling);
        }
        for (double z = 0.5 * step; z < 0.9; z += step) {
            attic.add({0.0, y, z}, Label::wall);
            attic.add({5.0, y, z}, Label::wall);
        }
    }
    for (double x = 0.5 * step; x < 5.0; x += step) {
        for (double z = 0.5 * step; z < attic_ceiling(x); z += step) {
            attic.add({x, 0.0, z}, Label::wall);
            attic.add({x, attic_length, z}, Label::wall);
        }
    }
    if (has_window) add_roof_window(attic, step);
    return attic;
}

TEST(Interpretation, UnderARoofTheSlopesAreOneCeilingWithTheLevelPart) {
    Attic attic = make_attic(false);
    const Interpretation result = interpret(std::move(attic.cloud));
    EXPECT_GT(result.upright.up().z(), 0.99);
    EXPECT_EQ(count(result.surfaces, Label::ceiling), 1);
    EXPECT_EQ(count(result.surfaces, Label::wall), 4);
    for (const Label label : {Label::floor, Label::ceiling, Label::wall})
        EXPECT_GT(iou(attic.truth, result.labels.labels, label), 0.93) << label_name(label);
    ASSERT_EQ(result.surfaces.rooms.size(), 1U);
    EXPECT_NEAR(result.surfaces.rooms[0].ceiling_height, 2.4, 0.02);
    EXPECT_TRUE(result.openings.components.empty());
}

TEST(Interpretation, FindsAWindowInTheSlopeOfARoof) {
    Attic attic = make_attic(true);
    const Interpretation result = interpret(std::move(attic.cloud));
    ASSERT_EQ(result.openings.components.size(), 2U);
    const Component& window = result.openings.components[0];
    EXPECT_EQ(window.label, Label::window);
    EXPECT_EQ(window.parent, "ceiling-1");
    const Eigen::Vector3d across = window.polygon[1] - window.polygon[0];
    const Eigen::Vector3d upwards = window.polygon[3] - window.polygon[0];
    EXPECT_NEAR(upwards.normalized().z(), std::sqrt(0.5), 0.01);
    EXPECT_NEAR(across.z(), 0.0, 1e-3);
    EXPECT_NEAR(result.openings.openings[0].frame_depth, 0.15, 0.02);
    EXPECT_NEAR(result.openings.openings[0].hole.width(), 0.7, 0.06);
    EXPECT_NEAR(result.openings.openings[0].hole.height(), 1.0, 0.06);
    EXPECT_GT(iou(attic.truth, result.labels.labels, Label::window_frame), 0.6);
}

TEST(Interpretation, KeepsPointsWithoutPlaceUnknown) {
    test::LabelledCloud room = test::simulate_furnished_room(9);
    const std::size_t total = room.cloud.size();
    room.cloud.positions[0].x() = std::numeric_limits<float>::quiet_NaN();
    room.cloud.positions[total - 1].setConstant(std::numeric_limits<float>::infinity());
    const Interpretation found = interpret(room.cloud);
    ASSERT_EQ(found.labels.labels.size(), total);
    for (const std::size_t i : {std::size_t{0}, total - 1}) {
        EXPECT_EQ(found.labels.labels[i], Label::unknown);
        EXPECT_EQ(found.labels.instances[i], -1);
        EXPECT_EQ(found.labels.confidences[i], 0.0F);
    }
    for (std::size_t i = 0; i < total; ++i) {
        ASSERT_EQ(found.labels.labels[i] != Label::unknown, found.labels.instances[i] != -1);
        EXPECT_GE(found.labels.confidences[i], 0.0F);
        EXPECT_LE(found.labels.confidences[i], 1.0F);
    }
}

TEST(Interpretation, FindsNothingInNextToNothing) {
    EXPECT_EQ(interpret({}).upright.stop, UprightStop::no_plane);
    PointCloud few;
    for (int i = 0; i < 10; ++i) {
        few.positions.emplace_back(static_cast<float>(i % 3), static_cast<float>(i % 4), 0.0F);
    }
    const Interpretation found = interpret(few);
    EXPECT_TRUE(found.surfaces.surfaces.empty());
    EXPECT_EQ(std::count(found.labels.labels.begin(), found.labels.labels.end(), Label::unknown),
              10);
    PointCloud equal;
    equal.positions.assign(1000, Eigen::Vector3f(1, 2, 3));
    EXPECT_TRUE(interpret(equal).surfaces.surfaces.empty());
}

TEST(Interpretation, CallsALonePlaneDoubtful) {
    PointCloud cloud;
    Random random(2);
    for (int i = 0; i < 4000; ++i) {
        cloud.positions.emplace_back(static_cast<float>(random.uniform()),
                                     static_cast<float>(random.uniform()), 0.5F);
    }
    const Interpretation found = interpret(cloud);
    EXPECT_EQ(found.upright.candidates.size(), 2U);
    EXPECT_EQ(found.upright.stop, UprightStop::ambiguous);
    for (const RoomSurface& surface : found.surfaces.surfaces) {
        EXPECT_EQ(surface.component.verdict, Verdict::doubtful);
        EXPECT_FALSE(surface.component.evidence.alternative.empty());
    }
}

TEST(LabelPoints, RejectsASampleOfAnotherMap) {
    const SurfaceSample sample;
    PointCloud map;
    map.positions.resize(3);
    EXPECT_THROW(label_points(map, sample, {}, {}, {}), InvalidArgument);
}

}  // namespace
}  // namespace roomscribe
