// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/room_error.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "roomscribe/evaluation/component_fit.hpp"
#include "roomscribe/evaluation/polygon_overlap.hpp"
#include "roomscribe/geometry/polygon.hpp"

namespace roomscribe {
namespace {

using Outline = std::vector<Eigen::Vector2d>;

/// A room's floor seen from above.
struct FloorView {
    Outline outline;
    double height = 0.0;  ///< m along true up
};

FloorView view_from_above(const Room& room, const Transform& room_from_map) {
    FloorView view;
    for (const Eigen::Vector3d& corner : room.polygon) {
        const Eigen::Vector3d seen = room_from_map * corner;
        view.outline.emplace_back(seen.head<2>());
        view.height += seen.z() / static_cast<double>(room.polygon.size());
    }
    return view;
}

std::vector<FloorView> views_from_above(const Scene& scene, const Transform& room_from_map) {
    std::vector<FloorView> views;
    for (const Room& room : scene.rooms)
        views.push_back(view_from_above(room, room_from_map));
    return views;
}

double height_of(const Room& room) {
    return room.ceiling_height - room.floor_height;
}

bool is_enough(double visible) {
    return visible >= protocol::min_visible - protocol::rounding;
}

/// Error as a share of what is true; 0 where truth says nothing.
double relative_error(double found, double truth) {
    return truth > 0.0 ? (found - truth) / truth : 0.0;
}

struct Pair {
    std::size_t truth = 0;
    std::size_t found = 0;
    double iou = 0.0;
};

/// What became of the rooms: who was matched with whom, by their numbers.
class RoomMatcher {
  public:
    RoomMatcher(const GroundTruth& truth, const Prediction& prediction)
        : truth_(truth.scene), found_(*prediction.scene) {
        const Transform from_true_map = truth.scene.room_from_map;
        true_views_ = views_from_above(truth_, from_true_map);
        found_views_ = views_from_above(
            found_, from_true_map * predicted_from_true_map(truth, prediction).inverse());
        for (const Room& room : truth_.rooms)
            counts_.push_back(is_enough(room_visibility(truth_, room)));
        found_of_true_.resize(truth_.rooms.size());
        true_of_found_.resize(found_.rooms.size());
    }

    void match(RoomError& error) {
        const std::vector<Pair> pairs = ranked_pairs();
        for (const bool counted : {true, false}) {
            for (const Pair& pair : pairs) {
                if (counts_[pair.truth] == counted) take(pair, error);
            }
        }
        for (std::size_t t = 0; t < truth_.rooms.size(); ++t) {
            if (found_of_true_[t]) continue;
            error.matches.push_back(
                {.outcome = counts_[t] ? DetectionOutcome::missed : DetectionOutcome::ignored,
                 .true_id = truth_.rooms[t].id,
                 .predicted_id = ""});
        }
        for (std::size_t p = 0; p < found_.rooms.size(); ++p) {
            if (true_of_found_[p]) continue;
            error.matches.push_back({.outcome = lies_in_unseen_rooms(p)
                                                    ? DetectionOutcome::ignored
                                                    : DetectionOutcome::false_positive,
                                     .true_id = "",
                                     .predicted_id = found_.rooms[p].id});
        }
    }

    DetectionCounts count_neighbors() const;

  private:
    std::vector<Pair> ranked_pairs() const {
        std::vector<Pair> pairs;
        for (std::size_t t = 0; t < truth_.rooms.size(); ++t) {
            for (std::size_t p = 0; p < found_.rooms.size(); ++p) {
                if (!is_in_storey(t, p)) continue;
                const double iou = polygon_iou(true_views_[t].outline, found_views_[p].outline);
                if (iou >= protocol::min_iou - protocol::rounding) pairs.push_back({t, p, iou});
            }
        }
        std::stable_sort(pairs.begin(), pairs.end(),
                         [](const Pair& a, const Pair& b) { return a.iou > b.iou; });
        return pairs;
    }

    /// Rooms of other storeys lie above each other.
    bool is_in_storey(std::size_t t, std::size_t p) const {
        return std::abs(true_views_[t].height - found_views_[p].height) <
               height_of(truth_.rooms[t]) / 2.0;
    }

    void take(const Pair& pair, RoomError& error) {
        if (found_of_true_[pair.truth] || true_of_found_[pair.found]) return;
        found_of_true_[pair.truth] = pair.found;
        true_of_found_[pair.found] = pair.truth;
        const Room& truth = truth_.rooms[pair.truth];
        const Room& found = found_.rooms[pair.found];
        error.matches.push_back(
            {.outcome = counts_[pair.truth] ? DetectionOutcome::correct : DetectionOutcome::ignored,
             .true_id = truth.id,
             .predicted_id = found.id,
             .iou = pair.iou,
             .area_error = relative_error(found.area, truth.area),
             .height_error = height_of(found) - height_of(truth),
             .volume_error = relative_error(found.volume, truth.volume)});
    }

