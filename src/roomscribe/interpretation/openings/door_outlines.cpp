// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/openings/door_outlines.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "roomscribe/core/quantile.hpp"
#include "roomscribe/interpretation/openings/wall_relief.hpp"

namespace roomscribe {
namespace {

/// m. Leaves of 0.61 to 1.11 m (DIN 18101): set back, and with casings of 95 mm beside them; two
/// leaves. Heights from the lowest leaf, 1.985 m less what lies on the floor, to the
/// casing over one of 2.235 m.
constexpr double min_width = 0.6;
constexpr double max_sunk_width = 1.15;
constexpr double max_width = 1.3;
constexpr double min_double_width = 1.35;
constexpr double max_double_width = 2.5;
constexpr double min_height = 1.93;
constexpr double max_height = 2.35;
/// m behind the wall: frames that are set back.
constexpr double most_sunk = 0.05;
/// m. DIN 18202 allows finished walls 3 mm over a decimetre.
constexpr double least_step = 0.004;
/// Of the usual difference between neighbouring strips, which noise and plaster make.
constexpr double min_contrast = 6.0;
/// m, on either side of an edge, over which levels are compared: the narrowest casing (44 mm).
constexpr double reach = 0.05;
/// m. Skirtings are lower; columns are read below the lowest lintel.
constexpr double above_skirting = 0.12;
constexpr double lowest_read = 0.3;
constexpr double highest_read = 1.8;
/// Bins: no finer than a centimetre, which scanners blur edges by, nor wider than half a casing; a
/// head is known from leaves' heights and may be read more coarsely.
constexpr double finest_bin = 0.01;
constexpr double coarsest_bin = 0.03;
constexpr double coarsest_top_bin = 0.1;
constexpr double usual_count = 20.0;
constexpr std::size_t min_in_bin = 6;
/// Of one step, how much another must reach at least to be like it.
constexpr double alike = 0.5;

/// Points that are looked at: an even share of more.
constexpr std::size_t max_points = 400'000;

constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();

bool are_alike(double a, double b) {
    return a * b > 0.0 &&
           std::min(std::abs(a), std::abs(b)) >= alike * std::max(std::abs(a), std::abs(b));
}

/// How far before the wall strips of points lie, one beside the other.
class StripProfile {
  public:
    StripProfile(double start, double end, double bin)
        : start_(start),
          bin_(bin),
          strips_(static_cast<std::size_t>(std::max(1.0, std::ceil((end - start) / bin)))) {}

    void add(double place, float height) {
        const double strip = std::floor((place - start_) / bin_);
        if (strip >= 0.0 && strip < static_cast<double>(strips_.size()))
            strips_[static_cast<std::size_t>(strip)].push_back(height);
    }
    void finish() {
        for (std::vector<float>& strip : strips_) {
            levels_.push_back(strip.size() < min_in_bin ? nowhere
                                                        : static_cast<double>(median(strip)));
        }
    }

    int size() const { return static_cast<int>(levels_.size()); }
    double place_of(int edge) const { return start_ + edge * bin_; }
    int edge_at(double place) const {
        return static_cast<int>(std::lround((place - start_) / bin_));
    }

    /// How much what follows an edge stands before what precedes it; NaN where too little of either
    /// was seen.
    double step_at(int edge) const {
        const int width = std::max(2, static_cast<int>(std::lround(reach / bin_)));
        return level(edge, edge + width) - level(edge - width, edge);
    }

  private:
    double level(int first, int last) const {
        std::vector<double> seen;
        for (int i = std::max(0, first); i < std::min(size(), last); ++i) {
            const double strip = levels_[static_cast<std::size_t>(i)];
            if (!std::isnan(strip)) seen.push_back(strip);
        }
        return 2 * static_cast<int>(seen.size()) < last - first ? nowhere : median(seen);
    }

    double start_;
    double bin_;
    std::vector<std::vector<float>> strips_;
    std::vector<double> levels_;
};

/// An upright edge at which the wall's surface steps.
struct Edge {
    double place = 0.0;  ///< m along
    double step = 0.0;   ///< m, of what follows it
};

class OutlineSearch {
  public:
    OutlineSearch(std::span<const FacePlace> near, const WallRectangle& wall) : wall_(wall) {
        const std::size_t stride = near.size() / max_points + 1;
        near_.reserve(near.size() / stride + 1);
        for (std::size_t i = 0; i < near.size(); i += stride)
            near_.push_back(near[i]);
        std::sort(near_.begin(), near_.end(), [](const FacePlace& a, const FacePlace& b) {
            return a.along != b.along   ? a.along < b.along
                   : a.above != b.above ? a.above < b.above
                                        : a.depth < b.depth;
        });
    }

    std::vector<DoorOutline> run() {
        find_edges();
        std::vector<DoorOutline> candidates;
        for (std::size_t left = 0; left < edges_.size(); ++left) {
            for (std::size_t right = left + 1; right < edges_.size(); ++right) {
                const double width = edges_[right].place - edges_[left].place;
                if (width > max_double_width) break;
                if (const auto outline = look_at(edges_[left], edges_[right]))
                    candidates.push_back(*outline);
            }
        }
        return choose(std::move(candidates));
    }

