// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/wall_openings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/core/quantile.hpp"
#include "roomscribe/core/units.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// m. Leaves have 0.61 to 1.11 m by 1.985 or 2.11 m (DIN 18101), double ones twice the width; old
// and narrow ones are a little off these.
constexpr double min_door_width = 0.55;
constexpr double max_door_width = 2.3;
constexpr double min_door_height = 1.8;
constexpr double max_door_height = 2.5;
constexpr double max_leaf_width = 1.3;
/// m. Thresholds, skirtings and what lies on the floor.
constexpr double floor_reach = 0.25;
/// m. Hatches and vents are smaller than a window.
constexpr double min_window_side = 0.35;
/// Confidence of a hole like a window's without a sign of glass, until drop_niches().
constexpr double unglazed = 0.1;
/// m. Panes of doors: above a bottom rail, between stiles.
constexpr double max_rail = 0.35;
constexpr double min_glazing_height = 1.3;
constexpr double usual_rail = 0.12;
/// m. Architraves are 44 to 95 mm wide.
constexpr double casing_width = 0.06;
/// m. uPVC frame and sash together show 100 to 120 mm, fixed lights 50 to 70 mm.
constexpr double usual_window_frame = 0.08;

/// A rectangle of cells: columns [left, right), rows [low, high).
struct CellRectangle {
    int left = 0;
    int right = 0;
    int low = 0;
    int high = 0;
    double sum = 0.0;
};

/// The rectangle with the largest sum of weights, the smallest of equal ones: Kadane's run over all
/// pairs of rows.
CellRectangle heaviest_rectangle(std::span<const float> weights, int num_columns, int num_rows) {
    CellRectangle best;
    std::vector<double> column_sums(static_cast<std::size_t>(num_columns));
    for (int low = 0; low < num_rows; ++low) {
        std::fill(column_sums.begin(), column_sums.end(), 0.0);
        for (int row = low; row < num_rows; ++row) {
            double run = 0.0;
            int start = 0;
            for (int column = 0; column < num_columns; ++column) {
                double& sum = column_sums[static_cast<std::size_t>(column)];
                sum += static_cast<double>(
                    weights[static_cast<std::size_t>(row) * static_cast<std::size_t>(num_columns) +
                            static_cast<std::size_t>(column)]);
                if (run <= 0.0) {
                    run = 0.0;
                    start = column;
                }
                run += sum;
                if (run > best.sum + 1e-9) best = {start, column + 1, low, row + 1, run};
            }
        }
    }
    return best;
}

/// The relief with cells that nothing was seen of filled from those around them, for walls that are
/// far from every scanner.
WallRelief fill_gaps(const WallRelief& relief) {
    constexpr int reach = 2;
    WallRelief filled = relief;
    for (int row = 0; row < relief.num_rows; ++row) {
        for (int column = 0; column < relief.num_columns; ++column) {
            const ReliefCell& cell = relief.at(column, row);
            if (cell.surface + cell.open() + cell.hidden > 0) continue;
            ReliefCell& target = filled.cells[relief.index(column, row)];
            for (int y = std::max(0, row - reach); y <= std::min(relief.num_rows - 1, row + reach);
                 ++y) {
                for (int x = std::max(0, column - reach);
                     x <= std::min(relief.num_columns - 1, column + reach); ++x) {
                    const ReliefCell& near = relief.at(x, y);
                    target.surface += near.surface;
                    target.recess += near.recess;
                    target.through += near.through;
                    target.height += near.height;
                }
            }
        }
    }
    return filled;
}

/// The holes of one wall's face.
class HoleFinder {
  public:
    explicit HoleFinder(const WallRelief& relief) : relief_(relief) {}

    std::vector<CellRectangle> run() {
        find_groups();
        std::vector<CellRectangle> holes;
        for (std::int32_t group = 0; group < num_groups_; ++group) {
            if (sizes_[static_cast<std::size_t>(group)] < min_cells()) continue;
            const CellRectangle hole =
                heaviest_rectangle(weights_of(group), relief_.num_columns, relief_.num_rows);
            if (hole.sum >= min_cells()) holes.push_back(hole);
        }
        return holes;
    }

  private:
    /// Half of the smallest window.
    double min_cells() const {
        return 0.5 * min_window_side * min_window_side / (relief_.cell_size * relief_.cell_size);
    }
    static bool is_open(const ReliefCell& cell) {
        // A ray that grazes the rim of a hole may end on either side.
        return cell.open() >= 2 && cell.open() > 2 * cell.surface;
    }
    static bool is_wall(const ReliefCell& cell) { return cell.surface > cell.open(); }

