// SPDX-License-Identifier: MIT
#include "roomscribe/report/viewer_points.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <unordered_map>

#include <zlib.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/parallel.hpp"
#include "roomscribe/core/quantile.hpp"
#include "roomscribe/geometry/polygon.hpp"
#include "roomscribe/report/viewer_model.hpp"

namespace roomscribe {
namespace {

constexpr unsigned grid_levels = 16;
constexpr std::size_t points_per_chunk = 1U << 16U;

/// Every third bit, from the lowest on.
std::uint64_t spread_bits(std::uint64_t value) {
    value = (value | (value << 32U)) & 0x00FF00000000FFFFU;
    value = (value | (value << 16U)) & 0x00FF0000FF0000FFU;
    value = (value | (value << 8U)) & 0xF00F00F00F00F00FU;
    value = (value | (value << 4U)) & 0x30C30C30C30C30C3U;
    return (value | (value << 2U)) & 0x9249249249249249U;
}

std::uint64_t morton_code(const std::array<std::uint16_t, 3>& place) {
    return spread_bits(place[0]) | (spread_bits(place[1]) << 1U) | (spread_bits(place[2]) << 2U);
}

/// The inverse of spread_bits.
std::uint16_t gather_bits(std::uint64_t value) {
    value &= 0x9249249249249249U;
    value = (value | (value >> 2U)) & 0x30C30C30C30C30C3U;
    value = (value | (value >> 4U)) & 0xF00F00F00F00F00FU;
    value = (value | (value >> 8U)) & 0x00FF0000FF0000FFU;
    value = (value | (value >> 16U)) & 0x00FF00000000FFFFU;
    return static_cast<std::uint16_t>(value | (value >> 32U));
}

std::array<std::uint16_t, 3> place_of(std::uint64_t code) {
    return {gather_bits(code), gather_bits(code >> 1U), gather_bits(code >> 2U)};
}

struct CodedPoint {
    std::uint64_t code = 0;
    std::uint32_t number = 0;
};

constexpr std::uint64_t outside = ~std::uint64_t{0};

constexpr unsigned bucket_shift = 3 * grid_levels - 12;

/// Sorts points that agree in the twelve upper bits of their codes, and keeps the order of equal
/// ones: digit by digit from the lowest, as codes are short numbers and points many.
void sort_bucket(std::span<CodedPoint> points) {
    constexpr std::size_t few = 256;  // for which counting digits does not pay
    if (points.size() < few) {
        std::stable_sort(points.begin(), points.end(),
                         [](const CodedPoint& a, const CodedPoint& b) { return a.code < b.code; });
        return;
    }
    constexpr unsigned digit_bits = 9;
    constexpr std::size_t num_digits = 1U << digit_bits;
    std::vector<CodedPoint> other(points.size());
    std::span<CodedPoint> from = points;
    std::span<CodedPoint> to = other;
    for (unsigned shift = 0; shift < bucket_shift; shift += digit_bits) {
        const auto digit = [shift](const CodedPoint& point) {
            return (point.code >> shift) & (num_digits - 1);
        };
        std::array<std::size_t, num_digits + 1> next{};
        for (const CodedPoint& point : from)
            ++next[digit(point) + 1];
        for (std::size_t i = 1; i <= num_digits; ++i)
            next[i] += next[i - 1];
        for (const CodedPoint& point : from)
            to[next[digit(point)]++] = point;
        std::swap(from, to);
    }
    static_assert(bucket_shift % (2 * digit_bits) == 0, "the sorted points end where they began");
}

/// Sorts by code, then number: shared out by the twelve upper bits of the codes.
std::vector<CodedPoint> sorted_points(const std::vector<std::uint64_t>& codes,
                                      const Context& context) {
    constexpr std::size_t num_buckets = 1U << 12U;
    std::vector<std::size_t> ends(num_buckets + 1, 0);
    for (const std::uint64_t code : codes)
        if (code != outside) ++ends[(code >> bucket_shift) + 1];
    for (std::size_t i = 1; i <= num_buckets; ++i)
        ends[i] += ends[i - 1];
    std::vector<std::size_t> next(ends.begin(), ends.end() - 1);
    std::vector<CodedPoint> points(ends.back());
    for (std::size_t i = 0; i < codes.size(); ++i) {
        if (codes[i] == outside) continue;
        points[next[codes[i] >> bucket_shift]++] = {codes[i], static_cast<std::uint32_t>(i)};
    }
    parallel_for(context, num_buckets, 1, [&](std::size_t begin, std::size_t end) {
        sort_bucket(std::span(points).subspan(ends[begin], ends[end] - ends[begin]));
    });
    return points;
}

std::uint8_t level_between(std::uint64_t a, std::uint64_t b) {
    if (a == b) return grid_levels + 1;
    const auto highest_bit = static_cast<unsigned>(std::bit_width(a ^ b)) - 1;
    return static_cast<std::uint8_t>(grid_levels - highest_bit / 3);
}

/// The last level at which the points fill no more cells than the budget.
std::uint8_t level_for(const GriddedPoints& points, std::size_t budget) {
    std::array<std::size_t, grid_levels + 2> num_new{};
    for (const std::uint8_t level : points.levels)
        ++num_new[level];
    std::size_t num_cells = 0;
    std::uint8_t level = 0;
    while (level <= grid_levels && num_cells + num_new[level] <= budget)
        num_cells += num_new[level++];
    return level == 0 ? level : static_cast<std::uint8_t>(level - 1);
}

/// Planes of bytes, one after another.
class PlaneWriter {
  public:
    /// `max_planes` that will be added.
    PlaneWriter(std::size_t num_points, std::size_t max_planes) : num_points_(num_points) {
        bytes_.reserve(num_points * max_planes);
    }

