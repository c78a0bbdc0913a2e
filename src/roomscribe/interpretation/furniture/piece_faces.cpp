// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/furniture/piece_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "roomscribe/core/quantile.hpp"

namespace roomscribe {
namespace {

/// m: fronts are 16 to 22 mm thick, behind them is the carcass; the gap's floor is no deeper.
constexpr double max_gap_depth = 0.05;
/// m: rays that enter a gap of 4 mm aslant end on its side a little behind the face.
constexpr double min_gap_depth = 0.0025;
/// m: drawers are 0.1 high at least, doors 0.2 wide.
constexpr double min_panel_height = 0.09;
constexpr double min_panel_width = 0.18;
/// m: single doors are not wider (docs/furniture.md).
constexpr double max_door_width = 0.65;
/// m: fronts of drawers are lower, doors higher.
constexpr double max_drawer_height = 0.42;
/// m2: less is no front.
constexpr double min_front_area = 0.04;
/// Points of a front side; fewer tell no edges.
constexpr std::size_t min_points = 40;

/// A point of a front side: m along, m above, m behind the plane.
struct SidePoint {
    float along;
    float above;
    float depth;
};

/// A line that parts a panel.
struct GapLine {
    bool is_upright = false;
    double at = 0.0;
    double score = 0.0;
};

/// Deviations of the face's noise that a point in a gap lies deeper at least.
constexpr double min_deviations = 2.5;

/// Whether points in gaps can be told from the face's noise: a gap is as deep as doors are thick.
bool shows_gaps(double noise) {
    constexpr double door_thickness = 0.019;  // m: chipboard of doors and drawers is 16 to 19 mm
    return min_deviations * noise <= door_thickness;
}

class PanelParter {
  public:
    PanelParter(std::span<const SidePoint> points, double noise, std::vector<WallRectangle>& panels)
        : points_(points),
          gap_depth_(std::max(min_gap_depth, min_deviations * noise)),
          panels_(panels) {}

    void part(const WallRectangle& panel) {
        std::optional<GapLine> best;
        for (const bool is_upright : {true, false}) {
            const std::optional<GapLine> line = find_gap(panel, is_upright);
            if (line && (!best || line->score > best->score)) best = line;
        }
        if (!best) {
            panels_.push_back(panel);
            return;
        }
        WallRectangle low = panel;
        WallRectangle high = panel;
        if (best->is_upright) {
            low.end = high.start = best->at;
        } else {
            low.top = high.bottom = best->at;
        }
        part(low);
        part(high);
    }

  private:
    static constexpr std::size_t num_segments = 6;
    static constexpr double bin_width = 0.01;  // m: a gap and the beam's width

    struct Bin {
        std::array<std::uint32_t, num_segments> deep{};
        std::uint32_t num_deep = 0;
        std::uint32_t num = 0;
    };

    /// Of how many lines are looked at (some hundred), one in a hundred faces may show a false one:
    /// a chance of exp(-score) each (Chernoff's bound for a Poisson variable).
    static constexpr double min_score = 9.0;

    /// Whether few points lie deep right beside a line: a gap and the beam are no wider than 15 mm,
    /// waves and steps of a depth camera's noise are.
    static bool is_narrow(const std::vector<Bin>& bins, std::size_t at, double share) {
        constexpr std::size_t away = 2;
        constexpr double max_share = 0.5;
        for (const std::size_t i : {at - 1 - away, at + away}) {
            const Bin& bin = bins[i];
            if (bin.num_deep > max_share * share * static_cast<double>(bin.num)) return false;
        }
        return true;
    }

