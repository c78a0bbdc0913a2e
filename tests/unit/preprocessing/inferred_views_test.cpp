// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/inferred_views.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "support/shapes.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr float step = 0.02F;  // m, between points
constexpr float height = 2.5F;

/// Two rooms of 3 x 4 m whose floors and walls were merged into one cloud without a ceiling: from
/// x = 0 to 3 and from 3.1 to 6.1, with faces of their own on both sides of the wall between them.
struct TwoRooms {
    ScanMap map;
    std::uint32_t first_of_second = 0;

    /// `has_door`: a way of 0.9 x 2 m between them.
    explicit TwoRooms(bool has_door) {
        add_room(0.0F, has_door);
        first_of_second = static_cast<std::uint32_t>(map.cloud.size());
        add_room(3.1F, has_door);
        map.sections.push_back(
            {"map", 0, static_cast<std::uint32_t>(map.cloud.size()), std::nullopt});
    }

    void add_room(float start, bool has_door) {
        const auto is_way = [&](float x, float y, float z) {
            const bool is_between = x > 2.9F && x < 3.2F;
            return has_door && is_between && y > 1.5F && y < 2.4F && z < 2.0F;
        };
        const auto add = [&](float x, float y, float z) {
            if (!is_way(x, y, z)) map.cloud.positions.emplace_back(x, y, z);
        };
        for (float y = 0.0F; y <= 4.0F; y += step) {
            for (float x = start; x <= start + 3.0F; x += step)
                add(x, y, 0.0F);
            for (float z = 0.0F; z <= height; z += step) {
                add(start, y, z);
                add(start + 3.0F, y, z);
            }
        }
        for (float x = start; x <= start + 3.0F; x += step) {
            for (float z = 0.0F; z <= height; z += step) {
                add(x, 0.0F, z);
                add(x, 4.0F, z);
            }
        }
    }
    bool holds(const Vector3d& place) const {
        const bool is_between = place.x() > 3.0 && place.x() < 3.1;
        return place.x() > 0.0 && place.x() < 6.1 && !is_between && place.y() > 0.0 &&
               place.y() < 4.0 && place.z() > 0.0;
    }
};

double seen_share(const ScanMap& map, const std::vector<InferredView>& views) {
    std::vector<bool> is_seen(map.cloud.size(), false);
    for (const InferredView& view : views) {
        for (const std::uint32_t point : view.points)
            is_seen[point] = true;
    }
    return static_cast<double>(std::count(is_seen.begin(), is_seen.end(), true)) /
           static_cast<double>(is_seen.size());
}

TEST(InferredViews, StandInRoomsAndSeeNearlyAll) {
    const TwoRooms rooms(false);
    const auto views = infer_views(rooms.map, Vector3d::UnitZ());
    ASSERT_FALSE(views.empty());
    for (const InferredView& view : views)
        EXPECT_TRUE(rooms.holds(view.position)) << view.position.transpose();
    EXPECT_GT(seen_share(rooms.map, views), 0.98);
}

TEST(InferredViews, SeeNothingThroughAWall) {
    const TwoRooms rooms(false);
    for (const InferredView& view : infer_views(rooms.map, Vector3d::UnitZ())) {
        const bool is_in_second = view.position.x() > 3.05;
        // Over the walls, where no ceiling was scanned, the other room's may be seen.
        if (view.position.z() > 1.5) continue;
        for (const std::uint32_t point : view.points) {
            if (rooms.map.cloud.positions[point].z() > height - 0.05F) continue;
            EXPECT_EQ(point >= rooms.first_of_second, is_in_second)
                << view.position.transpose() << " sees "
                << rooms.map.cloud.positions[point].transpose();
        }
    }
}

TEST(InferredViews, SeeThroughAnOpenDoor) {
    const TwoRooms rooms(true);
    std::size_t num_through = 0;
    for (const InferredView& view : infer_views(rooms.map, Vector3d::UnitZ())) {
        const bool is_in_second = view.position.x() > 3.05;
        for (const std::uint32_t point : view.points) {
            const Vector3f& position = rooms.map.cloud.positions[point];
            const bool is_low = view.position.z() < 1.5 && position.z() < 1.0F;
            num_through += is_low && point >= rooms.first_of_second && !is_in_second ? 1 : 0;
        }
    }
    EXPECT_GT(num_through, 1000U);
}

TEST(InferredViews, DoNotDependOnFrameOrOnWhatIsFarAway) {
    const TwoRooms rooms(true);
    Random random(3);
    const Transform turned = test::random_transform(random, 5.0);
    ScanMap map = rooms.map;
    map.cloud.positions = test::transformed(map.cloud.positions, turned);
    for (int i = 0; i < 20; ++i)
        map.cloud.positions.emplace_back(900.0F, 100.0F * static_cast<float>(i), 0.0F);
    map.sections[0].count += 20;
    const auto views = infer_views(map, turned.linear() * Vector3d::UnitZ());
    ASSERT_FALSE(views.empty());
    for (const InferredView& view : views)
        EXPECT_TRUE(rooms.holds(turned.inverse() * view.position));
    EXPECT_GT(seen_share(map, views), 0.97);
}

TEST(InferredViews, StandNowhereButInRooms) {
    ScanMap wall;
    for (float y = 0.0F; y <= 4.0F; y += step) {
        for (float z = 0.0F; z <= height; z += step)
            wall.cloud.positions.emplace_back(0.0F, y, z);
    }
    wall.sections.push_back(
        {"wall", 0, static_cast<std::uint32_t>(wall.cloud.size()), std::nullopt});
    EXPECT_TRUE(infer_views(wall, Vector3d::UnitZ()).empty());
}

TEST(InferredViews, AreOnlyOfSectionsWithoutAScanner) {
    TwoRooms rooms(false);
    rooms.map.sections[0].sensor_position = Vector3d(1.5, 2.0, 1.2);
    EXPECT_TRUE(infer_views(rooms.map, Vector3d::UnitZ()).empty());
    EXPECT_TRUE(infer_views({}, Vector3d::UnitZ()).empty());
    ScanMap lost;
    lost.cloud.positions.assign(5000, Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
    lost.sections.push_back({"lost", 0, 5000, std::nullopt});
    EXPECT_TRUE(infer_views(lost, Vector3d::UnitZ()).empty());
}

TEST(InferredViews, AreTheSameOnAnyNumberOfThreads) {
    const TwoRooms rooms(true);
    Context one;
    one.num_threads = 1;
    Context two;
    two.num_threads = 2;
    const auto views = infer_views(rooms.map, Vector3d::UnitZ(), one);
    const auto others = infer_views(rooms.map, Vector3d::UnitZ(), two);
    ASSERT_EQ(views.size(), others.size());
    for (std::size_t i = 0; i < views.size(); ++i) {
        EXPECT_EQ(views[i].position, others[i].position);
        EXPECT_EQ(views[i].points, others[i].points);
    }
}

}  // namespace
}  // namespace roomscribe