  private:
    static bool is_double(const WallRectangle& border) { return border.width() > max_width; }

    /// The points of [start, end) along the wall.
    std::span<const FacePlace> between(double start, double end) const {
        const auto at = [this](double along) {
            return std::partition_point(near_.begin(), near_.end(),
                                        [along](const FacePlace& place) {
                                            return static_cast<double>(place.along) < along;
                                        });
        };
        const auto first = at(start);
        return {first, std::max(first, at(end))};
    }

    static double bin_of(double points_per_metre) {
        return std::max(finest_bin, usual_count / std::max(1.0, points_per_metre));
    }

    void find_edges() {
        std::size_t num_read = 0;
        for (const FacePlace& place : near_) {
            const double above = static_cast<double>(place.above) - wall_.bottom;
            num_read += above >= lowest_read && above <= highest_read ? 1 : 0;
        }
        const double per_metre = static_cast<double>(num_read) / std::max(0.1, wall_.width());
        bin_ = bin_of(per_metre);
        if (bin_ > coarsest_bin) return;
        StripProfile profile(wall_.start, wall_.end, bin_);
        for (const FacePlace& place : near_) {
            const double above = static_cast<double>(place.above) - wall_.bottom;
            if (above >= lowest_read && above <= highest_read)
                profile.add(place.along, -place.depth);
        }
        profile.finish();
        std::vector<double> steps;
        std::vector<double> sizes;
        for (int edge = 0; edge <= profile.size(); ++edge) {
            steps.push_back(profile.step_at(edge));
            if (!std::isnan(steps.back())) sizes.push_back(std::abs(steps.back()));
        }
        if (sizes.empty()) return;
        least_ = std::max(least_step, min_contrast * median(sizes));
        const int beside = std::max(1, static_cast<int>(std::lround(0.5 * reach / bin_)));
        for (int edge = 0; edge < static_cast<int>(steps.size()); ++edge) {
            const double step = steps[static_cast<std::size_t>(edge)];
            if (!(std::abs(step) >= least_)) continue;
            bool is_peak = true;
            for (int other = std::max(0, edge - beside);
                 other <= std::min(profile.size(), edge + beside); ++other) {
                const double rival = std::abs(steps[static_cast<std::size_t>(other)]);
                if (rival > std::abs(step) || (rival == std::abs(step) && other < edge))
                    is_peak = false;
            }
            if (is_peak) edges_.push_back({profile.place_of(edge), step});
        }
    }

    std::optional<DoorOutline> look_at(const Edge& left, const Edge& right) const {
        DoorOutline outline;
        outline.border = {left.place, right.place, wall_.bottom, wall_.bottom};
        const double width = outline.border.width();
        if (width < min_width || (width > max_width && width < min_double_width))
            return std::nullopt;
        outline.step = 0.5 * (left.step - right.step);
        if (!are_alike(left.step, -right.step) || outline.step > most_proud ||
            outline.step < -most_sunk || (outline.step < 0.0 && width > max_sunk_width)) {
            return std::nullopt;
        }
        const std::optional<Edge> top = top_of(outline);
        if (!top) return std::nullopt;
        outline.border.top = top->place;
        if (!runs_straight(outline)) return std::nullopt;
        outline.inside = inside_of(outline.border);
        if (!is_even(outline)) return std::nullopt;
        outline.contrast =
            std::min({std::abs(left.step), std::abs(right.step), std::abs(top->step)}) / least_;
        return outline;
    }

    /// The clearest step of a door's height between two upright edges.
    std::optional<Edge> top_of(const DoorOutline& outline) const {
        constexpr double inset = 0.03;
        constexpr double margin = 0.2;
        const auto inner = between(outline.border.start + inset, outline.border.end - inset);
        const double low = wall_.bottom + min_height - margin;
        const double high = wall_.bottom + max_height + margin;
        const auto num_seen = std::count_if(
            inner.begin(), inner.end(),
            [&](const FacePlace& place) { return place.above >= low && place.above < high; });
        // Lines of a scanner that looks up by few degrees are far apart there.
        const double bin = bin_of(static_cast<double>(num_seen) / (high - low));
        if (bin > coarsest_top_bin) return std::nullopt;
        StripProfile profile(low, high, bin);
        for (const FacePlace& place : inner)
            profile.add(place.above, -place.depth);
        profile.finish();
        std::optional<Edge> best;
        for (int edge = profile.edge_at(wall_.bottom + min_height);
             edge <= profile.edge_at(wall_.bottom + max_height); ++edge) {
            const double step = -profile.step_at(edge);
            if (!(std::abs(step) >= least_) || !are_alike(step, outline.step)) continue;
            if (!best || std::abs(step) > std::abs(best->step))
                best = Edge{profile.place_of(edge), step};
        }
        return best;
    }