    /// The clearest line from edge to edge along which more points lie deep than elsewhere.
    std::optional<GapLine> find_gap(const WallRectangle& panel, bool is_upright) const {
        const double extent = is_upright ? panel.width() : panel.height();
        const double length = is_upright ? panel.height() : panel.width();
        const double least = is_upright ? min_panel_width : min_panel_height;
        if (extent < 2.0 * least || length < least) return std::nullopt;
        const auto num_bins = static_cast<std::size_t>(extent / bin_width) + 1;
        std::vector<Bin> bins(num_bins);
        std::size_t num_deep = 0;
        std::size_t num = 0;
        for (const SidePoint& point : points_) {
            const double along = static_cast<double>(point.along);
            const double above = static_cast<double>(point.above);
            if (along < panel.start || along > panel.end || above < panel.bottom ||
                above > panel.top) {
                continue;
            }
            const double across = is_upright ? along - panel.start : above - panel.bottom;
            const double on_line = is_upright ? above - panel.bottom : along - panel.start;
            Bin& bin = bins[std::min(static_cast<std::size_t>(across / bin_width), num_bins - 1)];
            ++bin.num;
            ++num;
            if (static_cast<double>(point.depth) < gap_depth_) continue;
            ++bin.num_deep;
            ++num_deep;
            ++bin.deep[std::min(static_cast<std::size_t>(on_line / length * num_segments),
                                num_segments - 1)];
        }
        if (num_deep < num_segments) return std::nullopt;
        // How many points are deep elsewhere: of the three quarters of the bins with the fewest.
        std::vector<std::pair<double, std::uint32_t>> shares;
        for (const Bin& bin : bins) {
            if (bin.num > 0)
                shares.emplace_back(bin.num_deep / static_cast<double>(bin.num), bin.num);
        }
        std::sort(shares.begin(), shares.end());
        double deep_elsewhere = 1.0;
        double elsewhere = 1.0;
        for (std::size_t i = 0; i < 3 * shares.size() / 4; ++i) {
            deep_elsewhere += shares[i].first * shares[i].second;
            elsewhere += shares[i].second;
        }
        const double share = deep_elsewhere / elsewhere;
        std::optional<GapLine> best;
        const auto margin = static_cast<std::size_t>(least / bin_width);
        for (std::size_t i = margin; i + margin < num_bins; ++i) {
            // Two bins, for the line may lie on their border.
            const Bin& a = bins[i];
            const Bin& b = bins[i - 1];
            const double deep = a.num_deep + b.num_deep;
            const double expected = share * (a.num + b.num);
            if (deep <= expected) continue;
            const double score = deep * std::log(deep / expected) - (deep - expected);
            std::size_t segments = 0;
            for (std::size_t k = 0; k < num_segments; ++k)
                segments += a.deep[k] + b.deep[k] > 0 ? 1U : 0U;
            if (score < min_score || segments + 2 < num_segments) continue;
            if (!is_narrow(bins, i, deep / std::max(1.0, static_cast<double>(a.num + b.num))))
                continue;
            if (!best || score > best->score) {
                const double at = bin_width * static_cast<double>(i);
                best = GapLine{is_upright, at + (is_upright ? panel.start : panel.bottom), score};
            }
        }
        return best;
    }

