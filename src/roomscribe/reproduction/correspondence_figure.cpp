// SPDX-License-Identifier: MIT
#include "roomscribe/reproduction/correspondence_figure.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "roomscribe/core/units.hpp"

namespace roomscribe {
namespace {

// Pixels.
constexpr double panel_width = 900.0;
constexpr double margin = 24.0;
constexpr double gap = 60.0;  ///< between the two scans
constexpr double caption_height = 34.0;

Eigen::Vector2d seen_from_above(const Eigen::Vector3d& point) {
    return {-point.y(), -point.x()};
}

struct DrawnScan {
    std::vector<Eigen::Vector2d> level;    ///< floors and table tops
    std::vector<Eigen::Vector2d> upright;  ///< walls and all that stands
};

DrawnScan sort_points(const PaperScan& scan) {
    DrawnScan drawn;
    for (std::size_t i = 0; i < scan.positions.size(); ++i) {
        const float up = scan.normals[i].z();
        if (up < -0.7F) continue;  // ceiling
        (up > 0.7F ? drawn.level : drawn.upright)
            .push_back(seen_from_above(scan.positions[i].cast<double>()));
    }
    return drawn;
}

/// Without the few points beyond windows and doors, which would leave the room a speck.
Eigen::AlignedBox2d frame_of(const DrawnScan& scan) {
    Eigen::AlignedBox2d frame(Eigen::Vector2d::Zero());  // the scanner is in the picture
    for (const int axis : {0, 1}) {
        std::vector<double> values;
        for (const auto* points : {&scan.level, &scan.upright}) {
            for (const Eigen::Vector2d& point : *points)
                values.push_back(point[axis]);
        }
        std::sort(values.begin(), values.end());
        if (values.empty()) continue;
        const std::size_t cut = values.size() / 50;
        Eigen::Vector2d corner = frame.min();
        corner[axis] = values[cut];
        frame.extend(corner);
        corner[axis] = values[values.size() - 1 - cut];
        frame.extend(corner);
    }
    const Eigen::Vector2d border = Eigen::Vector2d::Constant(0.2);
    return {frame.min() - border, frame.max() + border};
}

/// Where a scan stands in a panel.
struct Placement {
    Eigen::AlignedBox2d frame;  ///< m
    Eigen::Vector2d corner;     ///< px, upper left
    double scale = 1.0;         ///< px per m

