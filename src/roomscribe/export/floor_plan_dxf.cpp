// SPDX-License-Identifier: MIT
#include "roomscribe/export/floor_plan_dxf.hpp"

#include <cmath>

#include <fmt/format.h>

#include "roomscribe/core/units.hpp"

namespace roomscribe {
namespace {

/// Colours of AutoCAD's index, by layer: 8 and 9 grey, 7 black or white, 1 red, 4 cyan, 5 blue, 6
/// magenta.
constexpr std::array<int, plan_layer_names.size()> colors{9, 8, 7, 1, 4, 5, 6, 8, 7};

/// Under which name entities carry the id of what they show (extended data).
constexpr const char* application = "ROOMSCRIBE";

class DxfText {
  public:
    void add(int code, const std::string& value) {
        text_ += fmt::format("{:3}\n{}\n", code, value);
    }
    void add(int code, std::string_view value) { add(code, std::string(value)); }
    void add(int code, const char* value) { add(code, std::string(value)); }
    void add(int code, int value) { add(code, fmt::format("{}", value)); }
    void add(int code, double value) {
        add(code, fmt::format("{:.6f}", std::round(value * 1e6) / 1e6 + 0.0));
    }
    /// A point in model space: groups 10, 20, 30, or 11, 21, 31.
    void add_point(int code, const Eigen::Vector2d& p) {
        add(code, p.x());
        add(code + 10, p.y());
        add(code + 20, 0.0);
    }
    void begin_section(const char* name) {
        add(0, "SECTION");
        add(2, name);
    }
    void end_section() { add(0, "ENDSEC"); }
    void begin_table(const char* name, int count) {
        add(0, "TABLE");
        add(2, name);
        add(70, count);
    }
    void end_table() { add(0, "ENDTAB"); }
    const std::string& text() const { return text_; }

