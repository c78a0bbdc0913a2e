// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/scanning/station_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/simulation/building/openings.hpp"
#include "roomscribe/simulation/building/wall_layout.hpp"
#include "roomscribe/simulation/furnishing/footprint.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector2d;

constexpr double candidate_step = 0.2;
constexpr double wall_clearance = 0.9;   ///< people keep off what a scanner is too near to see
constexpr double item_clearance = 0.35;  ///< of what the scanner looks over
constexpr double eye_height = 1.2;
constexpr double least_clearance = 0.7;  ///< nearer, a terrestrial scanner is blind
constexpr double passable_height = 2.0;  ///< what hangs higher does not bar the way

/// How a scanner is carried.
struct Carrier {
    double lowest = 1.4;  ///< m, of its centre above the floor
    double highest = 1.6;
    double max_pitch = 1.5;  ///< degrees off level, either way
    double mean_pitch = 0.0;
    double pitch_swing = 0.0;  ///< degrees: up and down again, as a hand does
    double turn = 0.0;         ///< degrees from scan to scan; 0: it sees all around
    double step = 2.5;         ///< m from scan to scan
};

Carrier carrier_of(ScannerKind scanner) {
    switch (scanner) {
        case ScannerKind::sick_lms200:
            return {0.5, 0.7, 1.0, 0.0, 0.0, 75.0, 1.2};
        case ScannerKind::hokuyo_utm30lx:
            return {1.0, 1.3, 1.0, 0.0, 0.0, 95.0, 1.5};
        case ScannerKind::terrestrial:
            return {1.35, 1.75, 0.6, 0.0, 0.0, 0.0, 2.8};
        case ScannerKind::structured_light:
            return {1.2, 1.6, 4.0, 8.0, 22.0, 20.0, 0.3};
        case ScannerKind::spinning_lidar:
            return {0.5, 1.5, 3.0, 0.0, 0.0, 0.0, 1.5};
    }
    return {};
}

double distance_to_outline(const RoomPlan& room, const Vector2d& point) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < room.outline.size(); ++i) {
        nearest =
            std::min(nearest, distance_to_segment(point, room.outline[i],
                                                  room.outline[(i + 1) % room.outline.size()]));
    }
    return nearest;
}

/// Where the leaves of doors stand that are not closed.
struct LeafSegment {
    Vector2d start;
    Vector2d end;
};

std::vector<LeafSegment> open_leaves(const Scenario& scenario) {
    const std::vector<BuiltWallFace> faces = wall_faces(scenario.rooms);
    std::vector<LeafSegment> leaves;
    for (const OpeningPlan& opening : scenario.openings) {
        if (opening.kind != OpeningKind::door || opening.leaf == LeafState::closed) continue;
        const OpeningSite site =
            locate_opening(opening, scenario.rooms, faces, scenario.outer_wall_thickness);
        for (const DoorLeaf& leaf : door_leaves(opening, site)) {
            if (leaf.angle == 0.0) continue;
            const Transform frame = frame_of_leaf(site.world_from_site, leaf);
            const Eigen::Vector3d low = frame * Eigen::Vector3d(leaf.area.x_low, leaf.y_low, 0.0);
            const Eigen::Vector3d high = frame * Eigen::Vector3d(leaf.area.x_high, leaf.y_low, 0.0);
            leaves.push_back({low.head<2>(), high.head<2>()});
        }
    }
    return leaves;
}

Footprint footprint_of(const ItemPlan& item) {
    const Eigen::Vector3d half(item.size.x() / 2.0, item.size.y() / 2.0, item.size.z());
    return footprint_of(item, {Eigen::Vector3d(-half.x(), -half.y(), 0.0), half});
}

