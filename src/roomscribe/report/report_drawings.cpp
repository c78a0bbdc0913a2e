// SPDX-License-Identifier: MIT
#include "roomscribe/report/report_drawings.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "roomscribe/export/building.hpp"
#include "roomscribe/export/floor_plan_svg.hpp"
#include "roomscribe/export/storey_plan.hpp"
#include "roomscribe/report/html_text.hpp"

namespace roomscribe {
namespace {

/// What an A4 page has between its margins.
constexpr double page_width = 182.0;  // mm
// Of a drawing, mm on paper: room for the dimensions below and to the right, and a rim.
constexpr double rim = 2.0;
constexpr double below = 9.0;
constexpr double aside = 14.0;

/// A rectangle on a wall as its room sees it: x to the right from the wall's left end, y up from
/// its foot.
struct OnWall {
    std::string id;
    Label label = Label::unknown;
    bool is_doubtful = false;
    double from = 0.0;
    double to = 0.0;
    double bottom = 0.0;
    double top = 0.0;
};

/// A hole in a wall and what is in it: leaf or glass within its frame, or one of the two.
struct OpeningOnWall {
    OnWall hole;  ///< to the outer edge of the frame
    std::vector<OnWall> parts;
    ComponentSize size;  ///< of leaf or glass, else of the hole
    std::string id;
};

struct Elevation {
    std::string id;
    std::string room;
    double length = 0.0;
    double height = 0.0;
    std::vector<Eigen::Vector2d> outline;
    std::vector<OpeningOnWall> openings;
};

Elevation elevation_of(const Building& building, const Wall& wall, std::size_t wall_index,
                       const FaceInPlan& face) {
    const Scene& scene = building.scene;
    const Component& component = scene.components[face.component];
    // The room lies to the left of the way from start to end: who looks at the face from there has
    // its end on the left.
    const Eigen::Vector2d right = (face.start - face.end).normalized();
    const auto station = [&](const Eigen::Vector2d& place) { return right.dot(place - face.end); };
    Elevation elevation;
    elevation.id = component.id;
    if (const auto room = building.room_of[face.component]) elevation.room = scene.rooms[*room].id;
    elevation.length = (face.end - face.start).norm();
    elevation.height = face.top - face.bottom;
    for (const Eigen::Vector3d& corner : component.polygon)
        elevation.outline.emplace_back(station(corner.head<2>()), corner.z() - face.bottom);
    for (const Opening& opening : building.openings) {
        if (opening.wall != wall_index) continue;
        const double a = station(wall.start + opening.from * wall.along());
        const double b = station(wall.start + opening.to * wall.along());
        const double middle = (a + b) / 2.0;
        if (middle < 0.0 || middle > elevation.length) continue;
        OpeningOnWall on_wall;
        on_wall.hole = {"",
                        Label::unknown,
                        false,
                        std::min(a, b),
                        std::max(a, b),
                        opening.bottom - face.bottom,
                        opening.top - face.bottom};
        for (const auto& index : {opening.frame, opening.passage, opening.filling}) {
            if (!index) continue;
            const Component& part = scene.components[*index];
            OnWall& shape = on_wall.parts.emplace_back(on_wall.hole);
            shape.id = part.id;
            shape.label = part.label;
            shape.is_doubtful = part.verdict == Verdict::doubtful;
            Eigen::AlignedBox2d bounds;
            for (const Eigen::Vector3d& corner : part.polygon)
                bounds.extend(Eigen::Vector2d(station(corner.head<2>()), corner.z()));
            shape.from = bounds.min().x();
            shape.to = bounds.max().x();
            shape.bottom = bounds.min().y() - face.bottom;
            shape.top = bounds.max().y() - face.bottom;
            on_wall.id = part.id;
            on_wall.size = flat_size(part);
        }
        elevation.openings.push_back(std::move(on_wall));
    }
    std::sort(
        elevation.openings.begin(), elevation.openings.end(),
        [](const OpeningOnWall& a, const OpeningOnWall& b) { return a.hole.from < b.hole.from; });
    return elevation;
}

/// Millimetres of paper per metre, for all walls.
double scale_for(std::span<const Elevation> elevations) {
    double longest = 0.0;
    for (const Elevation& elevation : elevations)
        longest = std::max(longest, elevation.length);
    for (const double scale : {20.0, 10.0})
        if (scale * longest + aside + rim <= page_width) return scale;
    return 5.0;
}

/// SVG of one elevation, in millimetres of paper.
class ElevationDrawing {
  public:
    ElevationDrawing(const Elevation& elevation, double scale)
        : elevation_(elevation), scale_(scale), right_(elevation.length) {
        // A hole is drawn as it was measured, also where it reaches beyond its wall.
        for (const OpeningOnWall& opening : elevation.openings) {
            left_ = std::min(left_, opening.hole.from);
            right_ = std::max(right_, opening.hole.to);
        }
    }

