// SPDX-License-Identifier: MIT
#include "roomscribe/export/storey_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "roomscribe/export/wall_openings.hpp"
#include "roomscribe/geometry/polygon.hpp"

namespace roomscribe {
namespace {

/// Over the floor: through doors and windows, over tables (drawing practice).
constexpr double cut_height = 1.2;
/// DIN 18101 ends at 1.235 m; wider doors have two leaves.
constexpr double widest_leaf = 1.25;
// At 1:50 capitals of 3.2, 2.6, 2.2 and 1.7 mm: sizes of lettering on plans.
constexpr double name_height = 0.16;
constexpr double area_height = 0.13;
constexpr double dimension_height = 0.11;
constexpr double kind_height = 0.085;
/// Of common fonts, a letter's advance by its capitals' height.
constexpr double letter_width = 0.85;
/// Half the room that a name with its area takes.
constexpr double label_half_width = 0.45;
constexpr double label_half_height = 0.25;
constexpr double tick = 0.06;
/// From the wall to a dimension line beside it.
constexpr double dimension_offset = 0.3;
constexpr double overall_offset = 0.7;

using Outline = std::vector<Eigen::Vector2d>;

struct Interval {
    double from;
    double to;
};

/// What is left of a stretch of wall between its openings.
std::vector<Interval> gaps_removed(Interval stretch, std::vector<Interval> holes) {
    std::sort(holes.begin(), holes.end(),
              [](const Interval& a, const Interval& b) { return a.from < b.from; });
    std::vector<Interval> left;
    for (const Interval& hole : holes) {
        if (hole.from > stretch.from)
            left.push_back({stretch.from, std::min(hole.from, stretch.to)});
        stretch.from = std::max(stretch.from, hole.to);
    }
    left.push_back(stretch);
    std::erase_if(left, [](const Interval& i) { return i.to - i.from < 1e-6; });
    return left;
}

Outline band(const Wall& wall, double from, double to) {
    const Eigen::Vector2d half = 0.5 * wall.thickness * wall.left();
    const Eigen::Vector2d a = wall.start + from * wall.along();
    const Eigen::Vector2d b = wall.start + to * wall.along();
    return {a - half, b - half, b + half, a + half};
}

Outline footprint(const OrientedBox& box) {
    Outline corners;
    for (const double x : {-0.5, 0.5}) {
        for (const double y : {-0.5, 0.5}) {
            for (const double z : {-0.5, 0.5}) {
                corners.emplace_back((box.center + x * box.size.x() * box.axes[0] +
                                      y * box.size.y() * box.axes[1] +
                                      z * box.size.z() * box.axes[2])
                                         .head<2>());
            }
        }
    }
    return convex_hull(corners);
}

Eigen::AlignedBox2d bounds_of(const Outline& outline) {
    Eigen::AlignedBox2d bounds;
    for (const Eigen::Vector2d& corner : outline)
        bounds.extend(corner);
    return bounds;
}

double distance_to_edges(const Outline& outline, const Eigen::Vector2d& place) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Eigen::Vector2d edge = outline[(i + 1) % outline.size()] - outline[i];
        const double length2 = std::max(edge.squaredNorm(), 1e-12);
        const double share = std::clamp(edge.dot(place - outline[i]) / length2, 0.0, 1.0);
        nearest = std::min(nearest, (outline[i] + share * edge - place).norm());
    }
    return nearest;
}

/// Where a line at height `y` runs inside an outline: its longest stretch.
std::optional<Interval> chord(const Outline& outline, double y) {
    std::vector<double> crossings;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Eigen::Vector2d& a = outline[i];
        const Eigen::Vector2d& b = outline[(i + 1) % outline.size()];
        if ((a.y() > y) == (b.y() > y)) continue;
        crossings.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
    }
    std::sort(crossings.begin(), crossings.end());
    std::optional<Interval> longest;
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
        if (!longest || crossings[i + 1] - crossings[i] > longest->to - longest->from)
            longest = Interval{crossings[i], crossings[i + 1]};
    }
    return longest;
}

