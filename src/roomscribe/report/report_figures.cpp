// SPDX-License-Identifier: MIT
#include "roomscribe/report/report_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/geometry/polygon.hpp"
#include "roomscribe/report/cloud_picture.hpp"
#include "roomscribe/report/html_text.hpp"
#include "roomscribe/report/png_image.hpp"
#include "roomscribe/report/report_views.hpp"

namespace roomscribe {
namespace {

/// Colours that stay apart for most eyes (Okabe and Ito 2008), then again from the first.
constexpr std::array<std::array<std::uint8_t, 3>, 7> scan_colors{{{0, 114, 178},
                                                                  {213, 94, 0},
                                                                  {0, 158, 115},
                                                                  {204, 121, 167},
                                                                  {230, 159, 0},
                                                                  {86, 180, 233},
                                                                  {120, 94, 180}}};

/// Where a point of the map lies on the picture, in percent from the left and from the top.
Eigen::Vector2d percent_of(const CloudView& view, const Eigen::Vector3d& point) {
    const Eigen::Vector3d p = view.view_from_cloud * point;
    const Eigen::Vector3d extent = view.high - view.low;
    return {100.0 * (p.x() - view.low.x()) / extent.x(),
            100.0 * (view.high.y() - p.y()) / extent.y()};
}

bool is_on_picture(const Eigen::Vector2d& percent) {
    return (percent.array() >= 0.0).all() && (percent.array() <= 100.0).all();
}

/// 1, 2 or 5 times a power of ten: about a `parts`-th of the length.
double round_step(double length, double parts) {
    const double power = std::pow(10.0, std::floor(std::log10(length / parts)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor * power >= length / parts) return factor * power;
    }
    return 10.0 * power;
}

/// Grid lines into `svg` and the numbers beside them into `labels`.
void add_axis(const RoomView& view, bool is_horizontal, double step, std::string& svg,
              std::string& labels) {
    const PictureAxis axis = is_horizontal ? view.horizontal : view.vertical;
    const Eigen::Index side = is_horizontal ? 0 : 1;
    const double low = view.view.low(side);
    const double high = view.view.high(side);
    for (double k = std::ceil(low / step); k * step <= high; k += 1.0) {
        const double share = 100.0 * (k * step - low) / (high - low);
        if (share < 1.5 || share > 98.5) continue;
        const std::string coordinate = decimal(axis.sign * k * step, step < 1.0 ? 1 : 0);
        if (is_horizontal) {
            svg += fmt::format("<path class=\"grid\" d=\"M{0:.2f} 0V100\"/>", share);
            labels += fmt::format("<span class=\"tick tick-x\" style=\"left:{:.2f}%\">{}</span>",
                                  share, coordinate);
        } else {
            svg += fmt::format("<path class=\"grid\" d=\"M0 {0:.2f}H100\"/>", 100.0 - share);
            labels += fmt::format("<span class=\"tick tick-y\" style=\"top:{:.2f}%\">{}</span>",
                                  100.0 - share, coordinate);
        }
    }
}

std::string outline(const CloudView& view, const std::vector<Eigen::Vector3d>& polygon) {
    std::string points;
    for (const Eigen::Vector3d& corner : polygon) {
        const Eigen::Vector2d p = percent_of(view, corner);
        points += fmt::format("{:.2f},{:.2f} ", p.x(), p.y());
    }
    return points;
}

/// The outline of a component; of a box that of its base as the view sees it.
std::vector<Eigen::Vector3d> outline_corners(const Component& component, const CloudView& view) {
    if (!component.box) return component.polygon;
    const OrientedBox& box = *component.box;
    // The axis that points most at the viewer goes; the other two span what is seen.
    std::array<std::size_t, 3> order{0, 1, 2};
    const Eigen::RowVector3d to_viewer = view.view_from_cloud.linear().row(2);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::abs(to_viewer.dot(box.axes[a])) < std::abs(to_viewer.dot(box.axes[b]));
    });
    const auto half = [&box](std::size_t axis) -> Eigen::Vector3d {
        return box.axes[axis] * box.size(static_cast<Eigen::Index>(axis)) / 2.0;
    };
    const Eigen::Vector3d u = half(order[0]);
    const Eigen::Vector3d v = half(order[1]);
    return {box.center - u - v, box.center + u - v, box.center + u + v, box.center - u + v};
}

Eigen::Vector3d mean_of(const std::vector<Eigen::Vector3d>& corners) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& corner : corners)
        sum += corner;
    return sum / static_cast<double>(corners.size());
}

