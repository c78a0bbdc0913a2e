// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/furniture/pedestals.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>

#include "roomscribe/core/quantile.hpp"
#include "roomscribe/interpretation/furniture/furnishing_sizes.hpp"
#include "roomscribe/interpretation/furniture/plan_rectangle.hpp"

namespace roomscribe {
namespace {

/// m above the floor: of a desk's or table's top; a worktop has its units below.
constexpr double max_top = 0.85;
/// m: pedestals are 0.40 to 0.43 wide, of which voxels at the corners may be another side's, and
/// 0.52 to 0.65 high, on castors of 5 cm and more; what lies lower than 0.2 may be hidden.
constexpr double min_width = 0.36;
constexpr double max_width = 0.5;
constexpr double usual_width = 0.43;
constexpr double min_front_top = 0.52;
constexpr double max_front_bottom = 0.2;
/// m: of pedestals for desks 0.7 and 0.8 deep; deeper ones stand beside.
constexpr double max_depth = 0.62;
/// m: a pedestal that is a part of the desk ends at most a plate (30 mm) and a grip (40 mm) below
/// the surface of the top.
constexpr double min_gap = 0.08;
/// m: whoever opens the drawers has not to reach far under the top.
constexpr double max_inset = 0.3;
/// m: half a voxel.
constexpr double slack = 0.02;

/// The front of a pedestal, in the plan.
struct PedestalFront {
    PlanRectangle rectangle;  ///< of the front; its length is the pedestal's width
    Eigen::Vector2d outward;
    double top = 0.0;    ///< m above the floor
    double noise = 0.0;  ///< m

    /// Whether a place is behind the front, no farther than a pedestal is deep.
    bool is_behind(const Eigen::Vector2d& place) const {
        const Eigen::Vector2d from = place - rectangle.center;
        const double behind = -from.dot(outward);
        const double margin = slack + 2.0 * noise;
        const double width = std::max(rectangle.length, usual_width);
        return std::abs(from.dot(rectangle.axis)) <= 0.5 * width + margin &&
               behind >= -0.5 * rectangle.width - margin && behind <= max_depth;
    }
};

/// A flat upright surface as a pedestal's front, if it is one under the slab.
std::optional<PedestalFront> as_front(const FurnitureVoxels& all,
                                      std::span<const std::uint32_t> members,
                                      const LevelSlab& slab) {
    std::vector<double> heights;
    std::vector<double> noise;
    for (const std::uint32_t i : members) {
        heights.push_back(all.voxels[i].height);
        noise.push_back(all.voxels[i].noise);
    }
    PedestalFront front;
    front.top = quantile(heights, 0.98);
    front.noise = median(noise);
    if (quantile(heights, 0.02) > max_front_bottom || front.top < min_front_top ||
        front.top > slab.height - min_gap) {
        return std::nullopt;
    }
    front.rectangle = smallest_rectangle(places_of(all, members));
    const double width = front.rectangle.length;
    // Rays that meet its edge lie beside it.
    if (width < min_width || width > max_width + 2.0 * front.noise) return std::nullopt;
    front.outward = front.rectangle.across();
    const Eigen::Vector2d from_middle = front.rectangle.center - slab.rectangle.center;
    if (front.outward.dot(from_middle) < 0.0) front.outward = -front.outward;
    // People sit along a desk, and open the drawers beside them.
    constexpr double parallel = 0.95;
    if (std::abs(front.outward.dot(slab.rectangle.across())) < parallel) return std::nullopt;
    const double inset = 0.5 * slab.rectangle.width - front.outward.dot(from_middle);
    // Knees have the larger share of what is below a top.
    constexpr double max_share = 0.5;
    if (inset > max_inset || width > max_share * slab.rectangle.length) return std::nullopt;
    return front;
}

/// The fronts among the flat upright surfaces of a draft.
std::vector<PedestalFront> find_fronts(const FurnitureVoxels& all, const PieceDraft& draft,
                                       const LevelSlab& slab) {
    constexpr std::size_t min_voxels = 25;  // as many as tell a thing, see piece_drafts.cpp
    std::vector<std::pair<std::uint32_t, std::uint32_t>> of_patches;
    for (const std::uint32_t i : draft.voxels) {
        const FurnitureVoxel& voxel = all.voxels[i];
        if (voxel.is_upright && voxel.is_planar) of_patches.emplace_back(voxel.patch, i);
    }
    std::sort(of_patches.begin(), of_patches.end());
    std::vector<PedestalFront> fronts;
    std::vector<std::uint32_t> members;
    for (std::size_t begin = 0, end = 0; begin < of_patches.size(); begin = end) {
        members.clear();
        for (; end < of_patches.size() && of_patches[end].first == of_patches[begin].first; ++end)
            members.push_back(of_patches[end].second);
        if (members.size() < min_voxels) continue;
        if (auto front = as_front(all, members, slab)) fronts.push_back(*front);
    }
    return fronts;
}

}  // namespace

void part_pedestals(const FurnitureVoxels& all, std::span<const LevelSlab> slabs,
                    std::vector<PieceDraft>& drafts) {
    std::vector<PieceDraft> pedestals;
    for (const PieceDraft& draft : drafts) {
        if (draft.slabs.empty() || draft.voxels.empty()) continue;
        const LevelSlab& slab = slabs[draft.slabs.front()];
        if (slab.height < min_table_height || slab.height > max_top) continue;
        const FurnitureVoxel& some = all.voxels[draft.voxels.front()];
        const PedestalFront* last = nullptr;
        const std::vector<PedestalFront> fronts = find_fronts(all, draft, slab);
        for (const PedestalFront& front : fronts) {
            // The front of a drawer that stands out a little is of the same pedestal.
            if (last && last->is_behind(front.rectangle.center)) continue;
            PieceDraft pedestal;
            pedestal.is_under_top = true;
            const auto is_of_pedestal = [&](std::uint32_t i) {
                const FurnitureVoxel& voxel = all.voxels[i];
                return voxel.storey == some.storey && voxel.room == some.room &&
                       voxel.height <= front.top + slack && front.is_behind(voxel.place.head<2>());
            };
            for (PieceDraft& other : drafts) {
                const auto kept =
                    std::stable_partition(other.voxels.begin(), other.voxels.end(),
                                          [&](std::uint32_t i) { return !is_of_pedestal(i); });
                pedestal.voxels.insert(pedestal.voxels.end(), kept, other.voxels.end());
                other.voxels.erase(kept, other.voxels.end());
            }
            if (pedestal.voxels.empty()) continue;
            std::sort(pedestal.voxels.begin(), pedestal.voxels.end());
            pedestals.push_back(std::move(pedestal));
        }
    }
    std::move(pedestals.begin(), pedestals.end(), std::back_inserter(drafts));
}

}  // namespace roomscribe