    template <typename ByteOf>
    void add(const ByteOf& byte_of) {
        for (std::size_t i = 0; i < num_points_; ++i)
            bytes_ += static_cast<char>(static_cast<std::uint8_t>(byte_of(i)));
    }
    const std::string& bytes() const { return bytes_; }

  private:
    std::size_t num_points_;
    std::string bytes_;
};

std::string compressed(const std::string& bytes) {
    uLongf size = compressBound(static_cast<uLong>(bytes.size()));
    std::string packed(size, '\0');
    // Level 4 is as small as the default to a few percent, in half the time.
    constexpr int level = 4;
    const int done = compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                               reinterpret_cast<const Bytef*>(bytes.data()),
                               static_cast<uLong>(bytes.size()), level);
    if (done != Z_OK) throw InvalidArgument("points", "not compressed", "points that fit memory");
    packed.resize(size);
    return packed;
}

/// Grey levels of intensities, of whatever unit: from their 2nd to their 98th percent.
struct IntensityScale {
    float low = 0.0F;
    float high = 1.0F;

    explicit IntensityScale(const std::vector<float>& intensities) {
        constexpr std::size_t max_sample = 100'000;
        std::vector<float> sample;
        const std::size_t stride = intensities.size() / max_sample + 1;
        for (std::size_t i = 0; i < intensities.size(); i += stride)
            if (std::isfinite(intensities[i])) sample.push_back(intensities[i]);
        if (sample.empty()) return;
        low = static_cast<float>(quantile(sample, 0.02));
        high = std::max(static_cast<float>(quantile(sample, 0.98)), low + 1e-6F);
    }
    std::uint8_t byte_of(float intensity) const {
        const float share = (intensity - low) / (high - low);
        return std::isfinite(share) ? share_to_byte(share) : 0;
    }
    static std::uint8_t share_to_byte(float share) {
        return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(share, 0.0F, 1.0F)));
    }
};

/// Number in Component::instance -> number in the viewer's list, counted from 1.
std::unordered_map<std::int32_t, std::uint16_t> listed_numbers(const Scene& scene) {
    std::unordered_map<std::int32_t, std::uint16_t> numbers;
    const std::vector<std::size_t> listed = listed_components(scene);
    for (std::size_t i = 0; i < listed.size(); ++i) {
        numbers.emplace(scene.components[listed[i]].instance, static_cast<std::uint16_t>(i + 1));
    }
    numbers.erase(-1);
    return numbers;
}

