// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/furnishing/furnisher.hpp"

#include <algorithm>
#include <cmath>

#include "roomscribe/core/units.hpp"
#include "roomscribe/simulation/furnishing/item_kinds.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector2d;

constexpr int num_wall_tries = 14;
constexpr int num_free_tries = 20;

double heading(const Vector2d& direction) {
    return degrees(std::atan2(direction.y(), direction.x()));
}

double rounded(double value, double step) {
    return std::round(value / step) * step;
}

}  // namespace

std::string_view Furnisher::one_of(std::initializer_list<std::string_view> kinds) {
    return kinds.begin()[random_.below(static_cast<std::uint32_t>(kinds.size()))];
}

ItemPlan Furnisher::make(std::string_view kind, const Eigen::Vector3d& size) {
    return make_of_style(kind, random_.below(1'000'000), size);
}

ItemPlan Furnisher::make_of_style(std::string_view kind, std::uint64_t style,
                                  const Eigen::Vector3d& size) {
    ItemPlan item;
    item.kind = kind;
    item.size = size;
    item.style = style;
    item = resolve_item(item);
    item.elevation += floor_.room().floor_height;
    return item;
}

std::optional<ItemPlan> Furnisher::place(const ItemPlan& item, const Demands& demands) {
    ItemPlan plan = item;
    // What a person would write down: millimetres and hundredths of a degree.
    plan.at = {rounded(item.at.x(), 0.001), rounded(item.at.y(), 0.001)};
    plan.turn = rounded(item.turn, 0.01);
    plan.elevation = rounded(item.elevation, 0.0001);
    if (!floor_.place(plan, demands)) return std::nullopt;
    return plan;
}

std::size_t Furnisher::pick_wall(double min_length) {
    double total = 0.0;
    for (const BuiltWallFace& wall : floor_.walls())
        total += std::max(0.0, wall.length() - min_length);
    double at = random_.uniform(0.0, std::max(total, 1e-9));
    for (std::size_t i = 0; i < floor_.walls().size(); ++i) {
        at -= std::max(0.0, floor_.walls()[i].length() - min_length);
        if (at < 0.0) return i;
    }
    return 0;
}

std::optional<ItemPlan> Furnisher::place_at_wall(ItemPlan item, std::size_t wall, double along,
                                                 double gap, const Demands& demands) {
    const BuiltWallFace& face = floor_.walls()[wall];
    item.at = face.start + along * face.along() + (gap + item.size.x() / 2.0) * face.inward();
    item.turn = heading(face.inward());
    return place(item, demands);
}

std::optional<ItemPlan> Furnisher::place_along_wall(const ItemPlan& item, const Demands& demands,
                                                    double gap) {
    const double half = item.size.y() / 2.0;
    for (int attempt = 0; attempt < num_wall_tries; ++attempt) {
        const std::size_t wall = pick_wall(item.size.y());
        const double length = floor_.walls()[wall].length();
        const double corner = pick(0.005, 0.05);
        const double low = half + corner;
        const double high = length - half - corner;
        if (low > high) continue;
        const double lot = random_.uniform();
        const double along = lot < 0.25 ? low : lot < 0.5 ? high : pick(low, high);
        const double off = gap > 0.0 ? gap : pick(0.016, 0.035);
        if (auto placed = place_at_wall(item, wall, along, off, demands)) return placed;
    }
    return std::nullopt;
}

std::optional<ItemPlan> Furnisher::hang(const ItemPlan& item) {
    return place_along_wall(item, {}, 0.003);
}

std::optional<ItemPlan> Furnisher::place_freely(const ItemPlan& item, const Demands& demands) {
    ItemPlan plan = item;
    for (int attempt = 0; attempt < num_free_tries; ++attempt) {
        const std::size_t wall = pick_wall(0.0);
        const BuiltWallFace& face = floor_.walls()[wall];
        const double along = pick(0.0, face.length());
        const double depth = pick(0.0, 1.0) * floor_.depth_at(wall, along);
        if (!std::isfinite(depth)) continue;
        plan.at = face.start + along * face.along() + depth * face.inward();
        plan.turn = chance(0.4) ? heading(face.inward()) : pick(-180.0, 180.0);
        if (auto placed = place(plan, demands)) return placed;
    }
    return std::nullopt;
}

std::optional<ItemPlan> Furnisher::place_in_the_middle(ItemPlan item, const Demands& demands) {
    for (int attempt = 0; attempt < num_free_tries; ++attempt) {
        const std::size_t wall = pick_wall(0.8);
        const BuiltWallFace& face = floor_.walls()[wall];
        const double along = pick(0.35, 0.65) * face.length();
        const double depth = pick(0.35, 0.65) * floor_.depth_at(wall, along);
        if (!std::isfinite(depth)) continue;
        item.at = face.start + along * face.along() + depth * face.inward();
        item.turn = heading(chance(0.5) ? face.inward() : face.along());
        if (auto placed = place(item, demands)) return placed;
    }
    return std::nullopt;
}

std::optional<ItemPlan> Furnisher::place_by(const ItemPlan& host, ItemPlan item, double x, double y,
                                            double turn, const Demands& demands) {
    const double angle = radians(host.turn);
    const Vector2d front(std::cos(angle), std::sin(angle));
    item.at = host.at + x * front + y * Vector2d(-front.y(), front.x());
    item.turn = std::remainder(host.turn + turn, 360.0);
    return place(item, demands);
}

std::optional<ItemPlan> Furnisher::put_on(const ItemPlan& host, ItemPlan item, double x, double y,
                                          double turn) {
    // Half a millimetre above, so that no two surfaces lie in one plane.
    item.elevation = host.elevation + host.size.z() + 0.0005;
    return place_by(host, std::move(item), x, y, turn, {.avoids_windows = false});
}

void Furnisher::strew_on(const ItemPlan& host, std::initializer_list<std::string_view> kinds,
                         int count) {
    for (int i = 0; i < count; ++i) {
        const ItemPlan item = make(one_of(kinds));
        const double reach = item.size.head<2>().norm() / 2.0;
        const double x = host.size.x() / 2.0 - std::min(reach, item.size.x() / 2.0 + 0.03);
        const double y = host.size.y() / 2.0 - reach;
        if (x < 0.0 || y < 0.0) continue;
        const double turn = reach < x ? pick(-40.0, 40.0) : pick(-4.0, 4.0);
        const double forward = pick(-x, x);
        put_on(host, item, forward, pick(-y, y), turn);
    }
}

}  // namespace roomscribe
