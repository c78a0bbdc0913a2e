// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "roomscribe/core/units.hpp"
#include "roomscribe/geometry/polygon.hpp"
#include "roomscribe/simulation/furnishing/furnishing.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::array uses{"office",  "meeting", "kitchen", "corridor", "living",
                          "bedroom", "bath",    "storage", "lobby",    "workshop"};

struct Mesh {
    std::vector<std::array<Vector3d, 3>> triangles;
    std::vector<Vector3d> vertices;
    Eigen::AlignedBox3d extent;
};

Mesh mesh_of(const ItemPlan& item) {
    SimulatedWorld world;
    add_item(world, item);
    Mesh mesh;
    for (const Eigen::Vector3f& vertex : world.vertices) {
        mesh.vertices.emplace_back(vertex.cast<double>());
        mesh.extent.extend(mesh.vertices.back());
    }
    for (const auto& t : world.triangles)
        mesh.triangles.push_back({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]});
    return mesh;
}

/// A furnished room with a door and a window of its own and a door of the room behind.
struct Case {
    RoomPlan room;
    std::vector<OpeningPlan> openings;
    std::vector<ItemPlan> items;
    std::vector<Mesh> meshes;  ///< of the items
};

/// In the middle of the i-th side, or at a share of it.
OpeningPlan opening_at(const RoomPlan& room, std::size_t side, double share, OpeningKind kind) {
    OpeningPlan opening;
    opening.kind = kind;
    opening.room = room.name;
    opening.at =
        (1.0 - share) * room.outline[side] + share * room.outline[(side + 1) % room.outline.size()];
    return opening;
}

RoomPlan made_up_room(std::uint64_t seed) {
    Random random(seed, 11);
    RoomPlan room;
    room.name = "here";
    room.use = uses[seed % uses.size()];
    room.ceiling_height = random.uniform(2.4, 3.0);
    const double width = random.uniform(3.0, 8.0);
    const double depth = random.uniform(3.0, 6.0);
    switch (seed / uses.size() % 3) {
        case 0:
            room.outline = {{0, 0}, {width, 0}, {width, depth}, {0, depth}};
            break;
        case 1:
            room.outline = {{0, 0},
                            {width, 0},
                            {width, depth + 2.0},
                            {0.5 * width, depth + 2.0},
                            {0.5 * width, depth},
                            {0, depth}};
            break;
        default:
            room.outline = {{0, 0}, {width + 0.9, 0}, {width, depth}, {0.3, depth + 0.8}};
    }
    const double turn = random.uniform(0.0, 6.28);
    for (Vector2d& corner : room.outline)
        corner = Eigen::Rotation2Dd(turn) * corner + Vector2d(3.0, -2.0);
    return room;
}

Case furnished(std::uint64_t seed) {
    Case made{.room = made_up_room(seed), .openings = {}, .items = {}, .meshes = {}};
    Random random(seed, 12);
    OpeningPlan door = opening_at(made.room, 0, random.uniform(0.35, 0.65), OpeningKind::door);
    door.is_hinged_left = seed % 2 == 0;
    door.leaf = LeafState::open;
    door.leaf_angle = random.uniform(0.0, 110.0);
    made.openings.push_back(door);
    OpeningPlan window = opening_at(made.room, 1, 0.5, OpeningKind::window);
    window.width = random.uniform(0.6, 2.0);
    window.sill = random.uniform(0.8, 1.0);
    window.height = 1.3;
    made.openings.push_back(window);
    // The far side of a door in the last wall, 12 cm thick, that swings into here.
    const std::size_t last = made.room.outline.size() - 1;
    OpeningPlan behind = opening_at(made.room, last, 0.5, OpeningKind::door);
    const Vector2d along = (made.room.outline[0] - made.room.outline[last]).normalized();
    behind.room = "there";
    behind.at += 0.12 * Vector2d(along.y(), -along.x());
    behind.opens_into_room = false;
    made.openings.push_back(behind);
    Random choice(seed);
    made.items = furnish_room(made.room, made.openings, choice);
    for (const ItemPlan& item : made.items)
        made.meshes.push_back(mesh_of(item));
    return made;
}

constexpr std::uint64_t num_seeds = 100;

/// That of a seed, made once.
const Case& furnished_case(std::uint64_t seed) {
    static const std::vector<Case> cases = [] {
        std::vector<Case> made;
        for (std::uint64_t i = 0; i < num_seeds; ++i)
            made.push_back(furnished(i));
        return made;
    }();
    return cases[seed];
}