  private:
    std::string text_;
};

/// Release 12 knows no Unicode but by escapes; a line break would end the group.
std::string plain(const std::string& text) {
    std::string safe;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto c = static_cast<unsigned char>(text[i]);
        const auto next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0U;
        if (c == 0xc2 && next == 0xb2) {
            safe += "2";  // the square of "m2"
            ++i;
        } else if (c < 0x20 || c > 0x7e) {
            safe += '?';
        } else {
            safe += text[i];
        }
    }
    return safe;
}

void add_header(DxfText& dxf, const Eigen::AlignedBox2d& bounds) {
    dxf.begin_section("HEADER");
    dxf.add(9, "$ACADVER");
    dxf.add(1, "AC1009");
    dxf.add(9, "$INSUNITS");
    dxf.add(70, 6);
    dxf.add(9, "$EXTMIN");
    dxf.add_point(10, bounds.min());
    dxf.add(9, "$EXTMAX");
    dxf.add_point(10, bounds.max());
    dxf.end_section();
}

void add_line_type(DxfText& dxf, const char* name, const char* words,
                   const std::vector<double>& dashes) {
    dxf.add(0, "LTYPE");
    dxf.add(2, name);
    dxf.add(70, 0);
    dxf.add(3, words);
    dxf.add(72, 65);
    dxf.add(73, static_cast<int>(dashes.size()));
    double length = 0.0;
    for (const double dash : dashes)
        length += std::abs(dash);
    dxf.add(40, length);
    for (const double dash : dashes)
        dxf.add(49, dash);
}

void add_tables(DxfText& dxf) {
    dxf.begin_section("TABLES");
    dxf.begin_table("LTYPE", 2);
    add_line_type(dxf, "CONTINUOUS", "Solid line", {});
    add_line_type(dxf, "DASHED", "__ __ __ __", {0.06, -0.04});
    dxf.end_table();
    dxf.begin_table("LAYER", 1 + static_cast<int>(plan_layer_names.size()));
    const auto add_layer = [&](std::string_view name, int color) {
        dxf.add(0, "LAYER");
        dxf.add(2, name);
        dxf.add(70, 0);
        dxf.add(62, color);
        dxf.add(6, "CONTINUOUS");
    };
    add_layer("0", 7);
    for (std::size_t i = 0; i < plan_layer_names.size(); ++i)
        add_layer(plan_layer_names[i], colors[i]);
    dxf.end_table();
    dxf.begin_table("STYLE", 1);
    dxf.add(0, "STYLE");
    dxf.add(2, "STANDARD");
    dxf.add(70, 0);
    dxf.add(40, 0.0);
    dxf.add(41, 1.0);
    dxf.add(50, 0.0);
    dxf.add(71, 0);
    dxf.add(42, 0.1);
    dxf.add(3, "txt");
    dxf.add(4, "");
    dxf.end_table();
    dxf.begin_table("APPID", 1);
    dxf.add(0, "APPID");
    dxf.add(2, application);
    dxf.add(70, 0);
    dxf.end_table();
    dxf.end_section();
}

void begin_entity(DxfText& dxf, const char* kind, PlanLayer layer, PlanStroke stroke) {
    dxf.add(0, kind);
    dxf.add(8, plan_layer_names[static_cast<std::size_t>(layer)]);
    if (stroke == PlanStroke::dashed) dxf.add(6, "DASHED");
}

void add_id(DxfText& dxf, const std::string& id) {
    if (id.empty()) return;
    dxf.add(1001, application);
    dxf.add(1000, plain(id));
}

void add_path(DxfText& dxf, const PlanPath& path, const Eigen::Vector2d& shift) {
    if (path.corners.size() == 2) {
        begin_entity(dxf, "LINE", path.layer, path.stroke);
        dxf.add_point(10, path.corners[0] + shift);
        dxf.add_point(11, path.corners[1] + shift);
        add_id(dxf, path.id);
        return;
    }
    begin_entity(dxf, "POLYLINE", path.layer, path.stroke);
    dxf.add(66, 1);
    dxf.add_point(10, Eigen::Vector2d::Zero());
    dxf.add(70, path.is_closed ? 1 : 0);
    add_id(dxf, path.id);
    for (const Eigen::Vector2d& corner : path.corners) {
        begin_entity(dxf, "VERTEX", path.layer, path.stroke);
        dxf.add_point(10, corner + shift);
    }
    begin_entity(dxf, "SEQEND", path.layer, PlanStroke::solid);
}

void add_arc(DxfText& dxf, const PlanArc& arc, const Eigen::Vector2d& shift) {
    begin_entity(dxf, "ARC", arc.layer, arc.stroke);
    dxf.add_point(10, arc.center + shift);
    dxf.add(40, arc.radius);
    dxf.add(50, degrees(arc.from));
    dxf.add(51, degrees(arc.to));
    add_id(dxf, arc.id);
}

void add_text(DxfText& dxf, const PlanText& text, const Eigen::Vector2d& shift) {
    begin_entity(dxf, "TEXT", text.layer, PlanStroke::solid);
    dxf.add_point(10, text.position + shift);
    dxf.add(40, text.height);
    dxf.add(1, plain(text.text));
    dxf.add(50, degrees(text.angle));
    dxf.add(72, 1);  // centred along the line,
    dxf.add_point(11, text.position + shift);
    dxf.add(73, 2);  // and across it
}

}  // namespace

std::string plans_to_dxf(const std::vector<StoreyPlan>& plans) {
    const std::vector<double> shifts = plan_shifts(plans);
    Eigen::AlignedBox2d all;
    DxfText entities;
    entities.begin_section("ENTITIES");
    for (std::size_t i = 0; i < plans.size(); ++i) {
        const Eigen::Vector2d shift(shifts[i], 0.0);
        all.extend(plans[i].bounds.min() + shift);
        all.extend(plans[i].bounds.max() + shift);
        for (const PlanPath& path : plans[i].paths)
            add_path(entities, path, shift);
        for (const PlanArc& arc : plans[i].arcs)
            add_arc(entities, arc, shift);
        for (const PlanText& text : plans[i].texts)
            add_text(entities, text, shift);
    }
    entities.end_section();
    if (all.isEmpty()) all.extend(Eigen::Vector2d::Zero());
    DxfText dxf;
    add_header(dxf, all);
    add_tables(dxf);
    return dxf.text() + entities.text() + "  0\nEOF\n";
}

}  // namespace roomscribe
