// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/furniture/furniture.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/interpretation/furniture/hidden_seats.hpp"
#include "roomscribe/interpretation/furniture/level_slabs.hpp"
#include "roomscribe/interpretation/furniture/pedestals.hpp"
#include "roomscribe/interpretation/furniture/piece_drafts.hpp"
#include "roomscribe/interpretation/furniture/piece_faces.hpp"
#include "roomscribe/interpretation/furniture/piece_kinds.hpp"
#include "roomscribe/interpretation/furniture/plan_rectangle.hpp"
#include "roomscribe/interpretation/furniture/row_cuts.hpp"
#include "roomscribe/interpretation/furniture/tall_pieces.hpp"
#include "roomscribe/interpretation/point_labels.hpp"
#include "roomscribe/interpretation/upright/upright.hpp"
#include "roomscribe/preprocessing/scan_statistics.hpp"
#include "roomscribe/structure/planar_surfaces.hpp"
#include "roomscribe/structure/principal_axes.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

/// Clouds of rectangles whose points know what they are of.
class MadeUpRoom {
  public:
    static constexpr double spacing = 0.02;
    static constexpr int room = -1;

    /// 5 x 4 x 2.6 m, closed.
    MadeUpRoom() {
        rectangle({0, 0, 0}, {5, 0, 0}, {0, 4, 0}, room);
        rectangle({0, 0, 2.6}, {5, 0, 0}, {0, 4, 0}, room);
        rectangle({0, 0, 0}, {5, 0, 0}, {0, 0, 2.6}, room);
        rectangle({0, 4, 0}, {5, 0, 0}, {0, 0, 2.6}, room);
        rectangle({0, 0, 0}, {0, 4, 0}, {0, 0, 2.6}, room);
        rectangle({5, 0, 0}, {0, 4, 0}, {0, 0, 2.6}, room);
    }

    /// A box that stands with its middle at a place, turned about it; all sides but the underside.
    void box(const Vector3d& middle, double turn, const Vector3d& size, int thing,
             double bottom = 0.0) {
        const Vector3d u = size.x() * Vector3d(std::cos(turn), std::sin(turn), 0.0);
        const Vector3d v = size.y() * Vector3d(-std::sin(turn), std::cos(turn), 0.0);
        const Vector3d w(0.0, 0.0, size.z());
        const Vector3d low = middle - 0.5 * (u + v) + Vector3d(0.0, 0.0, bottom);
        rectangle(low, u, w, thing);
        rectangle(low + v, u, w, thing);
        rectangle(low, v, w, thing);
        rectangle(low + u, v, w, thing);
        rectangle(low + w, u, v, thing);
    }

    /// What is seen of a box in a row along the wall at y = 0: its front and its top.
    void in_row(double from, double to, double depth, double height, int thing) {
        rectangle({from, depth, 0}, {to - from, 0, 0}, {0, 0, height}, thing);
        rectangle({from, 0.03, height}, {to - from, 0, 0}, {0, depth - 0.03, 0}, thing);
    }

    /// A plate on four legs.
    void table(const Vector3d& middle, double turn, double length, double width, double height,
               int thing) {
        box(middle, turn, {length, width, 0.03}, thing, height - 0.03);
        const Vector3d u(std::cos(turn), std::sin(turn), 0.0);
        const Vector3d v(-std::sin(turn), std::cos(turn), 0.0);
        for (const double i : {-0.5, 0.5}) {
            for (const double j : {-0.5, 0.5}) {
                const Vector3d foot = middle + i * (length - 0.06) * u + j * (width - 0.06) * v;
                box(foot, turn, {0.05, 0.05, height - 0.03}, thing);
            }
        }
    }

    /// A seat of 0.44 m at 0.45 m on four legs, with a back to 0.9 m on the far side.
    void chair(const Vector3d& middle, double turn, int thing) {
        table(middle, turn, 0.44, 0.44, 0.45, thing);
        const Vector3d v(-std::sin(turn), std::cos(turn), 0.0);
        box(middle + 0.21 * v, turn, {0.44, 0.03, 0.45}, thing, 0.45);
    }

    PointCloud cloud;
    std::vector<int> things;  ///< per point

  private:
    void rectangle(const Vector3d& corner, const Vector3d& u, const Vector3d& v, int thing) {
        const auto columns = static_cast<int>(std::ceil(u.norm() / spacing));
        const auto rows = static_cast<int>(std::ceil(v.norm() / spacing));
        const Vector3d normal = u.cross(v).normalized();
        for (int i = 0; i <= columns; ++i) {
            for (int j = 0; j <= rows; ++j) {
                const Vector3d point =
                    corner + u * i / columns + v * j / rows + 0.001 * random_.normal() * normal;
                cloud.positions.emplace_back(point.cast<float>());
                things.push_back(thing);
            }
        }
    }

    Random random_{7};
};

struct Found {
    Furniture furniture;
    PointLabels labels;
    std::int32_t first_instance = 0;
};

