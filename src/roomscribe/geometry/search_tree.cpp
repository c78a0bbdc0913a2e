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

/// The least float above: with it as a limit, a point at exactly the distance still passes `<`.
float just_above(float value) {
    return std::nextafter(value, std::numeric_limits<float>::max());
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
    float worstDist() const { return limit_; }
    bool addPoint(float squared_distance, std::uint32_t index) {
        const Neighbor candidate{index, squared_distance};
        if (!full()) {
            neighbors_.push_back(candidate);
        } else if (nearer(candidate, neighbors_.back())) {
            neighbors_.back() = candidate;
        } else {
            return true;
        }
        for (std::size_t i = neighbors_.size() - 1; i > 0 && nearer(candidate, neighbors_[i - 1]);
             --i) {
            std::swap(neighbors_[i], neighbors_[i - 1]);
        }
        if (full()) limit_ = just_above(neighbors_.back().squared_distance);
        return true;
    }

  private:
    std::vector<Neighbor>& neighbors_;
    std::size_t capacity_;
    float limit_ = std::numeric_limits<float>::max();
};

/// Keeps the nearest point; nanoflann's result-set contract.
class NearestOne {
  public:
    using DistanceType = float;

    bool full() const { return limit_ < std::numeric_limits<float>::max(); }
    std::size_t size() const { return full() ? 1 : 0; }
    float worstDist() const { return limit_; }
    bool addPoint(float squared_distance, std::uint32_t index) {
        const Neighbor candidate{index, squared_distance};
        if (full() && !nearer(candidate, neighbor_)) return true;
        neighbor_ = candidate;
        limit_ = just_above(squared_distance);
        return true;
    }
    Neighbor neighbor() const { return neighbor_; }

  private:
    Neighbor neighbor_{0, std::numeric_limits<float>::max()};
    float limit_ = std::numeric_limits<float>::max();
};

/// Keeps the two nearest points within a limit; nanoflann's result-set contract.
class NearestTwo {
  public:
    using DistanceType = float;

    explicit NearestTwo(float max_squared_distance) : limit_(max_squared_distance) {}
    bool full() const { return true; }
    std::size_t size() const { return 2; }
    float worstDist() const { return limit_; }
    bool addPoint(float squared_distance, std::uint32_t index) {
        const Neighbor candidate{index, squared_distance};
        if (!nearer(candidate, neighbors_[1])) return true;
        neighbors_[1] = candidate;
        if (nearer(candidate, neighbors_[0])) std::swap(neighbors_[0], neighbors_[1]);
        limit_ = std::min(limit_, just_above(neighbors_[1].squared_distance));
        return true;
    }
    const std::array<Neighbor, 2>& neighbors() const { return neighbors_; }

  private:
    static constexpr Neighbor absent{0, std::numeric_limits<float>::infinity()};
    std::array<Neighbor, 2> neighbors_{absent, absent};
    float limit_;
};

/// Collects everything within a radius; nanoflann's result-set contract.
class RadiusSet {
  public:
    using DistanceType = float;

    RadiusSet(std::vector<Neighbor>& neighbors, float squared_radius)
        : neighbors_(neighbors),
          squared_radius_(squared_radius),
          limit_(just_above(squared_radius)) {
        neighbors_.clear();
    }
    bool full() const { return true; }
    std::size_t size() const { return neighbors_.size(); }
    float worstDist() const { return limit_; }
    bool addPoint(float squared_distance, std::uint32_t index) {
        if (squared_distance <= squared_radius_) neighbors_.push_back({index, squared_distance});
        return true;
    }

  private:
    std::vector<Neighbor>& neighbors_;
    float squared_radius_;
    float limit_;
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
    NearestOne set;
    index_->tree.findNeighbors(set, query.data(), nanoflann::SearchParams());
    return set.neighbor();
}

std::array<Neighbor, 2> SearchTree::nearest_two(const Eigen::Vector3f& query,
                                                float max_distance) const {
    NearestTwo set(max_distance * max_distance);
    if (size() > 0) index_->tree.findNeighbors(set, query.data(), nanoflann::SearchParams());
    return set.neighbors();
}

}  // namespace roomscribe
