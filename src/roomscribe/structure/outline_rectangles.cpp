// SPDX-License-Identifier: MIT
#include "roomscribe/structure/outline_rectangles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace roomscribe {
namespace {

using Eigen::Vector2d;

struct Interval {
    double low;
    double high;
};

/// Lines on one straight line of the frame that have their material on the same side.
struct Side {
    double position = 0.0;
    std::vector<Interval> stretches;   ///< ascending
    std::vector<std::uint32_t> lines;  ///< one per stretch
};

/// How much of [low, high] the side's stretches cover.
double covered_length(const Side& side, double low, double high) {
    double covered = 0.0;
    double reached = low;
    for (const Interval& stretch : side.stretches) {
        const double from = std::max(stretch.low, reached);
        const double to = std::min(stretch.high, high);
        if (to <= from) continue;
        covered += to - from;
        reached = to;
    }
    return covered;
}

/// The angle, within 90 degrees, along and across which most of the lines run.
double dominant_angle(std::span<const OutlineLine> lines) {
    // The mean of the angles times four, by length squared: long lines know it best.
    Vector2d sum = Vector2d::Zero();
    for (const OutlineLine& line : lines) {
        const Vector2d along = line.direction();
        const double angle = 4.0 * std::atan2(along.y(), along.x());
        sum += line.length() * line.length() * Vector2d(std::cos(angle), std::sin(angle));
    }
    return 0.25 * std::atan2(sum.y(), sum.x());
}

enum SideName : std::size_t { left, right, bottom, top };

/// A rectangle in the frame, and which of its sides were seen.
struct Candidate {
    double x_low = 0.0;
    double x_high = 0.0;
    double y_low = 0.0;
    double y_high = 0.0;
    std::array<const Side*, 4> sides{};
    double covered = 0.0;
    int num_sides = 0;

    double perimeter() const { return 2.0 * (x_high - x_low + y_high - y_low); }
    Interval extent_of(std::size_t side) const {
        return side == left || side == right ? Interval{y_low, y_high} : Interval{x_low, x_high};
    }
};

class RectangleFinder {
  public:
    RectangleFinder(std::span<const OutlineLine> lines, const OutlineRectangleSettings& settings)
        : lines_(lines), settings_(settings), angle_(dominant_angle(lines)) {}

    void find(bool is_hole, std::vector<OutlineRectangle>& rectangles) {
        collect_sides(is_hole);
        std::vector<Candidate> candidates;
        for (const Side& a : sides_[left]) {
            for (const Side& b : sides_[right]) {
                if (b.position - a.position >= settings_.min_side) pair_up(a, b, candidates);
            }
        }
        for (const Side& a : sides_[bottom]) {
            for (const Side& b : sides_[top]) {
                if (b.position - a.position >= settings_.min_side) close(a, b, candidates);
            }
        }
        std::stable_sort(
            candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return merit(a) > merit(b); });
        std::vector<bool> is_used(lines_.size(), false);
        for (const Candidate& candidate : candidates) {
            if (unused_length(candidate, is_used) >= min_unused * candidate.covered)
                rectangles.push_back(take(candidate, is_hole, is_used));
        }
    }

  private:
    static constexpr double min_side_cover = 0.5;
    static constexpr double min_cover = 0.65;  ///< of the sides that were seen
    static constexpr double min_unused = 0.8;

    static double merit(const Candidate& candidate) {
        const double share = candidate.covered / candidate.perimeter();
        return share * share * share * std::sqrt(candidate.perimeter());
    }

    Vector2d into_frame(const Vector2d& point) const {
        const double c = std::cos(angle_);
        const double s = std::sin(angle_);
        return {c * point.x() + s * point.y(), c * point.y() - s * point.x()};
    }
    Vector2d out_of_frame(double x, double y) const {
        const double c = std::cos(angle_);
        const double s = std::sin(angle_);
        return {c * x - s * y, s * x + c * y};
    }