    /// Groups of open cells; cells that nothing was seen of do not part them.
    void find_groups() {
        group_.assign(relief_.cells.size(), -1);
        // What stands before a window hides a part of it, from top to bottom more often than
        // from side to side.
        const int reach_across = std::max(2, static_cast<int>(0.5 / relief_.cell_size));
        constexpr int reach_up = 2;
        std::vector<std::size_t> stack;
        const auto width = static_cast<std::size_t>(relief_.num_columns);
        for (std::size_t seed = 0; seed < group_.size(); ++seed) {
            if (group_[seed] >= 0 || !is_open(relief_.cells[seed])) continue;
            sizes_.push_back(0);
            group_[seed] = num_groups_;
            stack.push_back(seed);
            while (!stack.empty()) {
                const std::size_t cell = stack.back();
                stack.pop_back();
                ++sizes_.back();
                const int column = static_cast<int>(cell % width);
                const int row = static_cast<int>(cell / width);
                for (const auto& [dx, dy] :
                     {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
                    const int reach = dx != 0 ? reach_across : reach_up;
                    for (int step = 1; step <= reach; ++step) {
                        const int x = column + step * dx;
                        const int y = row + step * dy;
                        if (x < 0 || y < 0 || x >= relief_.num_columns || y >= relief_.num_rows)
                            break;
                        const std::size_t next = relief_.index(x, y);
                        if (is_wall(relief_.cells[next])) break;
                        if (!is_open(relief_.cells[next]) || group_[next] >= 0) continue;
                        group_[next] = num_groups_;
                        stack.push_back(next);
                    }
                }
            }
            ++num_groups_;
        }
    }

    std::vector<float> weights_of(std::int32_t group) const {
        std::vector<float> weights(relief_.cells.size(), 0.0F);
        for (std::size_t i = 0; i < weights.size(); ++i) {
            if (group_[i] == group) {
                weights[i] = 1.0F;
            } else if (is_wall(relief_.cells[i])) {
                weights[i] = -1.5F;
            }
        }
        return weights;
    }

    const WallRelief& relief_;
    std::vector<std::int32_t> group_;
    std::vector<int> sizes_;
    std::int32_t num_groups_ = 0;
};

enum class HoleSide : std::uint8_t { left, right, bottom, top };

/// Share of the cells closely beside a hole that are wall; nothing if less than a third of them was
/// seen.
std::optional<double> look_at_side(const WallRelief& relief, const CellRectangle& hole,
                                   HoleSide side) {
    double wall = 0.0;
    double seen = 0.0;
    double cells = 0.0;
    const auto look = [&](int column, int row) {
        ++cells;
        if (column < 0 || row < 0 || column >= relief.num_columns || row >= relief.num_rows) return;
        const ReliefCell& cell = relief.at(column, row);
        if (cell.surface + cell.open() == 0) return;
        ++seen;
        wall += cell.surface >= cell.open() ? 1.0 : 0.0;
    };
    for (int gap = 1; gap <= 2; ++gap) {
        if (side == HoleSide::left || side == HoleSide::right) {
            const int column = side == HoleSide::left ? hole.left - 1 - gap : hole.right + gap;
            for (int row = hole.low; row < hole.high; ++row)
                look(column, row);
        } else {
            const int row = side == HoleSide::bottom ? hole.low - 1 - gap : hole.high + gap;
            for (int column = hole.left; column < hole.right; ++column)
                look(column, row);
        }
    }
    return 3.0 * seen >= cells ? std::optional(wall / seen) : std::nullopt;
}

/// m, at which the cells along the sides lie, and those in the middle, as most of them do.
struct HoleDepths {
    std::optional<double> rim;
    std::optional<double> middle;
};

/// The hole's edges to a fraction of a cell: of the cells on either side of an edge, as much
/// belongs to the wall as rays ended on it there.
WallRectangle measure_edges(const WallRelief& relief, const CellRectangle& hole) {
    const auto open_share = [&](int left, int right, int low, int high) {
        double open = 0.0;
        double seen = 0.0;
        for (int row = std::max(0, low); row < std::min(relief.num_rows, high); ++row) {
            for (int column = std::max(0, left); column < std::min(relief.num_columns, right);
                 ++column) {
                const ReliefCell& cell = relief.at(column, row);
                const double total = cell.surface + cell.open();
                if (total == 0.0) continue;
                ++seen;
                open += cell.open() / total;
            }
        }
        return seen > 0.0 ? std::optional(open / seen) : std::nullopt;
    };
    // How far the edge lies outwards of the rectangle of cells.
    const auto outwards = [&](std::optional<double> inner, std::optional<double> outer) {
        return relief.cell_size * (outer.value_or(0.0) - (1.0 - inner.value_or(1.0)));
    };
    const double left = outwards(open_share(hole.left, hole.left + 1, hole.low, hole.high),
                                 open_share(hole.left - 1, hole.left, hole.low, hole.high));
    const double right = outwards(open_share(hole.right - 1, hole.right, hole.low, hole.high),
                                  open_share(hole.right, hole.right + 1, hole.low, hole.high));
    const double below = outwards(open_share(hole.left, hole.right, hole.low, hole.low + 1),
                                  open_share(hole.left, hole.right, hole.low - 1, hole.low));
    const double above = outwards(open_share(hole.left, hole.right, hole.high - 1, hole.high),
                                  open_share(hole.left, hole.right, hole.high, hole.high + 1));
    return {relief.start + hole.left * relief.cell_size - left,
            relief.start + hole.right * relief.cell_size + right,
            relief.bottom + hole.low * relief.cell_size - below,
            relief.bottom + hole.high * relief.cell_size + above};
}

/// What the cells of a hole tell.
struct HoleEvidence {
    double seen = 0.0;           ///< share of the cells that are open
    double hidden = 0.0;         ///< share of the cells that only hidden rays were aimed at
    double opaque = 0.0;         ///< share of the open rays that ended in the hole
    double through_share = 0.0;  ///< share of the open cells that most rays went through
    double depth = 0.0;          ///< m, at which most of these ended
    double at_depth = 0.0;       ///< share of them that did near it
    /// By side: share of the cells closely around it that are wall, if enough were seen.
    std::array<std::optional<double>, 4> rim;
    double framed = 0.0;  ///< share of the cells along its sides in which rays ended
    /// By how much cells without a return are more frequent among the open ones, as panes leave
    /// them, than in the wall around.
    double lost = 0.0;
    HoleDepths depths;