bool is_free(const Scenario& scenario, std::span<const LeafSegment> leaves, const RoomPlan& room,
             const Vector2d& point, double share_of_clearance) {
    if (!contains(room.outline, point) ||
        distance_to_outline(room, point) < share_of_clearance * wall_clearance) {
        return false;
    }
    const double tall_clearance = std::max(share_of_clearance * wall_clearance, least_clearance);
    const auto bars = [&](const ItemPlan& item) {
        if (item.elevation >= room.floor_height + passable_height) return false;
        const bool is_tall = item.elevation + item.size.z() > room.floor_height + eye_height;
        return footprint_of(item).distance(point) <
               (is_tall ? tall_clearance : share_of_clearance * item_clearance);
    };
    const auto stands_in_the_way = [&](const LeafSegment& leaf) {
        return distance_to_segment(point, leaf.start, leaf.end) < tall_clearance;
    };
    return std::none_of(scenario.items.begin(), scenario.items.end(), bars) &&
           std::none_of(leaves.begin(), leaves.end(), stands_in_the_way);
}

double widest_distance(const std::vector<Vector2d>& places) {
    double widest = 0.0;
    for (const Vector2d& place : places)
        widest = std::max(widest, (place - places.front()).norm());
    return widest;
}

/// A crowded room leaves less than one would wish: then nearer to walls and things, before all
/// stations stand on one spot.
std::vector<Vector2d> free_places(const Scenario& scenario, const RoomPlan& room,
                                  double wanted_width) {
    const std::vector<LeafSegment> leaves = open_leaves(scenario);
    const Eigen::AlignedBox2d bounds = bounds_of(room.outline);
    std::vector<Vector2d> places;
    for (const double share : {1.0, 0.7, 0.45, 0.3}) {
        places.clear();
        for (double x = bounds.min().x() + 0.1; x < bounds.max().x(); x += candidate_step) {
            for (double y = bounds.min().y() + 0.1; y < bounds.max().y(); y += candidate_step) {
                if (is_free(scenario, leaves, room, {x, y}, share)) places.emplace_back(x, y);
            }
        }
        if (!places.empty() && widest_distance(places) >= wanted_width) return places;
    }
    if (places.empty()) {
        throw InvalidArgument(fmt::format("items in room \"{}\"", room.name), "so many",
                              "some free floor for a scanner");
    }
    return places;
}

Vector2d centroid(const std::vector<Vector2d>& points) {
    Vector2d sum = Vector2d::Zero();
    for (const Vector2d& point : points)
        sum += point;
    return sum / static_cast<double>(points.size());
}

/// The place for which `cost` is least.
template <typename Cost>
Vector2d best_place(const std::vector<Vector2d>& places, Cost&& cost) {
    const auto better = [&](const Vector2d& a, const Vector2d& b) { return cost(a) < cost(b); };
    return *std::min_element(places.begin(), places.end(), better);
}

Station station_at(const Vector2d& at, double floor, double heading, const Carrier& carrier,
                   Random& random) {
    Station station;
    station.at.head<2>() = at;
    station.at.z() = floor + random.uniform(carrier.lowest, carrier.highest);
    station.heading = heading;
    station.pitch = carrier.mean_pitch + random.uniform(-carrier.max_pitch, carrier.max_pitch);
    station.roll = random.uniform(-carrier.max_pitch, carrier.max_pitch);
    return station;
}

/// The first where most is seen, the others far from those before, but within reach.
void add_surround_stations(std::vector<Station>& stations, const RoomPlan& room,
                           const std::vector<Vector2d>& places, int count, const Carrier& carrier,
                           Random& random) {
    std::vector<Vector2d> chosen;
    const Vector2d middle = centroid(places);
    for (int i = 0; i < count; ++i) {
        const double wish = carrier.step * random.uniform(0.8, 1.2);
        const Vector2d place = best_place(places, [&](const Vector2d& candidate) {
            if (chosen.empty()) return (candidate - middle).norm();
            double nearest = std::numeric_limits<double>::infinity();
            for (const Vector2d& other : chosen)
                nearest = std::min(nearest, (candidate - other).norm());
            // Two scans from one spot tell nothing that one does not.
            return std::abs(nearest - wish) + (nearest < 0.5 ? carrier.step : 0.0);
        });
        chosen.push_back(place);
    }
    // The first of all stays first; the others are walked through from one end.
    std::sort(chosen.begin() + (stations.empty() ? 1 : 0), chosen.end(),
              [](const Vector2d& a, const Vector2d& b) { return a.x() < b.x(); });
    for (const Vector2d& place : chosen) {
        stations.push_back(
            station_at(place, room.floor_height, random.uniform(-180.0, 180.0), carrier, random));
    }
}