/// Outlines of the components in the view's box (the plan's box ends below the ceiling).
std::string component_shapes(const Scene& scene, const CloudView& view) {
    std::string halos;
    std::string shapes;
    for (const Component& component : scene.components) {
        const std::vector<Eigen::Vector3d> corners = outline_corners(component, view);
        if (component.verdict == Verdict::rejected || corners.empty()) continue;
        const double depth = (view.view_from_cloud * mean_of(corners)).z();
        if (depth < view.low.z() || depth > view.high.z()) continue;
        const std::string points = outline(view, corners);
        halos += fmt::format("<polygon class=\"halo\" points=\"{}\"/>\n", points);
        shapes += fmt::format(
            "<polygon class=\"shape label-{}{}\" points=\"{}\"><title>{}, {:.0f} "
            "%</title></polygon>\n",
            label_name(component.label),
            component.verdict == Verdict::doubtful ? " doubtful-shape" : "", points,
            escape_html(component.id), 100.0 * component.confidence);
    }
    return halos + shapes;
}

std::string scale_bar(const CloudView& view) {
    const double extent = view.high.x() - view.low.x();
    const double length = round_step(extent, 9.0);
    return fmt::format(
        "<div class=\"scale\" style=\"width:{:.2f}%\"><span>{:g}&#8239;m</span></div>",
        100.0 * length / extent, length);
}

struct FigureText {
    std::string title;
    std::string caption;
    std::string alternative;
};

/// A picture with its axes, what lies over it in vectors (`shapes`, percent of the picture) and in
/// text (`tags`), and a legend below.
std::string figure(const RoomView& view, const Image& image, const FigureText& text,
                   const std::string& shapes, const std::string& tags, const std::string& legend) {
    const Eigen::Vector3d extent = view.view.high - view.view.low;
    const double step = round_step(std::max(extent.x(), extent.y()), 12.0);
    std::string grid;
    std::string ticks;
    add_axis(view, true, step, grid, ticks);
    add_axis(view, false, step, grid, ticks);
    const std::vector<std::byte> png = encode_png(image);
    return fmt::format(
        "<figure>\n<figcaption><strong>{}</strong><span>{}</span></figcaption>\n"
        "<div class=\"plot\" style=\"--aspect:{:.4f}\"><div class=\"frame\">\n"
        "<div class=\"canvas\"><img alt=\"{}\" width=\"{}\" height=\"{}\" "
        "src=\"data:image/png;base64,{}\"/>\n"
        "<svg viewBox=\"0 0 100 100\" preserveAspectRatio=\"none\" "
        "aria-hidden=\"true\">{}\n{}</svg>\n"
        "{}{}</div>\n<div aria-hidden=\"true\">{}</div></div></div>\n{}</figure>\n",
        text.title, text.caption, extent.x() / extent.y(), text.alternative, image.width,
        image.height, encode_base64(png), grid, shapes, tags, scale_bar(view.view), ticks, legend);
}

Pixel opaque(const std::array<std::uint8_t, 3>& color) {
    return {color[0], color[1], color[2], 255};
}

PointColor color_by_label(const Reconstruction& reconstruction, bool with_ceiling) {
    return [&labels = reconstruction.labels.labels, with_ceiling](std::size_t index) {
        const Label label = labels[index];
        if (label == Label::ceiling && !with_ceiling) return Pixel{};
        return opaque(label_color(label));
    };
}

/// Below the ceiling by so much that lamps and the ceiling's own noise do not hide the room.
double plan_cut(const Scene& scene, const Eigen::AlignedBox3d& box) {
    constexpr double below_ceiling = 0.25;
    double ceiling = -std::numeric_limits<double>::infinity();
    for (const Room& room : scene.rooms)
        ceiling = std::max(ceiling, room.ceiling_height);
    if (!std::isfinite(ceiling)) ceiling = box.max().z();
    return std::max(ceiling - below_ceiling, box.min().z() + 0.5);
}

std::string room_tags(const Scene& scene, const CloudView& view) {
    std::string tags;
    for (const Room& room : scene.rooms) {
        if (room.polygon.empty()) continue;
        const Eigen::Vector2d p = percent_of(view, mean_of(room.polygon));
        if (!is_on_picture(p)) continue;
        tags += fmt::format(
            "<span class=\"tag\" style=\"left:{:.2f}%;top:{:.2f}%\">{} &#183; "
            "{:.1f}&#8239;m&#178;</span>\n",
            p.x(), p.y(), escape_html(room.id), room.area);
    }
    return tags;
}

