// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/openings/flat_doors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "roomscribe/core/quantile.hpp"
#include "roomscribe/interpretation/openings/door_sizes.hpp"

namespace roomscribe {
namespace {

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
                if (cell.near > 0 && 2 * cell.near >= cell.surface + cell.open()) {
                    const double mean = static_cast<double>(cell.height) / cell.near;
                    // Levers stand out, and what hangs on the wall.
                    if (mean <= max_height) sum = {1.0, mean, mean * mean, 0.0};
                    if (cell.standing > cell.near) sum.covered = sum.count;
                }
                at(column + 1, row + 1) =
                    sum + at(column, row + 1) + at(column + 1, row) - at(column, row);
            }
        }
        measure_usual_shares();
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
    static constexpr double max_height = 0.05;  // m before the face
    /// m. Usual leaves (DIN 18101: 0.61 to 1.11 by 1.985 or 2.11), with a cell or two of error:
    /// narrower than what doors are that a hole shows (door_sizes.hpp).
    static constexpr double min_leaf_width = 0.6;
    static constexpr double max_flat_width = 1.15;
    static constexpr double min_leaf_height = 1.88;
    static constexpr double max_leaf_height = 2.2;
    /// By which the least step grows with each metre beyond the first: twice what walls may be more
    /// out of true over 4 m than over 1 m (8 and 3 mm, as for least_wall_step).
    static constexpr double min_step_per_metre = 0.0033;
    /// Standard errors of the difference of two strips; neighbouring cells err alike.
    static constexpr double min_errors = 3.0;
    static constexpr double correlated_cells = 8.0;
    /// m to either side, within which a wall is seen about as well.
    static constexpr double usual_reach = 1.0;
    /// Of the least step, what a leaf with a lever must show: no wall has one.
    static constexpr double least_with_lever = 0.5;
    /// m. Levers stand out 4 to 6 cm and are 2 cm thick: the mean of a cell that holds one.
    static constexpr double least_lever_height = 0.008;
    /// m above the floor (DIN 18040 asks for 0.85, usual is 1.05), and from the leaf's edge
    /// (backset of 55 to 65 mm, and a lever 12 to 14 cm long).
    static constexpr double lowest_lever = 0.8;
    static constexpr double highest_lever = 1.2;
    static constexpr double lever_reach = 0.25;
    /// Of a step, by how much the leaf itself may bend.
    static constexpr double max_bend = 0.4;

    struct Sum {
        double count = 0.0;
        double heights = 0.0;
        double squares = 0.0;
        double covered = 0.0;  ///< cells straight before which more was seen than on them

        Sum operator+(const Sum& other) const {
            return {count + other.count, heights + other.heights, squares + other.squares,
                    covered + other.covered};
        }
        Sum operator-(const Sum& other) const {
            return {count - other.count, heights - other.heights, squares - other.squares,
                    covered - other.covered};
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
    Sum sum_of(int left, int right, int low, int high) const {
        return at(right, high) - at(left, high) - at(right, low) + at(left, low);
    }
    /// Share of the cells of a column that rays were aimed at, up to a door's height, where they
    /// are most nearby: the lines of some scanners are far apart, the more so far away.
    void measure_usual_shares() {
        const int high = std::min(cells(min_leaf_height), relief_.num_rows);
        std::vector<double> shares;
        for (int column = 0; column < relief_.num_columns; ++column) {
            int aimed_at = 0;
            for (int row = 0; row < high; ++row) {
                const ReliefCell& cell = relief_.at(column, row);
                aimed_at += cell.near + cell.surface + cell.open() + cell.hidden > 0 ? 1 : 0;
            }
            shares.push_back(static_cast<double>(aimed_at) / high);
        }
        const int reach = cells(usual_reach);
        for (int column = 0; column < relief_.num_columns; ++column) {
            const int end = std::min(relief_.num_columns, column + reach + 1);
            std::vector<double> nearby(shares.begin() + std::max(0, column - reach),
                                       shares.begin() + end);
            usual_shares_.push_back(quantile(nearby, 0.75));
        }
    }
    double usual_share(int left, int right) const {
        return usual_shares_[static_cast<std::size_t>((left + right) / 2)];
    }
    /// Of columns [left, right) and rows [low, high), if more than half as much of it was seen as
    /// is usual there.
    std::optional<Sum> strip(int left, int right, int low, int high) const {
        if (left < 0 || low < 0 || right > relief_.num_columns || high > relief_.num_rows)
            return std::nullopt;
        if (right <= left || high <= low) return std::nullopt;
        const Sum sum = sum_of(left, right, low, high);
        const double usual = usual_share(left, right) * (right - left) * (high - low);
        if (sum.count < 0.5 * usual || sum.count < 4.0) return std::nullopt;
        return sum;
    }
    /// How much the first strip lies before the second, in the least step that counts.
    static double step(const Sum& a, const Sum& b, double least) {
        const double error = std::sqrt(a.variance_of_mean() + b.variance_of_mean());
        return (a.mean() - b.mean()) / std::max(least, min_errors * error);
    }

    /// The strips along one edge of a leaf, from within outwards.
    struct Side {
        std::optional<Sum> leaf, casing, wall;
        bool is_corner = false;  ///< the wall ends closely beside the leaf
    };

    /// Left or right of a leaf. Beside a corner there is less wall, or nothing but a casing.
    Side side_of(const CellRectangle& door, bool is_left) const {
        const int gap = 1;  // cells half on either side
        const int casing = cells(0.1);
        const int inner = cells(0.2);
        const int outer = cells(0.15);
        const int low = cells(0.15);                 // above skirtings
        const auto beside = [&](int from, int to) {  // outwards of the leaf
            return is_left ? strip(door.left - to, door.left - from, low, door.high)
                           : strip(door.right + from, door.right + to, low, door.high);
        };
        const int columns = is_left ? door.left : relief_.num_columns - door.right;
        Side side;
        side.leaf = beside(-gap - inner, -gap);
        side.is_corner = relief_.has_rays && columns <= casing;
        side.casing = side.is_corner ? std::nullopt : beside(0, casing - gap);
        side.wall = side.is_corner ? beside(0, columns - gap)
                                   : beside(casing, std::min(columns, casing + outer));
        return side;
    }

    /// Of a leaf: left, right, above.
    std::array<Side, 3> sides_of(const CellRectangle& door) const {
        const int gap = 1;
        const int casing = cells(0.1);
        const int high = door.high;
        Side above;
        above.leaf = strip(door.left, door.right, high - gap - cells(0.2), high - gap);
        above.casing = strip(door.left, door.right, high, high + casing - gap);
        above.wall = strip(door.left, door.right, high + casing, high + casing + cells(0.15));
        return {side_of(door, true), side_of(door, false), above};
    }

    /// Nothing but a few cells was seen above.
    bool is_top_unseen(const CellRectangle& door) const {
        const int high = std::min(relief_.num_rows, door.high + cells(0.25));
        if (high <= door.high) return true;
        return sum_of(door.left, door.right, door.high, high).count <
               0.1 * usual_share(door.left, door.right) * (door.right - door.left) *
                   (high - door.high);
    }

    /// Whether all of a leaf lies `height` before the wall: boards and pictures hang above the
    /// floor and are smaller. Of quarters of its height and halves of its width, most must be seen,
    /// and one at the floor, where a desk may hide that a board ends above it.
    bool is_even(const CellRectangle& door, const Sum& leaf, double height) const {
        constexpr int rows = 4;
        constexpr int columns = 2;
        constexpr int min_seen = 5;
        const int low = cells(0.1);
        int num_seen = 0;
        int num_at_floor = 0;
        for (int i = 0; i < rows * columns; ++i) {
            const int row = i / columns;
            const int column = i % columns;
            const int wide = door.right - door.left - 2;
            const int high = door.high - 1 - low;
            const auto part = strip(door.left + 1 + wide * column / columns,
                                    door.left + 1 + wide * (column + 1) / columns,
                                    low + high * row / rows, low + high * (row + 1) / rows);
            if (!part) continue;
            if (std::abs(part->mean() - leaf.mean()) > max_bend * height) return false;
            ++num_seen;
            num_at_floor += row == 0 ? 1 : 0;
        }
        return num_seen >= min_seen && num_at_floor > 0;
    }

    /// By how many least steps a leaf stands before the wall on all its sides, as rebated ones do
    /// on the side that they open to. The wall above must be seen: piers between two recesses go
    /// on up there. A corner closely beside the leaf hides one side.
    double proud_contrast(const CellRectangle& door, const Sum& leaf,
                          const std::array<Side, 3>& sides, double least) const {
        if (leaf.covered > max_covered * leaf.count) return 0.0;
        double contrast = std::numeric_limits<double>::infinity();
        double lowest = most_proud;
        int num_hidden = 0;
        for (const Side& side : sides) {
            if (!side.wall && side.is_corner && side.leaf) {
                ++num_hidden;
                continue;
            }
            if (!side.leaf || !side.wall) return 0.0;
            const double height = side.leaf->mean() - side.wall->mean();
            if (std::abs(side.leaf->mean() - leaf.mean()) > max_bend * height) return 0.0;
            lowest = std::min(lowest, height);
            if (height > most_proud) return 0.0;
            contrast = std::min(contrast, step(*side.leaf, *side.wall, least));
            if (contrast < 1.0) return 0.0;
        }
        return num_hidden <= 1 && is_even(door, leaf, lowest) ? contrast : 0.0;
    }

    /// By how many least steps a leaf lies deeper than the wall on its sides, or its casing stands
    /// out.
    double recessed_contrast(const CellRectangle& door, const Sum& leaf,
                             const std::array<Side, 3>& sides, double least) const {
        // A scanner that cannot look up sees no lintel; of one that shows in part, casings on both
        // sides make up for it.
        const bool is_top_seen = sides[2].leaf && sides[2].wall;
        double lower = std::numeric_limits<double>::infinity();
        double cased = lower;
        int num_hidden = 0;
        for (std::size_t i = 0; i < (is_top_seen ? 3 : 2); ++i) {
            const Side& side = sides[i];
            if (!side.wall && side.is_corner && side.leaf && is_top_seen) {
                ++num_hidden;
                continue;
            }
            if (!side.leaf || !side.wall) return 0.0;
            // What stands before what is beside it is wall between two doors.
            const double depth = side.wall->mean() - side.leaf->mean();
            if (depth <= -0.5 * least_wall_step) return 0.0;
            const bool is_flat = std::abs(side.leaf->mean() - leaf.mean()) <= max_bend * depth;
            lower = std::min(lower, is_flat ? -step(*side.leaf, *side.wall, least) : 0.0);
            cased = std::min(cased, side.casing
                                        ? std::min(step(*side.casing, *side.wall, least_wall_step),
                                                   step(*side.casing, *side.leaf, least_wall_step))
                                        : 0.0);
        }
        if (num_hidden > 1) return 0.0;
        // Two leaves side by side are told by the casing around them: wide pieces of wall between
        // others lie deeper as well.
        const bool needs_casing =
            width_of(door) > max_flat_width || (!is_top_seen && !is_top_unseen(door));
        return needs_casing ? cased : std::max(lower, cased);
    }

    double contrast_of(const CellRectangle& door, const Sum& leaf, const std::array<Side, 3>& sides,
                       double least) const {
        return std::max(proud_contrast(door, leaf, sides, least),
                        recessed_contrast(door, leaf, sides, least));
    }

    /// Whether what stands out of a leaf is as small as a lever, beside one edge, at a lever's
    /// height. Noise stands out anywhere.
    bool has_lever(const CellRectangle& door, const Sum& leaf) const {
        constexpr int min_cells = 2;
        constexpr double max_elsewhere = 0.3;
        const double level = leaf.mean() + least_lever_height;
        const int reach = cells(lever_reach);
        int num_left = 0;
        int num_right = 0;
        int num_all = 0;
        for (int row = cells(0.15); row < door.high - 1; ++row) {
            const double above_floor = (row + 0.5) * relief_.cell_size;
            const bool is_at_height = above_floor >= lowest_lever && above_floor <= highest_lever;
            for (int column = door.left + 1; column < door.right - 1; ++column) {
                const ReliefCell& cell = relief_.at(column, row);
                if (cell.near == 0 || cell.height < level * cell.near) continue;
                ++num_all;
                num_left += is_at_height && column < door.left + reach ? 1 : 0;
                num_right += is_at_height && column >= door.right - reach ? 1 : 0;
            }
        }
        const int num_lever = std::max(num_left, num_right);
        return num_lever >= min_cells && num_all - num_lever <= max_elsewhere * num_lever;
    }

    double width_of(const CellRectangle& door) const {
        return (door.right - door.left) * relief_.cell_size;
    }

    std::optional<FlatDoor> look_at(const CellRectangle& door) const {
        const int gap = 1;
        const auto leaf = strip(door.left + gap, door.right - gap, cells(0.15), door.high - gap);
        if (!leaf) return std::nullopt;
        const std::array<Side, 3> sides = sides_of(door);
        const double least =
            least_wall_step + min_step_per_metre * std::max(0.0, width_of(door) - 1.0);
        double contrast = contrast_of(door, *leaf, sides, least);
        if (contrast < 1.0) {
            contrast = contrast_of(door, *leaf, sides, least_with_lever * least);
            if (contrast >= 1.0 && !has_lever(door, *leaf)) return std::nullopt;
        }
        if (contrast < 1.0) return std::nullopt;
        const bool is_top_seen = sides[2].leaf && sides[2].wall;
        double height = 0.0;
        int num_sides = 0;
        for (std::size_t i = 0; i < (is_top_seen ? 3 : 2); ++i) {
            if (!sides[i].wall) continue;
            height += sides[i].leaf->mean() - sides[i].wall->mean();
            ++num_sides;
        }
        return FlatDoor{door, height / num_sides, contrast, is_top_seen};
    }

    const WallRelief& relief_;
    std::vector<Sum> sums_;
    std::vector<double> usual_shares_;  ///< by column
};

}  // namespace

std::vector<FlatDoor> find_flat_doors(const WallRelief& relief) {
    return FlatDoorSearch(relief).run();
}

}  // namespace roomscribe