    /// The step at an upright edge, of its inner side, between two heights.
    std::optional<double> step_between(const WallRectangle& border, bool is_left, double low,
                                       double high) const {
        constexpr std::size_t min_points = 5;
        constexpr double blur = 0.005;
        const double place = is_left ? border.start : border.end;
        std::vector<float> before;
        std::vector<float> after;
        for (const FacePlace& point : between(place - reach - blur, place + reach + blur)) {
            if (point.above < low || point.above >= high) continue;
            const double beyond = static_cast<double>(point.along) - place;
            if (beyond < -blur) before.push_back(-point.depth);
            if (beyond > blur) after.push_back(-point.depth);
        }
        if (before.size() < min_points || after.size() < min_points) return std::nullopt;
        const auto step = static_cast<double>(median(after) - median(before));
        return is_left ? step : -step;
    }

    /// Whether the upright edges step alike all the way up, and no more above: pillars, corners
    /// and joints go on, boards and pictures begin higher.
    bool runs_straight(const DoorOutline& outline) const {
        constexpr int num_parts = 4;
        constexpr int min_like = 5;  // of eight
        constexpr double lintel = 0.3;
        const WallRectangle& border = outline.border;
        const double low = border.bottom + above_skirting;
        const double high = (border.top - reach - low) / num_parts;
        int num_like = 0;
        int num_unlike = 0;
        for (const bool is_left : {true, false}) {
            for (int part = 0; part < num_parts; ++part) {
                const auto step =
                    step_between(border, is_left, low + part * high, low + (part + 1) * high);
                if (!step) continue;
                const bool is_like =
                    *step * outline.step > 0.0 && std::abs(*step) >= alike * std::abs(outline.step);
                (is_like ? num_like : num_unlike) += 1;
            }
            const auto above =
                step_between(border, is_left, border.top + reach, border.top + lintel);
            if (above && *above * outline.step > 0.0 &&
                std::abs(*above) > alike * std::abs(outline.step))
                return false;
        }
        return num_like >= min_like + num_unlike && num_unlike <= 1;
    }

    /// How far points of a rectangle lie before the face.
    std::vector<float> heights_in(double start, double end, double low, double high) const {
        std::vector<float> heights;
        for (const FacePlace& point : between(start, end)) {
            if (point.above >= low && point.above < high) heights.push_back(-point.depth);
        }
        return heights;
    }

    /// Whether what was seen within lies where the stiles do: curtains hang to the left and right
    /// of a window, and between them there is wall. Panes return next to nothing.
    bool is_even(const DoorOutline& outline) const {
        constexpr int num_parts = 4;
        constexpr double stile = 0.2;
        constexpr double min_density = 0.4;  // of the stiles'
        constexpr double panel = 0.012;  // m; fields of panelled leaves lie to a centimetre deeper
        const WallRectangle& border = outline.border;
        const double low = border.bottom + above_skirting;
        const double high = (border.top - stile - low) / num_parts;
        const double most = std::max(panel, alike * std::abs(outline.step));
        for (int part = 0; part < num_parts; ++part) {
            const double from = low + part * high;
            std::vector<float> middle =
                heights_in(border.start + stile, border.end - stile, from, from + high);
            const std::size_t beside =
                heights_in(border.start, border.start + stile, from, from + high).size() +
                heights_in(border.end - stile, border.end, from, from + high).size();
            const double density =
                static_cast<double>(middle.size()) / (border.width() - 2.0 * stile);
            if (density < min_density * static_cast<double>(beside) / (2.0 * stile)) continue;
            if (std::abs(static_cast<double>(median(middle)) - outline.inside) > most) return false;
        }
        return true;
    }

    /// m before the face: the median within what may be a casing, and the stiles of a leaf.
    double inside_of(const WallRectangle& border) const {
        constexpr double casing = 0.1;
        constexpr double stile = 0.2;
        const double low = border.bottom + above_skirting;
        const double high = border.top - casing;
        std::vector<float> heights =
            heights_in(border.start + casing, border.start + stile, low, high);
        const std::vector<float> right =
            heights_in(border.end - stile, border.end - casing, low, high);
        heights.insert(heights.end(), right.begin(), right.end());
        return static_cast<double>(median(heights));
    }

    static std::vector<DoorOutline> choose(std::vector<DoorOutline> candidates) {
        std::stable_sort(
            candidates.begin(), candidates.end(), [](const DoorOutline& a, const DoorOutline& b) {
                return is_double(a.border) != is_double(b.border) ? is_double(b.border)
                                                                  : a.contrast > b.contrast;
            });
        std::vector<DoorOutline> chosen;
        for (const DoorOutline& candidate : candidates) {
            const bool is_free =
                std::none_of(chosen.begin(), chosen.end(), [&](const DoorOutline& outline) {
                    return candidate.border.start < outline.border.end &&
                           outline.border.start < candidate.border.end;
                });
            if (is_free) chosen.push_back(candidate);
        }
        return chosen;
    }

    std::vector<FacePlace> near_;  ///< by place along the wall
    WallRectangle wall_;
    double bin_ = finest_bin;  ///< m
    double least_ = least_step;
    std::vector<Edge> edges_;  ///< along the wall
};

}  // namespace

std::vector<DoorOutline> find_door_outlines(std::span<const FacePlace> near,
                                            const WallRectangle& wall) {
    return OutlineSearch(near, wall).run();
}

}  // namespace roomscribe