    /// m, by how much the middle lies deeper than the sides.
    double sunk() const { return depths.rim && depths.middle ? *depths.middle - *depths.rim : 0.0; }
};

/// m, at which most of what was seen at these cells lies; nothing if nothing was.
std::optional<double> depth_of(const WallRelief& relief, int column, int row) {
    const std::uint16_t* counts = relief.depths.data() + relief.index(column, row) * num_depth_bins;
    const auto most = std::max_element(counts, counts + num_depth_bins);
    if (*most == 0) return std::nullopt;
    return (static_cast<double>(most - counts) + 0.5) * depth_bin;
}

HoleDepths measure_depths(const WallRelief& relief, const CellRectangle& hole) {
    std::vector<double> rim;
    std::vector<double> middle;
    // The rim without its outermost cell, half of which is wall; the middle half.
    for (int row = hole.low + 1; row < hole.high - 1; ++row) {
        for (int column = hole.left + 1; column < hole.right - 1; ++column) {
            const auto depth = depth_of(relief, column, row);
            if (!depth) continue;
            const bool is_rim = row == hole.low + 1 || row == hole.high - 2 ||
                                column == hole.left + 1 || column == hole.right - 2;
            const bool is_middle = 4 * (row - hole.low) > hole.high - hole.low &&
                                   4 * (hole.high - row) > hole.high - hole.low &&
                                   4 * (column - hole.left) > hole.right - hole.left &&
                                   4 * (hole.right - column) > hole.right - hole.left;
            if (is_rim) rim.push_back(*depth);
            if (is_middle) middle.push_back(*depth);
        }
    }
    HoleDepths depths;
    if (!rim.empty()) depths.rim = median(rim);
    if (!middle.empty()) depths.middle = median(middle);
    return depths;
}

/// Share of the open cells along the sides in which something was seen in the hole.
double measure_framing(const WallRelief& relief, const CellRectangle& hole) {
    double framed = 0.0;
    double open = 0.0;
    for (int row = hole.low; row < hole.high; ++row) {
        for (int column = hole.left; column < hole.right; ++column) {
            const int inwards = std::min(
                {row - hole.low, hole.high - 1 - row, column - hole.left, hole.right - 1 - column});
            const ReliefCell& cell = relief.at(column, row);
            if (inwards != 1 || cell.open() == 0) continue;
            ++open;
            framed += 2 * cell.recess >= cell.open() ? 1.0 : 0.0;
        }
    }
    return framed / std::max(open, 1.0);
}

/// Share of the cells without a return among those that have some beside them.
double share_of_gaps(const WallRelief& relief, const CellRectangle& area, bool in_hole) {
    double gaps = 0.0;
    double cells = 0.0;
    const auto is_seen = [&](int column, int row) {
        const ReliefCell& cell = relief.at(column, row);
        return in_hole ? cell.open() > 0 : cell.surface > 0;
    };
    for (int row = std::max(1, area.low); row < std::min(relief.num_rows - 1, area.high); ++row) {
        for (int column = std::max(1, area.left);
             column < std::min(relief.num_columns - 1, area.right); ++column) {
            if (is_seen(column, row)) {
                ++cells;
                continue;
            }
            const ReliefCell& cell = relief.at(column, row);
            if (cell.surface + cell.open() > 0) continue;
            const int beside =
                (is_seen(column - 1, row) ? 1 : 0) + (is_seen(column + 1, row) ? 1 : 0) +
                (is_seen(column, row - 1) ? 1 : 0) + (is_seen(column, row + 1) ? 1 : 0);
            if (beside < 2) continue;
            ++cells;
            ++gaps;
        }
    }
    return gaps / std::max(cells, 1.0);
}

/// By how much gaps are more frequent in the hole than in the wall around it.
double measure_losses(const WallRelief& relief, const CellRectangle& hole) {
    const int margin = std::max(3, (hole.right - hole.left) / 2);
    const CellRectangle inside{hole.left + 1, hole.right - 1, hole.low + 1, hole.high - 1, 0.0};
    const CellRectangle around{hole.left - margin, hole.right + margin, hole.low - margin,
                               hole.high + margin, 0.0};
    return share_of_gaps(relief, inside, true) - share_of_gaps(relief, around, false);
}

HoleEvidence look_into(const WallRelief& relief, const CellRectangle& hole) {
    HoleEvidence evidence;
    std::array<double, num_depth_bins> depths{};
    double cells = 0.0;
    double open = 0.0;
    double hidden = 0.0;
    double through_cells = 0.0;
    double recess = 0.0;
    double through = 0.0;
    for (int row = hole.low; row < hole.high; ++row) {
        for (int column = hole.left; column < hole.right; ++column) {
            const ReliefCell& cell = relief.at(column, row);
            ++cells;
            if (cell.open() > cell.surface) {
                // Every cell counts alike, however many rays it met.
                ++open;
                const double weight = 1.0 / cell.open();
                recess += weight * cell.recess;
                through += weight * cell.through;
                through_cells += cell.through > cell.recess ? 1.0 : 0.0;
                const std::uint16_t* counts =
                    relief.depths.data() + relief.index(column, row) * num_depth_bins;
                for (std::size_t bin = 0; bin < num_depth_bins; ++bin)
                    depths[bin] += weight * counts[bin];
            } else if (cell.surface == 0 && cell.hidden > 0) {
                ++hidden;
            }
        }
    }
    evidence.seen = open / cells;
    evidence.hidden = hidden / cells;
    evidence.opaque = recess / std::max(recess + through, 1e-9);
    evidence.through_share = through_cells / std::max(open, 1.0);
    const auto deepest = std::max_element(depths.begin(), depths.end()) - depths.begin();
    evidence.depth = (static_cast<double>(deepest) + 0.5) * depth_bin;
    double near = 0.0;
    constexpr std::ptrdiff_t reach = 3;  // bins: noise, and the leaf's own relief
    for (std::ptrdiff_t bin = std::max<std::ptrdiff_t>(0, deepest - reach);
         bin <= std::min<std::ptrdiff_t>(num_depth_bins - 1, deepest + reach); ++bin) {
        near += depths[static_cast<std::size_t>(bin)];
    }
    evidence.at_depth = near / std::max(recess, 1e-9);

    for (std::size_t side = 0; side < 4; ++side)
        evidence.rim[side] = look_at_side(relief, hole, static_cast<HoleSide>(side));
    evidence.lost = measure_losses(relief, hole);
    evidence.depths = measure_depths(relief, hole);
    evidence.framed = measure_framing(relief, hole);
    return evidence;
}

/// Width of the frame within a window's hole: from its sides inwards to where rays pass.
double measure_frame(const WallRelief& relief, const CellRectangle& hole) {
    const auto is_pane = [&](int column) {
        int through = 0;
        int seen = 0;
        for (int row = hole.low; row < hole.high; ++row) {
            const ReliefCell& cell = relief.at(column, row);
            if (cell.open() == 0) continue;
            ++seen;
            through += cell.through > cell.recess ? 1 : 0;
        }
        return seen > 0 && 2 * through > seen;
    };
    const int middle = (hole.left + hole.right) / 2;
    int left = hole.left;
    while (left < middle && !is_pane(left))
        ++left;
    int right = hole.right - 1;
    while (right > middle && !is_pane(right))
        --right;
    if (left >= middle || right <= middle) return usual_window_frame;
    const double width =
        0.5 * relief.cell_size * static_cast<double>(left - hole.left + hole.right - 1 - right);
    return width >= 0.04 && width <= 0.12 ? width : usual_window_frame;
}

/// A leaf that lies nearly in the plane of its wall.
struct FlatDoor {
    CellRectangle cells;
    double height = 0.0;    ///< m, of the leaf before the wall beside it
    double contrast = 0.0;  ///< in the least difference that counts
};

/// Looks at all rectangles of a door's size that stand on the floor.
class FlatDoorSearch {
  public:
    explicit FlatDoorSearch(const WallRelief& relief) : relief_(relief) {
        const auto stride = static_cast<std::size_t>(relief.num_columns) + 1;
        sums_.assign(stride * (static_cast<std::size_t>(relief.num_rows) + 1), Sum{});
        for (int row = 0; row < relief.num_rows; ++row) {
            for (int column = 0; column < relief.num_columns; ++column) {
                const ReliefCell& cell = relief.at(column, row);
                Sum sum;
                if (cell.surface > 0 && cell.surface >= cell.open()) {
                    const double mean = static_cast<double>(cell.height) / cell.surface;
                    // Levers stand out, and what hangs on the wall.
                    if (std::abs(mean) <= max_height) sum = {1.0, mean, mean * mean};
                }
                at(column + 1, row + 1) =
                    sum + at(column, row + 1) + at(column + 1, row) - at(column, row);
            }
        }
    }