/// The way up is given: that of a bare room with a box in it is anybody's guess.
Found find(const PointCloud& cloud, const FurnitureSettings& settings = {},
           const Context& context = {},
           const Eigen::Matrix3d& room_from_map = Eigen::Matrix3d::Identity()) {
    const ScanMap map = map_of_cloud({"room", cloud});
    const ScanStatistics statistics = estimate_scan_statistics(map.cloud, context);
    const SurfaceSample sample = sample_surface(map, statistics, {}, context);
    const auto patches =
        find_planar_surfaces(
            map, sample,
            {.distance_tolerance = sample.tolerance, .cell_size = 2.0 * sample.spacing}, context)
            .patches;
    const PrincipalAxes axes = estimate_principal_axes(patches, {}, context);
    Upright upright = find_upright(sample, patches, axes, {}, context);
    upright.room_from_map = room_from_map;
    RoomSurfaces surfaces =
        find_room_surfaces(sample_rays(map), sample, patches, upright, {}, context);
    const Openings openings =
        find_openings(map, sample_rays(map), sample, patches, surfaces, upright.room_from_map,
                      statistics.point_spacing, context);
    Found found;
    found.labels = label_points(map.cloud, sample, patches, surfaces, openings, {}, context);
    found.first_instance =
        static_cast<std::int32_t>(surfaces.surfaces.size() + openings.components.size());
    found.furniture = find_furniture(map, sample, patches, surfaces, found.labels.labels,
                                     found.first_instance, 1, settings, context);
    label_furniture(sample, found.furniture, found.labels);
    return found;
}

std::vector<const Component*> pieces_of(const Found& found) {
    std::vector<const Component*> pieces;
    for (const Component& component : found.furniture.components) {
        if (component.label == Label::furniture && component.box) pieces.push_back(&component);
    }
    return pieces;
}

/// IoU in points of a made-up thing and the piece that shares most with it.
double best_iou(const MadeUpRoom& made, const Found& found, int thing) {
    std::map<std::int32_t, std::size_t> shared;
    std::map<std::int32_t, std::size_t> size;
    std::size_t num_thing = 0;
    for (std::size_t i = 0; i < made.things.size(); ++i) {
        const std::int32_t instance =
            found.labels.labels[i] == Label::furniture ? found.labels.instances[i] : -1;
        if (instance >= 0) ++size[instance];
        if (made.things[i] != thing) continue;
        ++num_thing;
        if (instance >= 0) ++shared[instance];
    }
    double best = 0.0;
    for (const auto& [instance, count] : shared) {
        const double together = static_cast<double>(num_thing + size[instance] - count);
        best = std::max(best, static_cast<double>(count) / together);
    }
    return best;
}

TEST(FindFurniture, FindsNothingInAnEmptyRoom) {
    const MadeUpRoom made;
    const Found found = find(made.cloud);
    EXPECT_TRUE(found.furniture.components.empty());
    EXPECT_TRUE(found.furniture.fronts.empty());
}

TEST(FindFurniture, GivesABoxOnTheFloorItsSizeTopAndFront) {
    MadeUpRoom made;
    made.box({2.0, 0.25, 0.0}, 0.0, {0.8, 0.45, 0.9}, 1);
    const Found found = find(made.cloud);
    const auto pieces = pieces_of(found);
    ASSERT_EQ(pieces.size(), 1U);
    EXPECT_EQ(pieces[0]->kind, "cabinet");
    EXPECT_EQ(pieces[0]->instance, found.first_instance);
    EXPECT_FALSE(pieces[0]->parent.empty());
    EXPECT_NEAR(pieces[0]->box->size.x(), 0.8, 0.04);
    EXPECT_NEAR(pieces[0]->box->size.y(), 0.45, 0.05);
    EXPECT_NEAR(pieces[0]->box->size.z(), 0.9, 0.04);
    // Its back lies on the wall for all that can be told.
    EXPECT_GT(best_iou(made, found, 1), 0.6);
    const Component* top = nullptr;
    for (const Component& component : found.furniture.components) {
        if (component.kind == "top") top = &component;
    }
    ASSERT_NE(top, nullptr);
    EXPECT_EQ(top->parent, pieces[0]->id);
    ASSERT_EQ(top->polygon.size(), 4U);
    EXPECT_NEAR((top->polygon[1] - top->polygon[0]).norm(), 0.8, 0.05);
    EXPECT_NEAR((top->polygon[2] - top->polygon[1]).norm(), 0.45, 0.05);
    // The front looks off the wall at y = 0.
    ASSERT_EQ(found.furniture.fronts.size(), 1U);
    const MountingFace& front = found.furniture.fronts[0];
    EXPECT_GT(front.plane.normal.y(), 0.99);
    EXPECT_NEAR(front.plane.offset, 0.475, 0.01);
    EXPECT_NEAR(front.extent.width(), 0.8, 0.02);
    EXPECT_TRUE(front.may_be_several);
    EXPECT_EQ(found.furniture.components[front.component].parent, pieces[0]->id);
}

TEST(FindFurniture, PartsCabinetsOfTwoHeightsSideBySide) {
    MadeUpRoom made;
    made.in_row(1.2, 2.0, 0.47, 0.9, 1);
    made.in_row(2.0, 2.8, 0.47, 0.75, 2);
    made.in_row(2.8, 3.8, 0.63, 2.0, 3);
    const Found found = find(made.cloud);
    EXPECT_EQ(pieces_of(found).size(), 3U);
    for (const int thing : {1, 2, 3})
        EXPECT_GT(best_iou(made, found, thing), 0.8) << thing;
}

TEST(FindFurniture, TellsAChairFromTheTableThatItIsPushedUnder) {
    for (const double turn : {0.0, radians(30.0)}) {
        MadeUpRoom made;
        const Vector3d middle(2.5, 2.0, 0.0);
        const Vector3d v(-std::sin(turn), std::cos(turn), 0.0);
        made.table(middle, turn, 1.4, 0.8, 0.74, 1);
        made.chair(middle + 0.4 * v, turn, 2);
        const Found found = find(made.cloud);
        EXPECT_EQ(pieces_of(found).size(), 2U);
        EXPECT_GT(best_iou(made, found, 1), 0.8);
        EXPECT_GT(best_iou(made, found, 2), 0.7);
    }
}