std::string station_marks(const ScanMap& map, const CloudView& view) {
    std::string marks;
    for (std::size_t i = 0; i < map.sections.size(); ++i) {
        if (!map.sections[i].sensor_position) continue;
        const Eigen::Vector2d p = percent_of(view, *map.sections[i].sensor_position);
        if (!is_on_picture(p)) continue;
        marks += fmt::format(
            "<span class=\"station\" style=\"left:{:.2f}%;top:{:.2f}%\" title=\"{}\">{}</span>\n",
            p.x(), p.y(), escape_html(map.sections[i].name), i);
    }
    return marks;
}

/// Number of the section that a point is in: sections lie one after another.
std::size_t section_of(const std::vector<MapSection>& sections, std::size_t index) {
    const auto next = std::upper_bound(
        sections.begin(), sections.end(), index,
        [](std::size_t i, const MapSection& section) { return i < section.first; });
    return next == sections.begin() ? 0 : static_cast<std::size_t>(next - sections.begin()) - 1;
}

std::string scan_legend(const std::vector<MapSection>& sections) {
    std::string legend = "<ul class=\"legend\">\n";
    for (std::size_t i = 0; i < sections.size(); ++i) {
        const auto [red, green, blue] = scan_colors[i % scan_colors.size()];
        legend += fmt::format(
            "<li><i class=\"swatch\" style=\"background:rgb({} {} {})\"></i>{} {} <span>{} "
            "points</span></li>\n",
            red, green, blue, i, escape_html(sections[i].name), with_separators(sections[i].count));
    }
    return legend + "</ul>\n";
}

/// A piece with all that is mounted on it, however deep.
std::vector<Component> piece_with_parts(const Scene& scene, const Component& piece) {
    std::vector<Component> parts{piece};
    for (std::size_t i = 0; i < parts.size(); ++i) {
        for (const Component& component : scene.components) {
            if (component.parent == parts[i].id) parts.push_back(component);
        }
    }
    return parts;
}

/// Which way the piece looks, level: as most of its upright faces do, else as its fixtures are
/// approached. Zero if neither tells.
Eigen::Vector3d front_of(std::span<const Component> parts, const Eigen::Vector3d& up) {
    constexpr double fixture_area = 0.01;  // any face outvotes fixtures
    Eigen::Vector3d front = Eigen::Vector3d::Zero();
    for (const Component& part : parts) {
        if (part.grasp) front -= fixture_area * part.grasp->approach;
        const Eigen::Vector3d area = area_vector(part.polygon);
        if (std::abs(area.dot(up)) < 0.5 * area.norm()) front += area;
    }
    front -= front.dot(up) * up;
    return front.norm() > 0.0 ? Eigen::Vector3d(front.normalized()) : Eigen::Vector3d::Zero();
}

/// m, about a piece on its picture.
constexpr double piece_margin = 0.12;

/// From before the piece; coordinates are metres from its lower left corner.
RoomView piece_view(const OrientedBox& box, const Eigen::Vector3d& front,
                    const Eigen::Vector3d& up) {
    RoomView view;
    view.horizontal = {0, 1.0};
    view.vertical = {2, 1.0};
    Eigen::Matrix3d axes;
    axes.row(0) = up.cross(front).transpose();
    axes.row(1) = up.transpose();
    axes.row(2) = front.transpose();
    Eigen::Vector3d half = Eigen::Vector3d::Zero();
    for (Eigen::Index i = 0; i < 3; ++i) {
        half += 0.5 * box.size(i) * (axes * box.axes[static_cast<std::size_t>(i)]).cwiseAbs();
    }
    view.view.view_from_cloud.linear() = axes;
    view.view.view_from_cloud.translation() = half - axes * box.center;
    view.view.low = Eigen::Vector3d::Constant(-piece_margin);
    view.view.high = 2.0 * half + Eigen::Vector3d::Constant(piece_margin);
    // The longer side of a picture; pages show it at half the size, so that dense screens are
    // sharp.
    constexpr double longer_side = 720.0;  // pixels
    const Eigen::Vector3d extent = view.view.high - view.view.low;
    view.view.width = static_cast<std::size_t>(
        std::max(1.0, longer_side * std::min(1.0, extent.x() / extent.y())));
    return view;
}

/// A piece, as it is seen from its front.
struct PiecePicture {
    Scene alone;  ///< the piece, then its parts
    RoomView view;
    std::vector<Eigen::Vector3f> points;  ///< in the view's box and about it
    std::vector<std::uint32_t> numbers;   ///< of these in the map
};