class PlanDrawer {
  public:
    PlanDrawer(const Building& building, std::size_t storey)
        : building_(building), storey_(storey) {}

    StoreyPlan draw() {
        const BuildingStorey& storey = building_.storeys[storey_];
        plan_.title = fmt::format("Storey {}", storey_ + 1);
        plan_.elevation = storey.elevation;
        draw_furniture();
        for (const std::size_t room : storey.rooms)
            draw_room(building_.scene.rooms[room]);
        for (std::size_t i = 0; i < building_.walls.size(); ++i)
            if (building_.walls[i].storey == storey_) draw_wall(i);
        for (const Opening& opening : building_.openings)
            if (building_.walls[opening.wall].storey == storey_) draw_opening(opening);
        draw_lone_fillings();
        for (const PlanPath& path : plan_.paths)
            for (const Eigen::Vector2d& corner : path.corners)
                plan_.bounds.extend(corner);
        if (plan_.bounds.isEmpty()) {
            plan_.bounds = Eigen::AlignedBox2d(Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 1));
        } else {
            draw_overall_size();
        }
        return plan_;
    }

  private:
    const Component& component(std::size_t index) const {
        return building_.scene.components[index];
    }
    static PlanStroke stroke_of(const Component& component) {
        return component.verdict == Verdict::accepted ? PlanStroke::solid : PlanStroke::dashed;
    }
    void add_line(PlanLayer layer, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                  PlanStroke stroke = PlanStroke::solid, std::string id = "") {
        plan_.paths.push_back({layer, {a, b}, false, stroke, std::move(id)});
    }

    void draw_furniture() {
        for (std::size_t i = 0; i < building_.scene.components.size(); ++i) {
            const Component& component = this->component(i);
            const bool is_handle = component.label == Label::handle;
            if (building_.storey_of[i] != storey_ || !component.box) continue;
            if (component.label != Label::furniture && !is_handle) continue;
            const Outline outline = footprint(*component.box);
            if (outline.size() < 3) continue;
            PlanStroke stroke = stroke_of(component);
            const double bottom = component.box->center.z() - 0.5 * box_size(*component.box).height;
            if (bottom > plan_.elevation + cut_height) stroke = PlanStroke::dashed;
            const PlanLayer layer = is_handle ? PlanLayer::handles : PlanLayer::furniture;
            plan_.paths.push_back({layer, outline, true, stroke, component.id});
            if (is_handle) continue;
            furniture_.push_back(outline);
            draw_kind(component, outline, stroke);
        }
    }

    /// Where it has room: what hangs over something leaves the word to what stands below.
    void draw_kind(const Component& component, const Outline& outline, PlanStroke stroke) {
        if (component.kind.empty() || stroke == PlanStroke::dashed) return;
        std::string words = component.kind;
        std::replace(words.begin(), words.end(), '_', ' ');
        const Eigen::AlignedBox2d bounds = bounds_of(outline);
        const double width = kind_height * letter_width * static_cast<double>(words.size());
        const bool is_upright =
            bounds.sizes().y() > bounds.sizes().x() && width > bounds.sizes().x();
        if (width > 1.05 * bounds.sizes()(is_upright ? 1 : 0)) return;
        plan_.texts.push_back({PlanLayer::furniture, bounds.center(), kind_height,
                               is_upright ? std::numbers::pi / 2 : 0.0, words, false});
    }

    void draw_room(const Room& room) {
        const Outline outline = clean_outline(plan_of_room(room));
        if (outline.size() < 3) return;
        plan_.paths.push_back({PlanLayer::rooms, outline, true, PlanStroke::solid, room.id});
        const Eigen::Vector2d label = place_of_label(outline);
        const Eigen::Vector2d line(0.0, 0.14);
        plan_.texts.push_back({PlanLayer::text, label + line, name_height, 0.0, room.id, true});
        plan_.texts.push_back({PlanLayer::text, label - line, area_height, 0.0,
                               fmt::format("{:.2f} m\u00b2", room.area), false});
        draw_clear_sizes(outline, label);
    }

    /// Far from the walls of the room and from its furniture.
    Eigen::Vector2d place_of_label(const Outline& outline) const {
        constexpr int steps = 40;
        const Eigen::AlignedBox2d bounds = bounds_of(outline);
        Eigen::Vector2d best = bounds.center();
        double best_room = -std::numeric_limits<double>::infinity();
        // A label is wider than high: places are compared where it is a square.
        const Eigen::Vector2d square(label_half_height / label_half_width, 1.0);
        const auto squeezed = [&](Outline shape) {
            for (Eigen::Vector2d& corner : shape)
                corner = corner.cwiseProduct(square);
            return shape;
        };
        const Outline room = squeezed(outline);
        std::vector<Outline> pieces;
        for (const Outline& piece : furniture_) {
            if (bounds.intersects(bounds_of(piece))) pieces.push_back(squeezed(piece));
        }
        for (int i = 1; i < steps; ++i) {
            for (int j = 1; j < steps; ++j) {
                const Eigen::Vector2d share(i / double{steps}, j / double{steps});
                const Eigen::Vector2d place = bounds.min() + share.cwiseProduct(bounds.sizes());
                if (!is_inside(outline, place)) continue;
                const Eigen::Vector2d there = place.cwiseProduct(square);
                double free = distance_to_edges(room, there);
                for (const Outline& piece : pieces) {
                    const double distance = distance_to_edges(piece, there);
                    free = std::min(free, is_inside(piece, there) ? -distance : distance);
                }
                if (free <= best_room + 1e-9) continue;
                best_room = free;
                best = place;
            }
        }
        return best;
    }

    void draw_clear_sizes(const Outline& outline, const Eigen::Vector2d& label) {
        draw_clear_size(outline, label, false);
        draw_clear_size(outline, label, true);
    }

    static bool is_about(double a, double b) { return std::abs(a - b) < 0.02 * b; }

    /// The length that most lines across a room have, of equally many the longest: a niche or a
    /// bulge does not say how wide it is.
    static double usual_length(const std::vector<std::pair<double, Interval>>& lines) {
        double usual = 0.0;
        std::ptrdiff_t most = 0;
        for (const auto& [y, line] : lines) {
            const double length = line.to - line.from;
            const std::ptrdiff_t count =
                std::count_if(lines.begin(), lines.end(), [&](const auto& other) {
                    return is_about(other.second.to - other.second.from, length);
                });
            if (count < most || (count == most && length <= usual)) continue;
            most = count;
            usual = length;
        }
        return usual;
    }

    /// Along x, or along y by exchanging them: the line as long as most, which keeps off the walls,
    /// meets the least furniture and not the room's name, and lies nearest to the first wall.
    void draw_clear_size(const Outline& outline, const Eigen::Vector2d& label, bool along_y) {
        const auto turned = [&](const Eigen::Vector2d& p) {
            return along_y ? Eigen::Vector2d(p.y(), p.x()) : p;
        };
        Outline room;
        for (const Eigen::Vector2d& corner : outline)
            room.push_back(turned(corner));
        const Eigen::AlignedBox2d bounds = bounds_of(room);
        const double inset = std::min(dimension_offset, 0.25 * bounds.sizes().y());
        constexpr int steps = 24;
        std::vector<std::pair<double, Interval>> lines;
        for (int i = 0; i <= steps; ++i) {
            const double y =
                bounds.min().y() + inset + i / double{steps} * (bounds.sizes().y() - 2.0 * inset);
            const auto line = chord(room, y);
            if (line) lines.emplace_back(y, *line);
        }
        const double usual = usual_length(lines);
        std::optional<std::pair<double, Interval>> best;
        int least = std::numeric_limits<int>::max();
        const Eigen::Vector2d half =
            turned({label_half_width, label_half_height + 2.0 * dimension_height});
        for (const auto& [y, line] : lines) {
            if (!is_about(line.to - line.from, usual)) continue;
            int cost = std::abs(turned(label).y() - y) < half.y() ? 100 : 0;
            for (int i = 1; i < 8; ++i) {
                const Eigen::Vector2d on_line(line.from + i / 8.0 * (line.to - line.from), y);
                if (distance_to_edges(room, on_line) < 0.5 * dimension_offset) cost += 10;
            }
            for (const Outline& piece : furniture_) {
                Eigen::AlignedBox2d box;
                for (const Eigen::Vector2d& corner : piece)
                    box.extend(turned(corner));
                if (box.max().x() > line.from && box.min().x() < line.to && box.max().y() > y &&
                    box.min().y() < y) {
                    ++cost;
                }
            }
            if (cost >= least) continue;
            least = cost;
            best = {y, line};
        }
        if (!best) return;
        draw_dimension(turned({best->second.from, best->first}),
                       turned({best->second.to, best->first}));
    }

    void draw_dimension(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
        const Eigen::Vector2d along = (b - a).normalized();
        const Eigen::Vector2d across(-along.y(), along.x());
        add_line(PlanLayer::dimensions, a, b);
        const Eigen::Vector2d slash = tick * (along + across);
        for (const Eigen::Vector2d& end : {a, b})
            add_line(PlanLayer::dimensions, end - slash, end + slash);
        const double angle = std::atan2(along.y(), along.x());
        plan_.texts.push_back({PlanLayer::dimensions,
                               0.5 * (a + b) + 0.9 * dimension_height * across, dimension_height,
                               angle, fmt::format("{:.2f}", (b - a).norm()), false});
    }

    void draw_overall_size() {
        const Eigen::AlignedBox2d all = plan_.bounds;
        const Eigen::Vector2d low = all.min() - Eigen::Vector2d::Constant(overall_offset);
        draw_dimension({all.min().x(), low.y()}, {all.max().x(), low.y()});
        draw_dimension({low.x(), all.min().y()}, {low.x(), all.max().y()});
        plan_.bounds.extend(low);
    }

    void draw_wall(std::size_t index) {
        const Wall& wall = building_.walls[index];
        std::vector<Interval> holes;
        for (const Opening& opening : building_.openings)
            if (opening.wall == index) holes.push_back({opening.from, opening.to});
        const PlanStroke stroke = stroke_of(component(wall.faces.front().component));
        for (const Interval& left : gaps_removed({wall.body_from, wall.body_to}, holes)) {
            plan_.paths.push_back(
                {PlanLayer::walls, band(wall, left.from, left.to), true, stroke, wall.id});
        }
        for (const FaceInPlan& face : wall.faces) {
            const Component& seen = component(face.component);
            add_line(PlanLayer::faces, face.start, face.end, stroke_of(seen), seen.id);
        }
    }

    void draw_opening(const Opening& opening) {
        if (!opening.filling) return;
        const Component& filling = component(*opening.filling);
        if (filling.label == Label::window) {
            plan_.paths.push_back({PlanLayer::windows,
                                   band(building_.walls[opening.wall], opening.from, opening.to),
                                   true, stroke_of(filling), filling.id});
        }
        draw_filling(filling);
    }

    /// Doors and windows that lie in no wall that was found.
    void draw_lone_fillings() {
        for (std::size_t i = 0; i < building_.scene.components.size(); ++i) {
            const Component& component = this->component(i);
            if (building_.storey_of[i] != storey_) continue;
            if (component.label != Label::door && component.label != Label::window) continue;
            if (std::none_of(building_.openings.begin(), building_.openings.end(),
                             [i](const Opening& opening) { return opening.filling == i; }))
                draw_filling(component);
        }
    }

    void draw_filling(const Component& filling) {
        // What lies flat has no place in a plan of what stands.
        if (area_vector(filling.polygon).head<2>().norm() < 1e-9) return;
        if (filling.label == Label::window) {
            draw_panes(filling);
        } else {
            draw_door(filling);
        }
    }

    /// Glass as two lines, about as far apart as panes are.
    void draw_panes(const Component& window) {
        const auto [a, b] = ends_of(window);
        const Eigen::Vector2d along = (b - a).normalized();
        const Eigen::Vector2d across(-along.y(), along.x());
        for (const double side : {-0.015, 0.015}) {
            add_line(PlanLayer::windows, a + side * across, b + side * across, stroke_of(window),
                     window.id);
        }
    }

    /// Ends of what stands upright, seen from above: in its own plane, as its size is measured.
    static std::pair<Eigen::Vector2d, Eigen::Vector2d> ends_of(const Component& component) {
        const Eigen::Vector3d normal = area_vector(component.polygon);
        const Eigen::Vector2d along = Eigen::Vector2d(normal.y(), -normal.x()).normalized();
        Eigen::Vector2d center = Eigen::Vector2d::Zero();
        for (const Eigen::Vector3d& corner : component.polygon)
            center += corner.head<2>() / static_cast<double>(component.polygon.size());
        double low = 0.0;
        double high = 0.0;
        for (const Eigen::Vector3d& corner : component.polygon) {
            low = std::min(low, along.dot(corner.head<2>() - center));
            high = std::max(high, along.dot(corner.head<2>() - center));
        }
        return {center + low * along, center + high * along};
    }

    void draw_door(const Component& door) {
        const auto [a, b] = ends_of(door);
        const PlanStroke stroke = stroke_of(door);
        const bool is_hinged = door.opens && door.opens->kind == MotionKind::hinged;
        if (!is_hinged) {
            add_line(PlanLayer::doors, a, b, stroke, door.id);
            return;
        }
        const Eigen::Vector2d hinge = door.opens->point.head<2>();
        const bool at_a = (hinge - a).norm() < (hinge - b).norm();
        // As a right hand's fingers turn about the axis.
        const double turn = door.opens->direction.z() < 0.0 ? -1.0 : 1.0;
        if ((b - a).norm() <= widest_leaf) {
            draw_leaf(at_a ? a : b, at_a ? b : a, turn, stroke, door.id);
            return;
        }
        const Eigen::Vector2d middle = 0.5 * (a + b);
        draw_leaf(at_a ? a : b, middle, turn, stroke, door.id);
        draw_leaf(at_a ? b : a, middle, -turn, stroke, door.id);
    }

    /// Open by a quarter turn, with the way of its edge.
    void draw_leaf(const Eigen::Vector2d& hinge, const Eigen::Vector2d& edge, double turn,
                   PlanStroke stroke, const std::string& id) {
        const Eigen::Vector2d shut = edge - hinge;
        const Eigen::Vector2d open = turn * Eigen::Vector2d(-shut.y(), shut.x());
        constexpr double leaf = 0.04;
        const Eigen::Vector2d inside = leaf * shut.normalized();
        plan_.paths.push_back({PlanLayer::doors,
                               {hinge, hinge + inside, hinge + inside + open, hinge + open},
                               true,
                               stroke,
                               id});
        double from = std::atan2(shut.y(), shut.x());
        double to = std::atan2(open.y(), open.x());
        if (turn < 0.0) std::swap(from, to);
        if (to < from) to += 2.0 * std::numbers::pi;
        plan_.arcs.push_back({PlanLayer::doors, hinge, shut.norm(), from, to, stroke, id});
        const double middle = 0.5 * (from + to);
        plan_.bounds.extend(hinge +
                            shut.norm() * Eigen::Vector2d(std::cos(middle), std::sin(middle)));
    }

    const Building& building_;
    std::size_t storey_;
    StoreyPlan plan_;
    std::vector<Outline> furniture_;
};

}  // namespace

std::vector<StoreyPlan> draw_floor_plans(const Building& building) {
    std::vector<StoreyPlan> plans;
    for (std::size_t i = 0; i < building.storeys.size(); ++i)
        plans.push_back(PlanDrawer(building, i).draw());
    return plans;
}

std::vector<double> plan_shifts(const std::vector<StoreyPlan>& plans) {
    constexpr double gap = 2.0;
    std::vector<double> shifts{0.0};
    for (std::size_t i = 1; i < plans.size(); ++i) {
        const double right = shifts.back() + plans[i - 1].bounds.max().x();
        shifts.push_back(std::ceil(right + gap - plans[i].bounds.min().x()));
    }
    shifts.resize(plans.size());
    return shifts;
}

}  // namespace roomscribe