    std::vector<FlatDoor> run() const {
        std::vector<FlatDoor> candidates;
        const int high_low = cells(min_leaf_height);
        const int high_high = std::min(cells(max_leaf_height), relief_.num_rows - cells(0.1));
        for (int left = 0; left < relief_.num_columns; ++left) {
            for (int width = cells(min_leaf_width); width <= cells(2.0 * max_flat_width); ++width) {
                if (left + width > relief_.num_columns) break;
                const double metres = width * relief_.cell_size;
                if (metres > max_flat_width && metres < 2.0 * min_leaf_width) continue;
                for (int high = high_low; high <= high_high; ++high) {
                    const CellRectangle door{left, left + width, 0, high, 0.0};
                    if (const auto found = look_at(door)) candidates.push_back(*found);
                }
            }
        }
        std::stable_sort(
            candidates.begin(), candidates.end(),
            [](const FlatDoor& a, const FlatDoor& b) { return a.contrast > b.contrast; });
        std::vector<FlatDoor> doors;
        for (const FlatDoor& candidate : candidates) {
            const bool is_free =
                std::none_of(doors.begin(), doors.end(), [&](const FlatDoor& door) {
                    return candidate.cells.left < door.cells.right &&
                           door.cells.left < candidate.cells.right;
                });
            if (is_free) doors.push_back(candidate);
        }
        return doors;
    }

  private:
    static constexpr double max_height = 0.05;
    static constexpr double min_leaf_width = 0.6;
    static constexpr double max_flat_width = 1.15;
    static constexpr double min_leaf_height = 1.88;
    static constexpr double max_leaf_height = 2.2;
    /// m. Twice what walls are out of true over 1 m (DIN 18202, table 3, line 7: 3 mm).
    static constexpr double min_step = 0.006;
    /// Standard errors of the difference of two strips; neighbouring cells err alike.
    static constexpr double min_errors = 3.0;
    static constexpr double correlated_cells = 8.0;
    /// Of a step, by how much the leaf itself may bend.
    static constexpr double max_bend = 0.4;

    struct Sum {
        double count = 0.0;
        double heights = 0.0;
        double squares = 0.0;

        Sum operator+(const Sum& other) const {
            return {count + other.count, heights + other.heights, squares + other.squares};
        }
        Sum operator-(const Sum& other) const {
            return {count - other.count, heights - other.heights, squares - other.squares};
        }
        double mean() const { return heights / count; }
        double variance_of_mean() const {
            return correlated_cells * std::max(0.0, squares / count - mean() * mean()) / count;
        }
    };

    int cells(double length) const {
        return std::max(1, static_cast<int>(std::lround(length / relief_.cell_size)));
    }
    Sum& at(int column, int row) {
        return sums_[static_cast<std::size_t>(row) *
                         (static_cast<std::size_t>(relief_.num_columns) + 1) +
                     static_cast<std::size_t>(column)];
    }
    const Sum& at(int column, int row) const {
        return sums_[static_cast<std::size_t>(row) *
                         (static_cast<std::size_t>(relief_.num_columns) + 1) +
                     static_cast<std::size_t>(column)];
    }
    /// Of columns [left, right) and rows [low, high), if more than half of it was seen.
    std::optional<Sum> strip(int left, int right, int low, int high) const {
        if (left < 0 || low < 0 || right > relief_.num_columns || high > relief_.num_rows)
            return std::nullopt;
        const Sum sum = at(right, high) - at(left, high) - at(right, low) + at(left, low);
        if (sum.count < 0.5 * (right - left) * (high - low) || sum.count < 4.0) return std::nullopt;
        return sum;
    }
    /// How much the first strip lies before the second, in the least step that counts.
    static double step(const Sum& a, const Sum& b) {
        const double error = std::sqrt(a.variance_of_mean() + b.variance_of_mean());
        return (a.mean() - b.mean()) / std::max(min_step, min_errors * error);
    }