TEST(FindFurniture, PartsAPedestalFromTheDeskThatItRollsUnder) {
    // As wide as pedestals, its front 6 cm behind the desk's edge.
    const auto iou_of = [](double height, int thing) {
        MadeUpRoom made;
        made.table({2.5, 2.0, 0.0}, 0.0, 1.6, 0.8, 0.74, 1);
        made.box({2.0, 1.96, 0.0}, 0.0, {0.43, 0.6, height}, 2);
        return best_iou(made, find(made.cloud), thing);
    };
    EXPECT_GT(iou_of(0.6, 1), 0.8);
    EXPECT_GT(iou_of(0.6, 2), 0.7);
    // What reaches the top is a part of the desk.
    EXPECT_LT(iou_of(0.7, 2), 0.5);
}

TEST(FindFurniture, GivesABackTheLegsBelowItThatTouchATable) {
    MadeUpRoom made;
    const Vector3d middle(2.5, 2.0, 0.0);
    made.table(middle, 0.0, 1.4, 0.8, 0.74, 1);
    // Its seat was not seen, and its legs are nearer to the table than to its back.
    const Vector3d seat(2.6, 2.3, 0.0);
    made.box(seat + Vector3d(0.0, 0.21, 0.0), 0.0, {0.44, 0.03, 0.4}, 2, 0.5);
    for (const double x : {-0.2, 0.2}) {
        for (const double y : {-0.2, 0.1})
            made.box(seat + Vector3d(x, y, 0.0), 0.0, {0.04, 0.04, 0.44}, 2);
    }
    const Found found = find(made.cloud);
    EXPECT_EQ(pieces_of(found).size(), 2U);
    EXPECT_GT(best_iou(made, found, 1), 0.8);
    EXPECT_GT(best_iou(made, found, 2), 0.7);
}

TEST(FindFurniture, KeepsATableForMeetingsWholeAndPartsDesksThatFaceEachOther) {
    MadeUpRoom meeting;
    meeting.table({2.5, 2.0, 0.0}, 0.0, 2.6, 1.3, 0.74, 1);
    const Found whole = find(meeting.cloud);
    EXPECT_EQ(pieces_of(whole).size(), 1U);
    EXPECT_GT(best_iou(meeting, whole, 1), 0.8);
    MadeUpRoom desks;
    desks.table({2.5, 1.65, 0.0}, 0.0, 1.6, 0.7, 0.74, 1);
    desks.table({2.5, 2.35, 0.0}, 0.0, 1.6, 0.7, 0.74, 2);
    desks.chair({2.3, 1.2, 0.0}, radians(180.0), 3);
    desks.chair({2.6, 2.8, 0.0}, 0.0, 4);
    const Found parted = find(desks.cloud);
    EXPECT_GT(best_iou(desks, parted, 1), 0.7);
    EXPECT_GT(best_iou(desks, parted, 2), 0.7);
}

TEST(FindFurniture, LeavesWhatStandsOnATableUnknown) {
    MadeUpRoom made;
    made.table({2.5, 2.0, 0.0}, 0.0, 1.4, 0.8, 0.74, 1);
    made.box({2.4, 2.0, 0.0}, 0.0, {0.3, 0.25, 0.3}, 2, 0.74);
    const Found found = find(made.cloud);
    EXPECT_EQ(pieces_of(found).size(), 1U);
    EXPECT_GT(best_iou(made, found, 1), 0.85);
    EXPECT_LT(best_iou(made, found, 2), 0.1);
}

TEST(FindFurniture, TellsAChestFromTheScreenOnIt) {
    MadeUpRoom made;
    made.box({2.0, 0.25, 0.0}, 0.0, {1.6, 0.4, 0.5}, 1);
    made.box({2.0, 0.25, 0.0}, 0.0, {1.3, 0.05, 0.8}, 2, 0.55);
    const Found found = find(made.cloud);
    const auto pieces = pieces_of(found);
    ASSERT_EQ(pieces.size(), 1U);
    EXPECT_EQ(pieces[0]->kind, "tv_unit");
    EXPECT_GT(best_iou(made, found, 1), 0.7);
}

TEST(FindFurniture, PartsDesksThatTouchAtCornersOfOneAnother) {
    // Two that face each other, a third across their end, a fourth that goes on from it.
    MadeUpRoom made;
    made.table({1.7, 1.35, 0.0}, radians(90.0), 1.6, 0.7, 0.74, 1);
    made.table({2.4, 1.35, 0.0}, radians(90.0), 1.6, 0.7, 0.74, 2);
    made.table({2.75, 2.55, 0.0}, 0.0, 1.4, 0.8, 0.74, 3);
    made.table({3.8, 2.25, 0.0}, radians(90.0), 1.4, 0.7, 0.74, 4);
    made.chair({1.3, 1.4, 0.0}, radians(90.0), 5);
    made.chair({2.8, 1.2, 0.0}, radians(-90.0), 6);
    const Found found = find(made.cloud);
    for (const int thing : {1, 2, 3, 4})
        EXPECT_GT(best_iou(made, found, thing), 0.6) << thing;
}

TEST(FindFurniture, CallsAThinThingBeforeAWallARadiator) {
    MadeUpRoom made;
    made.box({2.5, 0.09, 0.0}, 0.0, {1.2, 0.1, 0.5}, 1, 0.12);
    const Found found = find(made.cloud);
    ASSERT_EQ(found.furniture.components.size(), 1U);
    const Component& radiator = found.furniture.components[0];
    EXPECT_EQ(radiator.label, Label::unknown);
    EXPECT_EQ(radiator.kind, "radiator");
    for (std::size_t i = 0; i < made.things.size(); ++i) {
        if (made.things[i] != 1) continue;
        ASSERT_NE(found.labels.labels[i], Label::furniture);
    }
}