    bool lies_in_unseen_rooms(std::size_t p) const {
        double unseen = 0.0;
        for (std::size_t t = 0; t < truth_.rooms.size(); ++t) {
            if (!counts_[t] && is_in_storey(t, p))
                unseen += overlap_area(true_views_[t].outline, found_views_[p].outline);
        }
        const double area = std::abs(signed_area(found_views_[p].outline));
        return unseen > 0.0 && unseen >= area / 2.0;
    }

    const Scene& truth_;
    const Scene& found_;
    std::vector<FloorView> true_views_;
    std::vector<FloorView> found_views_;
    std::vector<bool> counts_;  ///< true rooms of which enough was seen
    std::vector<std::optional<std::size_t>> found_of_true_;
    std::vector<std::optional<std::size_t>> true_of_found_;
};

using RoomPair = std::pair<std::size_t, std::size_t>;

RoomPair in_order(std::size_t a, std::size_t b) {
    return {std::min(a, b), std::max(a, b)};
}

/// The pairs of rooms that are neighbours, by their numbers, with the doors between them.
std::map<RoomPair, std::vector<std::string_view>> neighbor_pairs(const Scene& scene) {
    std::map<std::string_view, std::size_t> numbers;
    for (std::size_t i = 0; i < scene.rooms.size(); ++i)
        numbers.emplace(scene.rooms[i].id, i);
    std::map<RoomPair, std::vector<std::string_view>> pairs;
    for (std::size_t i = 0; i < scene.rooms.size(); ++i) {
        for (const RoomNeighbor& neighbor : scene.rooms[i].neighbors) {
            const auto other = numbers.find(neighbor.room);
            if (other == numbers.end() || other->second == i) continue;
            pairs[in_order(i, other->second)].push_back(neighbor.through);
        }
    }
    return pairs;
}

bool was_seen(const Scene& scene, const std::vector<std::string_view>& doors) {
    return std::any_of(scene.components.begin(), scene.components.end(), [&](const Component& c) {
        return std::find(doors.begin(), doors.end(), c.id) != doors.end() &&
               is_enough(c.visible.value_or(1.0));
    });
}

DetectionCounts RoomMatcher::count_neighbors() const {
    DetectionCounts counts;
    std::set<RoomPair> counted;
    const auto true_pairs = neighbor_pairs(truth_);
    for (const auto& [rooms, doors] : true_pairs) {
        if (counts_[rooms.first] && counts_[rooms.second] && was_seen(truth_, doors))
            counted.insert(rooms);
    }
    counts.ground_truth = counted.size();
    counts.scenes = counted.empty() ? 0 : 1;
    for (const auto& [rooms, doors] : neighbor_pairs(found_)) {
        const auto a = true_of_found_[rooms.first];
        const auto b = true_of_found_[rooms.second];
        const bool knows_unseen = (a ? !counts_[*a] : lies_in_unseen_rooms(rooms.first)) ||
                                  (b ? !counts_[*b] : lies_in_unseen_rooms(rooms.second));
        if (a && b && counted.contains(in_order(*a, *b))) {
            ++counts.correct;
        } else if (!knows_unseen && !(a && b && true_pairs.contains(in_order(*a, *b)))) {
            ++counts.false_positives;
        }
    }
    return counts;
}

DetectionCounts count(const std::vector<RoomMatch>& matches) {
    DetectionCounts counts;
    for (const RoomMatch& match : matches) {
        const bool is_correct = match.outcome == DetectionOutcome::correct;
        counts.correct += is_correct ? 1U : 0U;
        counts.ground_truth += is_correct || match.outcome == DetectionOutcome::missed ? 1U : 0U;
        counts.false_positives += match.outcome == DetectionOutcome::false_positive ? 1U : 0U;
    }
    counts.scenes = counts.ground_truth > 0 ? 1U : 0U;
    return counts;
}

}  // namespace

double room_visibility(const Scene& truth, const Room& room) {
    double seen = 0.0;
    double whole = 0.0;
    for (const Component& component : truth.components) {
        const bool bounds = component.label == Label::floor || component.label == Label::ceiling ||
                            component.label == Label::wall;
        if (!bounds || component.parent != room.id) continue;
        const double area = polygon_area(component.polygon);
        seen += area * component.visible.value_or(1.0);
        whole += area;
    }
    return whole > 0.0 ? seen / whole : 1.0;
}

RoomError evaluate_rooms(const GroundTruth& truth, const Prediction& prediction) {
    RoomError error;
    RoomMatcher matcher(truth, prediction);
    matcher.match(error);
    std::stable_sort(error.matches.begin(), error.matches.end(),
                     [](const RoomMatch& a, const RoomMatch& b) { return a.iou > b.iou; });
    error.rooms = count(error.matches);
    error.neighbors = matcher.count_neighbors();
    return error;
}

}  // namespace roomscribe
