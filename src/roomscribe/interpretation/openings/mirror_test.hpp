// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "roomscribe/interpretation/rooms/ray_sample.hpp"
#include "roomscribe/structure/surface_sample.hpp"

namespace roomscribe {

/// Tells mirrors from windows: what a mirror shows behind itself is the room before it, so that its
/// points, turned over at its plane, lie on surfaces that were seen.
class MirrorTest {
  public:
    /// `rays` must stay where they are.
    MirrorTest(std::span<const Ray> rays, const SurfaceSample& sample);

    /// Share of the rays through a rectangle on a wall whose points, `min_depth` m behind it or
    /// more, have a surface at their mirror image. 0 if fewer than 20 rays passed.
    double share_of_images(const UprightWindow& window, double min_depth) const;

  private:
    std::uint64_t cell_of(const Eigen::Vector3f& point) const;
    bool is_occupied(const Eigen::Vector3f& point) const;

    std::span<const Ray> rays_;
    std::vector<std::uint64_t> occupied_;  ///< ascending
};

}  // namespace roomscribe