TEST(FindFurniture, FindsTheSameUnderARigidMotion) {
    MadeUpRoom made;
    made.box({1.6, 0.25, 0.0}, 0.0, {0.8, 0.45, 0.9}, 1);
    made.table({3.2, 2.2, 0.0}, 0.4, 1.4, 0.8, 0.74, 2);
    Transform pose = Transform::Identity();
    pose.linear() =
        Eigen::AngleAxisd(0.7, Vector3d(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
    pose.translation() = Vector3d(12.0, -7.0, 3.0);
    PointCloud moved = made.cloud;
    transform_in_place(moved, pose);
    const Found first = find(made.cloud);
    const Found second = find(moved, {}, {}, pose.linear().transpose());
    const auto a = pieces_of(first);
    const auto b = pieces_of(second);
    ASSERT_EQ(a.size(), 2U);
    ASSERT_EQ(b.size(), 2U);
    for (const Component* piece : a) {
        const auto same = std::find_if(b.begin(), b.end(), [&](const Component* other) {
            return (pose * piece->box->center - other->box->center).norm() < 0.05;
        });
        ASSERT_NE(same, b.end());
        EXPECT_EQ((*same)->kind, piece->kind);
        EXPECT_LT(((*same)->box->size - piece->box->size).norm(), 0.06);
    }
}

TEST(FindFurniture, GivesTheSameBitsOnOneAndTwoThreads) {
    MadeUpRoom made;
    made.box({1.6, 0.25, 0.0}, 0.0, {0.8, 0.45, 0.9}, 1);
    made.table({3.2, 2.2, 0.0}, 0.4, 1.4, 0.8, 0.74, 2);
    Context one;
    one.num_threads = 1;
    Context two;
    two.num_threads = 2;
    const Found a = find(made.cloud, {}, one);
    const Found b = find(made.cloud, {}, two);
    EXPECT_EQ(a.furniture.component_of_voxel, b.furniture.component_of_voxel);
    ASSERT_EQ(a.furniture.components.size(), b.furniture.components.size());
    for (std::size_t i = 0; i < a.furniture.components.size(); ++i)
        EXPECT_EQ(a.furniture.components[i].polygon, b.furniture.components[i].polygon);
    EXPECT_EQ(a.labels.instances, b.labels.instances);
}

TEST(FindFurniture, FindsTheSurfacesOfAlgorithmFive) {
    MadeUpRoom made;
    made.box({2.5, 2.0, 0.0}, 0.0, {1.2, 0.9, 0.9}, 1);
    FurnitureSettings settings;
    settings.method = FurnitureMethod::algorithm_5;
    const Found found = find(made.cloud, settings);
    // A top of 1.08 m2 and four sides of 1.08 and 0.81 m2: more than 500 voxels of 3.5 cm each.
    ASSERT_EQ(found.furniture.components.size(), 5U);
    const auto tops =
        std::count_if(found.furniture.components.begin(), found.furniture.components.end(),
                      [](const Component& component) { return component.kind == "table"; });
    EXPECT_EQ(tops, 1);
    EXPECT_TRUE(found.furniture.fronts.empty());
}

TEST(DetectFurnitureSurfaces, DropsClustersOfFewerThanFiveHundred) {
    PointCloud cloud;
    const auto add = [&](double x0, double size) {
        for (double x = 0.0; x <= size; x += 0.03) {
            for (double y = 0.0; y <= size; y += 0.03)
                cloud.positions.emplace_back(static_cast<float>(x0 + x), static_cast<float>(y),
                                             0.7F);
        }
    };
    add(0.0, 1.0);  // 1 m2: 816 voxels
    add(2.0, 0.6);  // 0.36 m2: 294 voxels
    const FurnitureSurfaces found =
        detect_furniture_surfaces(cloud, Eigen::Matrix3d::Identity(), 1);
    ASSERT_EQ(found.surfaces.size(), 1U);
    EXPECT_EQ(found.surfaces[0].axis, 2);
    EXPECT_NEAR(found.surfaces[0].plane.offset, 0.7, 1e-4);
    EXPECT_NEAR(static_cast<double>(found.surfaces[0].points.size()), 816.0, 60.0);
    for (const std::uint32_t point : found.surfaces[0].points)
        EXPECT_LT(found.cloud.positions[point].x(), 1.1F);
}

TEST(DetectFurnitureSurfaces, FindsNothingInNothing) {
    EXPECT_TRUE(detect_furniture_surfaces({}, Eigen::Matrix3d::Identity(), 1).surfaces.empty());
}

TEST(SmallestRectangle, LiesAlongTheTwoSidesThatWereSeen) {
    for (const double degrees : {10.0, 25.0, 40.0, 65.0, 80.0}) {
        const Eigen::Vector2d u(std::cos(radians(degrees)), std::sin(radians(degrees)));
        const Eigen::Vector2d v(-u.y(), u.x());
        std::vector<Eigen::Vector2d> places;
        for (int i = 0; i <= 20; ++i) {
            places.emplace_back(0.04 * i * u);
            places.emplace_back(0.03 * i * v);
        }
        const PlanRectangle rectangle = smallest_rectangle(places);
        EXPECT_NEAR(rectangle.length, 0.8, 1e-6) << degrees;
        EXPECT_NEAR(rectangle.width, 0.6, 1e-6) << degrees;
        EXPECT_NEAR(std::abs(rectangle.axis.dot(u)), 1.0, 1e-6) << degrees;
    }
}

/// Voxels of 4 cm that fill boxes, and which of them are neighbours.
class MadeUpVoxels {
  public:
    static constexpr double edge = 0.04;

    void fill(const Vector3d& low, const Vector3d& high, bool is_level = false) {
        for (double x = low.x(); x <= high.x() + 1e-9; x += edge) {
            for (double y = low.y(); y <= high.y() + 1e-9; y += edge) {
                for (double z = low.z(); z <= high.z() + 1e-9; z += edge) {
                    FurnitureVoxel voxel;
                    voxel.place = {x, y, z};
                    voxel.height = z;
                    voxel.is_level = is_level;
                    voxel.is_upright = !is_level;
                    voxel.is_planar = true;
                    voxel.is_core = true;
                    all_.voxels.push_back(voxel);
                }
            }
        }
    }

    /// A level square around a place, turned about it.
    void fill_turned(const Vector3d& middle, double turn, double side) {
        const double half = 0.5 * side * (std::abs(std::cos(turn)) + std::abs(std::sin(turn)));
        const auto steps = static_cast<int>(half / edge);
        for (int i = -steps; i <= steps; ++i) {
            for (int j = -steps; j <= steps; ++j) {
                const Eigen::Vector2d from(edge * i, edge * j);
                const Eigen::Vector2d within = Eigen::Rotation2Dd(-turn) * from;
                if (within.cwiseAbs().maxCoeff() > 0.5 * side) continue;
                const Vector3d place = middle + Vector3d(from.x(), from.y(), 0.0);
                fill(place, place, true);
            }
        }
    }

    FurnitureVoxels finish() {
        all_.reach = 2.0 * edge;
        all_.first.assign(1, 0);
        for (std::uint32_t i = 0; i < all_.voxels.size(); ++i) {
            for (std::uint32_t j = 0; j < all_.voxels.size(); ++j) {
                const double distance = (all_.voxels[i].place - all_.voxels[j].place).norm();
                if (i != j && distance <= all_.reach + 1e-9) all_.neighbors.push_back(j);
            }
            all_.first.push_back(all_.neighbors.size());
        }
        return all_;
    }

  private:
    FurnitureVoxels all_;
};

TEST(CutRow, KeepsARowWholeThatThingsStandOn) {
    MadeUpVoxels made;
    made.fill({0.0, 0.6, 0.1}, {1.8, 0.6, 0.9});   // its front
    made.fill({0.0, 0.1, 0.9}, {1.8, 0.56, 0.9});  // its top
    made.fill({0.3, 0.2, 0.94}, {0.9, 0.3, 1.2});
    const FurnitureVoxels all = made.finish();
    std::vector<std::uint32_t> members(all.voxels.size());
    std::iota(members.begin(), members.end(), 0U);
    EXPECT_EQ(cut_row(all, members).size(), 1U);
    EXPECT_NEAR(front_top(all, members), 0.9, MadeUpVoxels::edge);
}

TEST(CutRow, CutsWhereTheFrontEndsLower) {
    MadeUpVoxels made;
    made.fill({0.0, 0.6, 0.1}, {0.9, 0.6, 0.9});
    made.fill({0.94, 0.6, 0.1}, {1.8, 0.6, 0.7});
    const FurnitureVoxels all = made.finish();
    std::vector<std::uint32_t> members(all.voxels.size());
    std::iota(members.begin(), members.end(), 0U);
    EXPECT_EQ(cut_row(all, members).size(), 2U);
}

TEST(DraftHangingPieces, FindsWhatHangsOverThingsOnAWorktop) {
    MadeUpVoxels made;
    made.fill({0.0, 0.36, 1.4}, {1.6, 0.36, 2.0});  // the front of a wall unit
    const std::size_t num_hanging = 41 * 16;
    made.fill({0.4, 0.36, 0.9}, {0.52, 0.36, 1.36});  // a bottle that touches it
    FurnitureVoxels all = made.finish();
    const std::vector<PieceDraft> drafts = draft_hanging_pieces(all);
    ASSERT_EQ(drafts.size(), 1U);
    EXPECT_NEAR(static_cast<double>(drafts[0].voxels.size()), num_hanging, 20.0);
}

TEST(DraftHangingPieces, FindsWhatHangsOverThingsThatDoNotTouchIt) {
    MadeUpVoxels made;
    made.fill({0.0, 0.36, 1.44}, {1.6, 0.36, 2.0});
    made.fill({0.0, 0.36, 0.9}, {1.2, 0.36, 1.2});
    FurnitureVoxels all = made.finish();
    EXPECT_EQ(draft_hanging_pieces(all).size(), 1U);
}

TEST(DraftHangingPieces, LeavesWhatStands) {
    MadeUpVoxels made;
    made.fill({0.0, 0.36, 0.9}, {1.6, 0.36, 2.0});
    FurnitureVoxels all = made.finish();
    EXPECT_TRUE(draft_hanging_pieces(all).empty());
}

TEST(FindLevelSlabs, PartsSeatsThatNoiseTiesTogether) {
    MadeUpVoxels made;
    made.fill({0.0, 0.0, 0.45}, {0.44, 0.44, 0.45}, true);
    made.fill({0.56, 0.0, 0.45}, {1.0, 0.44, 0.45}, true);
    made.fill({0.48, 0.2, 0.45}, {0.52, 0.24, 0.45}, true);
    EXPECT_EQ(find_level_slabs(made.finish(), MadeUpVoxels::edge).size(), 2U);
    MadeUpVoxels bench;
    bench.fill({0.0, 0.0, 0.45}, {1.0, 0.44, 0.45}, true);
    EXPECT_EQ(find_level_slabs(bench.finish(), MadeUpVoxels::edge).size(), 1U);
}

TEST(FindLevelSlabs, JoinsNoSeatsOfARow) {
    for (const bool noise_ties_them : {false, true}) {
        MadeUpVoxels row;
        for (const double start : {0.0, 0.6, 1.2})
            row.fill({start, 0.0, 0.45}, {start + 0.44, 0.44, 0.45}, true);
        for (const double gap : {0.48, 1.08}) {
            if (noise_ties_them) row.fill({gap, 0.2, 0.45}, {gap + 0.08, 0.24, 0.45}, true);
        }
        EXPECT_EQ(find_level_slabs(row.finish(), MadeUpVoxels::edge).size(), 3U);
    }
}

TEST(FindLevelSlabs, PartsSeatsThatStandAskew) {
    // The corner of one that is turned by 15 degrees touches the other.
    MadeUpVoxels turned;
    turned.fill({0.0, 0.0, 0.45}, {0.44, 0.44, 0.45}, true);
    turned.fill_turned({0.76, 0.2, 0.45}, radians(15.0), 0.44);
    EXPECT_EQ(find_level_slabs(turned.finish(), MadeUpVoxels::edge).size(), 2U);
    // One that stands before the other.
    MadeUpVoxels staggered;
    staggered.fill({0.0, 0.0, 0.45}, {0.44, 0.44, 0.45}, true);
    staggered.fill({0.48, 0.24, 0.45}, {0.92, 0.68, 0.45}, true);
    EXPECT_EQ(find_level_slabs(staggered.finish(), MadeUpVoxels::edge).size(), 2U);
}

TEST(DraftPieces, GivesStraysToTheTopThatTheyLieIn) {
    MadeUpVoxels made;
    made.fill({0.0, 0.0, 0.74}, {1.2, 0.5, 0.74}, true);
    made.fill({0.0, 0.7, 0.74}, {1.2, 0.7, 0.74}, true);
    made.fill({0.6, 0.1, 0.3}, {0.6, 0.1, 0.3});
    made.fill({0.6, 1.0, 0.74}, {0.6, 1.0, 0.74}, true);
    FurnitureVoxels all = made.finish();
    std::size_t num_within = 0;
    for (FurnitureVoxel& voxel : all.voxels) {
        if (voxel.height > 0.5 && voxel.place.y() < 0.69) continue;
        voxel.is_core = voxel.place.y() > 0.69 && voxel.place.y() < 0.9;
        voxel.is_stray = !voxel.is_core;
        num_within += voxel.is_stray ? 1 : 0;
    }
    ASSERT_EQ(num_within, 2U);
    const std::vector<PieceDraft> drafts =
        draft_pieces(all, find_level_slabs(all, MadeUpVoxels::edge));
    std::size_t num_drafted = 0;
    for (const PieceDraft& draft : drafts) {
        for (const std::uint32_t i : draft.voxels) {
            if (!all.voxels[i].is_stray) continue;
            ++num_drafted;
            EXPECT_LT(all.voxels[i].height, 0.5);
        }
    }
    EXPECT_EQ(num_drafted, 1U);
}

/// Pieces of three seats, closed below, on one plate.
std::size_t num_drafts_of_seats(double gap) {
    constexpr double seat = 0.64;
    MadeUpVoxels made;
    double start = 0.0;
    for (const double height : {0.45, 0.5, 0.45}) {
        made.fill({start, 0.0, height}, {start + seat, seat, height}, true);
        for (const double side : {0.0, seat})
            made.fill({start, side, 0.08}, {start + seat, side, 0.4});
        start += seat + gap;
    }
    made.fill({0.0, 0.04, 0.08}, {start - gap, seat - 0.04, 0.08});
    const FurnitureVoxels all = made.finish();
    const std::vector<PieceDraft> drafts =
        draft_pieces(all, find_level_slabs(all, MadeUpVoxels::edge));
    return static_cast<std::size_t>(
        std::count_if(drafts.begin(), drafts.end(),
                      [](const PieceDraft& draft) { return !draft.voxels.empty(); }));
}

TEST(DraftPieces, TellsSeatsInARowFromASofa) {
    EXPECT_EQ(num_drafts_of_seats(0.04), 1U);
    EXPECT_GE(num_drafts_of_seats(0.2), 3U);
}

/// Panels of a front of 1.2 x 0.8 m, down the middle of which a line lies deeper.
std::size_t num_panels_of_front(double noise, double gap_depth) {
    Random random{5};
    PointCloud cloud;
    for (double x = 0.0; x <= 1.2; x += 0.005) {
        for (double z = 0.0; z <= 0.8; z += 0.005) {
            const bool is_gap = std::abs(x - 0.6) < 0.003;
            const double y = is_gap ? -gap_depth : noise * random.normal();
            cloud.positions.emplace_back(static_cast<float>(x), static_cast<float>(y),
                                         static_cast<float>(z));
        }
    }
    SurfaceSample sample;
    sample.cloud.positions.emplace_back(0.0F, 0.0F, 0.0F);
    sample.voxel_of_point.assign(cloud.size(), 0U);
    FrontSide side;
    side.plane = {Vector3d::UnitY(), 0.0};
    side.along = -Vector3d::UnitX();
    side.voxels = {0U};
    return find_front_panels(cloud, sample, std::span(&side, 1), Vector3d::UnitZ()).size();
}

TEST(FindFrontPanels, PartsAFrontOnlyWhereNoiseLetsGapsShow) {
    EXPECT_EQ(num_panels_of_front(0.002, 0.015), 2U);
    // What lies so deep in so much noise is a wave of it.
    EXPECT_EQ(num_panels_of_front(0.010, 0.035), 1U);
}

/// What stands in the middle of a room, flat and upright.
PieceForm upright_form(double length, double width, double bottom, double top) {
    PieceForm form;
    form.rectangle.length = length;
    form.rectangle.width = width;
    form.bottom = bottom;
    form.top = top;
    form.front_top = top;
    form.upright = 0.9;
    form.planar = 0.95;
    form.surface = length * (top - bottom);
    form.face = 0.8 * form.surface;
    form.num_voxels = 300;
    return form;
}

/// Voxels of the side x = 0 of a top 1.8 m long at 0.87 m, in columns and rows of 4 cm.
bool is_closed_by(double left, double right, double low) {
    constexpr double voxel_size = 0.04;
    FurnitureVoxels all;
    all.reach = 2.0 * voxel_size;
    PieceDraft draft;
    for (double y = left; y < right; y += voxel_size) {
        for (double z = low; z < 0.85; z += voxel_size) {
            FurnitureVoxel voxel;
            voxel.place = {0.0, y, z};
            voxel.height = z;
            voxel.is_upright = true;
            draft.voxels.push_back(static_cast<std::uint32_t>(all.voxels.size()));
            all.voxels.push_back(voxel);
        }
    }
    PieceForm form;
    form.rectangle.axis = Eigen::Vector2d::UnitY();
    form.rectangle.length = 1.8;
    form.rectangle.width = 0.7;
    form.seat = 0.87;
    FrontSide side;
    side.plane = {Eigen::Vector3d::UnitX(), 0.0};
    side.along = Eigen::Vector3d::UnitY();
    return closes_piece(all, draft, form, side, Eigen::Matrix3d::Identity());
}

TEST(ClosesPiece, TellsFrontsSeenFromAboveFromAnApronAndASidePanel) {
    EXPECT_TRUE(is_closed_by(0.0, 1.8, 0.6));
    EXPECT_FALSE(is_closed_by(0.0, 1.8, 0.75));
    EXPECT_FALSE(is_closed_by(0.0, 0.5, 0.1));
}

TEST(JudgePiece, TakesAFrontForACabinetOnlyAtItsDepthBeforeAWall) {
    PieceForm front = upright_form(0.6, 0.06, 0.07, 1.0);
    EXPECT_LT(judge_piece(front).confidence, 0.5);
    front.depth = 0.5;
    EXPECT_EQ(judge_piece(front).kind, "drawer_unit");
    EXPECT_GE(judge_piece(front).confidence, 0.5);
    // A radiator with its sill is lower.
    EXPECT_LT(judge_piece(upright_form(1.2, 0.4, 0.1, 0.62)).confidence, 0.5);
}

TEST(JudgePiece, TellsALeafFromAFront) {
    PieceForm sheet = upright_form(0.9, 0.06, 0.07, 2.0);
    EXPECT_FALSE(judge_piece(sheet).is_furniture);
    sheet.depth = 0.6;
    EXPECT_FALSE(judge_piece(sheet).is_furniture);
    PieceForm wide = upright_form(1.8, 0.06, 0.07, 2.0);
    wide.depth = 0.6;
    EXPECT_TRUE(judge_piece(wide).is_furniture);
    // A cupboard's front, whose wall was not found; a leaf is higher.
    EXPECT_TRUE(judge_piece(upright_form(0.9, 0.06, 0.07, 1.8)).is_furniture);
    // The wall beyond a doorway.
    wide.depth = 0.0;
    EXPECT_FALSE(judge_piece(wide).is_furniture);
}

TEST(JudgePiece, TakesNoiseFromTheThicknessOfASheet) {
    PieceForm sheet = upright_form(1.8, 0.3, 0.07, 2.0);
    sheet.depth = 2.0;
    EXPECT_TRUE(judge_piece(sheet).is_furniture);
    sheet.blur = 0.12;
    EXPECT_FALSE(judge_piece(sheet).is_furniture);
}

TEST(JudgePiece, TakesWhatIsLikeAChairForOneInTheOpenOnly) {
    PieceForm form = upright_form(0.6, 0.5, 0.06, 1.0);
    form.planar = 0.6;
    form.face = 0.2;
    EXPECT_EQ(judge_piece(form).kind, "chair");
    EXPECT_GE(judge_piece(form).confidence, 0.5);
    form.depth = 0.55;  // a plant
    EXPECT_LT(judge_piece(form).confidence, 0.5);
}

TEST(IsBackOfChair, TellsMeshAndBentBacksFromLeavesAndRadiators) {
    PieceForm back = upright_form(0.5, 0.2, 0.5, 1.0);
    back.planar = 0.0;
    back.face = 0.0;
    EXPECT_TRUE(is_back_of_chair(back));
    PieceForm leaves = back;
    leaves.upright = 0.5;
    EXPECT_FALSE(is_back_of_chair(leaves));
    PieceForm at_wall = back;
    at_wall.depth = 0.3;
    EXPECT_FALSE(is_back_of_chair(at_wall));
    // A thing that stands on the floor shows its lower part.
    EXPECT_FALSE(is_back_of_chair(upright_form(0.5, 0.2, 0.1, 1.0)));
}

TEST(CompleteChairs, LeavesTheUpperHalfOfAFront) {
    MadeUpVoxels made;
    made.fill({0.0, 0.0, 0.6}, {0.48, 0.0, 0.9});
    const std::size_t num_back = 13 * 8;
    made.fill({0.0, 0.0, 0.08}, {0.48, 0.0, 0.52});
    const FurnitureVoxels all = made.finish();
    PieceDraft back;
    for (std::uint32_t i = 0; i < all.voxels.size(); ++i) {
        if (all.voxels[i].height > 0.58) back.voxels.push_back(i);
    }
    std::vector<PieceDraft> drafts{back};
    RoomSurfaces surfaces;
    surfaces.storeys.resize(1);
    surfaces.storeys[0].plan.rooms.resize(1);
    complete_chairs(all, {}, surfaces, drafts);
    EXPECT_FALSE(drafts[0].is_chair);
    EXPECT_EQ(drafts[0].voxels.size(), num_back);
}

TEST(JudgePiece, AsksOfSeatsAndTopsTheirSizes) {
    PieceForm stool = upright_form(0.36, 0.34, 0.06, 0.46);
    stool.num_slabs = 1;
    stool.seat = 0.45;
    stool.highest_slab = 0.45;
    EXPECT_EQ(judge_piece(stool).kind, "stool");
    stool.rectangle.length = 0.6;  // a bag
    EXPECT_FALSE(judge_piece(stool).is_furniture);
    PieceForm desk = upright_form(1.5, 0.7, 0.06, 0.75);
    desk.num_slabs = 1;
    desk.seat = 0.74;
    desk.highest_slab = 0.74;
    EXPECT_EQ(judge_piece(desk).kind, "desk");
    desk.rectangle.width = 0.4;  // the back of a sofa
    EXPECT_LT(judge_piece(desk).confidence, 0.5);
}

TEST(JudgePiece, AsksOfNarrowFrontsThatTheyAreFlatAllOver) {
    PieceForm narrow = upright_form(0.55, 0.06, 0.07, 1.75);
    narrow.depth = 0.5;
    narrow.face = 0.95 * narrow.surface;
    EXPECT_TRUE(judge_piece(narrow).is_furniture);
    // A plant or a coat rack.
    narrow.face = 0.4 * narrow.surface;
    EXPECT_FALSE(judge_piece(narrow).is_furniture);
    // A column.
    EXPECT_FALSE(judge_piece(upright_form(0.45, 0.4, 0.07, 2.0)).is_furniture);
}

TEST(JudgePiece, TellsAWallUnitFromAPilaster) {
    PieceForm unit = upright_form(0.5, 0.34, 1.4, 2.1);
    unit.depth = 0.36;
    unit.is_at_wall = true;
    EXPECT_EQ(judge_piece(unit).kind, "wall_unit");
    unit.bottom = 0.95;
    unit.top = 2.6;
    EXPECT_FALSE(judge_piece(unit).is_furniture);
}

TEST(JudgePiece, TellsShallowCupboardsFromRadiators) {
    PieceForm shallow = upright_form(0.8, 0.18, 0.07, 1.15);
    shallow.depth = 0.22;
    shallow.is_at_wall = true;
    EXPECT_EQ(judge_piece(shallow).kind, "cabinet");
    shallow.top = 0.8;
    EXPECT_EQ(judge_piece(shallow).kind, "radiator");
}

TEST(JudgePiece, TakesLowBoardsBeforeAWallForAShelf) {
    PieceForm shelf = upright_form(0.8, 0.34, 0.07, 0.82);
    shelf.is_at_wall = true;
    shelf.depth = 0.36;
    shelf.num_slabs = 2;
    shelf.seat = shelf.highest_slab = 0.8;
    shelf.seat_area = 0.25;
    shelf.closed = 0.3;
    EXPECT_EQ(judge_piece(shelf).kind, "shelf");
    shelf.seat_area = 0.1;  // a radiator with its sill, a plant
    EXPECT_NE(judge_piece(shelf).kind, "shelf");
}

TEST(JudgePiece, TellsAnArmchairFromAPlantInItsPot) {
    PieceForm chair = upright_form(1.0, 0.8, 0.07, 0.9);
    chair.num_slabs = 1;
    chair.seat = chair.highest_slab = 0.4;
    chair.seat_area = 0.3;
    chair.closed = 1.0;
    EXPECT_EQ(judge_piece(chair).kind, "armchair");
    chair.seat = chair.highest_slab = 0.3;
    chair.seat_area = 0.05;
    EXPECT_LT(judge_piece(chair).confidence, 0.5);
}

TEST(JudgePiece, LabelsWhatIsAsLargeAsFurnitureButFitsNoKindAsOther) {
    // Too deep for a chest and without a wall.
    PieceForm box = upright_form(1.4, 1.1, 0.07, 0.8);
    EXPECT_TRUE(judge_piece(box).is_furniture);
    EXPECT_EQ(judge_piece(box).kind, "other");
    EXPECT_LT(judge_piece(box).confidence, min_piece_confidence);
    // A plant of that size.
    box.planar = 0.3;
    box.face = 0.05;
    EXPECT_FALSE(judge_piece(box).is_furniture);
    // A carton.
    EXPECT_FALSE(judge_piece(upright_form(0.35, 0.3, 0.07, 0.3)).is_furniture);
}

TEST(SmallestRectangle, FollowsATurnedRectangle) {
    std::vector<Eigen::Vector2d> places;
    const double turn = radians(25.0);
    const Eigen::Vector2d u(std::cos(turn), std::sin(turn));
    const Eigen::Vector2d v(-u.y(), u.x());
    for (int i = 0; i <= 20; ++i) {
        for (int j = 0; j <= 10; ++j)
            places.emplace_back(Eigen::Vector2d(1.0, 2.0) + 0.1 * i * u + 0.1 * j * v);
    }
    const PlanRectangle rectangle = smallest_rectangle(places);
    EXPECT_NEAR(rectangle.length, 2.0, 1e-9);
    EXPECT_NEAR(rectangle.width, 1.0, 1e-9);
    EXPECT_NEAR(std::abs(rectangle.axis.dot(u)), 1.0, 1e-9);
    EXPECT_NEAR(rectangle.distance(Eigen::Vector2d(1.0, 2.0) + 2.3 * u + 0.5 * v), 0.3, 1e-9);
    EXPECT_EQ(smallest_rectangle({}).area(), 0.0);
}

}  // namespace
}  // namespace roomscribe
