// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/building/building_plan.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"
#include "roomscribe/geometry/polygon.hpp"
#include "roomscribe/simulation/building/building.hpp"
#include "roomscribe/simulation/building/wall_layout.hpp"
#include "roomscribe/simulation/simulated_scene.hpp"

namespace roomscribe {
namespace {

constexpr std::uint64_t num_seeds = 40;

template <typename Check>
void for_all_buildings(Check&& check) {
    for (std::size_t kind = 0; kind < scene_kind_names.size(); ++kind) {
        for (std::uint64_t seed = 1; seed <= num_seeds; ++seed) {
            SCOPED_TRACE(std::string(scene_kind_names[kind]) + " " + std::to_string(seed));
            check(static_cast<SceneKind>(kind), plan_building(static_cast<SceneKind>(kind), seed));
        }
    }
}

bool is_within(double value, double low, double high) {
    return value >= low - 1e-9 && value <= high + 1e-9;
}

TEST(BuildingPlan, EveryPlanCanBeBuilt) {
    for_all_buildings([](SceneKind, const Scenario& scenario) {
        SimulatedWorld world;
        EXPECT_NO_THROW(add_building(world, scenario));
        EXPECT_GT(world.triangles.size(), 50U);
    });
}

TEST(BuildingPlan, RoomsDoNotRunIntoEachOther) {
    Random random(7);
    for_all_buildings([&](SceneKind, const Scenario& scenario) {
        for (const RoomPlan& room : scenario.rooms) {
            EXPECT_GT(signed_area(room.outline), 1.5);
            for (int i = 0; i < 50; ++i) {
                const double share = random.uniform();
                const std::size_t edge =
                    random.below(static_cast<std::uint32_t>(room.outline.size()));
                const Eigen::Vector2d on_wall =
                    room.outline[edge] +
                    share * (room.outline[(edge + 1) % room.outline.size()] - room.outline[edge]);
                for (const RoomPlan& other : scenario.rooms) {
                    EXPECT_FALSE(&other != &room && contains(other.outline, on_wall));
                }
            }
        }
    });
}

TEST(BuildingPlan, DoorsAndWindowsHaveTheSizesOfTheIssue) {
    for_all_buildings([](SceneKind, const Scenario& scenario) {
        for (const OpeningPlan& opening : scenario.openings) {
            if (opening.kind == OpeningKind::door) {
                EXPECT_TRUE(is_within(opening.width, 0.68, opening.is_double ? 1.9 : 1.12));
                EXPECT_TRUE(is_within(opening.height, 1.95, 2.15));
                EXPECT_TRUE(is_within(opening.frame_width, 0.04, 0.09));
                EXPECT_TRUE(is_within(opening.frame_protrusion, 0.0, 0.03));
                EXPECT_TRUE(is_within(opening.recess, 0.0, 0.12));
            }
            if (opening.kind == OpeningKind::window) {
                EXPECT_TRUE(is_within(opening.width, 0.5, 2.4));
                EXPECT_TRUE(is_within(opening.recess, 0.05, 0.2));
            }
        }
    });
}

TEST(BuildingPlan, EveryKindOfThingComesUp) {
    std::array<int, 4> openings{};
    std::array<int, 3> leaves{};
    int num_double = 0;
    int num_glazed = 0;
    int num_blinds = 0;
    int num_slanted = 0;
    for_all_buildings([&](SceneKind kind, const Scenario& scenario) {
        for (const OpeningPlan& opening : scenario.openings) {
            ++openings[static_cast<std::size_t>(opening.kind)];
            if (opening.kind == OpeningKind::door) ++leaves[static_cast<std::size_t>(opening.leaf)];
            num_double += opening.is_double ? 1 : 0;
            num_glazed += opening.is_glazed ? 1 : 0;
            num_blinds += opening.blind > 0.0 ? 1 : 0;
        }
        for (const BuiltWallFace& face : wall_faces(scenario.rooms)) {
            num_slanted += face.along().cwiseAbs().minCoeff() > 0.05 ? 1 : 0;
        }
        if (kind == SceneKind::floor) {
            EXPECT_GE(scenario.rooms.size(), 13U);
        }
        if (kind == SceneKind::flat) {
            EXPECT_GE(scenario.rooms.size(), 3U);  // The hall and 2 to 5 rooms.
            EXPECT_LE(scenario.rooms.size(), 6U);
        }
    });
    for (const int count : openings)
        EXPECT_GT(count, 10);
    for (const int count : leaves)
        EXPECT_GT(count, 50);
    EXPECT_GT(num_double, 5);
    EXPECT_GT(num_glazed, 20);
    EXPECT_GT(num_blinds, 20);
    EXPECT_GT(num_slanted, 20);
}

TEST(BuildingPlan, EveryRoomHasAWayIn) {
    int num_without = 0;
    int num_rooms = 0;
    for_all_buildings([&](SceneKind, const Scenario& scenario) {
        SimulatedWorld world;
        add_building(world, scenario);
        for (const Room& room : world.scene.rooms) {
            ++num_rooms;
            num_without += room.neighbors.empty() ? 1 : 0;
        }
    });
    EXPECT_LE(num_without, num_rooms / 50) << "of " << num_rooms;
}

TEST(StationPlan, StandsOnFreeFloorAndSeesTheRoom) {
    for (const SceneKind kind : {SceneKind::kitchen, SceneKind::flat, SceneKind::office}) {
        for (std::uint64_t seed = 1; seed <= 6; ++seed) {
            const Scenario scenario = plan_scene(kind, seed, {ScannerKind::terrestrial, 2, 20.0});
            const std::vector<std::size_t> rooms = rooms_to_scan(kind, scenario);
            EXPECT_GE(scenario.stations.size(), 2 * rooms.size());
            const SimulatedScene scene = simulate_scene(scenario);
            for (std::size_t i = 0; i < scene.scans.size(); ++i) {
                SCOPED_TRACE(scenario.name + " station " + std::to_string(i));
                EXPECT_TRUE(std::any_of(rooms.begin(), rooms.end(), [&](std::size_t room) {
                    return contains(scenario.rooms[room].outline,
                                    scenario.stations[i].at.head<2>());
                }));
                const PointCloud& cloud = scene.scans[i].cloud;
                EXPECT_GT(finite_points(cloud).size(), cloud.size() * 7 / 10);
                for (std::size_t j = 0; j < i; ++j) {
                    const double apart =
                        (scenario.stations[i].at - scenario.stations[j].at).head<2>().norm();
                    EXPECT_GT(apart, 0.15) << "as station " << j;
                }
            }
        }
    }
}

}  // namespace
}  // namespace roomscribe