    void collect_sides(bool is_hole) {
        struct Edge {
            double position;
            Interval stretch;
            std::uint32_t line;
        };
        std::array<std::vector<Edge>, 4> edges;
        for (std::uint32_t i = 0; i < lines_.size(); ++i) {
            const Vector2d a = into_frame(lines_[i].start);
            const Vector2d b = into_frame(lines_[i].end);
            const Vector2d along = (b - a).normalized();
            const double sine = std::sin(settings_.angle_tolerance);
            if (std::abs(along.y()) <= sine) {
                // Material above a line that runs along +x: an island's bottom, a hole's top.
                const bool is_bottom = (along.x() > 0.0) != is_hole;
                edges[is_bottom ? bottom : top].push_back(
                    {0.5 * (a.y() + b.y()), {std::min(a.x(), b.x()), std::max(a.x(), b.x())}, i});
            } else if (std::abs(along.x()) <= sine) {
                const bool is_right = (along.y() > 0.0) != is_hole;
                edges[is_right ? right : left].push_back(
                    {0.5 * (a.x() + b.x()), {std::min(a.y(), b.y()), std::max(a.y(), b.y())}, i});
            }
        }
        for (std::size_t name = 0; name < 4; ++name) {
            auto& of_name = edges[name];
            std::sort(of_name.begin(), of_name.end(), [](const Edge& a, const Edge& b) {
                return std::pair(a.position, a.line) < std::pair(b.position, b.line);
            });
            sides_[name].clear();
            for (std::size_t begin = 0; begin < of_name.size();) {
                std::size_t end = begin;
                while (end < of_name.size() && of_name[end].position - of_name[begin].position <=
                                                   settings_.distance_tolerance) {
                    ++end;
                }
                std::sort(of_name.begin() + static_cast<std::ptrdiff_t>(begin),
                          of_name.begin() + static_cast<std::ptrdiff_t>(end),
                          [](const Edge& a, const Edge& b) {
                              return std::pair(a.stretch.low, a.line) <
                                     std::pair(b.stretch.low, b.line);
                          });
                Side side;
                double length = 0.0;
                for (std::size_t i = begin; i < end; ++i) {
                    const double part = of_name[i].stretch.high - of_name[i].stretch.low;
                    side.position += part * of_name[i].position;
                    length += part;
                    side.stretches.push_back(of_name[i].stretch);
                    side.lines.push_back(of_name[i].line);
                }
                side.position /= length;
                sides_[name].push_back(std::move(side));
                begin = end;
            }
        }
    }

    /// Left and right are given: with a bottom, a top, or both.
    void pair_up(const Side& a, const Side& b, std::vector<Candidate>& candidates) const {
        Candidate base;
        base.sides[left] = &a;
        base.sides[right] = &b;
        base.x_low = a.position;
        base.x_high = b.position;
        const double low = std::max(a.stretches.front().low, b.stretches.front().low);
        const double high = std::min(last(a), last(b));
        if (low >= high) return;
        const auto reaches = [&](const Side& side) {
            return covered_length(side, base.x_low, base.x_high) >=
                   min_side_cover * (base.x_high - base.x_low);
        };
        std::vector<const Side*> bottoms;
        std::vector<const Side*> tops;
        for (const Side& side : sides_[bottom]) {
            if (reaches(side)) bottoms.push_back(&side);
        }
        for (const Side& side : sides_[top]) {
            if (reaches(side)) tops.push_back(&side);
        }
        for (const Side* floor : bottoms) {
            for (const Side* ceiling : tops) {
                Candidate whole = base;
                whole.sides[bottom] = floor;
                whole.sides[top] = ceiling;
                whole.y_low = floor->position;
                whole.y_high = ceiling->position;
                consider(whole, candidates);
            }
            consider_open(base, a, b, bottom, *floor, candidates);
        }
        for (const Side* ceiling : tops)
            consider_open(base, a, b, top, *ceiling, candidates);
    }

    /// Bottom and top are given: with a left or a right side alone.
    void close(const Side& a, const Side& b, std::vector<Candidate>& candidates) const {
        Candidate base;
        base.sides[bottom] = &a;
        base.sides[top] = &b;
        base.y_low = a.position;
        base.y_high = b.position;
        for (const std::size_t name : {left, right}) {
            for (const Side& side : sides_[name])
                consider_open(base, a, b, name, side, candidates);
        }
    }