/// The box of a view in the map's frame.
Eigen::AlignedBox3f box_in_map(const CloudView& view) {
    const Transform map_from_view = view.view_from_cloud.inverse();
    const Eigen::AlignedBox3d seen(view.low, view.high);
    Eigen::AlignedBox3f box;
    for (int i = 0; i < 8; ++i) {
        const auto corner = static_cast<Eigen::AlignedBox3d::CornerType>(i);
        box.extend(Eigen::Vector3d(map_from_view * seen.corner(corner)).cast<float>());
    }
    return box;
}

/// Deals the map's points out to the pictures that show them.
void take_points(const PointCloud& map, std::span<PiecePicture> pictures, const Context& context) {
    std::vector<Eigen::AlignedBox3f> boxes;
    Eigen::AlignedBox3f all;
    for (const PiecePicture& picture : pictures) {
        boxes.push_back(box_in_map(picture.view.view));
        all.extend(boxes.back());
    }
    using Numbers = std::vector<std::vector<std::uint32_t>>;  // per picture
    constexpr std::size_t chunk_size = 1U << 18U;
    std::vector<Numbers> numbers_of_chunk((map.size() + chunk_size - 1) / chunk_size);
    parallel_for(context, map.size(), chunk_size, [&](std::size_t begin, std::size_t end) {
        Numbers& numbers = numbers_of_chunk[begin / chunk_size];
        numbers.resize(pictures.size());
        for (std::size_t i = begin; i < end; ++i) {
            if (!all.contains(map.positions[i])) continue;
            for (std::size_t k = 0; k < pictures.size(); ++k) {
                if (boxes[k].contains(map.positions[i]))
                    numbers[k].push_back(static_cast<std::uint32_t>(i));
            }
        }
    });
    for (const Numbers& numbers : numbers_of_chunk) {
        for (std::size_t k = 0; k < numbers.size(); ++k) {
            for (const std::uint32_t number : numbers[k]) {
                pictures[k].points.push_back(map.positions[number]);
                pictures[k].numbers.push_back(number);
            }
        }
    }
}

std::string piece_figure(const PiecePicture& picture, std::span<const Label> labels,
                         const Context& context) {
    const std::vector<Component>& parts = picture.alone.components;
    const auto color = [&](std::size_t point) {
        return opaque(label_color(labels[picture.numbers[point]]));
    };
    const Image image =
        draw_cloud(picture.points, color, picture.view.view, PictureStyle::surface, context);
    const auto num_fixtures = std::count_if(parts.begin(), parts.end(), [](const Component& part) {
        return part.label == Label::handle;
    });
    const std::string name = escape_html(parts[0].id);
    const std::string kind = escape_html(in_words(parts[0].kind));
    const Eigen::Vector3d extent = picture.view.view.high - picture.view.view.low;
    return figure(
        picture.view, image,
        {name,
         fmt::format("{}{:.2f} &#215; {:.2f} m, {}", kind.empty() ? kind : kind + ", ",
                     extent.x() - 2.0 * piece_margin, extent.y() - 2.0 * piece_margin,
                     num_fixtures == 0 ? "no handle"
                                       : counted(static_cast<std::size_t>(num_fixtures), "handle")),
         fmt::format("{} from its front with the outlines of its faces and handles", name)},
        component_shapes(picture.alone, picture.view.view), "", "");
}

}  // namespace

std::string plan_figure(const Reconstruction& reconstruction, std::size_t width,
                        const Context& context) {
    Eigen::AlignedBox3d box = interesting_box(reconstruction);
    box.max().z() = plan_cut(reconstruction.scene, box);
    const RoomView view = plan_view(reconstruction, box, width);
    const Image image =
        draw_cloud(reconstruction.map.cloud.positions, color_by_label(reconstruction, false),
                   view.view, PictureStyle::surface, context);
    const FigureText text{
        "Plan",
        fmt::format("From above, cut at {:.2f} m with the ceiling taken off. Metres in the room "
                    "frame; the higher a surface, the stronger its colour.",
                    box.max().z()),
        "Top view of the labelled points, ceiling taken off, with the outlines of the components"};
    return figure(view, image, text, component_shapes(reconstruction.scene, view.view),
                  room_tags(reconstruction.scene, view.view), label_legend(reconstruction));
}

