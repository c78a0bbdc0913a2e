// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/registration/features/narf_changes.hpp"

namespace roomscribe {

/// The room that some points take. Positions have a fourth coordinate, 0, so that one instruction
/// takes them all.
struct PointBox {
    Eigen::Array4f low = Eigen::Array4f::Constant(std::numeric_limits<float>::infinity());
    Eigen::Array4f high = -low;

    static Eigen::Array4f position(const Eigen::Vector3f& point) {
        return {point.x(), point.y(), point.z(), 0.0F};
    }
    void extend(const PointBox& other) {
        low = low.min(other.low);
        high = high.max(other.high);
    }
    void extend(const Eigen::Vector3f& point) {
        extend(PointBox{position(point), position(point)});
    }
    bool is_empty() const { return low.x() > high.x(); }
    float diagonal() const { return (high - low).matrix().norm(); }
    /// Squared distance of the two boxes' nearest points.
    float squared_gap(const PointBox& other) const {
        return (low - other.high).max(other.low - high).max(0.0F).matrix().squaredNorm();
    }
    /// Squared distance of the two boxes' farthest points.
    float squared_span(const PointBox& other) const {
        return (high - other.low).max(other.high - low).matrix().squaredNorm();
    }
};

/// A change of the surface as seen from a box of pixels.
struct NearChange {
    Eigen::Array4f position;  ///< as in PointBox
    float score = 0.0F;
    std::uint32_t angle = 0;
    float weight = 0.0F;  ///< so much of the score counts in the box at most
};

/// What changes count for the pixels of a box, each score * (1 - distance / radius), per direction.
struct NarfBounds {
    AngleHistogram most{};  ///< no change counts for more anywhere in the box
    AngleHistogram sure{};  ///< so much counts everywhere in the box

    /// Adds changes. `kept` gets those within the radius, but some that count for less than others
    /// everywhere.
    void add(const std::vector<NearChange>& changes, const PointBox& box, float radius,
             std::vector<NearChange>& kept);

    /// The most that two directions count together, not more than which the square of a pixel's
    /// interest can be. `least` of each direction gets what a change has to count for at least to
    /// matter where the square is `enough`.
    float best_pair(float enough, AngleHistogram& least) const;
};

/// Drops those with less weight than their direction's least.
void drop_weak(const AngleHistogram& least, std::vector<NearChange>& changes);

}  // namespace roomscribe