    std::optional<FlatDoor> look_at(const CellRectangle& door) const {
        const int gap = 1;  // cells half on either side
        const int casing = cells(0.1);
        const int inner = cells(0.2);
        const int outer = cells(0.15);
        const int low = cells(0.15);  // above skirtings
        struct Side {
            std::optional<Sum> leaf, casing, wall;
        };
        const Side sides[3] = {
            {strip(door.left + gap, door.left + gap + inner, low, door.high),
             strip(door.left - casing + gap, door.left, low, door.high),
             strip(door.left - casing - outer, door.left - casing, low, door.high)},
            {strip(door.right - gap - inner, door.right - gap, low, door.high),
             strip(door.right, door.right + casing - gap, low, door.high),
             strip(door.right + casing, door.right + casing + outer, low, door.high)},
            {strip(door.left, door.right, door.high - gap - inner, door.high - gap),
             strip(door.left, door.right, door.high, door.high + casing - gap),
             strip(door.left, door.right, door.high + casing, door.high + casing + outer)}};
        const auto leaf = strip(door.left + gap, door.right - gap, low, door.high - gap);
        if (!leaf) return std::nullopt;
        double lower = std::numeric_limits<double>::infinity();
        double cased = lower;
        double height = 0.0;
        for (const Side& side : sides) {
            if (!side.leaf) return std::nullopt;
            if (!side.wall) return std::nullopt;
            const double depth = side.wall->mean() - side.leaf->mean();
            const bool is_flat = std::abs(side.leaf->mean() - leaf->mean()) <= max_bend * depth;
            lower = std::min(lower, is_flat ? -step(*side.leaf, *side.wall) : 0.0);
            height -= depth;
            cased = std::min(cased, side.casing ? std::min(step(*side.casing, *side.wall),
                                                           step(*side.casing, *side.leaf))
                                                : 0.0);
        }
        const double contrast = std::max(lower, cased);
        if (contrast < 1.0) return std::nullopt;
        return FlatDoor{door, height / 3.0, contrast};
    }

    const WallRelief& relief_;
    std::vector<Sum> sums_;
};

/// A window's pane lies in its frame, deeper than the frame's front.
void set_depths(WallOpening& opening, const HoleEvidence& evidence) {
    constexpr double usual_sinking = 0.035;
    constexpr double max_frame_depth = 0.3;
    opening.frame_depth = std::min(evidence.depths.rim.value_or(evidence.depth), max_frame_depth);
    const double sunk = evidence.sunk();
    opening.depth = opening.frame_depth + (sunk > 0.01 && sunk < 0.1 ? sunk : usual_sinking);
}

/// Whether wall was seen on three sides, or two of a hole on the floor, and nothing else on any.
bool is_framed_by_wall(const HoleEvidence& evidence, bool stands_on_floor) {
    constexpr double min_wall = 0.5;
    int num_walls = 0;
    for (std::size_t side = 0; side < 4; ++side) {
        if (stands_on_floor && static_cast<HoleSide>(side) == HoleSide::bottom) continue;
        if (!evidence.rim[side]) continue;
        if (*evidence.rim[side] < min_wall) return false;
        ++num_walls;
    }
    return num_walls >= (stands_on_floor ? 2 : 3);
}

/// An upright patch: m along its own level direction and along up.
struct LeafExtent {
    Vector3d along;
    double across = 0.0;  ///< m along its normal
    double start = 0.0;
    double end = 0.0;
    double bottom = 0.0;
    double top = 0.0;
};

class OpeningFinder {
  public:
    OpeningFinder(const ScanMap& map, const SurfaceSample& sample,
                  std::span<const PlanarPatch> patches, const RoomSurfaces& surfaces,
                  const Eigen::Matrix3d& room_from_map, double point_spacing)
        : map_(map),
          sample_(sample),
          patches_(patches),
          surfaces_(surfaces),
          room_from_map_(room_from_map),
          up_(room_from_map.row(2).transpose()),
          // Two points to a cell and side, and no finer than frames are wide.
          cell_size_(std::clamp(2.0 * point_spacing, 0.04, 0.12)) {}

    std::vector<WallOpening> look_at(std::size_t storey, std::size_t face) const;

  private:
    const StoreyLayout& layout(std::size_t storey) const { return surfaces_.storeys[storey]; }
    std::optional<WallOpening> judge(std::size_t storey, std::size_t face, const WallRelief& relief,
                                     const CellRectangle& hole) const;
    std::int32_t room_behind(const StoreyLayout& layout, const WallFace& face,
                             const WallRectangle& hole) const;
    bool is_indoors_behind(const StoreyLayout& layout, const WallFace& face,
                           const WallRectangle& hole) const;
    LeafExtent extent_of(const PlanarPatch& patch) const;
    void widen_to_hinge(const WallFace& face, WallRectangle& hole) const;
    std::vector<std::uint32_t> find_open_leaf(const WallFace& face,
                                              const WallRectangle& hole) const;
    void add_flat_doors(std::size_t storey, std::size_t face, const WallRelief& relief,
                        std::vector<WallOpening>& openings) const;
    Vector3d place(const WallFace& face, double along, double up) const {
        return face.plane.offset * face.plane.normal + along * face.along + up * up_;
    }

    const ScanMap& map_;
    const SurfaceSample& sample_;
    std::span<const PlanarPatch> patches_;
    const RoomSurfaces& surfaces_;
    Eigen::Matrix3d room_from_map_;
    Vector3d up_;
    double cell_size_;
};

std::int32_t OpeningFinder::room_behind(const StoreyLayout& layout, const WallFace& face,
                                        const WallRectangle& hole) const {
    constexpr double max_thickness = 0.8;
    const Vector3d middle = place(face, 0.5 * (hole.start + hole.end), hole.bottom);
    for (double depth = 0.1; depth <= max_thickness; depth += 0.05) {
        const Vector3d point = room_from_map_ * (middle - depth * face.plane.normal);
        const std::int32_t room = layout.plan.room_at(point.head<2>());
        if (room != no_room && room != face.room) return room;
    }
    return no_room;
}

/// Whether floor or ceiling go on behind the hole.
bool OpeningFinder::is_indoors_behind(const StoreyLayout& layout, const WallFace& face,
                                      const WallRectangle& hole) const {
    for (double share : {0.25, 0.5, 0.75}) {
        const Vector3d foot = place(face, hole.start + share * hole.width(), hole.bottom);
        for (double depth = 0.2; depth <= 1.5; depth += 0.1) {
            const Vector3d point = room_from_map_ * (foot - depth * face.plane.normal);
            if (layout.plan.has_level_at(point.head<2>())) return true;
        }
    }
    return false;
}

LeafExtent OpeningFinder::extent_of(const PlanarPatch& patch) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    LeafExtent extent;
    extent.along = up_.cross(patch.plane.normal).normalized();
    extent.across = patch.plane.normal.dot(patch.centroid);
    extent.start = extent.bottom = infinity;
    extent.end = extent.top = -infinity;
    for (const std::uint32_t voxel : patch.points) {
        const Vector3d point = sample_.cloud.positions[voxel].cast<double>();
        extent.bottom = std::min(extent.bottom, point.dot(up_));
        extent.top = std::max(extent.top, point.dot(up_));
        extent.start = std::min(extent.start, point.dot(extent.along));
        extent.end = std::max(extent.end, point.dot(extent.along));
    }
    return extent;
}