std::string section_figure(const Reconstruction& reconstruction, std::size_t width,
                           const Context& context) {
    const Eigen::AlignedBox3d box = interesting_box(reconstruction);
    const RoomView view = section_view(reconstruction, box, width);
    const Image image =
        draw_cloud(reconstruction.map.cloud.positions, color_by_label(reconstruction, true),
                   view.view, PictureStyle::surface, context);
    const bool along_x = view.horizontal.axis == 0;
    const FigureText text{
        "Section",
        fmt::format("Upright cut at {} = {:.2f} m, seen towards {}; the nearer a surface to the "
                    "cut, the stronger its colour.",
                    along_x ? "y" : "x", along_x ? box.center().y() : box.center().x(),
                    along_x ? "+y" : "&#8722;x"),
        "Vertical section of the labelled points with the outlines of the components behind it"};
    return figure(view, image, text, component_shapes(reconstruction.scene, view.view), "", "");
}

std::string scans_figure(const Reconstruction& reconstruction, std::size_t width,
                         const Context& context) {
    const std::vector<MapSection>& sections = reconstruction.map.sections;
    const RoomView view = plan_view(reconstruction, scanned_box(reconstruction), width);
    const bool by_label = has_labels(reconstruction);
    const PointColor color = [&](std::size_t index) {
        // Level surfaces would cover what shows a misfit: the walls.
        const Label label = by_label ? reconstruction.labels.labels[index] : Label::unknown;
        if (label == Label::floor || label == Label::ceiling) return Pixel{};
        return opaque(scan_colors[section_of(sections, index) % scan_colors.size()]);
    };
    const Image image = draw_cloud(reconstruction.map.cloud.positions, color, view.view,
                                   PictureStyle::density, context);
    const FigureText text{
        "Scans",
        fmt::format("All scans from above as an X-ray{}; where scans agree, their colours fall on "
                    "the same lines. Numbers stand where the scanner stood.",
                    by_label ? ", floor and ceiling left out" : ""),
        "Top view of the map, coloured by scan, with the scanner positions"};
    return figure(view, image, text, "", station_marks(reconstruction.map, view.view),
                  scan_legend(sections));
}

std::string furniture_figures(const Reconstruction& reconstruction, const Context& context) {
    constexpr std::size_t max_pieces = 12;
    constexpr double min_extent = 2.0 * piece_margin + 0.2;  // m, of what is worth a picture
    const Scene& scene = reconstruction.scene;
    const Eigen::Vector3d up = scene.room_from_map.linear().row(2).transpose();
    std::vector<const Component*> pieces;
    for (const Component& component : scene.components) {
        if (component.label == Label::furniture && component.box) pieces.push_back(&component);
    }
    std::stable_sort(pieces.begin(), pieces.end(), [](const Component* a, const Component* b) {
        return a->box->size.prod() > b->box->size.prod();
    });
    std::vector<PiecePicture> pictures;
    for (const Component* piece : pieces) {
        if (pictures.size() == max_pieces) break;
        PiecePicture picture;
        picture.alone.room_from_map = scene.room_from_map;
        picture.alone.components = piece_with_parts(scene, *piece);
        const Eigen::Vector3d front = front_of(picture.alone.components, up);
        if (front.isZero()) continue;
        picture.view = piece_view(*piece->box, front, up);
        const Eigen::Vector3d extent = picture.view.view.high - picture.view.view.low;
        if (extent.head<2>().minCoeff() >= min_extent) pictures.push_back(std::move(picture));
    }
    take_points(reconstruction.map.cloud, pictures, context);
    std::string html;
    for (const PiecePicture& picture : pictures)
        html += piece_figure(picture, reconstruction.labels.labels, context);
    return html.empty() ? html : "<div class=\"pieces\">\n" + html + "</div>\n";
}

std::string label_legend(const Reconstruction& reconstruction) {
    std::array<std::uint64_t, num_labels> points{};
    std::array<std::uint64_t, num_labels> components{};
    for (const Label label : reconstruction.labels.labels) {
        ++points[static_cast<std::size_t>(label)];
    }
    for (const Component& component : reconstruction.scene.components) {
        if (component.verdict != Verdict::rejected) {
            ++components[static_cast<std::size_t>(component.label)];
        }
    }
    std::string legend = "<ul class=\"legend\">\n";
    for (std::size_t id = 1; id <= num_labels; ++id) {
        const std::size_t i = id % num_labels;  // unknown comes last
        if (points[i] == 0 && components[i] == 0) continue;
        std::string name(label_name(static_cast<Label>(i)));
        legend += fmt::format("<li><i class=\"swatch label-{}\"></i>", name);
        std::replace(name.begin(), name.end(), '_', ' ');
        legend += components[i] > 0 ? fmt::format("{} &#215; {}", components[i], name) : name;
        legend += fmt::format(" <span>{} points</span></li>\n", with_separators(points[i]));
    }
    return legend + "</ul>\n";
}

}  // namespace roomscribe
