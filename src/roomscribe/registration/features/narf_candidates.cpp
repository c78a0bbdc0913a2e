// SPDX-License-Identifier: MIT
#include "roomscribe/registration/features/narf_candidates.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/registration/features/narf_bounds.hpp"

namespace roomscribe {
namespace {

constexpr int largest_side = 32;  // of a square of pixels, a power of 2
constexpr int least_side = 4;     // of a square of pixels that is held against cells of changes
constexpr std::size_t max_depth = 4;
constexpr float rounding = 1e-4F;

struct Square {
    int x = 0;
    int y = 0;
    int side = 0;

    std::array<Square, 4> quarters() const {
        const int half = side / 2;
        return {
            {{x, y, half}, {x + half, y, half}, {x, y + half, half}, {x + half, y + half, half}}};
    }
};

/// What is known of the pixels of a square before the changes around it are looked at.
struct PixelBound {
    PointBox box;  ///< of those that are steady enough
    float steadiness = 0.0F;
    AngleHistogram most{};  ///< scores in and right beside the square, which count in full

    void merge(const PixelBound& other);
};

/// A square of the image: its pixels, and its changes as others see them. It has either quarters
/// or, if it is the least, changes of its own.
struct Cell {
    Square square;
    PixelBound pixels;
    PointBox box;
    AngleHistogram most{};  ///< scores per direction
    std::vector<Cell> quarters;
    std::vector<NearChange> changes;
};

/// A cell as seen from a square of pixels.
struct NearCell {
    const Cell* cell = nullptr;
    float nearness = 0.0F;  ///< so much of its scores counts at most
};

/// What can count for a square, per depth of the tree.
struct Workspace {
    std::array<std::vector<const Cell*>, max_depth + 1> cells;
    std::array<std::vector<NearChange>, max_depth + 1> changes;
    std::vector<NearCell> near;
};

using Angles = Eigen::Array<float, num_change_angles, 1>;

Eigen::Map<Angles> as_array(AngleHistogram& values) {
    return Eigen::Map<Angles>(values.data());
}
Eigen::Map<const Angles> as_array(const AngleHistogram& values) {
    return Eigen::Map<const Angles>(values.data());
}

/// Whether any of the scores counts at some nearness.
bool is_strong(const AngleHistogram& scores, float nearness, const AngleHistogram& least) {
    return (nearness * as_array(scores) - as_array(least)).maxCoeff() >= 0.0F;
}

void PixelBound::merge(const PixelBound& other) {
    box.extend(other.box);
    steadiness = std::max(steadiness, other.steadiness);
    as_array(most) = as_array(most).max(as_array(other.most));
}

/// What can count for the pixels of a square.
struct SquareBound {
    PointBox box;
    NarfBounds changes;
    float enough = 0.0F;  ///< for the square of the interest but for its steadiness
    AngleHistogram least{};

    SquareBound(const PixelBound& pixels, float min_interest)
        : box(pixels.box), changes{.most = pixels.most, .sure = {}} {
        const float root = min_interest / pixels.steadiness;
        enough = root * root;
    }
    bool is_enough() { return changes.best_pair(enough, least) >= enough * (1.0F - rounding); }
};

class CandidateFinder {
  public:
    CandidateFinder(const RangeImage& image, const RangeImageBorders& borders,
                    const NarfChanges& changes, const NarfReach& reach)
        : image_(image),
          scores_(borders.surface_change_scores),
          changes_(changes),
          reach_(reach),
          steadiness_(image.size(), 0.0F),
          candidates_(image.size(), 0.0F) {}

    std::vector<float> find(const Context& context) {
        std::vector<Square> squares;
        for (int y = 0; y < image_.height; y += largest_side) {
            for (int x = 0; x < image_.width; x += largest_side)
                squares.push_back({x, y, largest_side});
        }
        std::vector<Cell> cells(squares.size());
        parallel_for(context, squares.size(), 4, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                bound_steadiness(squares[i]);
                cells[i] = make_cell(squares[i]);
            }
        });
        parallel_for(context, cells.size(), 2, [&](std::size_t begin, std::size_t end) {
            Workspace work;
            for (const Cell& cell : cells) {
                if (!cell.box.is_empty()) work.cells[0].push_back(&cell);
            }
            for (std::size_t i = begin; i < end; ++i)
                divide_by_cells(cells[i], work, 0);
        });
        return std::move(candidates_);
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

    Cell make_cell(const Square& square) const {
        Cell cell;
        cell.square = square;
        if (square.side > least_side) {
            for (const Square& quarter : square.quarters()) {
                const Cell& part = cell.quarters.emplace_back(make_cell(quarter));
                cell.pixels.merge(part.pixels);
                cell.box.extend(part.box);
                as_array(cell.most) = as_array(cell.most).max(as_array(part.most));
            }
            return cell;
        }
        cell.pixels = bound_pixels(square);
        for_pixels(square, 0, [&](std::size_t i) {
            if (!changes_.has_change(i)) return;
            const std::uint8_t angle = changes_.angles[i];
            cell.box.extend(image_.points[i]);
            cell.most[angle] = std::max(cell.most[angle], scores_[i]);
            cell.changes.push_back({PointBox::position(image_.points[i]), scores_[i], angle});
        });
        return cell;
    }

