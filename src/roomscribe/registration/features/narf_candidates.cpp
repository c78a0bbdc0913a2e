// SPDX-License-Identifier: MIT
#include "roomscribe/registration/features/narf_candidates.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "roomscribe/core/parallel.hpp"

namespace roomscribe {
namespace {

constexpr int largest_side = 16;  // of a square of pixels, a power of 2
constexpr std::size_t num_levels = 5;
constexpr int group_side = 4;  // squares of changes, in a larger one
constexpr float rounding = 1e-4F;

/// Positions have a fourth coordinate, 0, so that one instruction takes them all.
struct Change {
    Eigen::Array4f position;
    float score = 0.0F;
    float weight = 0.0F;  ///< at most so much of the score counts for the pixels of a square
    std::uint32_t angle = 0;
};

struct Square {
    int x, y, side;
};

/// The changes of a square of pixels.
struct ChangeCell {
    Eigen::AlignedBox3f box;
    std::vector<Change> changes;
};

/// Cells that are next to each other.
struct CellGroup {
    Eigen::AlignedBox3f box;
    std::vector<ChangeCell> cells;
};

/// Per direction what the best change of another one makes of it.
AngleHistogram best_partners(const AngleHistogram& most) {
    constexpr std::size_t n = num_change_angles;
    std::array<float, 2 * n> twice;
    std::copy(most.begin(), most.end(), twice.begin());
    std::copy(most.begin(), most.end(), twice.begin() + n);
    AngleHistogram partners{};
    for (std::size_t steps = 1; steps < n; ++steps) {
        const float difference = angle_difference(0, steps);
        for (std::size_t a = 0; a < n; ++a)
            partners[a] = std::max(partners[a], difference * twice[a + steps]);
    }
    return partners;
}

class CandidateFinder {
  public:
    CandidateFinder(const RangeImage& image, const RangeImageBorders& borders,
                    const NarfChanges& changes, const NarfReach& reach)
        : image_(image),
          scores_(borders.surface_change_scores),
          changes_(changes),
          reach_(reach),
          steadiness_(image.size(), 0.0F),
          is_candidate_(image.size(), 0) {}

    std::vector<std::uint8_t> find(const Context& context) {
        group_changes();
        const auto rows = static_cast<std::size_t>(image_.height);
        parallel_for(context, rows, largest_side, [&](std::size_t begin, std::size_t end) {
            bound_steadiness(static_cast<int>(begin), static_cast<int>(end));
            std::array<std::vector<Change>, num_levels + 1> lists;
            for (int x = 0; x < image_.width; x += largest_side) {
                const Square square{x, static_cast<int>(begin), largest_side};
                find_near(square, lists[0]);
                divide(square, lists, 0);
            }
        });
        return std::move(is_candidate_);
    }

  private:
    /// Calls visit(pixel) for those of a square and of a margin around it.
    template <typename Visit>
    void for_pixels(const Square& square, int margin, Visit&& visit) const {
        const int right = std::min(square.x + square.side + margin, image_.width);
        const int bottom = std::min(square.y + square.side + margin, image_.height);
        for (int y = std::max(square.y - margin, 0); y < bottom; ++y) {
            for (int x = std::max(square.x - margin, 0); x < right; ++x)
                visit(image_.index(x, y));
        }
    }

    void group_changes() {
        constexpr int side = 8;
        constexpr int step = side * group_side;
        for (int y = 0; y < image_.height; y += step) {
            for (int x = 0; x < image_.width; x += step) {
                CellGroup group;
                for (int cell = 0; cell < group_side * group_side; ++cell) {
                    add_cell({x + cell % group_side * side, y + cell / group_side * side, side},
                             group);
                }
                if (!group.cells.empty()) groups_.push_back(std::move(group));
            }
        }
    }

    void add_cell(const Square& square, CellGroup& group) const {
        ChangeCell cell;
        for_pixels(square, 0, [&](std::size_t i) {
            if (!changes_.has_change(i)) return;
            cell.box.extend(image_.points[i]);
            const Eigen::Vector3f& point = image_.points[i];
            cell.changes.push_back(
                {{point.x(), point.y(), point.z(), 0.0F}, scores_[i], 0.0F, changes_.angles[i]});
        });
        if (cell.changes.empty()) return;
        group.box.extend(cell.box);
        group.cells.push_back(std::move(cell));
    }

    /// What the changes right beside a pixel leave of its interest.
    void bound_steadiness(int begin, int end) {
        for (int y = begin; y < end; ++y) {
            for (int x = 0; x < image_.width; ++x) {
                const std::size_t i = image_.index(x, y);
                if (changes_.is_surface[i] == 0) continue;
                float edge = 0.0F;
                for_pixels({x, y, 1}, 1, [&](std::size_t other) {
                    if (!changes_.has_change(other) || scores_[other] <= edge) return;
                    const float distance = (image_.points[other] - image_.points[i]).norm();
                    edge =
                        std::max(edge, scores_[other] * (1.0F - distance / reach_.edge_distance));
                });
                const float steadiness = narf_steadiness(edge);
                if (steadiness >= reach_.min_interest - rounding) steadiness_[i] = steadiness;
            }
        }
    }

