// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/inferred_views.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>

#include <Eigen/Geometry>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/core/quantile.hpp"

namespace roomscribe {
namespace {

using Eigen::Array3i;
using Eigen::Vector3f;

constexpr std::size_t min_points = 1000;
/// Points that are looked at.
constexpr std::size_t max_points = 2'000'000;
/// m, edge of the cells that tell free from occupied; of most points' spacing, so that no surface
/// has holes. In larger ones the two faces of a wall (10 to 15 cm within a house) are one.
constexpr double min_cell_size = 0.05;
constexpr double max_cell_size = 0.15;
constexpr double cells_per_spacing = 2.5;
constexpr double max_cells = 4e8;
/// Of the points to either side of each axis, and m beyond: no room.
constexpr double stray_share = 0.005;
constexpr double stray_margin = 1.0;
/// m around a place that must be free: scanners stand and are carried no closer to things.
constexpr double clearance = 0.3;
/// m between places, widened until there are few enough.
constexpr double min_lattice = 0.5;
constexpr std::size_t max_places = 400;
constexpr std::size_t first_look = 100;  ///< of the directions, to tell what is outside
/// m. Rooms are not so long; halls are seen from several places.
constexpr float max_range = 20.0F;
constexpr std::size_t num_directions = 5000;
/// Of the directions below 45 degrees downwards, those that end at a surface: at a floor, or at
/// what stands on it. Between rooms and outside there is none.
constexpr double steep = 0.7;  ///< sine of the angle to the horizon
constexpr double min_below = 0.8;
/// Of the directions within 20 degrees of the horizon. All of a closed room's end at a surface, two
/// thirds of a corridor's of which a piece was cut out, and half before a house.
constexpr double level = 0.35;
constexpr double min_around = 0.6;
/// m, edge of the cells that views are chosen by.
constexpr double coarse_cell = 0.25;
/// Of all coarse cells, what a further view must add.
constexpr double min_gain = 0.003;
constexpr std::size_t max_views = 48;
/// Of a cell, by how much a point may lie behind what its neighbours in direction show: less than
/// half a leaf's thickness.
constexpr float max_behind = 0.4F;
/// Pixels along a face of the cube that a view's distances are drawn on: 0.5 degrees.
constexpr int face_pixels = 180;

/// The number of a cell of such an edge.
std::uint64_t cell_number(const Vector3f& point, double edge) {
    constexpr int bits = 21;
    constexpr int offset = 1 << (bits - 1);
    std::uint64_t key = 0;
    for (const float value : point) {
        const auto cell = static_cast<int>(std::floor(value / static_cast<float>(edge)));
        key = key << bits | (static_cast<std::uint64_t>(cell + offset) & ((1U << bits) - 1));
    }
    return key;
}

/// m, from which three quarters of the points have their neighbours at most: by how many share a
/// cell. What is far away, beyond windows, may be as sparse as it likes.
double spacing_of_most(const std::vector<Vector3f>& points) {
    constexpr double edge = 0.1;  // m
    std::vector<std::uint64_t> cells(points.size());
    std::transform(points.begin(), points.end(), cells.begin(),
                   [](const Vector3f& point) { return cell_number(point, edge); });
    std::sort(cells.begin(), cells.end());
    std::vector<double> counts;
    for (std::size_t begin = 0; begin < cells.size();) {
        const auto end = static_cast<std::size_t>(
            std::upper_bound(cells.begin() + static_cast<std::ptrdiff_t>(begin), cells.end(),
                             cells[begin]) -
            cells.begin());
        counts.insert(counts.end(), end - begin, static_cast<double>(end - begin));
        begin = end;
    }
    return edge / std::sqrt(quantile(counts, 0.25));
}

/// Without what lies far out: seen through windows, or nowhere.
Eigen::AlignedBox3f usual_box(const std::vector<Vector3f>& points) {
    Vector3f low;
    Vector3f high;
    std::vector<float> values(points.size());
    for (int axis = 0; axis < 3; ++axis) {
        std::transform(points.begin(), points.end(), values.begin(),
                       [axis](const Vector3f& point) { return point[axis]; });
        low[axis] = quantile(values, stray_share) - static_cast<float>(stray_margin);
        high[axis] = quantile(values, 1.0 - stray_share) + static_cast<float>(stray_margin);
    }
    return {low, high};
}

/// Which cells hold points.
class Occupancy {
  public:
    Occupancy(const std::vector<Vector3f>& points, double cell_size) {
        const Eigen::AlignedBox3f box = usual_box(points);
        const double volume = box.sizes().cast<double>().array().max(1.0).prod();
        cell_size = std::max(cell_size, std::cbrt(volume / max_cells));
        cell_ = static_cast<float>(cell_size);
        low_ = box.min().array() - cell_;
        size_ = ((box.max() - low_) / cell_).array().ceil().cast<int>() + 2;
        bits_.assign(static_cast<std::size_t>(size_.cast<std::int64_t>().prod()), false);
        for (const Vector3f& point : points) {
            if (!box.contains(point)) continue;
            const std::size_t cell = index(cell_of(point));
            if (!bits_[cell]) points_.push_back(point);
            bits_[cell] = true;
        }
    }