    PixelBound bound_pixels(const Square& square) const {
        PixelBound bound;
        for_pixels(square, 0, [&](std::size_t i) {
            if (steadiness_[i] <= 0.0F) return;
            bound.box.extend(image_.points[i]);
            bound.steadiness = std::max(bound.steadiness, steadiness_[i]);
        });
        if (bound.box.is_empty()) return bound;
        for_pixels(square, 1, [&](std::size_t i) {
            if (!changes_.has_change(i)) return;
            float& most = bound.most[changes_.angles[i]];
            most = std::max(most, scores_[i]);
        });
        return bound;
    }

    /// What the changes right beside a pixel leave of its interest.
    void bound_steadiness(const Square& square) {
        for_pixels(square, 0, [&](std::size_t i) {
            if (changes_.is_surface[i] == 0) return;
            float edge = 0.0F;
            for_pixels({image_.column(i), image_.row(i), 1}, 1, [&](std::size_t other) {
                if (!changes_.has_change(other) || scores_[other] <= edge) return;
                const float distance = (image_.points[other] - image_.points[i]).norm();
                edge = std::max(edge, scores_[other] * (1.0F - distance / reach_.edge_distance));
            });
            const float steadiness = narf_steadiness(edge);
            if (steadiness >= reach_.min_interest - rounding) steadiness_[i] = steadiness;
        });
    }

    /// Marks the candidates of a square, given all cells of changes that count for it.
    void divide_by_cells(const Cell& own, Workspace& work, std::size_t depth) {
        if (own.pixels.box.is_empty()) return;
        SquareBound bound(own.pixels, reach_.min_interest);
        add_cells(work.cells[depth], bound, work.near);
        if (!bound.is_enough()) return;
        if (own.quarters.empty()) {
            gather_changes(work.near, bound.least, work.changes[0]);
            for (const Square& quarter : own.square.quarters())
                divide(quarter, work, 0);
            return;
        }
        std::vector<const Cell*>& cells = work.cells[depth + 1];
        cells.clear();
        for (const auto& [cell, nearness] : work.near) {
            if (!is_strong(cell->most, nearness, bound.least)) continue;
            for (const Cell& quarter : cell->quarters) {
                if (is_strong(quarter.most, nearness, bound.least)) cells.push_back(&quarter);
            }
        }
        for (const Cell& quarter : own.quarters)
            divide_by_cells(quarter, work, depth + 1);
    }

    static void gather_changes(const std::vector<NearCell>& near, const AngleHistogram& least,
                               std::vector<NearChange>& changes) {
        changes.clear();
        for (const auto& [cell, nearness] : near) {
            if (!is_strong(cell->most, nearness, least)) continue;
            for (const NearChange& change : cell->changes) {
                if (change.score * nearness >= least[change.angle]) changes.push_back(change);
            }
        }
    }

    /// Marks the candidates of a square, given all changes that count for it.
    void divide(const Square& square, Workspace& work, std::size_t depth) {
        const PixelBound pixels = bound_pixels(square);
        if (pixels.box.is_empty()) return;
        SquareBound bound(pixels, reach_.min_interest);
        std::vector<NearChange>& kept = work.changes[depth + 1];
        bound.changes.add(work.changes[depth], bound.box, reach_.radius, kept);
        if (!bound.is_enough()) return;
        if (square.side == 1) {
            const std::size_t pixel = image_.index(square.x, square.y);
            candidates_[pixel] = steadiness_[pixel];
            return;
        }
        drop_weak(bound.least, kept);
        for (const Square& quarter : square.quarters())
            divide(quarter, work, depth + 1);
    }

    /// As NarfBounds::add, for cells.
    void add_cells(const std::vector<const Cell*>& cells, SquareBound& bound,
                   std::vector<NearCell>& kept) const {
        kept.clear();
        const float inverse_radius = 1.0F / reach_.radius;
        Angles most = as_array(bound.changes.most);
        Angles sure = Angles::Zero();
        for (const Cell* cell : cells) {
            const float nearness =
                1.0F - std::sqrt(cell->box.squared_gap(bound.box)) * inverse_radius;
            if (nearness <= 0.0F) continue;
            most = most.max(nearness * as_array(cell->most));
            kept.push_back({cell, nearness});
            const float farness = std::sqrt(cell->box.squared_span(bound.box)) * inverse_radius;
            if (farness < 1.0F) sure = sure.max((1.0F - farness) * as_array(cell->most));
        }
        as_array(bound.changes.most) = most;
        as_array(bound.changes.sure) = sure;
    }

    const RangeImage& image_;
    const std::vector<float>& scores_;
    const NarfChanges& changes_;
    NarfReach reach_;
    std::vector<float> steadiness_;  ///< at most; 0 where it is not enough
    std::vector<float> candidates_;  ///< their steadiness
};

}  // namespace

std::vector<float> find_narf_candidates(const RangeImage& image, const RangeImageBorders& borders,
                                        const NarfChanges& changes, const NarfReach& reach,
                                        const Context& context) {
    return CandidateFinder(image, borders, changes, reach).find(context);
}

}  // namespace roomscribe
