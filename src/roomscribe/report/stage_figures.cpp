// SPDX-License-Identifier: MIT
#include "roomscribe/report/stage_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "roomscribe/report/cloud_picture.hpp"
#include "roomscribe/report/html_text.hpp"
#include "roomscribe/report/png_image.hpp"
#include "roomscribe/report/report_views.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t picture_width = 900;  // pixels; pages show it at half the size

/// Bright colours that differ for neighbouring numbers: hues by the golden ratio.
Pixel color_of_patch(std::size_t patch) {
    const double hue = std::fmod(0.61803399 * static_cast<double>(patch), 1.0);
    Pixel color{0, 0, 0, 255};
    for (std::size_t channel = 0; channel < 3; ++channel) {
        const double turned = std::fmod(6.0 * hue + 6.0 - 2.0 * static_cast<double>(channel), 6.0);
        const double part = std::clamp(std::abs(turned - 3.0) - 1.0, 0.0, 1.0);
        color[channel] = static_cast<std::uint8_t>(std::lround(40.0 + 180.0 * part));
    }
    return color;
}

std::string css_color(const Pixel& color) {
    return fmt::format("rgb({} {} {})", color[0], color[1], color[2]);
}

/// From the front, right and above: walls and floors show about as much of themselves. The box is
/// still to be set.
CloudView slanted_view(const Reconstruction& reconstruction) {
    const Transform& room_from_map = reconstruction.scene.room_from_map;
    const Eigen::Vector3d to_viewer = Eigen::Vector3d(0.42, -0.68, 0.85).normalized();
    const Eigen::Vector3d right = Eigen::Vector3d::UnitZ().cross(to_viewer).normalized();
    Eigen::Matrix3d axes;
    axes << right.transpose(), to_viewer.cross(right).transpose(), to_viewer.transpose();
    CloudView view;
    view.width = picture_width;
    view.view_from_cloud.linear() = axes * room_from_map.linear();
    view.view_from_cloud.translation() = axes * room_from_map.translation();
    return view;
}

/// The patches of a picture and where their points lie on it.
struct StagePicture {
    CloudView view;
    std::vector<const OutlinedPatch*> patches;  ///< those that face the viewer, in the box

    Eigen::Vector2d percent_of(const Eigen::Vector3f& point) const {
        const Eigen::Vector3d p = view.view_from_cloud * point.cast<double>();
        const Eigen::Vector3d extent = view.high - view.low;
        return {100.0 * (p.x() - view.low.x()) / extent.x(),
                100.0 * (view.high.y() - p.y()) / extent.y()};
    }
};

StagePicture choose_patches(const Reconstruction& reconstruction) {
    StagePicture picture{slanted_view(reconstruction), {}};
    const Eigen::Vector3d to_viewer = picture.view.view_from_cloud.linear().row(2).transpose();
    Eigen::AlignedBox3d box = interesting_box(reconstruction);
    constexpr double margin = 0.1;  // m: window frames lie behind the wall
    box.min().array() -= margin;
    box.max().array() += margin;
    for (const OutlinedPatch& patch : reconstruction.patches) {
        if (patch.normal.dot(to_viewer) <= 0.0 || patch.points.empty()) continue;
        Eigen::Vector3d middle = Eigen::Vector3d::Zero();
        for (const Eigen::Vector3f& point : patch.points)
            middle += point.cast<double>() / static_cast<double>(patch.points.size());
        if (box.contains(Eigen::Vector3d(reconstruction.scene.room_from_map * middle)))
            picture.patches.push_back(&patch);
    }
    Eigen::AlignedBox3d seen;
    for (const OutlinedPatch* patch : picture.patches) {
        for (const Eigen::Vector3f& point : patch->points) {
            const Eigen::Vector3d p = point.cast<double>();
            if (box.contains(Eigen::Vector3d(reconstruction.scene.room_from_map * p)))
                seen.extend(Eigen::Vector3d(picture.view.view_from_cloud * p));
        }
    }
    picture.view.low = seen.min().array() - margin;
    picture.view.high = seen.max().array() + margin;
    return picture;
}

/// Points of the patches with the number of their patch; those of the rims stand before the others.
struct PatchPoints {
    std::vector<Eigen::Vector3f> places;
    std::vector<std::size_t> patches;
    std::size_t num_inner = 0;
};