    float cell() const { return cell_; }
    /// One point of each occupied cell.
    const std::vector<Vector3f>& points() const { return points_; }
    const Vector3f& low() const { return low_; }
    Vector3f high() const { return low_ + (size_.cast<float>() * cell_).matrix(); }

    /// m to the occupied cell that a ray meets first; infinite if none within max_range.
    float distance_along(const Vector3f& start, const Vector3f& direction) const {
        constexpr float none = std::numeric_limits<float>::infinity();
        Array3i cell = cell_of(start);
        if (bits_[index(cell)]) return 0.0F;
        Eigen::Array3f next;
        Eigen::Array3f stride;
        Array3i step;
        for (int axis = 0; axis < 3; ++axis) {
            const float way = direction[axis];
            step[axis] = way > 0.0F ? 1 : -1;
            stride[axis] = way == 0.0F ? none : cell_ / std::abs(way);
            const auto wall = static_cast<float>(cell[axis] + (way > 0.0F ? 1 : 0));
            next[axis] = way == 0.0F ? none : (low_[axis] + wall * cell_ - start[axis]) / way;
        }
        for (;;) {
            int axis = 0;
            const float distance = next.minCoeff(&axis);
            if (distance > max_range) return none;
            cell[axis] += step[axis];
            if (cell[axis] < 0 || cell[axis] >= size_[axis]) return none;
            if (bits_[index(cell)]) return distance;
            next[axis] += stride[axis];
        }
    }

  private:
    Array3i cell_of(const Vector3f& point) const {
        return ((point - low_) / cell_).array().floor().cast<int>();
    }
    std::size_t index(const Array3i& cell) const {
        return (static_cast<std::size_t>(cell.z()) * static_cast<std::size_t>(size_.y()) +
                static_cast<std::size_t>(cell.y())) *
                   static_cast<std::size_t>(size_.x()) +
               static_cast<std::size_t>(cell.x());
    }

    float cell_ = 0.0F;
    Vector3f low_ = Vector3f::Zero();
    Array3i size_ = Array3i::Zero();
    std::vector<bool> bits_;
    std::vector<Vector3f> points_;
};

/// All directions, evenly (Fibonacci's lattice).
std::vector<Vector3f> sphere() {
    std::vector<Vector3f> directions;
    const double turn = std::numbers::pi * (3.0 - std::sqrt(5.0));
    for (std::size_t i = 0; i < num_directions; ++i) {
        const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / num_directions;
        const double radius = std::sqrt(1.0 - z * z);
        const double angle = turn * static_cast<double>(i);
        directions.emplace_back(
            Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), z).cast<float>());
    }
    return directions;
}

/// A place and the coarse cells that it sees.
struct Place {
    Vector3f position;
    std::vector<std::uint64_t> cells;
};

/// Whether there is floor below a place and something around it.
class WithinRoom {
  public:
    explicit WithinRoom(const Vector3f& up) : up_(up) {}

    void count(const Vector3f& direction, bool is_closed) {
        const float rise = direction.dot(up_);
        Share& share = rise < -static_cast<float>(steep)            ? below_
                       : std::abs(rise) < static_cast<float>(level) ? around_
                                                                    : elsewhere_;
        ++share.looks;
        share.closed += is_closed ? 1 : 0;
    }
    bool is_over_floor() const { return below_.closed >= min_below * below_.looks; }
    bool verdict() const { return is_over_floor() && around_.closed >= min_around * around_.looks; }

  private:
    struct Share {
        int looks = 0;
        int closed = 0;
    };
    Vector3f up_;
    Share below_;
    Share around_;
    Share elsewhere_;
};

/// By a first look, which begins downwards: whether a place is free and within a room.
bool may_stand_at(const Occupancy& occupancy, const Vector3f& place, const Vector3f& up,
                  std::span<const Vector3f> directions) {
    WithinRoom within(up);
    bool is_below = true;
    for (const Vector3f& direction : directions) {
        if (is_below && direction.dot(up) >= -static_cast<float>(steep)) {
            if (!within.is_over_floor()) return false;
            is_below = false;
        }
        const float distance = occupancy.distance_along(place, direction);
        if (distance < static_cast<float>(clearance)) return false;
        within.count(direction, std::isfinite(distance));
    }
    return within.verdict();
}