std::size_t section_of(const std::vector<MapSection>& sections, std::size_t number) {
    const auto next = std::upper_bound(
        sections.begin(), sections.end(), number,
        [](std::size_t i, const MapSection& section) { return i < section.first; });
    return next == sections.begin() ? 0 : static_cast<std::size_t>(next - sections.begin()) - 1;
}

bool has_one_per_point(std::size_t size, const PointCloud& cloud) {
    return size == cloud.size() && size > 0;
}

}  // namespace

GriddedPoints grid_points(const Reconstruction& reconstruction, const Eigen::AlignedBox3d& box,
                          const Context& context) {
    GriddedPoints points;
    points.low = box.min();
    points.size_of_box = box.sizes();
    points.step = std::max(box.sizes().maxCoeff(), 1e-3) / 65535.0;
    const std::vector<Eigen::Vector3f>& positions = reconstruction.map.cloud.positions;
    std::vector<std::uint64_t> codes(positions.size(), outside);
    const Transform& room_from_map = reconstruction.scene.room_from_map;
    parallel_for(
        context, positions.size(), points_per_chunk, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                if (!is_finite(positions[i])) continue;
                const Eigen::Vector3d in_room = room_from_map * positions[i].cast<double>();
                if (!box.contains(in_room)) continue;
                const Eigen::Vector3d steps = (in_room - points.low) / points.step;
                std::array<std::uint16_t, 3> place{};
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    // None is below 0: this rounds to the nearest.
                    const double in_grid = steps(static_cast<Eigen::Index>(axis)) + 0.5;
                    place[axis] = static_cast<std::uint16_t>(std::min(in_grid, 65535.0));
                }
                codes[i] = morton_code(place);
            }
        });
    const std::vector<CodedPoint> sorted = sorted_points(codes, context);
    points.places.reserve(sorted.size());
    points.numbers.reserve(sorted.size());
    points.levels.reserve(sorted.size());
    std::uint64_t before = outside;
    for (const CodedPoint& point : sorted) {
        if (point.code == before) continue;
        points.places.push_back(place_of(point.code));
        points.numbers.push_back(point.number);
        points.levels.push_back(before == outside ? 0 : level_between(before, point.code));
        before = point.code;
    }
    return points;
}

std::vector<std::uint32_t> thin_points(const GriddedPoints& points, std::size_t budget) {
    std::vector<std::uint32_t> chosen;
    const std::uint8_t level = level_for(points, budget);
    std::size_t num_sure = 0;
    std::size_t num_further = 0;
    for (const std::uint8_t own : points.levels) {
        num_sure += own <= level ? 1 : 0;
        num_further += own == level + 1 ? 1 : 0;
    }
    std::size_t num_free = budget - std::min(budget, num_sure);
    num_free = std::min(num_free, num_further);
    std::size_t carry = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::uint8_t own = points.levels[i];
        bool is_chosen = own <= level;
        if (own == level + 1) {
            carry += num_free;
            is_chosen = carry >= num_further;
            if (is_chosen) carry -= num_further;
        }
        if (is_chosen && chosen.size() < budget) chosen.push_back(static_cast<std::uint32_t>(i));
    }
    return chosen;
}