/// Half of the way through the longer side of the free floor.
Vector2d long_way(const std::vector<Vector2d>& places, const Vector2d& middle) {
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (const Vector2d& place : places)
        spread += (place - middle) * (place - middle).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(spread);
    const double deviation =
        std::sqrt(solver.eigenvalues()(1) / static_cast<double>(places.size()));
    // An even spread over a length has a deviation of length / sqrt(12).
    return 0.35 * std::sqrt(12.0) * deviation * solver.eigenvectors().col(1);
}

/// Through the room, turning all the while, back from what it looks at.
void add_turning_stations(std::vector<Station>& stations, const RoomPlan& room,
                          const std::vector<Vector2d>& places, int count, const Carrier& carrier,
                          Random& random) {
    constexpr double frames_per_swing = 6.0;
    const Vector2d middle = centroid(places);
    const Vector2d way = long_way(places, middle);
    double heading = random.uniform(-180.0, 180.0);
    Vector2d last = count > 1 ? Vector2d(middle - way) : middle;
    for (int i = 0; i < count; ++i) {
        const Vector2d look(std::cos(radians(heading)), std::sin(radians(heading)));
        const double walked = count > 1 ? 2.0 * i / (count - 1.0) - 1.0 : 0.0;
        const double back = std::min(1.0, carrier.step) * random.uniform(0.3, 0.7);
        const Vector2d target = middle + walked * way - back * look;
        const Vector2d place = best_place(places, [&](const Vector2d& candidate) {
            const double too_far = std::max(0.0, (candidate - last).norm() - 2.0 * carrier.step);
            return (candidate - target).norm() + too_far;
        });
        stations.push_back(station_at(place, room.floor_height, heading, carrier, random));
        stations.back().pitch +=
            carrier.pitch_swing * std::sin(2.0 * std::numbers::pi * i / frames_per_swing);
        heading += carrier.turn * random.uniform(0.85, 1.15);
        last = place;
    }
}

}  // namespace

std::vector<Station> choose_stations(const Scenario& scenario, std::span<const std::size_t> rooms,
                                     int per_room, Random& random) {
    const Carrier carrier = carrier_of(scenario.scanner);
    std::vector<Station> stations;
    for (const std::size_t index : rooms) {
        const RoomPlan& room = scenario.rooms[index];
        const std::vector<Vector2d> places =
            free_places(scenario, room, per_room > 1 ? 0.6 * carrier.step : 0.0);
        if (carrier.turn > 0.0) {
            add_turning_stations(stations, room, places, per_room, carrier, random);
            continue;
        }
        double longest = 0.0;
        for (const Vector2d& place : places)
            longest = std::max(longest, (place - centroid(places)).norm() * 2.0);
        const int more = static_cast<int>(longest / 6.0);
        add_surround_stations(stations, room, places, per_room + more, carrier, random);
    }
    return stations;
}

int usual_scans_per_room(ScannerKind scanner) {
    switch (scanner) {
        case ScannerKind::sick_lms200:
        case ScannerKind::hokuyo_utm30lx:
            return 4;
        case ScannerKind::terrestrial:
            return 2;
        case ScannerKind::structured_light:
            return 18;
        case ScannerKind::spinning_lidar:
            return 3;
    }
    return 1;
}

}  // namespace roomscribe