/// Signed distance to the nearest side, positive inside (convex or not, near the outline).
double distance_inside(const std::vector<Vector2d>& outline, const Vector2d& p) {
    double nearest = std::numeric_limits<double>::infinity();
    bool is_inside = false;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Vector2d& a = outline[i];
        const Vector2d& b = outline[(i + 1) % outline.size()];
        const double share = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
        nearest = std::min(nearest, (p - a - share * (b - a)).norm());
        if ((a.y() > p.y()) != (b.y() > p.y()) &&
            p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y())) {
            is_inside = !is_inside;
        }
    }
    return is_inside ? nearest : -nearest;
}

/// True if the segment passes through the inside of the triangle (Moeller and Trumbore 1997).
bool pierces(const Vector3d& from, const Vector3d& to, const std::array<Vector3d, 3>& t) {
    const Vector3d direction = to - from;
    const Vector3d e1 = t[1] - t[0];
    const Vector3d e2 = t[2] - t[0];
    const Vector3d p = direction.cross(e2);
    const double determinant = e1.dot(p);
    if (std::abs(determinant) < 1e-14) return false;
    const Vector3d offset = from - t[0];
    const double u = offset.dot(p) / determinant;
    const Vector3d q = offset.cross(e1);
    const double v = direction.dot(q) / determinant;
    const double s = e2.dot(q) / determinant;
    return u > 0.0 && v > 0.0 && u + v < 1.0 && s > 0.0 && s < 1.0;
}

bool intersect(const Mesh& a, const Mesh& b) {
    const Eigen::AlignedBox3d common = a.extent.intersection(b.extent);
    if (common.isEmpty()) return false;
    const auto near = [&](const Mesh& mesh) {
        std::vector<std::array<Vector3d, 3>> kept;
        for (const auto& t : mesh.triangles) {
            Eigen::AlignedBox3d box(t[0]);
            box.extend(t[1]).extend(t[2]);
            if (box.intersects(common)) kept.push_back(t);
        }
        return kept;
    };
    const auto in_a = near(a);
    const auto in_b = near(b);
    for (const auto& s : in_a) {
        for (const auto& t : in_b) {
            for (std::size_t i = 0; i < 3; ++i) {
                if (pierces(s[i], s[(i + 1) % 3], t) || pierces(t[i], t[(i + 1) % 3], s)) {
                    return true;
                }
            }
        }
    }
    return false;
}

bool is_structure(const ItemPlan& item) {
    return item.kind == "beam" || item.kind == "soffit";
}

TEST(FurnishRoom, StaysWithinTheWalls) {
    for (std::uint64_t seed = 0; seed < num_seeds; ++seed) {
        const Case& made = furnished_case(seed);
        SCOPED_TRACE(fmt::format("seed {}, {}", seed, made.room.use));
        for (std::size_t i = 0; i < made.items.size(); ++i) {
            const ItemPlan& item = made.items[i];
            const Mesh& mesh = made.meshes[i];
            double nearest = std::numeric_limits<double>::infinity();
            for (const Vector3d& vertex : mesh.vertices) {
                nearest = std::min(nearest, distance_inside(made.room.outline, vertex.head<2>()));
            }
            EXPECT_GT(nearest, 0.0015) << item.kind;
            EXPECT_GT(mesh.extent.min().z(), -1e-6) << item.kind;
            EXPECT_LT(mesh.extent.max().z(), made.room.ceiling_height) << item.kind;
        }
    }
}

TEST(FurnishRoom, LetsNoTwoItemsRunIntoEachOther) {
    std::size_t num_items = 0;
    for (std::uint64_t seed = 0; seed < num_seeds; ++seed) {
        const Case& made = furnished_case(seed);
        SCOPED_TRACE(fmt::format("seed {}, {}", seed, made.room.use));
        const std::vector<Mesh>& meshes = made.meshes;
        num_items += meshes.size();
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            for (std::size_t j = i + 1; j < meshes.size(); ++j) {
                // Furniture stands on rugs.
                if ((made.items[i].kind == "rug") != (made.items[j].kind == "rug")) continue;
                EXPECT_FALSE(intersect(meshes[i], meshes[j]))
                    << made.items[i].kind << " and " << made.items[j].kind;
            }
        }
    }
    EXPECT_GT(num_items, 10 * num_seeds);
}