    /// The changes of all cells that are near enough.
    void find_near(const Square& square, std::vector<Change>& near) const {
        near.clear();
        Eigen::AlignedBox3f box;
        for_pixels(square, 0, [&](std::size_t i) {
            if (steadiness_[i] > 0.0F) box.extend(image_.points[i]);
        });
        if (box.isEmpty()) return;
        const float squared_radius = reach_.radius * reach_.radius;
        for (const CellGroup& group : groups_) {
            if (group.box.squaredExteriorDistance(box) >= squared_radius) continue;
            for (const ChangeCell& cell : group.cells) {
                if (cell.box.squaredExteriorDistance(box) >= squared_radius) continue;
                near.insert(near.end(), cell.changes.begin(), cell.changes.end());
            }
        }
    }

    /// Marks the candidates of a square, given all changes that count for it (lists[level]).
    void divide(const Square& square, std::array<std::vector<Change>, num_levels + 1>& lists,
                std::size_t level) {
        Eigen::AlignedBox3f box;
        float steadiness = 0.0F;
        for_pixels(square, 0, [&](std::size_t i) {
            if (steadiness_[i] <= 0.0F) return;
            box.extend(image_.points[i]);
            steadiness = std::max(steadiness, steadiness_[i]);
        });
        if (box.isEmpty()) return;
        AngleHistogram most{};
        for_pixels(square, 1, [&](std::size_t i) {
            if (!changes_.has_change(i)) return;
            most[changes_.angles[i]] = std::max(most[changes_.angles[i]], scores_[i]);
        });
        std::vector<Change>& kept = lists[level + 1];
        const AngleHistogram sure = weigh(lists[level], box, kept, most);
        const AngleHistogram partners = best_partners(most);
        const float root = reach_.min_interest / steadiness;
        const float least = root * root * (1.0F - rounding);
        bool is_enough = false;
        for (std::size_t a = 0; a < num_change_angles; ++a)
            is_enough = is_enough || most[a] * partners[a] >= least;
        if (!is_enough) return;
        if (square.side == 1) {
            is_candidate_[image_.index(square.x, square.y)] = 1;
            return;
        }
        std::erase_if(kept, [&](const Change& change) {
            return change.weight * partners[change.angle] < least ||
                   change.weight < sure[change.angle] - rounding;
        });
        const int half = square.side / 2;
        for (const int y : {square.y, square.y + half}) {
            for (const int x : {square.x, square.x + half})
                divide({x, y, half}, lists, level + 1);
        }
    }

    /// Those within the radius of a box, with what counts of them there at most. Returns what
    /// counts anywhere in the box: what counts less than that is of no matter.
    AngleHistogram weigh(const std::vector<Change>& changes, const Eigen::AlignedBox3f& box,
                         std::vector<Change>& kept, AngleHistogram& most) const {
        kept.clear();
        AngleHistogram sure{};
        const float inverse_radius = 1.0F / reach_.radius;
        Eigen::Array4f low = Eigen::Array4f::Zero();
        Eigen::Array4f high = Eigen::Array4f::Zero();
        low.head<3>() = box.min();
        high.head<3>() = box.max();
        const float diagonal = box.diagonal().norm() * inverse_radius;
        for (const Change& change : changes) {
            const float squared_distance =
                (change.position - change.position.max(low).min(high)).matrix().squaredNorm();
            if (squared_distance >= reach_.radius * reach_.radius) continue;
            const float nearness = 1.0F - std::sqrt(squared_distance) * inverse_radius;
            const std::uint32_t angle = change.angle;
            const float weight = change.score * nearness;
            most[angle] = std::max(most[angle], weight);
            sure[angle] = std::max(sure[angle], change.score * (nearness - diagonal));
            if (weight < sure[angle] - rounding) continue;
            kept.push_back({change.position, change.score, weight, angle});
        }
        return sure;
    }

    const RangeImage& image_;
    const std::vector<float>& scores_;
    const NarfChanges& changes_;
    NarfReach reach_;
    std::vector<CellGroup> groups_;
    std::vector<float> steadiness_;  ///< at most; 0 where it is not enough
    std::vector<std::uint8_t> is_candidate_;
};

}  // namespace

std::vector<std::uint8_t> find_narf_candidates(const RangeImage& image,
                                               const RangeImageBorders& borders,
                                               const NarfChanges& changes, const NarfReach& reach,
                                               const Context& context) {
    return CandidateFinder(image, borders, changes, reach).find(context);
}

}  // namespace roomscribe
