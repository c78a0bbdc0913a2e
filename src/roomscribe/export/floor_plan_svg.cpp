// SPDX-License-Identifier: MIT
#include "roomscribe/export/floor_plan_svg.hpp"

#include <cmath>

#include <fmt/format.h>

#include "roomscribe/core/units.hpp"

namespace roomscribe {
namespace {

/// Millimetres of paper per metre, at 1:50.
constexpr double scale = 20.0;
constexpr double margin = 12.0;
constexpr double title_block = 18.0;
/// Of common fonts, the size by the height of capitals.
constexpr double font_size = 1.4;

constexpr const char* style = R"(
text { font-family: "Helvetica Neue", Helvetica, Arial, "Liberation Sans", sans-serif; fill: #1d2430;
  text-anchor: middle; }
.strong { font-weight: 600; }
.halo { stroke: #fff; stroke-width: 0.9; stroke-linejoin: round; paint-order: stroke; }
path, line { fill: none; stroke-linejoin: round; stroke-linecap: butt; }
.ROOMS path { fill: #faf9f6; stroke: #cfc8b8; stroke-width: 0.15; }
.FURNITURE path { fill: #efece4; stroke: #a79f8e; stroke-width: 0.18; }
.FURNITURE path.dashed { fill: none; }
.FURNITURE text { fill: #857d6d; }
.WALLS path { fill: #2b313b; stroke: #2b313b; stroke-width: 0.12; }
.WALLS path.dashed { fill: #c3c7cd; stroke: #6d7480; stroke-width: 0.2; }
.FACES path { stroke: #8d949e; stroke-width: 0.1; }
.WINDOWS path { fill: #fff; stroke: #2b313b; stroke-width: 0.18; }
.DOORS path { stroke: #1f50dc; stroke-width: 0.22; }
.DOORS path.leaf { fill: #fff; }
.DOORS path.arc { stroke-width: 0.13; }
.HANDLES path { fill: #e33cbe; stroke: #e33cbe; stroke-width: 0.1; }
.DIMENSIONS path { stroke: #7a8290; stroke-width: 0.13; }
.DIMENSIONS text { fill: #4c5563; }
.dashed { stroke-dasharray: 0.9 0.6; }
.sheet text { text-anchor: start; }
)";

/// A thousandth of a millimetre of paper is a twentieth of a millimetre in the building.
std::string number(double value) {
    std::string text = fmt::format("{:.3f}", value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text == "-0" ? "0" : text;
}

std::string escaped(const std::string& text) {
    std::string safe;
    for (const char c : text) {
        switch (c) {
            case '&':
                safe += "&amp;";
                break;
            case '<':
                safe += "&lt;";
                break;
            case '>':
                safe += "&gt;";
                break;
            case '"':
                safe += "&quot;";
                break;
            default:
                // Other control characters are not allowed in XML.
                safe += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
        }
    }
    return safe;
}

/// From metres with y up to millimetres of paper with y down.
struct Paper {
    Eigen::Vector2d top_left;

    std::string place(const Eigen::Vector2d& p) const {
        return fmt::format("{} {}", number(x(p)), number(y(p)));
    }
    double x(const Eigen::Vector2d& p) const { return margin + scale * (p.x() - top_left.x()); }
    double y(const Eigen::Vector2d& p) const { return margin + scale * (top_left.y() - p.y()); }
};

std::string path_svg(const PlanPath& path, const Paper& paper) {
    std::string way;
    for (const Eigen::Vector2d& corner : path.corners)
        way += (way.empty() ? "M" : "L") + paper.place(corner);
    if (path.is_closed) way += "Z";
    std::string classes = path.layer == PlanLayer::doors && path.is_closed ? "leaf" : "";
    if (path.stroke == PlanStroke::dashed) classes += classes.empty() ? "dashed" : " dashed";
    std::string attributes;
    if (!classes.empty()) attributes += fmt::format(" class=\"{}\"", classes);
    if (!path.id.empty()) attributes += fmt::format(" data-id=\"{}\"", escaped(path.id));
    return fmt::format("<path d=\"{}\"{}/>\n", way, attributes);
}

std::string arc_svg(const PlanArc& arc, const Paper& paper) {
    const auto at = [&](double angle) {
        return Eigen::Vector2d(arc.center +
                               arc.radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    };
    // y is turned over, so that what runs counter-clockwise is sweep 0.
    return fmt::format("<path class=\"arc{}\" d=\"M{}A{} {} 0 0 0 {}\" data-id=\"{}\"/>\n",
                       arc.stroke == PlanStroke::dashed ? " dashed" : "", paper.place(at(arc.from)),
                       number(scale * arc.radius), number(scale * arc.radius),
                       paper.place(at(arc.to)), escaped(arc.id));
}

std::string text_svg(const PlanText& text, const Paper& paper) {
    const double x = paper.x(text.position);
    const double y = paper.y(text.position);
    const double height = scale * text.height;
    const std::string turn = text.angle == 0.0
                                 ? ""
                                 : fmt::format(" transform=\"rotate({} {} {})\"",
                                               number(-degrees(text.angle)), number(x), number(y));
    const char* halo = text.layer == PlanLayer::furniture ? "" : "halo";
    return fmt::format("<text class=\"{}{}\" x=\"{}\" y=\"{}\" font-size=\"{}\"{}>{}</text>\n",
                       halo, text.is_strong ? " strong" : "", number(x), number(y + 0.5 * height),
                       number(font_size * height), turn, escaped(text.text));
}

std::string storey_svg(const StoreyPlan& plan, const Paper& paper) {
    std::string svg = fmt::format("<g class=\"storey\" data-title=\"{}\" data-elevation=\"{}\">\n",
                                  escaped(plan.title), number(plan.elevation));
    for (std::size_t i = 0; i < plan_layer_names.size(); ++i) {
        const auto layer = static_cast<PlanLayer>(i);
        svg += fmt::format("<g class=\"{}\">\n", plan_layer_names[i]);
        for (const PlanPath& path : plan.paths)
            if (path.layer == layer) svg += path_svg(path, paper);
        for (const PlanArc& arc : plan.arcs)
            if (arc.layer == layer) svg += arc_svg(arc, paper);
        for (const PlanText& text : plan.texts)
            if (text.layer == layer) svg += text_svg(text, paper);
        svg += "</g>\n";
    }
    return svg + "</g>\n";
}

/// A bar of 5 m in steps of 1 m, black and white.
std::string scale_bar(double x, double y) {
    constexpr int metres = 5;
    std::string svg;
    for (int i = 0; i < metres; ++i) {
        svg += fmt::format(
            "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"1.2\" fill=\"{}\" stroke=\"#1d2430\" "
            "stroke-width=\"0.15\"/>\n",
            number(x + i * scale), number(y), number(scale), i % 2 == 0 ? "#1d2430" : "#fff");
    }
    for (const int i : {0, 1, metres}) {
        svg += fmt::format("<text x=\"{}\" y=\"{}\" font-size=\"2.6\">{}{}</text>\n",
                           number(x + i * scale), number(y + 4.2), i, i == metres ? " m" : "");
    }
    return svg;
}

}  // namespace

std::string plans_to_svg(const std::vector<StoreyPlan>& plans) {
    const std::vector<double> shifts = plan_shifts(plans);
    Eigen::AlignedBox2d all;
    for (std::size_t i = 0; i < plans.size(); ++i) {
        all.extend(plans[i].bounds.min() + shifts[i] * Eigen::Vector2d::UnitX());
        all.extend(plans[i].bounds.max() + shifts[i] * Eigen::Vector2d::UnitX());
    }
    if (all.isEmpty()) all.extend(Eigen::Vector2d::Zero());
    // The scale bar and the words beside it take 160 mm.
    const double width = std::max(scale * all.sizes().x(), 160.0) + 2.0 * margin;
    const double below = scale * all.sizes().y() + 2.0 * margin;
    const double height = below + title_block;
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}mm\" height=\"{1}mm\" "
        "viewBox=\"0 0 {0} {1}\">\n<title>Floor plan, 1:50</title>\n<style>{2}</style>\n"
        "<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
        number(width), number(height), style);
    for (std::size_t i = 0; i < plans.size(); ++i) {
        const Paper paper{{all.min().x() - shifts[i], all.max().y()}};
        svg += storey_svg(plans[i], paper);
    }
    svg += "<g class=\"sheet\">\n" + scale_bar(margin, below);
    std::string words = "Scale 1:50, lengths in m";
    for (std::size_t i = 0; i < plans.size(); ++i) {
        words += fmt::format("{} {} at {:+.2f} m", i == 0 ? " \u00b7" : ",", plans[i].title,
                             plans[i].elevation);
    }
    svg += fmt::format(
        "<text x=\"{0}\" y=\"{1}\" font-size=\"3\">{2}</text>\n"
        "<text x=\"{0}\" y=\"{3}\" font-size=\"2.6\">Dashed or grey: doubtful, or above the cut at "
        "1.2 m</text>\n</g>\n</svg>\n",
        number(margin), number(below + 9.6), escaped(words), number(below + 13.6));
    return svg;
}

}  // namespace roomscribe