    Eigen::Vector2d operator()(const Eigen::Vector2d& point) const {
        return corner + scale * (point - frame.min());
    }
};

struct Layout {
    Placement target;
    Placement source;
    double panel_height = 0.0;
};

Layout lay_out(const DrawnScan& target, const DrawnScan& source) {
    Layout layout;
    layout.target.frame = frame_of(target);
    layout.source.frame = frame_of(source);
    const Eigen::Vector2d target_size = layout.target.frame.sizes();
    const Eigen::Vector2d source_size = layout.source.frame.sizes();
    const double scale = (panel_width - 2.0 * margin - gap) / (target_size.x() + source_size.x());
    const double height = scale * std::max(target_size.y(), source_size.y());
    layout.target.scale = layout.source.scale = scale;
    layout.target.corner << margin, caption_height + 0.5 * (height - scale * target_size.y());
    layout.source.corner << margin + scale * target_size.x() + gap,
        caption_height + 0.5 * (height - scale * source_size.y());
    layout.panel_height = caption_height + height + 2.0 * margin;
    return layout;
}

/// One dot per pixel: a wall has many points one above the other.
void append_dots(std::string& svg, const std::vector<Eigen::Vector2d>& points,
                 const Placement& place, const char* color) {
    std::set<std::pair<long, long>> pixels;
    for (const Eigen::Vector2d& point : points) {
        if (!place.frame.contains(point)) continue;
        const Eigen::Vector2d at = place(point);
        pixels.emplace(std::lround(at.y()), std::lround(at.x()));
    }
    fmt::format_to(std::back_inserter(svg), "<path stroke=\"{}\" d=\"", color);
    for (const auto& [y, x] : pixels)
        fmt::format_to(std::back_inserter(svg), "M{} {}h0", x, y);
    svg += "\"/>\n";
}

void append_scan(std::string& svg, const DrawnScan& scan, const Placement& place) {
    append_dots(svg, scan.level, place, "#dcdfe4");
    append_dots(svg, scan.upright, place, "#7b8494");
    const Eigen::Vector2d at = place(Eigen::Vector2d::Zero());
    fmt::format_to(std::back_inserter(svg),
                   "<path d=\"M{:.1f} {:.1f}l6 15h-12z\" fill=\"#1f2430\"/>\n", at.x(),
                   at.y() - 9.0);
}

void append_name(std::string& svg, const std::string& name, const Placement& place,
                 double panel_height) {
    fmt::format_to(std::back_inserter(svg),
                   "<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"12\" text-anchor=\"middle\" "
                   "fill=\"#1f2430\">{}</text>\n",
                   place.corner.x() + 0.5 * place.scale * place.frame.sizes().x(),
                   panel_height - margin + 4.0, name);
}

/// About z.
std::string describe_turn(const std::optional<Transform>& target_from_source) {
    if (!target_from_source) return "";
    const Eigen::Matrix3d& turn = target_from_source->linear();
    return fmt::format(", turned by {:.0f}\u00b0",
                       std::abs(degrees(std::atan2(turn(1, 0), turn(0, 0)))));
}

struct LineStyle {
    const char* color;
    double width;
    double opacity;
};
constexpr LineStyle rejected_line{"#d1495b", 0.8, 0.55};
constexpr LineStyle kept_line{"#1565a9", 1.2, 0.9};

void append_lines(std::string& svg, std::span<const PointMatch> matches,
                  std::span<const std::uint32_t> which, const Layout& layout,
                  const LineStyle& style) {
    fmt::format_to(std::back_inserter(svg),
                   "<g stroke=\"{0}\" fill=\"{0}\" stroke-width=\"{1}\" stroke-opacity=\"{2}\">\n",
                   style.color, style.width, style.opacity);
    for (const std::uint32_t i : which) {
        const Eigen::Vector2d from = layout.target(seen_from_above(matches[i].target));
        const Eigen::Vector2d to = layout.source(seen_from_above(matches[i].source));
        fmt::format_to(std::back_inserter(svg),
                       "<path d=\"M{0:.1f} {1:.1f}L{2:.1f} {3:.1f}\"/>"
                       "<circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"2\" stroke=\"none\"/>"
                       "<circle cx=\"{2:.1f}\" cy=\"{3:.1f}\" r=\"2\" stroke=\"none\"/>\n",
                       from.x(), from.y(), to.x(), to.y());
    }
    svg += "</g>\n";
}

void append_caption(std::string& svg, const std::string& text) {
    fmt::format_to(std::back_inserter(svg),
                   "<text x=\"{}\" y=\"22\" font-size=\"15\" fill=\"#1f2430\">{}</text>\n", margin,
                   text);
}

void append_metre(std::string& svg, const Layout& layout) {
    fmt::format_to(
        std::back_inserter(svg),
        "<path d=\"M{0:.1f} {1:.1f}h{2:.1f}\" stroke=\"#1f2430\" stroke-width=\"2\"/>"
        "<text x=\"{3:.1f}\" y=\"{4:.1f}\" font-size=\"12\" fill=\"#1f2430\">1 m</text>\n",
        panel_width - margin - layout.source.scale, caption_height - 12.0, layout.source.scale,
        panel_width - margin - layout.source.scale - 28.0, caption_height - 8.0);
}

}  // namespace

std::string draw_correspondences(const PaperPair& pair, const FilteredMatches& matches,
                                 const std::optional<Transform>& true_target_from_source) {
    const DrawnScan target = sort_points(pair.target);
    const DrawnScan source = sort_points(pair.source);
    const Layout layout = lay_out(target, source);
    const std::vector<std::uint32_t>& kept = matches.rejection.inliers;
    std::vector<std::uint32_t> rejected;
    for (std::uint32_t i = 0; i < matches.matches.size(); ++i) {
        if (!std::binary_search(kept.begin(), kept.end(), i)) rejected.push_back(i);
    }
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
        "width=\"{0:.0f}\" height=\"{1:.0f}\" font-family=\"Helvetica, Arial, sans-serif\">\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
        "<defs><g id=\"scans\" stroke-width=\"1.8\" stroke-linecap=\"round\" fill=\"none\">\n",
        panel_width, 2.0 * layout.panel_height);
    append_scan(svg, target, layout.target);
    append_name(svg, "first scan", layout.target, layout.panel_height);
    append_scan(svg, source, layout.source);
    append_name(svg, "second scan" + describe_turn(true_target_from_source), layout.source,
                layout.panel_height);
    svg += "</g></defs>\n<use href=\"#scans\"/>\n";
    append_lines(svg, matches.matches, rejected, layout, rejected_line);
    append_lines(svg, matches.matches, kept, layout, kept_line);
    append_caption(svg, fmt::format("(a) initial correspondences: {}", matches.matches.size()));
    append_metre(svg, layout);
    fmt::format_to(std::back_inserter(svg),
                   "<g transform=\"translate(0 {:.0f})\">\n<use href=\"#scans\"/>\n",
                   layout.panel_height);
    append_lines(svg, matches.matches, kept, layout, kept_line);
    append_caption(svg, fmt::format("(b) filtered by sample consensus: {}", kept.size()));
    svg += "</g>\n</svg>\n";
    return svg;
}

}  // namespace roomscribe
