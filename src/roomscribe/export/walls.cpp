// SPDX-License-Identifier: MIT
#include "roomscribe/export/walls.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "roomscribe/core/units.hpp"
#include "roomscribe/geometry/polygon.hpp"

namespace roomscribe {
namespace {

/// The thickest inner walls of solid brick, with plaster on both sides, stay below it.
constexpr double thickest_wall = 0.6;
/// A sheet of glass or board in its frame.
constexpr double thinnest_wall = 0.01;
/// A stud wall with one board a side; drawn where nothing is known.
constexpr double nominal_thickness = 0.1;
/// Plaster, skirting and what a fit is off: faces of one wall lie in one plane by this.
constexpr double evenness = 0.05;
/// Over 4 m a wall that is built by eye is out of true by less.
constexpr double parallel_angle = radians(5.0);
/// Half a pillar: what shares less of its length with another face is not backed by it.
constexpr double least_overlap = 0.2;
/// Faces end where furniture hides the corner; no passage is as narrow.
constexpr double reach_of_joins = 0.3;
/// Below it two walls go on in a line, and where they cross says nothing.
constexpr double corner_angle = radians(20.0);

struct Group {
    std::vector<std::size_t> faces;
};

Eigen::Vector2d direction(const FaceInPlan& face) {
    return (face.end - face.start).normalized();
}

double length(const FaceInPlan& face) {
    return (face.end - face.start).norm();
}

/// Coordinates in the frame of a face: along it, and to its left.
struct FaceFrame {
    Eigen::Vector2d origin;
    Eigen::Vector2d along;

