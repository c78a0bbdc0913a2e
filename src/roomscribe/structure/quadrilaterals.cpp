// SPDX-License-Identifier: MIT
#include "roomscribe/structure/quadrilaterals.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>

namespace roomscribe {
namespace {

using Eigen::Vector3d;

/// Segments one after another, each turned so that it starts where the one before ends.
class Chain {
  public:
    Chain(const LineSegment& first, std::uint32_t number) : segments_{first}, lines_{number} {}

    std::size_t size() const { return segments_.size(); }

    /// Adds the segment at the end, or before the start, if the two conditions hold there.
    bool try_to_add(const LineSegment& line, std::uint32_t number,
                    const QuadrilateralSettings& settings) {
        const LineSegment turned{line.end, line.start};
        for (const LineSegment& candidate : {line, turned}) {
            if (fits(segments_.back(), candidate, settings) &&
                turns_alike(segments_.back(), candidate)) {
                segments_.push_back(candidate);
                lines_.push_back(number);
                return true;
            }
            if (fits(candidate, segments_.front(), settings) &&
                turns_alike(candidate, segments_.front())) {
                segments_.insert(segments_.begin(), candidate);
                lines_.push_back(number);
                return true;
            }
        }
        return false;
    }

    AssembledQuadrilateral finish() const {
        AssembledQuadrilateral result;
        result.lines = lines_;
        auto& corners = result.quadrilateral.corners;
        corners[1] = crossing(segments_[0], segments_[1]);
        corners[2] = crossing(segments_[1], segments_[2]);
        if (segments_.size() == 4) {
            corners[3] = crossing(segments_[2], segments_[3]);
            corners[0] = crossing(segments_[3], segments_[0]);
            return result;
        }
        const double length = std::max((segments_[0].start - corners[1]).norm(),
                                       (segments_[2].end - corners[2]).norm());
        corners[0] = corners[1] - length * segments_[0].direction();
        corners[3] = corners[2] + length * segments_[2].direction();
        return result;
    }

  private:
    /// Conditions (a) and (b).
    static bool fits(const LineSegment& before, const LineSegment& after,
                     const QuadrilateralSettings& settings) {
        return (after.start - before.end).norm() <= settings.end_distance &&
               std::abs(before.direction().dot(after.direction())) <=
                   std::sin(settings.angle_tolerance);
    }

    /// A rectangle turns the same way at each corner; a staircase or a step in space does not.
    bool turns_alike(const LineSegment& before, const LineSegment& after) const {
        if (segments_.size() < 2) return true;
        const Vector3d turn = segments_[0].direction().cross(segments_[1].direction());
        return turn.dot(before.direction().cross(after.direction())) > 0.9;
    }

    /// Middle of where two lines come nearest. They are about perpendicular.
    static Vector3d crossing(const LineSegment& a, const LineSegment& b) {
        const Vector3d u = a.direction();
        const Vector3d v = b.direction();
        const Vector3d between = b.start - a.start;
        const double cosine = u.dot(v);
        const double scale = 1.0 / (1.0 - cosine * cosine);
        const double along_a = scale * (between.dot(u) - cosine * between.dot(v));
        const double along_b = scale * (cosine * between.dot(u) - between.dot(v));
        return 0.5 * (a.start + along_a * u + b.start + along_b * v);
    }

    std::vector<LineSegment> segments_;
    std::vector<std::uint32_t> lines_;
};

}  // namespace

std::vector<AssembledQuadrilateral> assemble_quadrilaterals(std::span<const LineSegment> lines,
                                                            const QuadrilateralSettings& settings) {
    check_settings(settings);
    std::vector<AssembledQuadrilateral> quads;
    std::vector<std::uint32_t> left(lines.size());
    std::iota(left.begin(), left.end(), 0U);
    std::erase_if(left, [&](std::uint32_t i) { return !(lines[i].length() > 0.0); });
    while (!left.empty()) {  // steps 1 and 24
        // Steps 2 to 9: the first line is the first edge.
        Chain quad(lines[left.front()], left.front());
        left.erase(left.begin());
        for (std::size_t i = 0; i < left.size() && quad.size() < 4;) {      // steps 4 and 20
            if (quad.try_to_add(lines[left[i]], left[i], settings)) {       // steps 11 and 12
                left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));  // steps 13 and 14
                i = 0;                                                      // step 15
            } else {
                ++i;  // step 17
            }
        }
        if (quad.size() > 2) quads.push_back(quad.finish());  // steps 21 and 22
    }
    return quads;
}

}  // namespace roomscribe
