// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace roomscribe {

struct Neighbor {
    std::uint32_t index = 0;
    float squared_distance = 0.0F;
};

/// Nearest neighbours among 3D points (a k-d tree, nanoflann). The points are copied; all must be
/// finite. Queries are thread-safe. Among equally near points the lower index wins.
class SearchTree {
  public:
    explicit SearchTree(std::span<const Eigen::Vector3f> points);
    ~SearchTree();
    SearchTree(SearchTree&&) noexcept;
    SearchTree& operator=(SearchTree&&) noexcept;

    std::size_t size() const;

    /// The `count` nearest points, nearest first; fewer if the tree holds fewer. `neighbors` is
    /// overwritten, so that a caller can keep one buffer.
    void nearest(const Eigen::Vector3f& query, std::size_t count,
                 std::vector<Neighbor>& neighbors) const;

    /// All points within `radius` (inclusive), nearest first.
    void within_radius(const Eigen::Vector3f& query, double radius,
                       std::vector<Neighbor>& neighbors) const;

    /// The nearest point. Precondition: size() > 0.
    Neighbor nearest(const Eigen::Vector3f& query) const;

    /// The two nearest points that are nearer than `max_distance`, nearest first; the squared
    /// distance of an absent one is infinite.
    std::array<Neighbor, 2> nearest_two(const Eigen::Vector3f& query, float max_distance) const;

  private:
    struct Index;
    std::unique_ptr<Index> index_;
};

}  // namespace roomscribe