    explicit FaceFrame(const FaceInPlan& face) : origin(face.start), along(direction(face)) {}
    double station(const Eigen::Vector2d& p) const { return along.dot(p - origin); }
    double offset(const Eigen::Vector2d& p) const { return cross(along, p - origin); }
    double offset(const FaceInPlan& face) const { return offset(0.5 * (face.start + face.end)); }
};

double overlap(double from_a, double to_a, double from_b, double to_b) {
    return std::min(to_a, to_b) - std::max(from_a, from_b);
}

/// How thick a wall between two faces is; empty if they do not stand back to back.
std::optional<double> distance_between(const FaceInPlan& a, const FaceInPlan& b) {
    if (direction(a).dot(direction(b)) > -std::cos(parallel_angle)) return std::nullopt;
    const FaceFrame frame(a);
    const double from = frame.station(b.end);
    const double to = frame.station(b.start);
    const double shared = overlap(0.0, length(a), from, to);
    if (shared < least_overlap || overlap(a.bottom, a.top, b.bottom, b.top) < least_overlap)
        return std::nullopt;
    // Of the stretch that they share: faces that are out of true are farther apart elsewhere.
    const double middle = std::max(0.0, from) + 0.5 * shared;
    const double share = (middle - from) / (to - from);
    const double distance = -frame.offset(b.end + share * (b.start - b.end));
    if (distance < thinnest_wall || distance > thickest_wall) return std::nullopt;
    return distance;
}

/// Whether all faces lie in two planes, each facing its own way.
bool is_one_wall(const std::vector<FaceInPlan>& faces, const std::vector<std::size_t>& members) {
    const FaceFrame frame(faces[members.front()]);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double low[2] = {infinity, infinity};
    double high[2] = {-infinity, -infinity};
    for (const std::size_t member : members) {
        const int side = frame.along.dot(direction(faces[member])) > 0.0 ? 0 : 1;
        const double offset = frame.offset(faces[member]);
        low[side] = std::min(low[side], offset);
        high[side] = std::max(high[side], offset);
    }
    return high[0] - low[0] <= evenness && high[1] - low[1] <= evenness;
}

std::vector<Group> group_faces(const std::vector<FaceInPlan>& faces) {
    std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        for (std::size_t j = i + 1; j < faces.size(); ++j) {
            if (const auto distance = distance_between(faces[i], faces[j]))
                pairs.emplace_back(*distance, i, j);
        }
    }
    std::sort(pairs.begin(), pairs.end());
    std::vector<Group> groups(faces.size());
    std::vector<std::size_t> group_of(faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i) {
        groups[i].faces = {i};
        group_of[i] = i;
    }
    for (const auto& [distance, i, j] : pairs) {
        Group& kept = groups[group_of[i]];
        Group& other = groups[group_of[j]];
        if (&kept == &other) continue;
        std::vector<std::size_t> both = kept.faces;
        both.insert(both.end(), other.faces.begin(), other.faces.end());
        if (!is_one_wall(faces, both)) continue;
        for (const std::size_t face : other.faces)
            group_of[face] = group_of[i];
        other.faces.clear();
        kept.faces = std::move(both);
    }
    std::erase_if(groups, [](const Group& group) { return group.faces.empty(); });
    return groups;
}

/// Mean of the offsets of faces on one side, by length.
struct MeanOffset {
    double sum = 0.0;
    double weight = 0.0;
};

Wall wall_of_group(const std::vector<FaceInPlan>& faces, std::vector<std::size_t> members) {
    std::stable_sort(members.begin(), members.end(), [&](std::size_t a, std::size_t b) {
        return length(faces[a]) > length(faces[b]) + 1e-6;
    });
    Wall wall;
    const FaceFrame frame(faces[members.front()]);
    wall.bottom = std::numeric_limits<double>::infinity();
    wall.top = -wall.bottom;
    double from = wall.bottom;
    double to = -from;
    MeanOffset near;
    MeanOffset far;
    for (const std::size_t member : members) {
        const FaceInPlan& face = faces[member];
        wall.faces.push_back(face);
        wall.bottom = std::min(wall.bottom, face.bottom);
        wall.top = std::max(wall.top, face.top);
        from = std::min({from, frame.station(face.start), frame.station(face.end)});
        to = std::max({to, frame.station(face.start), frame.station(face.end)});
        MeanOffset& mean = frame.along.dot(direction(face)) > 0.0 ? near : far;
        mean.sum += length(face) * frame.offset(face);
        mean.weight += length(face);
    }
    const double near_offset = near.sum / near.weight;
    double far_offset = near_offset - nominal_thickness;
    if (far.weight > 0.0) {
        far_offset = far.sum / far.weight;
        wall.thickness_source = ThicknessSource::measured;
    }
    wall.thickness = near_offset - far_offset;
    const Eigen::Vector2d left(-frame.along.y(), frame.along.x());
    const Eigen::Vector2d middle = frame.origin + 0.5 * (near_offset + far_offset) * left;
    wall.start = middle + from * frame.along;
    wall.end = middle + to * frame.along;
    wall.body_to = wall.length();
    return wall;
}

/// Where one end of a wall meets another wall.
struct Meeting {
    WallJoin join;
    double extension = 0.0;       ///< m, by which the axis grows to meet the other's
    double half_thickness = 0.0;  ///< m along this axis, from the crossing to the other's face
};

std::optional<Meeting> meeting(const std::vector<Wall>& walls, std::size_t index, bool at_start,
                               std::size_t other_index) {
    const Wall& wall = walls[index];
    const Wall& other = walls[other_index];
    if (overlap(wall.bottom, wall.top, other.bottom, other.top) < least_overlap) return {};
    const Eigen::Vector2d outward = at_start ? Eigen::Vector2d(-wall.along()) : wall.along();
    const Eigen::Vector2d tip = at_start ? wall.start : wall.end;
    const double sine = cross(outward, other.along());
    if (std::abs(sine) < std::sin(corner_angle)) return {};
    Meeting meeting;
    meeting.half_thickness = 0.5 * other.thickness / std::abs(sine);
    meeting.extension = cross(other.start - tip, other.along()) / sine;
    if (std::abs(meeting.extension) > meeting.half_thickness + reach_of_joins) return {};
    const Eigen::Vector2d crossing = tip + meeting.extension * outward;
    const double station = other.along().dot(crossing - other.start);
    const double reach = 0.5 * wall.thickness / std::abs(sine) + reach_of_joins;
    if (station < -reach || station > other.length() + reach) return {};
    using Place = WallJoin::Place;
    meeting.join = {other_index, at_start, Place::along};
    if (station < reach) meeting.join.place = Place::start;
    if (station > other.length() - reach && other.length() - station < station)
        meeting.join.place = Place::end;
    return meeting;
}

std::optional<Meeting> nearest_meeting(const std::vector<Wall>& walls, std::size_t index,
                                       bool at_start) {
    std::optional<Meeting> best;
    for (std::size_t other = 0; other < walls.size(); ++other) {
        if (other == index || walls[other].storey != walls[index].storey) continue;
        const std::optional<Meeting> found = meeting(walls, index, at_start, other);
        if (!found) continue;
        if (!best || std::abs(found->extension) < std::abs(best->extension)) best = found;
    }
    return best;
}

/// Of the end and of the start of a wall.
using EndMeetings = std::array<std::optional<Meeting>, 2>;

/// Whether the end that a wall meets meets that wall in turn: a corner of two.
bool is_mutual(const Meeting& met, std::size_t index, const std::vector<EndMeetings>& meetings) {
    if (met.join.place == WallJoin::Place::along) return false;
    const bool at_start = met.join.place == WallJoin::Place::start;
    const std::optional<Meeting>& back = meetings[met.join.wall][at_start ? 1 : 0];
    return back && back->join.wall == index && back->join.place != WallJoin::Place::along &&
           (back->join.place == WallJoin::Place::start) == met.join.at_start;
}

void join_ends(Wall& wall, std::size_t index, const std::vector<EndMeetings>& meetings) {
    const Eigen::Vector2d along = wall.along();
    std::array<double, 2> extension{};
    std::array<double, 2> overhang{};  // of the body, over the axis
    for (const std::size_t at_start : {std::size_t{1}, std::size_t{0}}) {
        const std::optional<Meeting>& met = meetings[index][at_start];
        if (!met) continue;
        // At a corner the earlier wall goes through to the outer face of the other; all else ends
        // at the near face.
        const bool goes_through = index < met->join.wall && is_mutual(*met, index, meetings);
        extension[at_start] = met->extension;
        overhang[at_start] = goes_through ? met->half_thickness : -met->half_thickness;
    }
    const double new_length = wall.length() + extension[0] + extension[1];
    // A stub between two thick walls keeps its own ends.
    if (new_length <= 0.0 || new_length + overhang[0] + overhang[1] <= 0.0) return;
    for (const std::size_t at_start : {std::size_t{1}, std::size_t{0}}) {
        if (meetings[index][at_start]) wall.joins.push_back(meetings[index][at_start]->join);
    }
    wall.start -= extension[1] * along;
    wall.end += extension[0] * along;
    wall.body_from = -overhang[1];
    wall.body_to = new_length + overhang[0];
}

}  // namespace

std::string_view thickness_source_name(ThicknessSource source) {
    switch (source) {
        case ThicknessSource::measured:
            return "measured";
        case ThicknessSource::openings:
            return "depth of its openings";
        case ThicknessSource::nominal:
            return "nominal";
    }
    return "";
}

std::vector<Wall> pair_faces(const std::vector<FaceInPlan>& faces) {
    std::vector<Wall> walls;
    for (const Group& group : group_faces(faces))
        walls.push_back(wall_of_group(faces, group.faces));
    return walls;
}

void join_walls(std::vector<Wall>& walls) {
    const std::vector<Wall> before = walls;
    std::vector<EndMeetings> meetings;
    for (std::size_t i = 0; i < walls.size(); ++i)
        meetings.push_back({nearest_meeting(before, i, false), nearest_meeting(before, i, true)});
    for (std::size_t i = 0; i < walls.size(); ++i)
        join_ends(walls[i], i, meetings);
}

}  // namespace roomscribe