    std::span<const SidePoint> points_;
    double gap_depth_;
    std::vector<WallRectangle>& panels_;
};

/// Where most points on the plane lie: without the hundredth part at either end, which may be
/// strays.
WallRectangle extent_of(std::span<const SidePoint> points, double tolerance) {
    std::vector<float> along;
    std::vector<float> above;
    for (const SidePoint& point : points) {
        if (std::abs(static_cast<double>(point.depth)) > tolerance) continue;
        along.push_back(point.along);
        above.push_back(point.above);
    }
    constexpr double strays = 0.005;
    const auto at = [](std::vector<float>& values, double share) {
        return static_cast<double>(quantile(values, share));
    };
    return {at(along, strays), at(along, 1.0 - strays), at(above, strays), at(above, 1.0 - strays)};
}

}  // namespace

PanelKind kind_of_panel(const WallRectangle& extent, bool is_whole) {
    const bool is_drawer =
        extent.height() <= max_drawer_height && extent.width() >= 0.8 * extent.height();
    PanelKind kind;
    kind.may_be_several =
        is_drawer ? extent.width() > 2.0 * max_door_width : extent.width() > max_door_width;
    // A chest of drawers is as wide as high; so is a pair of low doors.
    kind.may_be_several = kind.may_be_several || (!is_drawer && extent.height() > 0.5 && is_whole);
    kind.name = kind.may_be_several ? "front" : is_drawer ? "drawer" : "door";
    return kind;
}

std::optional<FrontSide> find_front_side(const FurnitureVoxels& all, const PieceDraft& draft,
                                         const PieceForm& form,
                                         std::span<const PlanarPatch> patches,
                                         const Eigen::Matrix3d& room_from_map,
                                         const Eigen::Vector3d& to_room) {
    const Eigen::Vector3d up = room_from_map.row(2).transpose();
    const Eigen::Vector2d center = form.rectangle.center;
    std::map<std::uint32_t, std::size_t> size_of_patch;
    for (const std::uint32_t i : draft.voxels) {
        const FurnitureVoxel& voxel = all.voxels[i];
        if (voxel.patch != off_patch && voxel.is_upright) ++size_of_patch[voxel.patch];
    }
    std::optional<FrontSide> best;
    std::size_t most = 0;
    for (const auto& [patch, size] : size_of_patch) {
        if (size <= most) continue;
        Plane plane = patches[patch].plane;
        Eigen::Vector3d normal = plane.normal - plane.normal.dot(up) * up;
        normal.normalize();
        // Off the piece: to the side of its middle on which the patch lies.
        const Eigen::Vector3d turned = room_from_map * patches[patch].centroid;
        const Eigen::Vector2d level = (room_from_map * normal).head<2>();
        if ((turned.head<2>() - center).dot(level) < 0.0) normal = -normal;
        constexpr double aside = 0.7;
        if (to_room.squaredNorm() > 0.5 && normal.dot(to_room) < aside) continue;
        FrontSide side;
        side.plane = {normal, normal.dot(patches[patch].centroid)};
        side.along = up.cross(normal);
        best = std::move(side);
        most = size;
    }
    const double cell_area = 0.25 * all.reach * all.reach;
    if (!best || cell_area * static_cast<double>(most) < min_front_area) return std::nullopt;
    const Eigen::Vector3d normal = room_from_map * best->plane.normal;
    for (const std::uint32_t i : draft.voxels) {
        const double height = normal.dot(all.voxels[i].place) - best->plane.offset;
        if (std::abs(height) <= max_gap_depth) best->voxels.push_back(all.voxels[i].voxel);
    }
    return best;
}

bool closes_piece(const FurnitureVoxels& all, const PieceDraft& draft, const PieceForm& form,
                  const FrontSide& side, const Eigen::Matrix3d& room_from_map) {
    constexpr double min_height = 0.2;
    constexpr double min_share = 0.5;
    const Eigen::Vector3d normal = room_from_map * side.plane.normal;
    const Eigen::Vector3d along = room_from_map * side.along;
    constexpr double column_width = 0.1;
    std::map<int, std::size_t> columns;
    for (const std::uint32_t i : draft.voxels) {
        const FurnitureVoxel& voxel = all.voxels[i];
        const double off = normal.dot(voxel.place) - side.plane.offset;
        if (!voxel.is_upright || std::abs(off) > max_gap_depth || voxel.height >= form.seat)
            continue;
        ++columns[static_cast<int>(std::floor(along.dot(voxel.place) / column_width))];
    }
    const double cell_area = 0.25 * all.reach * all.reach;
    const auto num_closed = std::count_if(columns.begin(), columns.end(), [&](const auto& column) {
        return cell_area * static_cast<double>(column.second) >= min_height * column_width;
    });
    const PlanRectangle& plan = form.rectangle;
    const double length = plan.length * std::abs(plan.axis.dot(along.head<2>())) +
                          plan.width * std::abs(plan.across().dot(along.head<2>()));
    return column_width * static_cast<double>(num_closed) >= min_share * length;
}

std::vector<FrontPanel> find_front_panels(const PointCloud& map, const SurfaceSample& sample,
                                          std::span<const FrontSide> sides,
                                          const Eigen::Vector3d& up) {
    std::vector<std::int32_t> side_of_voxel(sample.cloud.size(), -1);
    for (std::size_t s = 0; s < sides.size(); ++s) {
        for (const std::uint32_t voxel : sides[s].voxels)
            side_of_voxel[voxel] = static_cast<std::int32_t>(s);
    }
    std::vector<std::vector<SidePoint>> points(sides.size());
    for (std::size_t i = 0; i < map.size(); ++i) {
        const std::uint32_t voxel = sample.voxel_of_point[i];
        if (voxel == no_voxel || side_of_voxel[voxel] < 0) continue;
        const auto s = static_cast<std::size_t>(side_of_voxel[voxel]);
        const Eigen::Vector3d point = map.positions[i].cast<double>();
        const double depth = -sides[s].plane.signed_distance(point);
        if (std::abs(depth) > max_gap_depth) continue;
        points[s].push_back({static_cast<float>(sides[s].along.dot(point)),
                             static_cast<float>(up.dot(point)), static_cast<float>(depth)});
    }
    std::vector<FrontPanel> panels;
    for (std::size_t s = 0; s < sides.size(); ++s) {
        if (points[s].size() < min_points) continue;
        std::vector<float> depths;
        for (const SidePoint& point : points[s])
            depths.push_back(std::abs(point.depth));
        // From the median of the deviations, which the gaps do not reach.
        const double noise = 1.48 * static_cast<double>(median(depths));
        const WallRectangle whole = extent_of(points[s], std::max(0.006, 3.0 * noise));
        if (whole.area() < min_front_area) continue;
        std::vector<WallRectangle> parts;
        if (shows_gaps(noise)) {
            PanelParter(points[s], noise, parts).part(whole);
        } else {
            parts.push_back(whole);
        }
        for (const WallRectangle& part : parts) {
            FrontPanel panel;
            panel.side = s;
            panel.extent = part;
            panel.rms = noise;
            const PanelKind kind = kind_of_panel(part, parts.size() == 1);
            panel.may_be_several = kind.may_be_several;
            panel.kind = kind.name;
            panels.push_back(panel);
        }
    }
    return panels;
}

}  // namespace roomscribe