    std::string svg() {
        draw_shape();
        for (const OpeningOnWall& opening : elevation_.openings)
            draw_opening(opening);
        draw_widths();
        draw_height();
        const double width = scale_ * (right_ - left_) + rim + aside;
        const double height = scale_ * elevation_.height + rim + below;
        return fmt::format(
            "<svg class=\"elevation\" role=\"img\" aria-label=\"Elevation of {0}\" "
            "width=\"{1:.2f}mm\" viewBox=\"0 0 {1:.2f} {2:.2f}\">\n{3}</svg>\n",
            escape_html(elevation_.id), width, height, shapes_);
    }

  private:
    double x(double along) const { return rim + scale_ * (along - left_); }
    double y(double up) const { return rim + scale_ * (elevation_.height - up); }

    void draw_shape() {
        std::string corners;
        for (const Eigen::Vector2d& p : elevation_.outline)
            corners += fmt::format("{:.2f},{:.2f} ", x(p.x()), y(p.y()));
        shapes_ += fmt::format("<polygon class=\"face\" points=\"{}\"/>\n", corners);
    }

    void draw_opening(const OpeningOnWall& opening) {
        for (const OnWall& part : opening.parts) {
            shapes_ += fmt::format(
                "<rect class=\"opening label-{}{}\" x=\"{:.2f}\" y=\"{:.2f}\" "
                "width=\"{:.2f}\" height=\"{:.2f}\"/>\n",
                label_name(part.label), part.is_doubtful ? " doubtful-shape" : "", x(part.from),
                y(part.top), scale_ * (part.to - part.from), scale_ * (part.top - part.bottom));
        }
        draw_name(opening);
        const OnWall& hole = opening.hole;
        constexpr double on_floor = 0.05;  // m: a door's threshold, and no parapet
        if (hole.bottom > on_floor) {
            const double middle = (x(hole.from) + x(hole.to)) / 2.0;
            line(middle, y(hole.bottom), middle, y(0.0));
            text(middle + 0.8, (y(hole.bottom) + y(0.0)) / 2.0 + 0.9,
                 fmt::format("{:.2f}", hole.bottom), "start");
        }
    }

    /// Name and size in the middle of an opening; upwards where it is too narrow for them.
    void draw_name(const OpeningOnWall& opening) {
        const OnWall& hole = opening.hole;
        const std::string size =
            fmt::format("{:.2f} \u00d7 {:.2f}", opening.size.width, opening.size.height);
        constexpr double letter = 1.4;  // mm, advance of common fonts at 2.5 mm
        const auto num_letters = static_cast<double>(std::max(opening.id.size(), size.size()));
        const bool is_narrow = letter * num_letters > scale_ * (hole.to - hole.from);
        const double middle = (x(hole.from) + x(hole.to)) / 2.0;
        const double level = (y(hole.bottom) + y(hole.top)) / 2.0;
        if (is_narrow)
            shapes_ += fmt::format("<g transform=\"rotate(-90 {:.2f} {:.2f})\">\n", middle, level);
        text(middle, level - 0.8, opening.id, "middle");
        text(middle, level + 2.4, size, "middle");
        if (is_narrow) shapes_ += "</g>\n";
    }