TEST(FurnishRoom, KeepsTheSpaceBeforeDoorsAndTheirSwingFree) {
    for (std::uint64_t seed = 0; seed < num_seeds; ++seed) {
        const Case& made = furnished_case(seed);
        SCOPED_TRACE(fmt::format("seed {}, {}", seed, made.room.use));
        const std::size_t last = made.room.outline.size() - 1;
        for (const std::size_t side : {std::size_t{0}, last}) {
            const OpeningPlan& door = made.openings[side == 0 ? 0 : 2];
            const Vector2d along =
                (made.room.outline[(side + 1) % (last + 1)] - made.room.outline[side]).normalized();
            const Vector2d inward(-along.y(), along.x());
            const Vector2d at = side == 0 ? door.at : Vector2d(door.at + 0.12 * inward);
            // Seen from the room of the door, left is along its wall; the far wall runs the other
            // way.
            const bool is_hinge_ahead = door.is_hinged_left == (side == 0);
            const Vector2d hinge = at + (is_hinge_ahead ? 0.45 : -0.45) * along;
            const double angle = std::max(90.0, door.leaf_angle);
            for (std::size_t i = 0; i < made.items.size(); ++i) {
                const ItemPlan& item = made.items[i];
                for (const Vector3d& vertex : made.meshes[i].vertices) {
                    if (vertex.z() > door.height) continue;
                    const Vector2d offset = vertex.head<2>() - at;
                    const double before = offset.dot(inward);
                    const bool is_in_the_way = before < 0.9 && std::abs(offset.dot(along)) < 0.45;
                    EXPECT_FALSE(is_in_the_way) << item.kind;
                    const Vector2d from_hinge = vertex.head<2>() - hinge;
                    const double toward = from_hinge.dot(is_hinge_ahead ? -along : along);
                    const double swing = degrees(std::atan2(from_hinge.dot(inward), toward));
                    EXPECT_FALSE(from_hinge.norm() < 0.9 && swing > 0.0 && swing < angle)
                        << item.kind << " in the swing";
                }
            }
        }
    }
}

TEST(FurnishRoom, PutsNothingTallBeforeWindows) {
    for (std::uint64_t seed = 0; seed < num_seeds; ++seed) {
        const Case& made = furnished_case(seed);
        const OpeningPlan& window = made.openings[1];
        const Vector2d along = (made.room.outline[2] - made.room.outline[1]).normalized();
        const Vector2d inward(-along.y(), along.x());
        for (const ItemPlan& item : made.items) {
            const bool is_tall = item.kind == "wardrobe" || item.kind == "office_cupboard" ||
                                 item.kind == "shelf" || item.kind == "fridge" ||
                                 item.kind == "tall_unit" || item.kind == "wall_unit" ||
                                 item.kind == "picture" || item.kind == "whiteboard";
            if (!is_tall) continue;
            const double left = std::abs((item.at - window.at).dot(along)) - item.size.y() / 2.0;
            const double before = (item.at - window.at).dot(inward) - item.size.x() / 2.0;
            const bool stands_along =
                std::abs(std::remainder(item.turn - degrees(std::atan2(inward.y(), inward.x())),
                                        180.0)) < 1.0;
            EXPECT_FALSE(stands_along && before < 0.3 && left < window.width / 2.0)
                << "seed " << seed << ": " << item.kind;
        }
    }
}

/// True if somebody of 0.25 m radius gets from door to door, by flooding cells of 5 cm that keep
/// that far from every item's convex hull and from the walls.
bool has_way_between_doors(const Case& made) {
    constexpr double cell = 0.05;
    constexpr double radius = 0.25;
    std::vector<std::vector<Vector2d>> hulls;
    for (std::size_t i = 0; i < made.items.size(); ++i) {
        if (is_structure(made.items[i])) continue;
        std::vector<Vector2d> points;
        for (const Vector3d& vertex : made.meshes[i].vertices) {
            if (vertex.z() > 0.06 && vertex.z() < 1.9) points.emplace_back(vertex.head<2>());
        }
        if (points.size() > 2) hulls.push_back(convex_hull(points));
    }
    const auto is_free = [&](const Vector2d& p) {
        return distance_inside(made.room.outline, p) > radius &&
               std::none_of(hulls.begin(), hulls.end(), [&](const auto& hull) {
                   return hull.size() > 2 && distance_inside(hull, p) > -radius;
               });
    };
    const std::size_t last = made.room.outline.size() - 1;
    const auto before = [&](std::size_t side, const Vector2d& at) {
        const Vector2d along =
            (made.room.outline[(side + 1) % (last + 1)] - made.room.outline[side]).normalized();
        return Vector2d(at + 0.55 * Vector2d(-along.y(), along.x()));
    };
    const Vector2d start = before(0, made.openings[0].at);
    const Vector2d goal = before(last, (made.room.outline[last] + made.room.outline[0]) / 2.0);
    constexpr int reach = 300;
    std::vector<bool> seen(static_cast<std::size_t>((2 * reach + 1) * (2 * reach + 1)), false);
    std::vector<std::array<int, 2>> queue{{0, 0}};
    for (std::size_t i = 0; i < queue.size(); ++i) {
        const auto [x, y] = queue[i];
        const Vector2d p = start + cell * Vector2d(x, y);
        if ((p - goal).norm() < 2.0 * cell) return true;
        for (const auto& [dx, dy] :
             std::array<std::array<int, 2>, 4>{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}}) {
            const std::array next{x + dx, y + dy};
            if (std::abs(next[0]) > reach || std::abs(next[1]) > reach) continue;
            const auto index =
                static_cast<std::size_t>((next[1] + reach) * (2 * reach + 1) + next[0] + reach);
            if (seen[index] || !is_free(start + cell * Vector2d(next[0], next[1]))) continue;
            seen[index] = true;
            queue.push_back(next);
        }
    }
    return false;
}

