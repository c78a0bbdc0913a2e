// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/openings/wall_holes.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "roomscribe/core/quantile.hpp"

namespace roomscribe {
namespace {

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
                    target.outdoors += near.outdoors;
                    target.near += near.near;
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
        join_parts(holes);
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

    /// Cells between the lines of a scanner, from line to line upwards, that it leaves unseen.
    int gap_between_lines() const {
        constexpr int least = 2;
        const int most = std::max(least, static_cast<int>(0.5 / relief_.cell_size));
        std::vector<int> gaps;
        for (int column = 0; column < relief_.num_columns; ++column) {
            int last = -1;
            for (int row = 0; row < relief_.num_rows; ++row) {
                const ReliefCell& cell = relief_.at(column, row);
                if (cell.surface + cell.open() == 0) continue;
                if (last >= 0) gaps.push_back(row - last);
                last = row;
            }
        }
        return gaps.empty() ? least : std::clamp(quantile(gaps, 0.9) + 1, least, most);
    }

    /// Groups of open cells; cells that nothing was seen of do not part them.
    void find_groups() {
        group_.assign(relief_.cells.size(), -1);
        // What stands before a window hides a part of it, from top to bottom more often than
        // from side to side.
        const int reach_across = std::max(2, static_cast<int>(0.5 / relief_.cell_size));
        const int reach_up = gap_between_lines();
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

    /// What stands before a hole, or lies in it, parts it: holes one over the other, as wide, with
    /// no wall between them are one.
    void join_parts(std::vector<CellRectangle>& holes) const {
        const int most_apart = std::max(2, static_cast<int>(0.5 / relief_.cell_size));
        for (std::size_t i = 0; i < holes.size(); ++i) {
            for (std::size_t j = 0; j < holes.size();) {
                if (j == i || !are_parts(holes[i], holes[j], most_apart)) {
                    ++j;
                    continue;
                }
                holes[i].left = std::min(holes[i].left, holes[j].left);
                holes[i].right = std::max(holes[i].right, holes[j].right);
                holes[i].high = holes[j].high;
                holes[i].sum += holes[j].sum;
                holes.erase(holes.begin() + static_cast<std::ptrdiff_t>(j));
                if (j < i) --i;
                j = 0;
            }
        }
    }

    bool are_parts(const CellRectangle& lower, const CellRectangle& upper, int most_apart) const {
        if (upper.low < lower.high || upper.low - lower.high > most_apart) return false;
        // A cell on either side may be lost to the edge.
        if (std::abs(lower.left - upper.left) > 1 || std::abs(lower.right - upper.right) > 1)
            return false;
        int wall = 0;
        int cells = 0;
        for (int row = lower.high; row < upper.low; ++row) {
            for (int column = lower.left; column < lower.right; ++column) {
                wall += is_wall(relief_.at(column, row)) ? 1 : 0;
                ++cells;
            }
        }
        return 4 * wall <= cells;
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
    if (!rim.empty()) {
        depths.rim = median(rim);
        constexpr double reach = 2.0 * depth_bin;  // noise, and a sash that is not in one plane
        depths.rim_at_depth =
            static_cast<double>(std::count_if(
                rim.begin(), rim.end(),
                [&](double depth) { return std::abs(depth - *depths.rim) <= reach + 1e-9; })) /
            static_cast<double>(rim.size());
    }
    if (!middle.empty()) depths.middle = median(middle);
    return depths;
}

/// How many rays meet a cell in a hole's middle, in those that meet one along its sides: panes
/// return few, frames all. 1 where too few met the sides to tell, or nobody knows which did.
double measure_thinning(const WallRelief& relief, const CellRectangle& hole) {
    if (!relief.has_rays) return 1.0;
    constexpr double min_rays = 3.0;
    constexpr double frame_width = 0.08;  // m; 50 to 120 mm
    const int frame = std::max(1, static_cast<int>(std::lround(frame_width / relief.cell_size)));
    std::vector<double> sides;
    std::vector<double> middle;
    // The outermost cells are half wall.
    for (int row = hole.low + 1; row < hole.high - 1; ++row) {
        for (int column = hole.left + 1; column < hole.right - 1; ++column) {
            const int inwards = std::min(
                {row - hole.low, hole.high - 1 - row, column - hole.left, hole.right - 1 - column});
            const ReliefCell& cell = relief.at(column, row);
            if (cell.hidden > cell.open()) continue;
            (inwards <= frame ? sides : middle).push_back(cell.surface + cell.open());
        }
    }
    if (sides.empty() || middle.empty()) return 1.0;
    const double usual = median(sides);
    return usual >= min_rays ? median(middle) / usual : 1.0;
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

/// Share of the left, right and upper edge of a hole with something behind the face within a cell
/// of it, as reveals are.
double measure_lining(const WallRelief& relief, const CellRectangle& hole) {
    int lined = 0;
    int count = 0;
    const auto look = [&](int column, int row, int dx, int dy) {
        bool is_lined = false;
        for (int step = -1; step <= 1; ++step) {
            const int x = column + step * dx;
            const int y = row + step * dy;
            if (x < 0 || y < 0 || x >= relief.num_columns || y >= relief.num_rows) continue;
            is_lined = is_lined || relief.at(x, y).recess > 0;
        }
        ++count;
        lined += is_lined ? 1 : 0;
    };
    for (int row = hole.low; row < hole.high; ++row) {
        look(hole.left, row, 1, 0);
        look(hole.right - 1, row, 1, 0);
    }
    for (int column = hole.left; column < hole.right; ++column)
        look(column, hole.high - 1, 0, 1);
    return static_cast<double>(lined) / std::max(1, count);
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

}  // namespace

std::vector<CellRectangle> find_wall_holes(const WallRelief& relief) {
    const WallRelief filled = fill_gaps(relief);
    return HoleFinder(filled).run();
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
    double outdoors = 0.0;
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
                outdoors += weight * cell.outdoors;
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
    evidence.outdoors = outdoors / std::max(through, 1e-9);
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
    evidence.thinned = measure_thinning(relief, hole);
    evidence.lining = measure_lining(relief, hole);
    return evidence;
}

double HoleEvidence::frame_depth() const {
    const double side = depths.rim.value_or(depth);
    // No frame lies behind its pane: of few points, most may have passed beside it. And no pane
    // lies so far behind its frame: along the sides a deep reveal was seen.
    return sunk() < 0.0 ? std::min(side, depth) : depth > side + most_sinking ? depth : side;
}

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

bool is_flush_pane(const HoleEvidence& evidence) {
    constexpr double min_rim = 0.9;
    constexpr double min_seen_through = 0.5;
    for (const HoleSide side : {HoleSide::left, HoleSide::right, HoleSide::bottom}) {
        if (evidence.rim_of(side).value_or(0.0) < min_rim) return false;
    }
    return evidence.framed < min_framed && evidence.through_share >= min_seen_through;
}

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

int top_of_blind(const WallRelief& relief, const CellRectangle& hole) {
    constexpr double least_standoff = 0.03;  // m; casings and pictures stand out less
    constexpr double min_filled = 0.7;
    constexpr double max_beside = 0.3;
    // A blind hangs over a hole's sides by less.
    const int beside = std::max(1, static_cast<int>(std::lround(0.15 / relief.cell_size)));
    const auto share = [&](int row, int first, int last) {
        double seen = 0.0;
        double proud = 0.0;
        for (int column = std::max(0, first); column < std::min(relief.num_columns, last);
             ++column) {
            const ReliefCell& cell = relief.at(column, row);
            if (cell.near == 0) continue;
            ++seen;
            proud += cell.height > static_cast<float>(least_standoff * cell.near) ? 1.0 : 0.0;
        }
        return proud / std::max(seen, 1.0);
    };
    int top = hole.high;
    // The lowest slat may end within a row.
    for (int row = hole.high; row < relief.num_rows && row <= top + 1; ++row) {
        if (share(row, hole.left + 1, hole.right - 1) >= min_filled &&
            share(row, hole.left - 2 * beside, hole.left - beside) <= max_beside &&
            share(row, hole.right + beside, hole.right + 2 * beside) <= max_beside) {
            top = row + 1;
        }
    }
    return top;
}

std::optional<double> measure_frame(const WallRelief& relief, const CellRectangle& hole) {
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
    if (left >= middle || right <= middle) return std::nullopt;
    const double width =
        0.5 * relief.cell_size * static_cast<double>(left - hole.left + hole.right - 1 - right);
    return width >= 0.04 && width <= 0.12 ? std::optional(width) : std::nullopt;
}

}  // namespace roomscribe