std::vector<std::uint8_t> rooms_of_points(const Reconstruction& reconstruction,
                                          const GriddedPoints& points,
                                          std::span<const std::uint32_t> chosen) {
    const Scene& scene = reconstruction.scene;
    const std::size_t num_rooms = std::min<std::size_t>(scene.rooms.size(), 255);
    std::vector<std::vector<Eigen::Vector2d>> plans(num_rooms);
    for (std::size_t room = 0; room < num_rooms; ++room) {
        for (const Eigen::Vector3d& corner : scene.rooms[room].polygon)
            plans[room].emplace_back((scene.room_from_map * corner).head<2>());
    }
    std::unordered_map<std::int32_t, std::uint8_t> room_of_instance;
    for (const Component& component : scene.components) {
        const std::optional<std::size_t> room = room_by_parents(scene, component);
        if (room && *room < num_rooms && component.instance >= 0)
            room_of_instance.emplace(component.instance, static_cast<std::uint8_t>(*room + 1));
    }
    const std::vector<std::int32_t>& instances = reconstruction.labels.instances;
    std::vector<std::uint8_t> rooms(chosen.size(), 0);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        const std::uint32_t number = points.numbers[chosen[i]];
        if (number < instances.size()) {
            const auto found = room_of_instance.find(instances[number]);
            if (found != room_of_instance.end()) {
                rooms[i] = found->second;
                continue;
            }
        }
        const auto& place = points.places[chosen[i]];
        const Eigen::Vector3d p =
            points.low + points.step * Eigen::Vector3d(place[0], place[1], place[2]);
        for (std::size_t room = 0; room < num_rooms; ++room) {
            // Half a slab above and below, where the floor and the ceiling are a room's own.
            constexpr double slab = 0.15;
            if (p.z() < scene.rooms[room].floor_height - slab ||
                p.z() > scene.rooms[room].ceiling_height + slab)
                continue;
            if (!is_inside(plans[room], Eigen::Vector2d(p.head<2>()))) continue;
            rooms[i] = static_cast<std::uint8_t>(room + 1);
            break;
        }
    }
    return rooms;
}

std::string pack_points(const Reconstruction& reconstruction, const GriddedPoints& points,
                        std::span<const std::uint32_t> chosen) {
    const PointCloud& cloud = reconstruction.map.cloud;
    const PointLabels& labels = reconstruction.labels;
    const auto number = [&](std::size_t i) { return points.numbers[chosen[i]]; };
    constexpr std::size_t max_planes = 16;
    PlaneWriter planes(chosen.size(), max_planes);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto step_of = [&](std::size_t i) {
            const int before = i == 0 ? 0 : points.places[chosen[i - 1]][axis];
            return static_cast<unsigned>(points.places[chosen[i]][axis] - before);
        };
        planes.add([&](std::size_t i) { return step_of(i) & 0xFFU; });
        planes.add([&](std::size_t i) { return (step_of(i) >> 8U) & 0xFFU; });
    }
    const bool has_labels = has_one_per_point(labels.labels.size(), cloud);
    planes.add([&](std::size_t i) {
        return has_labels ? static_cast<std::uint8_t>(labels.labels[number(i)]) : 0U;
    });
    const std::vector<std::uint8_t> rooms = rooms_of_points(reconstruction, points, chosen);
    planes.add([&](std::size_t i) { return rooms[i]; });
    const auto numbers = listed_numbers(reconstruction.scene);
    std::vector<std::uint16_t> components(chosen.size(), 0);
    for (std::size_t i = 0; has_labels && i < chosen.size(); ++i) {
        const auto found = numbers.find(labels.instances[number(i)]);
        if (found != numbers.end()) components[i] = found->second;
    }
    planes.add([&](std::size_t i) { return components[i] & 0xFFU; });
    planes.add([&](std::size_t i) { return components[i] >> 8U; });
    planes.add([&](std::size_t i) {
        return std::min<std::size_t>(section_of(reconstruction.map.sections, number(i)), 255);
    });
    const bool has_confidences = has_one_per_point(labels.confidences.size(), cloud);
    planes.add([&](std::size_t i) {
        return has_confidences ? IntensityScale::share_to_byte(labels.confidences[number(i)]) : 0U;
    });
    if (has_one_per_point(cloud.intensities.size(), cloud)) {
        const IntensityScale scale(cloud.intensities);
        planes.add([&](std::size_t i) { return scale.byte_of(cloud.intensities[number(i)]); });
    }
    if (has_one_per_point(cloud.colors.size(), cloud)) {
        for (std::size_t c = 0; c < 3; ++c)
            planes.add([&](std::size_t i) { return cloud.colors[number(i)][c]; });
    }
    return compressed(planes.bytes());
}

}  // namespace roomscribe
