// SPDX-License-Identifier: MIT
#include "roomscribe/geometry/search_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>

namespace roomscribe {
namespace {

struct Points {
    std::vector<Eigen::Vector3f> positions;

    std::size_t kdtree_get_point_count() const { return positions.size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const {
        return positions[i][static_cast<Eigen::Index>(axis)];
    }
    template <typename Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>,
                                                 Points, 3, std::uint32_t>;

constexpr std::size_t leaf_size = 12;

bool nearer(const Neighbor& a, const Neighbor& b) {
    return a.squared_distance < b.squared_distance ||
           (a.squared_distance == b.squared_distance && a.index < b.index);
}

/// Keeps the `capacity` nearest points seen so far, sorted; nanoflann's result-set contract.
class NearestSet {
  public:
    using DistanceType = float;

    NearestSet(std::vector<Neighbor>& neighbors, std::size_t capacity)
        : neighbors_(neighbors), capacity_(capacity) {
        neighbors_.clear();
    }
    bool full() const { return neighbors_.size() == capacity_; }
    std::size_t size() const { return neighbors_.size(); }
    float worstDist() const {
        // One step up lets an equally near point with a lower index still be seen.
        return full() ? std::nextafter(neighbors_.back().squared_distance,
                                       std::numeric_limits<float>::max())
                      : std::numeric_limits<float>::max();
    }
    bool addPoint(float squared_distance, std::uint32_t index) {
        const Neighbor candidate{index, squared_distance};
        if (full()) {
            if (!nearer(candidate, neighbors_.back())) return true;
            neighbors_.pop_back();
        }
        neighbors_.insert(
            std::upper_bound(neighbors_.begin(), neighbors_.end(), candidate, nearer), candidate);
        return true;
    }

  private:
    std::vector<Neighbor>& neighbors_;
    std::size_t capacity_;
};

/// Collects everything within a radius; nanoflann's result-set contract.
class RadiusSet {
  public:
    using DistanceType = float;

    RadiusSet(std::vector<Neighbor>& neighbors, float squared_radius)
        : neighbors_(neighbors), squared_radius_(squared_radius) {
        neighbors_.clear();
    }
    bool full() const { return true; }
    std::size_t size() const { return neighbors_.size(); }
    float worstDist() const {
        return std::nextafter(squared_radius_, std::numeric_limits<float>::max());
    }
    bool addPoint(float squared_distance, std::uint32_t index) {
        if (squared_distance <= squared_radius_) neighbors_.push_back({index, squared_distance});
        return true;
    }

  private:
    std::vector<Neighbor>& neighbors_;
    float squared_radius_;
};

}  // namespace

struct SearchTree::Index {
    explicit Index(std::span<const Eigen::Vector3f> points)
        : cloud{{points.begin(), points.end()}},
          tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(leaf_size)) {}

    Points cloud;
    Tree tree;
};

SearchTree::SearchTree(std::span<const Eigen::Vector3f> points)
    : index_(std::make_unique<Index>(points)) {}
SearchTree::~SearchTree() = default;
SearchTree::SearchTree(SearchTree&&) noexcept = default;
SearchTree& SearchTree::operator=(SearchTree&&) noexcept = default;

std::size_t SearchTree::size() const {
    return index_->cloud.positions.size();
}

void SearchTree::nearest(const Eigen::Vector3f& query, std::size_t count,
                         std::vector<Neighbor>& neighbors) const {
    NearestSet set(neighbors, std::min(count, size()));
    if (count == 0 || size() == 0) return;
    index_->tree.findNeighbors(set, query.data(), nanoflann::SearchParams());
}

void SearchTree::within_radius(const Eigen::Vector3f& query, double radius,
                               std::vector<Neighbor>& neighbors) const {
    RadiusSet set(neighbors, static_cast<float>(radius * radius));
    if (size() == 0) return;
    index_->tree.findNeighbors(set, query.data(), nanoflann::SearchParams());
    std::sort(neighbors.begin(), neighbors.end(), nearer);
}

Neighbor SearchTree::nearest(const Eigen::Vector3f& query) const {
    std::vector<Neighbor> neighbors;
    nearest(query, 1, neighbors);
    return neighbors.front();
}

}  // namespace roomscribe