    /// Arms `a` and `b` and one side across them. The arms end where they are hidden, or at the
    /// missing side: the longer one knows better.
    void consider_open(Candidate candidate, const Side& a, const Side& b, std::size_t name,
                       const Side& side, std::vector<Candidate>& candidates) const {
        const bool is_low = name == left || name == bottom;
        const double end = is_low ? std::max(last(a), last(b))
                                  : std::min(a.stretches.front().low, b.stretches.front().low);
        const auto [low, high] =
            is_low ? Interval{side.position, end} : Interval{end, side.position};
        candidate.sides[name] = &side;
        const bool is_upright = name == left || name == right;
        (is_upright ? candidate.x_low : candidate.y_low) = low;
        (is_upright ? candidate.x_high : candidate.y_high) = high;
        consider(candidate, candidates);
    }

    static double last(const Side& side) {
        double high = side.stretches.front().high;
        for (const Interval& stretch : side.stretches)
            high = std::max(high, stretch.high);
        return high;
    }

    void consider(Candidate candidate, std::vector<Candidate>& candidates) const {
        if (candidate.x_high - candidate.x_low < settings_.min_side ||
            candidate.y_high - candidate.y_low < settings_.min_side) {
            return;
        }
        double seen = 0.0;
        for (std::size_t name = 0; name < 4; ++name) {
            if (candidate.sides[name] == nullptr) continue;
            const auto [low, high] = candidate.extent_of(name);
            const double covered = covered_length(*candidate.sides[name], low, high);
            if (covered < min_side_cover * (high - low)) return;
            candidate.covered += covered;
            seen += high - low;
            ++candidate.num_sides;
        }
        if (candidate.covered >= min_cover * seen) candidates.push_back(candidate);
    }

    /// Calls `visit(line, length)` for the stretches that a candidate's sides are made of.
    template <typename Visit>
    static void for_each_stretch(const Candidate& candidate, Visit&& visit) {
        for (std::size_t name = 0; name < 4; ++name) {
            const Side* side = candidate.sides[name];
            if (side == nullptr) continue;
            const auto [low, high] = candidate.extent_of(name);
            for (std::size_t i = 0; i < side->stretches.size(); ++i) {
                const double length =
                    std::min(side->stretches[i].high, high) - std::max(side->stretches[i].low, low);
                if (length > 0.0) visit(side->lines[i], length);
            }
        }
    }

    static double unused_length(const Candidate& candidate, const std::vector<bool>& is_used) {
        double unused = 0.0;
        for_each_stretch(candidate, [&](std::uint32_t line, double length) {
            if (!is_used[line]) unused += length;
        });
        return unused;
    }

    OutlineRectangle take(const Candidate& candidate, bool is_hole,
                          std::vector<bool>& is_used) const {
        for_each_stretch(candidate, [&](std::uint32_t line, double length) {
            if (2.0 * length > lines_[line].length()) is_used[line] = true;
        });
        OutlineRectangle rectangle;
        rectangle.corners = {out_of_frame(candidate.x_low, candidate.y_low),
                             out_of_frame(candidate.x_high, candidate.y_low),
                             out_of_frame(candidate.x_high, candidate.y_high),
                             out_of_frame(candidate.x_low, candidate.y_high)};
        rectangle.is_hole = is_hole;
        rectangle.num_sides = candidate.num_sides;
        rectangle.support = std::min(1.0, candidate.covered / candidate.perimeter());
        return rectangle;
    }

    std::span<const OutlineLine> lines_;
    const OutlineRectangleSettings& settings_;
    double angle_;
    std::array<std::vector<Side>, 4> sides_;
};

}  // namespace

std::vector<OutlineRectangle> find_outline_rectangles(std::span<const OutlineLine> lines,
                                                      const OutlineRectangleSettings& settings) {
    std::vector<OutlineRectangle> rectangles;
    if (lines.size() < 3) return rectangles;
    RectangleFinder finder(lines, settings);
    finder.find(false, rectangles);
    finder.find(true, rectangles);
    std::stable_sort(
        rectangles.begin(), rectangles.end(),
        [](const OutlineRectangle& a, const OutlineRectangle& b) { return a.support > b.support; });
    return rectangles;
}

Quadrilateral place_on_plane(const OutlineRectangle& rectangle, const Plane& plane) {
    const PlaneAxes axes = plane_axes(plane.normal);
    Quadrilateral quad;
    for (std::size_t i = 0; i < 4; ++i) {
        quad.corners[i] = rectangle.corners[i].x() * axes.u + rectangle.corners[i].y() * axes.v +
                          plane.offset * plane.normal;
    }
    return quad;
}

}  // namespace roomscribe
