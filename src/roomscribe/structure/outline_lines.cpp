// SPDX-License-Identifier: MIT
#include "roomscribe/structure/outline_lines.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Eigenvalues>

#include "roomscribe/geometry/polygon.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector2d;

/// A run of rim points, by position in a loop that is repeated once.
struct Stretch {
    std::size_t begin;
    std::size_t end;  ///< the last point, included
};

class LoopSplitter {
  public:
    LoopSplitter(std::span<const Vector2d> loop, double tolerance)
        : loop_(loop), tolerance_(tolerance) {}

    const Vector2d& at(std::size_t i) const { return loop_[i % loop_.size()]; }

    std::vector<Stretch> split() const {
        // Two points far from each other are corners, or near one.
        const std::size_t first = farthest_from(0);
        const std::size_t second = farthest_from(first);
        const std::size_t low = std::min(first, second);
        const std::size_t high = std::max(first, second);
        std::vector<Stretch> stretches;
        if (low == high) return stretches;
        split({low, high}, stretches);
        split({high, low + loop_.size()}, stretches);
        return stretches;
    }

    /// Line through the middle of a stretch; its ends are put where the first and last point lie.
    std::optional<OutlineLine> fit(const Stretch& stretch) const {
        const std::size_t count = stretch.end - stretch.begin + 1;
        if (count < 4) return std::nullopt;
        const std::size_t trimmed = count >= 10 ? count / 10 : 0;
        Vector2d middle = Vector2d::Zero();
        const auto num_fitted = static_cast<double>(count - 2 * trimmed);
        for (std::size_t i = stretch.begin + trimmed; i + trimmed <= stretch.end; ++i)
            middle += at(i);
        middle /= num_fitted;
        Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
        for (std::size_t i = stretch.begin + trimmed; i + trimmed <= stretch.end; ++i)
            scatter += (at(i) - middle) * (at(i) - middle).transpose();
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(scatter);
        Vector2d along = solver.eigenvectors().col(1);
        if (along.dot(at(stretch.end) - at(stretch.begin)) < 0.0) along = -along;
        OutlineLine line;
        line.start = middle + along.dot(at(stretch.begin) - middle) * along;
        line.end = middle + along.dot(at(stretch.end) - middle) * along;
        line.num_points = static_cast<std::uint32_t>(count);
        line.rms = std::sqrt(std::max(solver.eigenvalues()[0], 0.0) / num_fitted);
        return line;
    }

  private:
    std::size_t farthest_from(std::size_t i) const {
        std::size_t best = i;
        for (std::size_t j = 0; j < loop_.size(); ++j) {
            if ((loop_[j] - loop_[i]).squaredNorm() > (loop_[best] - loop_[i]).squaredNorm())
                best = j;
        }
        return best;
    }

    void split(const Stretch& stretch, std::vector<Stretch>& stretches) const {
        std::vector<Stretch> open{stretch};
        while (!open.empty()) {
            const Stretch next = open.back();
            open.pop_back();
            const Vector2d chord = at(next.end) - at(next.begin);
            const double length = chord.norm();
            std::size_t corner = next.begin;
            double greatest = tolerance_;
            for (std::size_t i = next.begin + 1; i < next.end; ++i) {
                const Vector2d offset = at(i) - at(next.begin);
                const double distance =
                    length > 0.0 ? std::abs(cross(chord, offset)) / length : offset.norm();
                if (distance <= greatest) continue;
                greatest = distance;
                corner = i;
            }
            if (corner == next.begin) {
                stretches.push_back(next);
            } else {
                open.push_back({corner, next.end});
                open.push_back({next.begin, corner});
            }
        }
    }

    std::span<const Vector2d> loop_;
    double tolerance_;
};

bool are_one_line(const OutlineLine& a, const OutlineLine& b, double tolerance) {
    const Vector2d along = a.direction();
    constexpr double min_cosine = 0.996;  // 5 degrees
    return along.dot(b.direction()) >= min_cosine &&
           std::abs(cross(along, b.start - a.start)) <= tolerance &&
           std::abs(cross(along, b.end - a.start)) <= tolerance;
}

}  // namespace

std::vector<OutlineLine> find_outline_lines(const PatchOutline& outline,
                                            const OutlineLineSettings& settings) {
    std::vector<OutlineLine> lines;
    for (std::uint32_t number = 0; number < outline.loops.size(); ++number) {
        const LoopSplitter splitter(outline.loops[number].points, settings.tolerance);
        std::vector<std::pair<Stretch, OutlineLine>> of_loop;
        for (const Stretch& stretch : splitter.split()) {
            const auto line = splitter.fit(stretch);
            if (!line) continue;
            if (!of_loop.empty() && of_loop.back().first.end == stretch.begin &&
                are_one_line(of_loop.back().second, *line, settings.tolerance)) {
                const Stretch both{of_loop.back().first.begin, stretch.end};
                of_loop.back() = {both, *splitter.fit(both)};
            } else {
                of_loop.emplace_back(stretch, *line);
            }
        }
        for (auto& [stretch, line] : of_loop) {
            line.loop = number;
            // The last row of points lies half a spacing before the rim, on average.
            const Vector2d outwards(line.direction().y(), -line.direction().x());
            line.start += 0.5 * outline.spacing * outwards;
            line.end += 0.5 * outline.spacing * outwards;
            if (line.length() >= settings.min_length) lines.push_back(line);
        }
    }
    return lines;
}

}  // namespace roomscribe
