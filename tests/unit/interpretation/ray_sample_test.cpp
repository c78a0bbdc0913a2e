// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/rooms/ray_sample.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "roomscribe/interpretation/openings/mirror_test.hpp"
#include "support/shapes.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// 1 x 1 m in the plane x = 0, its lower corner at y = 0 and z = 1, looking along x.
UprightWindow window() {
    return {{Vector3d::UnitX(), 0.0}, Vector3d::UnitY(), Vector3d::UnitZ(), {0.0, 1.0, 1.0, 2.0}};
}

TEST(RaySample, HasARayForEachFinitePointOfAKnownScanner) {
    ScanMap map;
    map.cloud.positions = {Vector3f(1, 0, 0), Vector3f(0, 1, 0), Vector3f(0, 0, 1)};
    map.cloud.positions[1].x() = std::numeric_limits<float>::quiet_NaN();
    map.sections = {{"known", 0, 2, Vector3d(5, 5, 5)}, {"unknown", 2, 1, std::nullopt}};
    const std::vector<Ray> rays = sample_rays(map, 100);
    ASSERT_EQ(rays.size(), 1U);
    EXPECT_EQ(rays[0].origin, Vector3f(5, 5, 5));
    EXPECT_EQ(rays[0].end, Vector3f(1, 0, 0));
}

TEST(RaySample, TakesAnEvenShareOfMany) {
    ScanMap map;
    map.cloud.positions.assign(10'000, Vector3f(1, 2, 3));
    map.sections = {{"first", 0, 5000, Vector3d(0, 0, 0)},
                    {"second", 5000, 5000, Vector3d(1, 1, 1)}};
    const std::vector<Ray> rays = sample_rays(map, 1000);
    EXPECT_GE(rays.size(), 900U);
    EXPECT_LE(rays.size(), 1002U);
}

TEST(CountRays, TellsWhatEndedAndWhatPassed) {
    const Vector3f sensor(3.0F, 0.5F, 1.5F);
    const auto through = [&](float y, float z, float x) {
        // Meets the plane at (0, y, z) and ends at x.
        return Ray{sensor, sensor + (3.0F - x) / 3.0F * (Vector3f(0.0F, y, z) - sensor)};
    };
    const std::vector<Ray> rays{through(0.5F, 1.5F, 0.0F),   // ends on it
                                through(0.5F, 1.5F, -2.0F),  // passes
                                through(0.2F, 1.8F, -0.5F),  // passes
                                through(0.5F, 1.5F, 0.5F),   // ends before it
                                through(1.5F, 1.5F, -2.0F),  // beside it
                                through(0.5F, 0.5F, -2.0F),  // below it
                                Ray{Vector3f(-3.0F, 0.5F, 1.5F), Vector3f(2.0F, 0.5F, 1.5F)}};
    const RayCount count = count_rays(rays, window(), 0.05);
    EXPECT_EQ(count.ended, 1U);
    EXPECT_EQ(count.passed, 2U);
}

/// Points of a wall at x = 4 and of a cupboard at x = 2, and rays to their images behind x = 0.
struct Room {
    SurfaceSample sample;
    std::vector<Ray> to_images;
    std::vector<Ray> outdoors;
};

Room room_before_a_mirror() {
    Room room;
    Random random(2);
    const Vector3f sensor(3.0F, 0.5F, 1.5F);
    for (int i = 0; i < 4000; ++i) {
        const bool is_cupboard = i % 2 == 0;
        const Vector3f point(is_cupboard ? 2.0F : 4.0F,
                             static_cast<float>(random.uniform(-3.0, 3.0)),
                             static_cast<float>(random.uniform(0.0, 2.5)));
        room.sample.cloud.positions.push_back(point);
        room.to_images.push_back({sensor, Vector3f(-point.x(), point.y(), point.z())});
        room.outdoors.push_back({sensor, Vector3f(-5.0F * point.x() - 1.0F, 4.0F * point.y(),
                                                  4.0F * point.z() - 5.0F)});
    }
    return room;
}

TEST(MirrorTest, TellsAMirrorFromAWindow) {
    const Room room = room_before_a_mirror();
    EXPECT_GT(MirrorTest(room.to_images, room.sample).share_of_images(window(), 0.45), 0.95);
    EXPECT_LT(MirrorTest(room.outdoors, room.sample).share_of_images(window(), 0.45), 0.3);
}

TEST(MirrorTest, SaysNothingWithoutRays) {
    const Room room = room_before_a_mirror();
    EXPECT_EQ(MirrorTest({}, room.sample).share_of_images(window(), 0.45), 0.0);
    const std::vector<Ray> few(room.to_images.begin(), room.to_images.begin() + 10);
    EXPECT_EQ(MirrorTest(few, room.sample).share_of_images(window(), 0.45), 0.0);
}

}  // namespace
}  // namespace roomscribe