/// A few of the directions, those that lead most steeply down first.
std::vector<Vector3f> directions_to_begin_with(const std::vector<Vector3f>& directions,
                                               const Vector3f& up) {
    std::vector<Vector3f> first;
    for (std::size_t i = 0; i < directions.size(); i += directions.size() / first_look)
        first.push_back(directions[i]);
    std::stable_sort(first.begin(), first.end(),
                     [&](const Vector3f& a, const Vector3f& b) { return a.dot(up) < b.dot(up); });
    return first;
}

/// A lattice's places that are free and within a room, of the closest lattice with few enough.
std::vector<Vector3f> places_within(const Occupancy& occupancy, const Vector3f& up,
                                    const std::vector<Vector3f>& directions) {
    const std::vector<Vector3f> first = directions_to_begin_with(directions, up);
    std::vector<Vector3f> places;
    for (double lattice = min_lattice;; lattice *= 1.25) {
        places.clear();
        const auto step = static_cast<float>(lattice);
        const Vector3f low = occupancy.low().array() + step / 2.0F;
        const Vector3f high = occupancy.high();
        for (float z = low.z(); z < high.z(); z += step) {
            for (float y = low.y(); y < high.y(); y += step) {
                for (float x = low.x(); x < high.x() && places.size() <= max_places; x += step) {
                    const Vector3f place(x, y, z);
                    if (may_stand_at(occupancy, place, up, first)) places.push_back(place);
                }
            }
        }
        if (places.size() <= max_places) return places;
    }
}

/// What a place sees, if it is within a room.
std::optional<Place> look_around(const Occupancy& occupancy, const Vector3f& position,
                                 const Vector3f& up, const std::vector<Vector3f>& directions) {
    Place place{position, {}};
    WithinRoom within(up);
    for (const Vector3f& direction : directions) {
        const float distance = occupancy.distance_along(position, direction);
        within.count(direction, std::isfinite(distance));
        if (std::isfinite(distance))
            place.cells.push_back(cell_number(position + distance * direction, coarse_cell));
    }
    if (!within.verdict()) return std::nullopt;
    std::sort(place.cells.begin(), place.cells.end());
    place.cells.erase(std::unique(place.cells.begin(), place.cells.end()), place.cells.end());
    return place;
}