    /// A chain along the foot: from the left end over both sides of each opening to the right end.
    void draw_widths() {
        std::vector<double> stations{0.0, elevation_.length};
        for (const OpeningOnWall& opening : elevation_.openings) {
            stations.push_back(std::clamp(opening.hole.from, 0.0, elevation_.length));
            stations.push_back(std::clamp(opening.hole.to, 0.0, elevation_.length));
        }
        std::sort(stations.begin(), stations.end());
        const double level = y(0.0) + 3.0;
        line(x(0.0), level, x(elevation_.length), level);
        for (std::size_t i = 0; i < stations.size(); ++i) {
            line(x(stations[i]), level - 1.0, x(stations[i]), level + 1.0);
            if (i == 0) continue;
            const double width = stations[i] - stations[i - 1];
            constexpr double width_of_text = 6.5;  // mm
            if (scale_ * width < width_of_text) continue;
            text((x(stations[i - 1]) + x(stations[i])) / 2.0, level + 3.6,
                 fmt::format("{:.2f}", width), "middle");
        }
    }

    void draw_height() {
        const double place = x(right_) + 3.0;
        line(place, y(0.0), place, y(elevation_.height));
        line(place - 1.0, y(0.0), place + 1.0, y(0.0));
        line(place - 1.0, y(elevation_.height), place + 1.0, y(elevation_.height));
        text(place + 1.5, y(elevation_.height / 2.0) + 0.9,
             fmt::format("{:.2f}", elevation_.height), "start");
    }

    void line(double x1, double y1, double x2, double y2) {
        shapes_ += fmt::format("<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\"/>\n",
                               x1, y1, x2, y2);
    }
    void text(double place, double level, const std::string& words, const char* anchor) {
        shapes_ += fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\" text-anchor=\"{}\">{}</text>\n",
                               place, level, anchor, escape_html(words));
    }

    const Elevation& elevation_;
    double scale_;
    double left_ = 0.0;  ///< m, ends of what is drawn
    double right_;
    std::string shapes_;
};

/// "room-1, 12.00 m2; room-2, 9.00 m2"
std::string rooms_in_words(const Scene& scene) {
    std::string words;
    for (const Room& room : scene.rooms) {
        words += fmt::format("{}{}, {:.2f} m\u00b2", words.empty() ? "" : "; ", room.id, room.area);
    }
    return words;
}

}  // namespace

std::string floor_plan_drawing(const Scene& scene) {
    if (scene.rooms.empty()) return {};
    const std::string svg = plans_to_svg(draw_floor_plans(describe_building(scene)));
    return fmt::format(
        "<figure>\n<figcaption><strong>Floor plan</strong><span>1:50 on paper, lengths in metres. "
        "<code>roomscribe export</code> gives it as SVG and DXF.</span></figcaption>\n"
        "<div class=\"scroll sheet\" tabindex=\"0\" role=\"group\" aria-label=\"Floor plan, "
        "scrolls sideways\"><img "
        "class=\"drawing\" alt=\"Floor plan of {}: {}\" "
        "src=\"data:image/svg+xml;base64,{}\"/></div>\n</figure>\n",
        counted(scene.rooms.size(), "room"), escape_html(rooms_in_words(scene)),
        encode_base64(std::as_bytes(std::span(svg))));
}

std::string wall_elevations(const Scene& scene) {
    const Building building = describe_building(scene);
    std::vector<Elevation> elevations;
    for (std::size_t i = 0; i < building.walls.size(); ++i) {
        for (const FaceInPlan& face : building.walls[i].faces)
            elevations.push_back(elevation_of(building, building.walls[i], i, face));
    }
    if (elevations.empty()) return {};
    std::stable_sort(elevations.begin(), elevations.end(),
                     [](const Elevation& a, const Elevation& b) { return a.room < b.room; });
    const double scale = scale_for(elevations);
    std::string html = fmt::format(
        "<p class=\"note\">Each wall as it is seen from its room, 1:{:.0f} on paper, lengths in "
        "metres. Sizes in openings are those of leaf or glass; along the foot stand the outer "
        "edges "
        "of the frames.</p>\n<div class=\"elevations\">\n",
        1000.0 / scale);
    for (const Elevation& elevation : elevations) {
        html += fmt::format(
            "<figure><figcaption><strong>{}</strong><span>{}{:.2f} &#215; {:.2f} m</span>"
            "</figcaption>\n{}</figure>\n",
            escape_html(elevation.id),
            elevation.room.empty() ? "" : escape_html(elevation.room) + ", ", elevation.length,
            elevation.height, ElevationDrawing(elevation, scale).svg());
    }
    return html + "</div>\n";
}

}  // namespace roomscribe
