// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/handles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace roomscribe {
namespace {

using Eigen::Vector3d;

// Holes are drilled on the 32 mm system.
constexpr std::array hole_spacings{0.064, 0.096, 0.128, 0.160, 0.192, 0.256, 0.320};

// Posts reach a little into the face so that no two surfaces lie in one plane.
constexpr double root = 0.0005;

struct Outline {
    Vector3d low;
    Vector3d high;
    Vector3d hold;   ///< where fingers close
    double opening;  ///< along y
};

/// Draws cylinders and blobs of one handle.
struct Shaper {
    SimulatedWorld& world;
    std::uint32_t part;
    const Transform& frame;

    void rod(const Vector3d& start, const Vector3d& end, double radius, int sides = 12) const {
        add_cylinder(world, part, frame * start, frame * end, radius, sides);
    }
};

Outline bar_outline(const HandleStyle& style) {
    const double half = style.length() / 2.0;
    const double radius = style.diameter / 2.0;
    return {{-half, -radius, 0.0},
            {half, radius, style.projection},
            {0.0, 0.0, style.projection - radius},
            style.diameter};
}

void add_bar(const Shaper& shaper, const HandleStyle& style) {
    const double radius = style.diameter / 2.0;
    const double axis = style.projection - radius;
    const double half = style.length() / 2.0;
    shaper.rod({-half, 0.0, axis}, {half, 0.0, axis}, radius);
    for (const double side : {-0.5, 0.5}) {
        const double x = side * style.hole_spacing;
        shaper.rod({x, 0.0, -root}, {x, 0.0, axis}, 0.8 * radius);
    }
}

void add_bow(const Shaper& shaper, const HandleStyle& style) {
    constexpr int num_pieces = 8;
    const double radius = style.diameter / 2.0;
    const auto point = [&](int i) {
        const double angle = std::numbers::pi * i / num_pieces;
        // The power flattens the middle: an arch, not a half-circle. Its ends are cut aslant.
        const double foot = 0.45 * radius;
        return Vector3d(-std::cos(angle) * style.hole_spacing / 2.0, 0.0,
                        foot + (style.projection - radius - foot) * std::pow(std::sin(angle), 0.6));
    };
    for (int i = 0; i < num_pieces; ++i)
        shaper.rod(point(i), point(i + 1), radius, 8);
}

void add_knob(const Shaper& shaper, const HandleStyle& style) {
    const double head = style.diameter / 2.0;
    const double thickness = std::min(style.diameter, 0.6 * style.projection);
    shaper.rod({0.0, 0.0, -root}, {0.0, 0.0, style.projection - 0.5 * thickness}, 0.35 * head);
    Transform center = Transform::Identity();
    center.translation().z() = style.projection - thickness / 2.0;
    add_ellipsoid(shaper.world, shaper.part, shaper.frame * center, {head, head, thickness / 2.0});
}

void add_lever(const Shaper& shaper, const HandleStyle& style) {
    const double radius = style.diameter / 2.0;
    const double axis = style.projection - radius;
    shaper.rod({0.0, 0.0, -root}, {0.0, 0.0, 0.008}, 2.2 * radius, 16);
    shaper.rod({0.0, 0.0, -root}, {0.0, 0.0, axis}, 0.9 * radius);
    shaper.rod({-radius, 0.0, axis}, {style.hole_spacing, 0.0, axis}, radius);
}

Outline outline_of(const HandleStyle& style) {
    const double radius = style.diameter / 2.0;
    switch (style.shape) {
        case HandleShape::knob:
            return {{-radius, -radius, 0.0},
                    {radius, radius, style.projection},
                    {0.0, 0.0, style.projection - 0.3 * style.projection},
                    style.diameter};
        case HandleShape::lever:
            return {{-2.2 * radius, -2.2 * radius, 0.0},
                    {style.hole_spacing, 2.2 * radius, style.projection},
                    {0.6 * style.hole_spacing, 0.0, style.projection - radius},
                    style.diameter};
        default:
            return bar_outline(style);
    }
}

Component describe(const Transform& frame, const HandleStyle& style, const std::string& parent) {
    const Outline outline = outline_of(style);
    Component handle;
    handle.label = Label::handle;
    handle.kind = style.shape == HandleShape::knob    ? "knob"
                  : style.shape == HandleShape::lever ? "lever_handle"
                                                      : "bar_handle";
    handle.parent = parent;
    OrientedBox box;
    box.center = frame * ((outline.low + outline.high) / 2.0);
    box.axes = {frame.linear().col(0), frame.linear().col(1), frame.linear().col(2)};
    box.size = outline.high - outline.low;
    handle.box = box;
    handle.grasp = Grasp{.position = frame * outline.hold,
                         .axis = frame.linear().col(1),
                         .approach = -frame.linear().col(2),
                         .opening = outline.opening};
    return handle;
}

}  // namespace

double HandleStyle::length() const {
    switch (shape) {
        case HandleShape::bar:
            return hole_spacing + 2.0 * overhang;
        case HandleShape::bow:
            return hole_spacing + diameter;
        case HandleShape::knob:
            return diameter;
        case HandleShape::lever:
            return hole_spacing + 1.1 * diameter;
        case HandleShape::none:
            break;
    }
    return 0.0;
}

HandleStyle choose_handle(Random& random) {
    constexpr std::array materials{Material::metal, Material::metal, Material::metal,
                                   Material::chrome, Material::black_plastic};
    HandleStyle style;
    style.material = materials[random.below(materials.size())];
    const double pick = random.uniform();
    if (pick < 0.45) {
        style.shape = HandleShape::bar;
        style.hole_spacing = hole_spacings[1 + random.below(6)];
        style.diameter = random.uniform(0.008, 0.014);
        // Half of the bars end at their posts, the others reach beyond (T-bars).
        style.overhang = random.below(2) == 0 ? style.diameter / 2.0 : random.uniform(0.015, 0.035);
        style.projection = random.uniform(0.025, 0.040);
    } else if (pick < 0.65) {
        style.shape = HandleShape::bow;
        style.hole_spacing = hole_spacings[1 + random.below(3)];
        style.diameter = random.uniform(0.007, 0.011);
        style.projection = random.uniform(0.025, 0.035);
    } else if (pick < 0.88) {
        style.shape = HandleShape::knob;
        style.diameter = random.uniform(0.020, 0.035);
        style.projection = random.uniform(0.020, 0.033);
        if (random.below(3) == 0) style.material = Material::wood;
    }
    return style;
}

HandleStyle fitted_handle(HandleStyle style, double max_length) {
    for (std::size_t i = hole_spacings.size(); i-- > 0 && style.length() > max_length;) {
        style.hole_spacing = std::min(style.hole_spacing, hole_spacings[i]);
    }
    return style;
}

void add_handle(SimulatedWorld& world, const Transform& world_from_handle, const HandleStyle& style,
                const std::string& parent) {
    if (style.shape == HandleShape::none) return;
    const std::int32_t component = add_component(world, describe(world_from_handle, style, parent));
    const Shaper shaper{world, add_part(world, component, style.material), world_from_handle};
    switch (style.shape) {
        case HandleShape::bar:
            add_bar(shaper, style);
            break;
        case HandleShape::bow:
            add_bow(shaper, style);
            break;
        case HandleShape::knob:
            add_knob(shaper, style);
            break;
        case HandleShape::lever:
            add_lever(shaper, style);
            break;
        case HandleShape::none:
            break;
    }
}

}  // namespace roomscribe