/// The patches of a leaf that stands open: upright, as wide and high as the hole, with one upright
/// edge at a side of it.
std::vector<std::uint32_t> OpeningFinder::find_open_leaf(const WallFace& face,
                                                         const WallRectangle& hole) const {
    std::vector<std::uint32_t> leaf;
    for (std::uint32_t number = 0; number < patches_.size(); ++number) {
        const PlanarPatch& patch = patches_[number];
        if (std::abs(patch.plane.normal.dot(up_)) > std::sin(radians(8.0))) continue;
        const Vector3d middle = place(face, 0.5 * (hole.start + hole.end), patch.centroid.dot(up_));
        if ((patch.centroid - middle).norm() > hole.width() + 0.3) continue;
        if (std::abs(patch.plane.normal.dot(face.plane.normal)) > std::cos(radians(4.0)) &&
            std::abs(face.plane.signed_distance(patch.centroid)) < 0.15) {
            continue;
        }
        const LeafExtent extent = extent_of(patch);
        const double width = extent.end - extent.start;
        if (extent.top > hole.top + 0.12 || extent.top < hole.top - 0.4) continue;
        if (width > hole.width() + 0.15 || extent.top - extent.bottom < 0.5) continue;
        if (width < 0.4 * std::min(hole.width(), max_leaf_width)) continue;
        // One end of the leaf is at the hinge.
        bool is_hinged = false;
        for (const double position : {extent.start, extent.end}) {
            const Vector3d edge = position * extent.along + extent.across * patch.plane.normal;
            for (const double side : {hole.start, hole.end}) {
                const Vector3d jamb = place(face, side, 0.0);
                const Vector3d offset = edge - jamb;
                is_hinged = is_hinged || (offset - offset.dot(up_) * up_).norm() <= 0.25;
            }
        }
        if (is_hinged) leaf.push_back(number);
    }
    return leaf;
}

std::optional<WallOpening> OpeningFinder::judge(std::size_t storey, std::size_t number,
                                                const WallRelief& relief,
                                                const CellRectangle& cells) const {
    const StoreyLayout& rooms = layout(storey);
    const WallFace& face = rooms.faces[number];
    WallOpening opening;
    opening.storey = storey;
    opening.face = number;
    opening.hole = measure_edges(relief, cells);
    WallRectangle& hole = opening.hole;
    const HoleEvidence evidence = look_into(relief, cells);
    opening.coverage = evidence.seen;
    opening.hidden = evidence.hidden;
    constexpr double min_seen = 0.4;
    constexpr double min_lost = 0.08;
    constexpr double min_through = 0.1;
    if (evidence.seen + evidence.lost < min_seen) return std::nullopt;
    const bool stands_on_floor = hole.bottom - rooms.floor_height <= max_rail;
    if (!is_framed_by_wall(evidence, stands_on_floor)) return std::nullopt;
    opening.room_behind = room_behind(rooms, face, hole);
    const double above_floor = hole.bottom - rooms.floor_height;
    const bool is_closed = evidence.opaque >= 0.6 && evidence.at_depth >= 0.6;
    if (above_floor <= floor_reach) widen_to_hinge(face, hole);
    const bool is_door_size = hole.width() >= min_door_width && hole.width() <= max_door_width &&
                              hole.top - rooms.floor_height >= min_door_height &&
                              hole.top - rooms.floor_height <= max_door_height;
    if (above_floor <= floor_reach && is_door_size) {
        const bool is_indoors =
            opening.room_behind != no_room || is_indoors_behind(rooms, face, hole);
        hole.bottom = rooms.floor_height;
        opening.frame_width = casing_width;
        const bool is_glazed =
            evidence.lost >= min_lost || (relief.has_rays && evidence.through_share >= 0.3);
        if (is_closed && (is_indoors || !is_glazed)) {
            opening.depth = evidence.depth;
            opening.confidence = 0.9;
            return opening;
        }
        if (!is_indoors && is_glazed) {
            opening.type = OpeningType::window;
            set_depths(opening, evidence);
            opening.frame_width = measure_frame(relief, cells);
            opening.confidence = 0.7;
            return opening;
        }
        opening.leaf_patches = find_open_leaf(face, hole);
        opening.is_open = true;
        opening.depth = 0.05;
        opening.confidence = opening.leaf_patches.empty() ? 0.6 : 0.85;
        // Without its leaf a wide hole is as often a passage as a double door.
        if (opening.leaf_patches.empty() && hole.width() > max_leaf_width) opening.confidence = 0.5;
        return opening;
    }
    if (above_floor <= max_rail && hole.height() >= min_glazing_height &&
        hole.width() <= max_leaf_width && is_indoors_behind(rooms, face, hole)) {
        // The pane of a leaf whose rails lie in the plane of the wall.
        hole = hole.grown(usual_rail, 0.0, usual_rail);
        hole.bottom = rooms.floor_height;
        opening.frame_width = casing_width;
        opening.depth = 0.02;
        opening.confidence = 0.7;
        return opening;
    }
    if (hole.width() < min_window_side || hole.height() < min_window_side) return std::nullopt;
    if (above_floor < 0.3 && hole.height() < 1.5) return std::nullopt;
    // Panes let rays pass, or lose them, or lie deeper than the frame; the back of a niche does
    // none of these.
    constexpr double min_sinking = 0.02;
    const bool is_glazed = evidence.lost >= min_lost || evidence.sunk() >= min_sinking ||
                           (relief.has_rays && evidence.through_share >= min_through);
    // A mirror shows what lies behind it without a frame in the wall, and as often as not where
    // another room is.
    constexpr double min_framed = 0.25;
    if (evidence.framed < min_framed || is_indoors_behind(rooms, face, hole)) return std::nullopt;
    opening.type = OpeningType::window;
    set_depths(opening, evidence);
    opening.frame_width = measure_frame(relief, cells);
    opening.confidence = is_glazed ? 0.85 : unglazed;
    return opening;
}