/// Always the place that sees most of what none of those before it does.
std::vector<Vector3f> choose_places(std::vector<Place> places) {
    std::vector<std::uint64_t> all;
    for (const Place& place : places)
        all.insert(all.end(), place.cells.begin(), place.cells.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    std::vector<bool> is_seen(all.size(), false);
    for (Place& place : places) {
        for (std::uint64_t& cell : place.cells) {
            cell = static_cast<std::uint64_t>(std::lower_bound(all.begin(), all.end(), cell) -
                                              all.begin());
        }
    }
    std::vector<Vector3f> chosen;
    while (chosen.size() < max_views) {
        const Place* best = nullptr;
        std::size_t most = 0;
        for (Place& place : places) {
            std::erase_if(place.cells, [&](std::uint64_t cell) { return is_seen[cell]; });
            if (place.cells.size() <= most) continue;
            most = place.cells.size();
            best = &place;
        }
        if (static_cast<double>(most) <= min_gain * static_cast<double>(all.size())) break;
        for (const std::uint64_t cell : best->cells)
            is_seen[cell] = true;
        chosen.push_back(best->position);
    }
    return chosen;
}

/// Distances from a place to what is nearest in each direction, on the faces of a cube. What is
/// occupied hides as much as a cell to each side, so that surfaces have no holes.
class DistanceCube {
  public:
    DistanceCube(const Occupancy& occupancy, const Vector3f& place) : cell_(occupancy.cell()) {
        distances_.assign(std::size_t{6} * face_pixels * face_pixels,
                          std::numeric_limits<float>::infinity());
        for (const Vector3f& point : occupancy.points()) {
            const Vector3f way = point - place;
            const float distance = way.norm();
            if (distance > max_range) continue;
            const Pixel middle = pixel_of(way);
            for_each_around(middle, reach_at(middle.depth), [&](std::size_t pixel) {
                distances_[pixel] = std::min(distances_[pixel], distance);
            });
        }
        shrink_back();
    }

    /// m, to the surface that is seen in a direction; infinite if there is none.
    float distance_in(const Vector3f& way) const {
        const Pixel pixel = pixel_of(way);
        return distances_[index(pixel.face, pixel.u, pixel.v)];
    }

  private:
    struct Pixel {
        int face = 0;
        int u = 0;
        int v = 0;
        float depth = 0.0F;  ///< m, towards the face
    };

    static Pixel pixel_of(const Vector3f& way) {
        int axis = 0;
        const float depth = way.cwiseAbs().maxCoeff(&axis);
        const auto number = [&](float offset) {
            const auto pixel = static_cast<int>((offset / depth + 1.0F) * 0.5F * face_pixels);
            return std::clamp(pixel, 0, face_pixels - 1);
        };
        return {2 * axis + (way[axis] > 0.0F ? 0 : 1), number(way[(axis + 1) % 3]),
                number(way[(axis + 2) % 3]), depth};
    }
    /// Pixels that a cell reaches at a depth.
    int reach_at(float depth) const {
        const float radius = 0.5F * face_pixels * cell_ / depth;
        return static_cast<int>(std::min(radius + 0.5F, 0.5F * face_pixels));
    }
    template <typename Visit>
    static void for_each_around(const Pixel& middle, int reach, Visit&& visit) {
        const int last = face_pixels - 1;
        for (int v = std::max(middle.v - reach, 0); v <= std::min(middle.v + reach, last); ++v) {
            for (int u = std::max(middle.u - reach, 0); u <= std::min(middle.u + reach, last); ++u)
                visit(index(middle.face, u, v));
        }
    }
    /// Gives back to what is behind as much as was drawn beyond the rims of things, and to surfaces
    /// that are seen obliquely their distance.
    void shrink_back() {
        const std::vector<float> grown = distances_;
        for (int face = 0; face < 6; ++face) {
            for (int v = 0; v < face_pixels; ++v) {
                for (int u = 0; u < face_pixels; ++u) {
                    float& distance = distances_[index(face, u, v)];
                    if (!std::isfinite(distance)) continue;
                    const Eigen::Vector2f slope(coordinate(u), coordinate(v));
                    const float depth = distance / std::sqrt(1.0F + slope.squaredNorm());
                    for_each_around(
                        {face, u, v, depth}, std::max(reach_at(depth), 1),
                        [&](std::size_t pixel) { distance = std::max(distance, grown[pixel]); });
                }
            }
        }
    }
    static float coordinate(int pixel) {
        return (static_cast<float>(pixel) + 0.5F) * 2.0F / face_pixels - 1.0F;
    }
    static std::size_t index(int face, int u, int v) {
        return (static_cast<std::size_t>(face) * face_pixels + static_cast<std::size_t>(v)) *
                   face_pixels +
               static_cast<std::size_t>(u);
    }

    float cell_;
    std::vector<float> distances_;
};

InferredView view_from(const Vector3f& place, const Occupancy& occupancy,
                       const std::vector<Vector3f>& points,
                       const std::vector<std::uint32_t>& numbers) {
    const DistanceCube cube(occupancy, place);
    InferredView view{place.cast<double>(), {}};
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vector3f way = points[i] - place;
        const float distance = way.norm();
        if (distance > max_range) continue;
        if (distance <= cube.distance_in(way) + max_behind * occupancy.cell())
            view.points.push_back(numbers[i]);
    }
    return view;
}

}  // namespace

std::vector<InferredView> infer_views(const ScanMap& map, const Eigen::Vector3d& up,
                                      const Context& context) {
    std::vector<Vector3f> points;
    std::vector<std::uint32_t> numbers;
    const std::size_t stride = map.cloud.size() / max_points + 1;
    for (const MapSection& section : map.sections) {
        if (section.sensor_position) continue;
        for (std::size_t i = section.first; i < section.first + section.count; i += stride) {
            if (!is_finite(map.cloud.positions[i])) continue;
            points.push_back(map.cloud.positions[i]);
            numbers.push_back(static_cast<std::uint32_t>(i));
        }
    }
    if (points.size() < min_points) return {};
    const double cell_size = std::max(cells_per_spacing * spacing_of_most(points), min_cell_size);
    if (cell_size > max_cell_size) return {};
    const Occupancy occupancy(points, cell_size);
    const std::vector<Vector3f> directions = sphere();
    const Vector3f upwards = up.cast<float>();
    const std::vector<Vector3f> free = places_within(occupancy, upwards, directions);
    std::vector<std::optional<Place>> looks(free.size());
    parallel_for(context, free.size(), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            looks[i] = look_around(occupancy, free[i], upwards, directions);
    });
    std::vector<Place> places;
    for (std::optional<Place>& look : looks) {
        if (look) places.push_back(std::move(*look));
    }
    const std::vector<Vector3f> chosen = choose_places(std::move(places));
    std::vector<InferredView> views(chosen.size());
    parallel_for(context, chosen.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            views[i] = view_from(chosen[i], occupancy, points, numbers);
    });
    return views;
}

}  // namespace roomscribe