TEST(FurnishRoom, LeavesAWayFromDoorToDoor) {
    for (std::uint64_t seed = 0; seed < num_seeds; seed += 2) {
        const Case& made = furnished_case(seed);
        EXPECT_TRUE(has_way_between_doors(made)) << "seed " << seed << ", " << made.room.use;
    }
}

TEST(FurnishRoom, PutsInWhatTheUseCallsFor) {
    const auto share_with = [](std::size_t use, std::string_view kind) {
        int found = 0;
        int rooms = 0;
        for (std::uint64_t seed = use; seed < num_seeds; seed += uses.size()) {
            ++rooms;
            const Case& made = furnished_case(seed);
            if (std::any_of(made.items.begin(), made.items.end(),
                            [&](const ItemPlan& item) { return item.kind == kind; })) {
                ++found;
            }
        }
        return static_cast<double>(found) / rooms;
    };
    EXPECT_GE(share_with(0, "desk"), 0.9);
    EXPECT_GE(share_with(1, "table"), 0.7);
    EXPECT_GE(share_with(2, "kitchen_base"), 0.7);
    EXPECT_GE(share_with(4, "sofa"), 0.7);
    EXPECT_GE(share_with(5, "bed"), 0.7);
    EXPECT_GE(share_with(6, "toilet"), 0.7);
    EXPECT_GE(share_with(7, "shelf"), 0.7);
}

TEST(FurnishRoom, PutsARadiatorUnderMostWindows) {
    int found = 0;
    for (std::uint64_t seed = 0; seed < num_seeds; ++seed) {
        const Case& made = furnished_case(seed);
        for (const ItemPlan& item : made.items) {
            if (item.kind != "radiator") continue;
            ++found;
            // Below the sill, 3 to 6 cm off the wall.
            EXPECT_LT(item.elevation + item.size.z(), made.openings[1].sill);
            const double off = distance_inside(made.room.outline, item.at) - item.size.x() / 2.0;
            EXPECT_GT(off, 0.029);
            EXPECT_LT(off, 0.062);
            break;
        }
    }
    EXPECT_GT(found, static_cast<int>(num_seeds) / 2);
}

TEST(FurnishRoom, KeepsOffWhatIsThereAlready) {
    const RoomPlan room = made_up_room(4);
    ItemPlan column;
    column.kind = "column";
    column.size = {0.4, 0.4, 2.3};
    column.at = (room.outline[0] + room.outline[2]) / 2.0;
    const Mesh there = mesh_of(column);
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        Random random(seed);
        for (const ItemPlan& item : furnish_room(room, {}, random, std::span(&column, 1))) {
            EXPECT_NE(item.at, column.at);
            EXPECT_TRUE(item.kind == "rug" || !intersect(mesh_of(item), there)) << item.kind;
        }
    }
}

TEST(FurnishRoom, IsTheSameForARandomState) {
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
        const Case a = furnished(seed);
        const Case b = furnished(seed);
        ASSERT_EQ(a.items.size(), b.items.size());
        for (std::size_t i = 0; i < a.items.size(); ++i) {
            EXPECT_EQ(a.items[i].kind, b.items[i].kind);
            EXPECT_EQ(a.items[i].at, b.items[i].at);
            EXPECT_EQ(a.items[i].size, b.items[i].size);
            EXPECT_EQ(a.items[i].style, b.items[i].style);
        }
    }
}

}  // namespace
}  // namespace roomscribe