PatchPoints points_of(const StagePicture& picture, bool with_boundary) {
    PatchPoints points;
    for (std::size_t i = 0; i < picture.patches.size(); ++i) {
        const auto& own = picture.patches[i]->points;
        points.places.insert(points.places.end(), own.begin(), own.end());
        points.patches.insert(points.patches.end(), own.size(), i);
    }
    points.num_inner = points.places.size();
    if (!with_boundary) return points;
    constexpr float before = 0.05F;  // m
    const Eigen::Vector3f to_viewer =
        picture.view.view_from_cloud.linear().row(2).transpose().cast<float>();
    for (std::size_t i = 0; i < picture.patches.size(); ++i) {
        for (const Eigen::Vector3f& point : picture.patches[i]->boundary) {
            points.places.emplace_back(point + before * to_viewer);
            points.patches.push_back(i);
        }
    }
    return points;
}

std::string encoded(const Image& image) {
    return encode_base64(encode_png(image));
}

struct StageText {
    std::string title;
    std::string caption;
};

std::string stage_figure(const StagePicture& picture, const StageText& text, const std::string& png,
                         const std::string& shapes) {
    const Eigen::Vector3d extent = picture.view.high - picture.view.low;
    return fmt::format(
        "<figure>\n<figcaption><strong>{0}</strong><span>{1}</span></figcaption>\n"
        "<div class=\"canvas{2}\" style=\"--aspect:{3:.4f}\"><img alt=\"{0}: {1}\" "
        "src=\"data:image/png;base64,{4}\"/>\n<svg viewBox=\"0 0 100 100\" "
        "preserveAspectRatio=\"none\" aria-hidden=\"true\">{5}</svg></div>\n</figure>\n",
        text.title, text.caption, shapes.empty() ? "" : " faint", extent.x() / extent.y(), png,
        shapes);
}

/// One path per patch, along each of its shapes; `end` closes a shape or not.
template <typename Shapes>
std::string paths(const StagePicture& picture, std::string_view end, const Shapes& shapes_of) {
    std::string svg;
    for (std::size_t i = 0; i < picture.patches.size(); ++i) {
        std::string path;
        for (const auto& corners : shapes_of(*picture.patches[i])) {
            char command = 'M';
            for (const Eigen::Vector3f& corner : corners) {
                const Eigen::Vector2d p = picture.percent_of(corner);
                path += fmt::format("{}{:.2f} {:.2f}", command, p.x(), p.y());
                command = 'L';
            }
            path += end;
        }
        if (path.empty()) continue;
        svg += fmt::format("<path class=\"stage-line\" style=\"stroke:{}\" d=\"{}\"/>\n",
                           css_color(color_of_patch(i)), path);
    }
    return svg;
}

}  // namespace

std::string stage_figures(const Reconstruction& reconstruction, const Context& context) {
    const StagePicture picture = choose_patches(reconstruction);
    if (!(picture.view.high.array() > picture.view.low.array()).all()) return {};
    std::size_t num_boundary = 0;
    std::size_t num_lines = 0;
    std::size_t num_rectangles = 0;
    for (const OutlinedPatch& patch : reconstruction.patches) {
        num_boundary += patch.boundary.size();
        num_lines += patch.lines.size();
        num_rectangles += patch.rectangles.size();
    }
    const PatchPoints inner = points_of(picture, false);
    const std::string planes = encoded(draw_cloud(
        inner.places, [&](std::size_t i) { return color_of_patch(inner.patches[i]); }, picture.view,
        PictureStyle::surface, context));
    const PatchPoints all = points_of(picture, true);
    const Pixel grey{170, 170, 170, 255};
    const std::string boundaries = encoded(draw_cloud(
        all.places,
        [&](std::size_t i) { return i < all.num_inner ? grey : color_of_patch(all.patches[i]); },
        picture.view, PictureStyle::surface, context));
    const std::string base = encoded(draw_cloud(
        inner.places, [&](std::size_t) { return grey; }, picture.view, PictureStyle::surface,
        context));

    std::string html =
        "<p class=\"note\">What the model was made of, from above at a slant; what turns its back "
        "on the viewer is left out, the ceiling first of all. Numbers are of the whole map.</p>\n"
        "<div class=\"stages\">\n";
    html += stage_figure(
        picture, {"Planes", with_separators(reconstruction.patches.size()) + " planar patches"},
        planes, "");
    html += stage_figure(
        picture,
        {"Boundaries", with_separators(num_boundary) + " points on the rims of planes and holes"},
        boundaries, "");
    html += stage_figure(
        picture, {"Lines", with_separators(num_lines) + " straight stretches of the boundaries"},
        base,
        paths(
            picture, "", [](const OutlinedPatch& patch) -> const auto& { return patch.lines; }));
    html += stage_figure(
        picture,
        {"Quadrilaterals",
         with_separators(num_rectangles) + " rectangles of which three or four sides were seen"},
        base,
        paths(
            picture, "Z",
            [](const OutlinedPatch& patch) -> const auto& { return patch.rectangles; }));
    return html + "</div>\n";
}

}  // namespace roomscribe