/// A leaf that stands ajar hides a part of its hole: that reaches to the hinge then.
void OpeningFinder::widen_to_hinge(const WallFace& face, WallRectangle& hole) const {
    if (hole.width() >= max_leaf_width || hole.height() < min_door_height - floor_reach) return;
    for (const PlanarPatch& patch : patches_) {
        if (std::abs(patch.plane.normal.dot(up_)) > std::sin(radians(8.0))) continue;
        if (std::abs(patch.plane.normal.dot(face.plane.normal)) > std::cos(radians(4.0))) continue;
        const auto leaf = extent_of(patch);
        const double width = leaf.end - leaf.start;
        if (width < min_door_width || width > max_leaf_width) continue;
        if (std::abs(leaf.top - hole.top) > 0.15 || leaf.top - leaf.bottom < 1.2) continue;
        for (const double end : {leaf.start, leaf.end}) {
            const Vector3d hinge = end * leaf.along + leaf.across * patch.plane.normal;
            if (std::abs(face.plane.signed_distance(hinge)) > 0.2) continue;
            const double position = hinge.dot(face.along);
            constexpr double slack = 0.15;
            if (position < hole.start && std::abs(hole.end - position - width) <= slack)
                hole.start = position;
            if (position > hole.end && std::abs(position - hole.start - width) <= slack)
                hole.end = position;
        }
    }
}

/// Closed leaves nearly in the plane of their wall: rectangles of a door's size, on the floor, that
/// lie a few millimetres deeper than the wall on both sides and above, or have a casing
/// around them that stands out.
void OpeningFinder::add_flat_doors(std::size_t storey, std::size_t number, const WallRelief& relief,
                                   std::vector<WallOpening>& openings) const {
    const StoreyLayout& rooms = layout(storey);
    const FlatDoorSearch search(relief);
    for (const FlatDoor& door : search.run()) {
        WallOpening opening;
        opening.storey = storey;
        opening.face = number;
        opening.hole = {relief.start + door.cells.left * cell_size_,
                        relief.start + door.cells.right * cell_size_, rooms.floor_height,
                        relief.bottom + door.cells.high * cell_size_};
        const bool is_known =
            std::any_of(openings.begin(), openings.end(), [&](const WallOpening& known) {
                return std::min(opening.hole.end, known.hole.end) >
                       std::max(opening.hole.start, known.hole.start);
            });
        if (is_known) continue;
        opening.frame_width = casing_width;
        opening.depth = std::max(0.0, -door.height);
        opening.room_behind = room_behind(rooms, rooms.faces[number], opening.hole);
        opening.coverage = 1.0;
        opening.confidence = 0.75;
        openings.push_back(std::move(opening));
    }
}

std::vector<WallOpening> OpeningFinder::look_at(std::size_t storey, std::size_t number) const {
    const StoreyLayout& rooms = layout(storey);
    const WallFace& face = rooms.faces[number];
    const auto& room = rooms.plan.rooms[static_cast<std::size_t>(face.room)];
    const double top = room.ceiling_height.value_or(face.top);
    const double tolerance = std::max(sample_.tolerance, 2.0 * face.rms);
    const WallRelief relief = measure_wall_relief(map_, face, up_, rooms.floor_height, top,
                                                  std::min(tolerance, 0.06), cell_size_);
    std::vector<WallOpening> openings;
    const WallRelief filled = fill_gaps(relief);
    for (const CellRectangle& hole : HoleFinder(filled).run()) {
        if (auto opening = judge(storey, number, relief, hole))
            openings.push_back(std::move(*opening));
    }
    add_flat_doors(storey, number, relief, openings);
    return openings;
}

/// Of holes that may be windows behind blinds, or niches: only those are kept that look like a
/// window of the same building, since windows of a kind have one sill and one lintel.
void drop_niches(std::vector<WallOpening>& openings) {
    constexpr double alike = 0.1;
    const std::vector<WallOpening> all = openings;
    std::erase_if(openings, [&](const WallOpening& opening) {
        return opening.confidence <= unglazed &&
               std::none_of(all.begin(), all.end(), [&](const WallOpening& other) {
                   return other.type == OpeningType::window && other.storey == opening.storey &&
                          other.confidence > unglazed &&
                          std::abs(other.hole.bottom - opening.hole.bottom) <= alike &&
                          std::abs(other.hole.top - opening.hole.top) <= alike;
               });
    });
    for (WallOpening& opening : openings) {
        if (opening.confidence <= unglazed) opening.confidence = 0.7;
    }
}

/// Whether two openings are the two sides of one.
bool is_same(const WallOpening& a, const WallOpening& b, const RoomSurfaces& surfaces) {
    constexpr double max_thickness = 0.6;
    if (a.storey != b.storey || a.face == b.face) return false;
    const WallFace& face = surfaces.storeys[a.storey].faces[a.face];
    const WallFace& other = surfaces.storeys[b.storey].faces[b.face];
    if (std::abs(face.plane.normal.dot(other.plane.normal)) < std::cos(radians(15.0))) return false;
    const Vector3d middle =
        other.plane.offset * other.plane.normal + 0.5 * (b.hole.start + b.hole.end) * other.along;
    if (std::abs(face.plane.signed_distance(middle)) > max_thickness) return false;
    const double center = middle.dot(face.along);
    const double half = 0.5 * b.hole.width();
    const double overlap =
        std::min(center + half, a.hole.end) - std::max(center - half, a.hole.start);
    const double upright =
        std::min(a.hole.top, b.hole.top) - std::max(a.hole.bottom, b.hole.bottom);
    return overlap > 0.4 * std::min(a.hole.width(), b.hole.width()) &&
           upright > 0.4 * std::min(a.hole.height(), b.hole.height());
}

