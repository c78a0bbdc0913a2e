// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/openings/mirror_test.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace roomscribe {
namespace {

using Eigen::Vector3f;

/// m. Mirrors hang a centimetre or two before the plane that is taken for theirs, and bend; ground
/// outdoors lies farther below the floor.
constexpr float cell_size = 0.06F;
constexpr std::size_t min_rays = 20;

}  // namespace

MirrorTest::MirrorTest(std::span<const Ray> rays, const SurfaceSample& sample) : rays_(rays) {
    occupied_.reserve(sample.cloud.size());
    for (const Vector3f& point : sample.cloud.positions)
        occupied_.push_back(cell_of(point));
    std::sort(occupied_.begin(), occupied_.end());
    occupied_.erase(std::unique(occupied_.begin(), occupied_.end()), occupied_.end());
}

std::uint64_t MirrorTest::cell_of(const Vector3f& point) const {
    std::uint64_t cell = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const auto index = static_cast<std::int64_t>(std::floor(point[axis] / cell_size));
        cell = (cell << 21U) | (static_cast<std::uint64_t>(index) & 0x1FFFFFU);
    }
    return cell;
}

bool MirrorTest::is_occupied(const Vector3f& point) const {
    // Half a cell to all sides.
    constexpr std::array<float, 3> steps{-0.5F * cell_size, 0.0F, 0.5F * cell_size};
    for (const float x : steps) {
        for (const float y : steps) {
            for (const float z : steps) {
                const std::uint64_t cell = cell_of(point + Vector3f(x, y, z));
                if (std::binary_search(occupied_.begin(), occupied_.end(), cell)) return true;
            }
        }
    }
    return false;
}

double MirrorTest::share_of_images(const UprightWindow& window, double min_depth) const {
    const Vector3f normal = window.plane.normal.cast<float>();
    std::size_t images = 0;
    std::size_t passed = 0;
    visit_rays(rays_, window, [&](const Ray& ray, float behind) {
        if (behind < static_cast<float>(min_depth)) return;
        ++passed;
        images += is_occupied(ray.end + 2.0F * behind * normal) ? 1 : 0;
    });
    if (passed < min_rays) return 0.0;
    return static_cast<double>(images) / static_cast<double>(passed);
}

}  // namespace roomscribe
