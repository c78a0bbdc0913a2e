// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/storey_extent.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "roomscribe/interpretation/outline.hpp"

namespace roomscribe {
namespace {

/// Against `max_gap`, this fineness is enough.
constexpr double cell_size = 0.25;
/// Smaller pieces are not worth a name.
constexpr double min_piece_area = 0.5;

bool has_near(std::span<const Eigen::Vector2d> points, const Eigen::Vector2d& place,
              double distance) {
    return std::any_of(points.begin(), points.end(), [&](const Eigen::Vector2d& point) {
        return (point - place).squaredNorm() <= distance * distance;
    });
}

}  // namespace

StoreyExtent::Points StoreyExtent::footprint(std::span<const Level> levels) const {
    Points points;
    for (const Level& level : levels) {
        for (const std::uint32_t patch : level.patches) {
            for (const std::uint32_t point : patches_[patch].points) {
                const Eigen::Vector3d position = sample_.cloud.positions[point].cast<double>();
                points.emplace_back(position.dot(x_), position.dot(y_));
            }
        }
    }
    return thin_points(points, cell_size);
}

std::vector<Level> StoreyExtent::split(const Level& level) const {
    Points points;
    std::vector<std::size_t> first;
    for (const std::uint32_t patch : level.patches) {
        first.push_back(points.size());
        for (const std::uint32_t point : patches_[patch].points) {
            const Eigen::Vector3d position = sample_.cloud.positions[point].cast<double>();
            points.emplace_back(position.dot(x_), position.dot(y_));
        }
    }
    const std::vector<std::uint32_t> groups = link_points(points, max_gap_);
    const std::uint32_t count = *std::max_element(groups.begin(), groups.end()) + 1;
    if (count == 1) return {level};

    const Eigen::Vector3d up = x_.cross(y_);
    std::vector<Level> pieces(count);
    for (std::size_t i = 0; i < level.patches.size(); ++i) {
        const PlanarPatch& patch = patches_[level.patches[i]];
        Level& piece = pieces[groups[first[i]]];
        const double area = piece.area + patch.area;
        piece.height = (piece.height * piece.area + patch.centroid.dot(up) * patch.area) / area;
        piece.area = area;
        piece.patches.push_back(level.patches[i]);
    }
    std::erase_if(pieces, [](const Level& piece) { return piece.patches.empty(); });
    for (Level& piece : pieces)
        piece.facing_up = level.facing_up * piece.area / level.area;
    return pieces;
}

void StoreyExtent::keep_near(std::vector<Level>& levels, const Points& others) const {
    if (others.empty()) return;
    std::erase_if(levels, [&](const Level& level) {
        const Points places = footprint({&level, 1});
        return std::none_of(places.begin(), places.end(), [&](const Eigen::Vector2d& place) {
            return has_near(others, place, max_gap_);
        });
    });
}

Storey StoreyExtent::without_outside(const Storey& storey) const {
    std::vector<Level> floors;
    std::vector<Level> ceilings;
    const auto add = [&](std::vector<Level>& levels, const Level& level) {
        std::vector<Level> pieces = split(level);
        if (pieces.size() > 1) {
            std::erase_if(pieces, [](const Level& piece) { return piece.area < min_piece_area; });
        }
        levels.insert(levels.end(), pieces.begin(), pieces.end());
    };
    if (storey.floor) add(floors, *storey.floor);
    for (const Level& level : storey.other_floors)
        add(floors, level);
    for (const Level& level : storey.ceilings)
        add(ceilings, level);
    std::vector<Level> kept = floors;
    keep_near(kept, footprint(ceilings));
    keep_near(ceilings, footprint(floors));
    // A floor and a ceiling that are nowhere near each other say nothing about either.
    if (kept.empty() != floors.empty()) return storey;

    Storey result;
    for (const std::uint32_t patch : storey.sloping_ceilings) {
        std::vector<Level> sloping{Level{0.0, 0.0, 0.0, {patch}}};
        keep_near(sloping, footprint(floors));
        if (!sloping.empty() && is_topmost(patches_[patch])) {
            result.sloping_ceilings.push_back(patch);
        }
    }
    const auto larger = [](const Level& a, const Level& b) { return a.area < b.area; };
    const auto largest = std::max_element(kept.begin(), kept.end(), larger);
    if (largest != kept.end()) {
        result.floor = *largest;
        kept.erase(largest);
    }
    result.other_floors = std::move(kept);
    result.ceilings = std::move(ceilings);
    std::stable_sort(result.ceilings.begin(), result.ceilings.end(),
                     [](const Level& a, const Level& b) { return a.height < b.height; });
    return result;
}

StoreyExtent::Points StoreyExtent::footprint(const Storey& storey) const {
    std::vector<Level> levels = storey.other_floors;
    if (storey.floor) levels.push_back(*storey.floor);
    levels.insert(levels.end(), storey.ceilings.begin(), storey.ceilings.end());
    return footprint(levels);
}

bool StoreyExtent::is_beside(const UprightSurface& surface, const Points& footprint) const {
    if (footprint.empty()) return true;
    const Eigen::Vector3d origin = surface.plane.offset * surface.plane.normal;
    int total = 0;
    int near = 0;
    for (double along = surface.start; along <= surface.end; along += cell_size) {
        const Eigen::Vector3d place = origin + along * surface.along;
        ++total;
        near += has_near(footprint, {place.dot(x_), place.dot(y_)}, max_gap_) ? 1 : 0;
    }
    return 2 * near >= total;
}

bool StoreyExtent::is_topmost(const PlanarPatch& patch) const {
    constexpr double clearance = 0.15;
    constexpr double max_share_above = 0.1;
    Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
    Eigen::Array2d high = -low;
    for (const std::uint32_t point : patch.points) {
        const Eigen::Vector3d position = sample_.cloud.positions[point].cast<double>();
        const Eigen::Array2d place(position.dot(x_), position.dot(y_));
        low = low.min(place);
        high = high.max(place);
    }
    const double sign = patch.plane.normal.dot(x_.cross(y_)) > 0.0 ? 1.0 : -1.0;
    std::size_t above = 0;
    for (const Eigen::Vector3f& point : sample_.cloud.positions) {
        const Eigen::Vector3d position = point.cast<double>();
        if (sign * patch.plane.signed_distance(position) < clearance) continue;
        const Eigen::Array2d place(position.dot(x_), position.dot(y_));
        if ((place >= low).all() && (place <= high).all()) ++above;
    }
    return static_cast<double>(above) <= max_share_above * static_cast<double>(patch.points.size());
}

}  // namespace roomscribe