/// Which of two sides says more: a leaf that was seen, then the one that was seen better.
double merit(const WallOpening& opening) {
    return opening.confidence + 0.1 * opening.coverage;
}

/// The components of the openings, and the rooms that they lead to.
class ComponentBuilder {
  public:
    ComponentBuilder(RoomSurfaces& surfaces, const Vector3d& up) : surfaces_(surfaces), up_(up) {
        for (const RoomSurface& surface : surfaces.surfaces)
            next_instance_ = std::max(next_instance_, surface.component.instance + 1);
    }

    void add(WallOpening& opening, std::vector<Component>& components) {
        const StoreyLayout& layout = surfaces_.storeys[opening.storey];
        const WallFace& face = layout.faces[opening.face];
        const std::string wall = surfaces_.surfaces[layout.wall_of_face[opening.face]].component.id;
        const auto push = [&](Label label, const WallRectangle& rectangle, double depth) {
            Component component;
            component.label = label;
            const bool is_passage = label == Label::unknown;
            if (is_passage) component.kind = "opening";
            component.id = fmt::format("{}-{}", is_passage ? "opening" : label_name(label),
                                       ++counts_[static_cast<std::size_t>(label)]);
            component.instance = next_instance_++;
            component.parent = wall;
            const Vector3d on_plane = (face.plane.offset - depth) * face.plane.normal;
            const auto corner = [&](double along, double height) -> Vector3d {
                return on_plane + along * face.along + height * up_;
            };
            component.polygon = {
                corner(rectangle.start, rectangle.bottom), corner(rectangle.end, rectangle.bottom),
                corner(rectangle.end, rectangle.top), corner(rectangle.start, rectangle.top)};
            component.confidence = opening.confidence;
            component.verdict = opening.confidence >= 0.5 ? Verdict::accepted : Verdict::doubtful;
            component.evidence.coverage = opening.coverage;
            component.evidence.occluded = opening.hidden;
            component.evidence.rule = rule_of(opening);
            opening.components.push_back(components.size());
            components.push_back(std::move(component));
        };
        const WallRectangle& hole = opening.hole;
        const double width = opening.frame_width;
        switch (opening.type) {
            case OpeningType::window:
                push(Label::window, hole.grown(-width, -width, -width), opening.depth);
                push(Label::window_frame, hole, opening.frame_depth);
                break;
            case OpeningType::door:
                push(Label::door, hole, opening.depth);
                push(Label::door_frame, hole.grown(width, 0.0, width), casing_width);
                connect(opening, layout, components[opening.components[0]].id);
                break;
            case OpeningType::passage:
                push(Label::unknown, hole, opening.depth);
                connect(opening, layout, components[opening.components[0]].id);
                break;
        }
    }

  private:
    static std::string rule_of(const WallOpening& opening) {
        switch (opening.type) {
            case OpeningType::window:
                return "hole in the wall that rays pass through, above the floor";
            case OpeningType::passage:
                return "hole in the wall that stands on the floor, without a leaf";
            case OpeningType::door:
                break;
        }
        if (!opening.is_open) return "leaf of a door's size in the wall, on the floor";
        return opening.leaf_patches.empty() ? "hole of a door's size in the wall, on the floor"
                                            : "hole of a door's size in the wall and its open leaf";
    }

    void connect(const WallOpening& opening, const StoreyLayout& layout, const std::string& id) {
        const std::int32_t before = layout.faces[opening.face].room;
        if (before == no_room || opening.room_behind == no_room) return;
        const std::string& here = layout.room_ids[static_cast<std::size_t>(before)];
        const std::string& there = layout.room_ids[static_cast<std::size_t>(opening.room_behind)];
        for (Room& room : surfaces_.rooms) {
            if (room.id == here) room.neighbors.push_back({there, id});
            if (room.id == there) room.neighbors.push_back({here, id});
        }
    }

    RoomSurfaces& surfaces_;
    Vector3d up_;
    std::int32_t next_instance_ = 0;
    std::array<int, num_labels> counts_{};
};

}  // namespace

Openings find_openings(const ScanMap& map, const SurfaceSample& sample,
                       std::span<const PlanarPatch> patches, RoomSurfaces& surfaces,
                       const Eigen::Matrix3d& room_from_map, double point_spacing,
                       const Context& context) {
    const OpeningFinder finder(map, sample, patches, surfaces, room_from_map, point_spacing);
    std::vector<std::pair<std::size_t, std::size_t>> jobs;
    for (std::size_t storey = 0; storey < surfaces.storeys.size(); ++storey) {
        for (std::size_t face = 0; face < surfaces.storeys[storey].faces.size(); ++face)
            jobs.emplace_back(storey, face);
    }
    std::vector<std::vector<WallOpening>> found(jobs.size());
    parallel_for(context, jobs.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            found[i] = finder.look_at(jobs[i].first, jobs[i].second);
    });
    std::vector<WallOpening> sides;
    for (auto& of_face : found)
        std::move(of_face.begin(), of_face.end(), std::back_inserter(sides));
    std::stable_sort(sides.begin(), sides.end(), [](const WallOpening& a, const WallOpening& b) {
        return merit(a) > merit(b);
    });
    drop_niches(sides);
    Openings result;
    for (WallOpening& side : sides) {
        const bool is_known =
            std::any_of(result.openings.begin(), result.openings.end(),
                        [&](const WallOpening& known) { return is_same(known, side, surfaces); });
        if (!is_known) result.openings.push_back(std::move(side));
    }
    ComponentBuilder builder(surfaces, room_from_map.row(2).transpose());
    for (WallOpening& opening : result.openings)
        builder.add(opening, result.components);
    return result;
}

}  // namespace roomscribe
