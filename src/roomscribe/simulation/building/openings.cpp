// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/building/openings.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "roomscribe/core/random.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/simulation/handles.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

// What joiners build (docs/simulation.md, "Doors and windows").
constexpr double leaf_thickness = 0.04;
constexpr double leaf_gap = 0.003;
constexpr double gap_under_leaf = 0.008;
constexpr double lever_height = 1.05;
constexpr double window_frame_depth = 0.07;

std::vector<Vector3d> corners_at(const Transform& frame, const WallArea& area, double y) {
    return {frame * Vector3d(area.x_low, y, area.z_low),
            frame * Vector3d(area.x_high, y, area.z_low),
            frame * Vector3d(area.x_high, y, area.z_high),
            frame * Vector3d(area.x_low, y, area.z_high)};
}

void add_sheet(SimulatedWorld& world, std::uint32_t part, const Transform& frame,
               const WallArea& area, double y) {
    add_polygon(world, part, corners_at(frame, area, y));
}

/// The border between two rectangles, the inner one within the outer; no strip where they touch.
void add_border(SimulatedWorld& world, std::uint32_t part, const Transform& frame,
                const WallArea& outer, const WallArea& inner, double y) {
    const std::array strips{WallArea{outer.x_low, inner.x_low, outer.z_low, outer.z_high},
                            WallArea{inner.x_high, outer.x_high, outer.z_low, outer.z_high},
                            WallArea{inner.x_low, inner.x_high, outer.z_low, inner.z_low},
                            WallArea{inner.x_low, inner.x_high, inner.z_high, outer.z_high}};
    for (const WallArea& strip : strips) {
        if (strip.x_high - strip.x_low > 0.0 && strip.z_high - strip.z_low > 0.0) {
            add_sheet(world, part, frame, strip, y);
        }
    }
}

/// The sides of a tunnel through the wall; its bottom too if that is above the floor.
void add_tunnel(SimulatedWorld& world, std::uint32_t part, const Transform& frame,
                const WallArea& area, double y_near, double y_far) {
    const std::vector<Vector3d> near = corners_at(frame, area, y_near);
    const std::vector<Vector3d> far = corners_at(frame, area, y_far);
    for (std::size_t i = area.z_low > 0.0 ? 0 : 1; i < 4; ++i) {
        const std::size_t next = (i + 1) % 4;
        add_quad(world, part, near[i], near[next], far[next], far[i]);
    }
}

/// A frame of boxes within `outer`, `width` wide.
void add_frame_boxes(SimulatedWorld& world, std::uint32_t part, const Transform& frame,
                     const WallArea& outer, double width, double y_low, double y_high) {
    const auto bar = [&](double x_low, double x_high, double z_low, double z_high) {
        add_box(world, part, frame, {x_low, y_low, z_low}, {x_high, y_high, z_high});
    };
    bar(outer.x_low, outer.x_high, outer.z_low, outer.z_low + width);
    bar(outer.x_low, outer.x_high, outer.z_high - width, outer.z_high);
    bar(outer.x_low, outer.x_low + width, outer.z_low + width, outer.z_high - width);
    bar(outer.x_high - width, outer.x_high, outer.z_low + width, outer.z_high - width);
}

/// What both sides of a door have.
HandleStyle choose_door_handle(bool is_knob, Random& random) {
    HandleStyle style;
    style.shape = is_knob ? HandleShape::knob : HandleShape::lever;
    style.hole_spacing = random.uniform(0.10, 0.14);
    style.diameter = is_knob ? 0.054 : random.uniform(0.016, 0.022);
    style.projection = is_knob ? 0.065 : random.uniform(0.045, 0.06);
    return style;
}

/// The frame of a lever on a leaf: x towards the hinge, z out of the leaf. `side` is +1 towards the
/// room; `towards_hinge` is +1 or -1 along x.
Transform frame_of_lever(const Transform& leaf, const Vector3d& spindle, double side,
                         double towards_hinge) {
    Transform lever = Transform::Identity();
    lever.linear().col(0) = towards_hinge * Vector3d::UnitX();
    lever.linear().col(2) = side * Vector3d::UnitY();
    lever.linear().col(1) = lever.linear().col(2).cross(lever.linear().col(0));
    lever.translation() = spindle;
    return leaf * lever;
}

/// The whole doorway but for the gaps around.
WallArea closed_leaf(const OpeningPlan& opening) {
    const double half = opening.width / 2.0;
    return {-half + leaf_gap, half - leaf_gap, gap_under_leaf, opening.height - leaf_gap};
}

double leaf_back(const OpeningPlan& opening, const OpeningSite& site) {
    return opening.opens_into_room ? -opening.recess - leaf_thickness
                                   : -site.thickness + opening.recess;
}

void add_leaf(SimulatedWorld& world, const OpeningPlan& opening, const Transform& site,
              std::int32_t door, const DoorLeaf& leaf, Random& random) {
    const Transform frame = frame_of_leaf(site, leaf);
    const WallArea& area = leaf.area;
    const double y_high = leaf.y_low + leaf_thickness;
    const bool is_dark = random.uniform() < 0.25;
    const std::uint32_t part =
        add_part(world, door, is_dark ? Material::dark_wood : Material::wood);
    const double stile = 0.11;
    if (opening.is_glazed) {
        add_frame_boxes(world, part, frame, area, stile, leaf.y_low, y_high);
        const std::uint32_t pane = add_part(world, door, Material::glass);
        world.parts[pane].transparency = opening.transparency;
        add_sheet(
            world, pane, frame,
            {area.x_low + stile, area.x_high - stile, area.z_low + stile, area.z_high - stile},
            leaf.y_low + leaf_thickness / 2.0);
    } else {
        add_box(world, part, frame, {area.x_low, leaf.y_low, area.z_low},
                {area.x_high, y_high, area.z_high});
    }
    const double free_edge = leaf.hinge_side > 0.0 ? area.x_low + 0.06 : area.x_high - 0.06;
    const HandleStyle handle = choose_door_handle(opening.style % 6 == 5, random);
    const std::string id = world.scene.components[static_cast<std::size_t>(door)].id;
    for (const auto& [y, side] : {std::pair{y_high, 1.0}, std::pair{leaf.y_low, -1.0}}) {
        add_handle(world,
                   frame_of_lever(frame, {free_edge, y, lever_height}, side, leaf.hinge_side),
                   handle, id);
    }
}

/// Casing on both faces, lining between them.
void add_door_frame(SimulatedWorld& world, const OpeningPlan& opening, const OpeningSite& site) {
    const double half = opening.width / 2.0;
    const double outer = half + opening.frame_width;
    const double out = opening.frame_protrusion;
    const WallArea hole{-outer, outer, 0.0, opening.height + opening.frame_width};
    const WallArea way{-half, half, 0.0, opening.height};

    Component frame;
    frame.label = Label::door_frame;
    // Either casing of an inner wall may be what a scan saw, and both are near this plane.
    frame.polygon = corners_at(site.world_from_site, hole, -std::min(site.thickness / 2.0, 0.12));
    const std::int32_t component = add_component(world, std::move(frame));

    const std::uint32_t casing = add_part(world, component, Material::paint);
    for (const auto& [face, front] :
         {std::pair{0.0, out}, std::pair{-site.thickness, -site.thickness - out}}) {
        add_border(world, casing, site.world_from_site, hole, way, front);
        if (out > 0.0) add_tunnel(world, casing, site.world_from_site, hole, face, front);
    }
    const std::uint32_t lining =
        add_part(world, component, Material::paint, label_bit(Label::wall));
    add_tunnel(world, lining, site.world_from_site, way, out, -site.thickness - out);
}

void add_bare_lining(SimulatedWorld& world, const OpeningPlan& opening, const OpeningSite& site,
                     std::int32_t wall) {
    const double half = opening.width / 2.0;
    const std::uint32_t part =
        add_part(world, wall, Material::paint,
                 static_cast<LabelSet>(label_bit(Label::door_frame) | label_bit(Label::unknown)));
    add_tunnel(world, part, site.world_from_site, {-half, half, 0.0, opening.height}, 0.0,
               -site.thickness);
}

void add_threshold(SimulatedWorld& world, const OpeningPlan& opening, const OpeningSite& site,
                   std::int32_t floor) {
    const double half = opening.width / 2.0;
    const Transform& frame = site.world_from_site;
    add_quad(world, add_part(world, floor, Material::wood), frame * Vector3d(-half, 0.0, 0.0),
             frame * Vector3d(half, 0.0, 0.0), frame * Vector3d(half, -site.thickness, 0.0),
             frame * Vector3d(-half, -site.thickness, 0.0));
}

std::int32_t add_door(SimulatedWorld& world, const OpeningPlan& opening, const OpeningSite& site) {
    Random random(opening.style);
    Component component;
    component.label = Label::door;
    component.kind = opening.is_glazed ? "glazed_door" : opening.is_double ? "double_door" : "";
    component.polygon = corners_at(site.world_from_site, closed_leaf(opening),
                                   leaf_back(opening, site) + leaf_thickness / 2.0);
    const std::int32_t door = add_component(world, std::move(component));
    for (const DoorLeaf& leaf : door_leaves(opening, site))
        add_leaf(world, opening, site.world_from_site, door, leaf, random);
    return door;
}

std::int32_t add_passage(SimulatedWorld& world, const OpeningPlan& opening,
                         const OpeningSite& site) {
    const double half = opening.width / 2.0;
    Component component;
    component.kind = "opening";
    component.polygon =
        corners_at(site.world_from_site, {-half, half, 0.0, opening.height}, -site.thickness / 2.0);
    return add_component(world, std::move(component));
}

void add_blind(SimulatedWorld& world, const OpeningPlan& opening, const Transform& frame,
               std::int32_t window, const WallArea& hole) {
    const std::uint32_t part = add_part(world, window, Material::fabric, label_bit(Label::unknown));
    const double low = hole.z_high - opening.blind * (hole.z_high - hole.z_low);
    const double y = -opening.recess + 0.012;
    add_box(world, part, frame, {hole.x_low + 0.01, y, low},
            {hole.x_high - 0.01, y + 0.003, hole.z_high - 0.05});
    add_box(world, part, frame, {hole.x_low + 0.01, y - 0.01, hole.z_high - 0.05},
            {hole.x_high - 0.01, y + 0.03, hole.z_high - 0.002});
}

void add_window(SimulatedWorld& world, const OpeningPlan& opening, const OpeningSite& site,
                std::int32_t wall) {
    Random random(opening.style);
    const Transform& frame = site.world_from_site;
    const double half = opening.width / 2.0;
    const double width = opening.frame_width;
    const WallArea hole{-half, half, opening.sill, opening.sill + opening.height};
    const WallArea glazing{hole.x_low + width, hole.x_high - width, hole.z_low + width,
                           hole.z_high - width};
    const double front = -opening.recess;
    const double pane_y = front - window_frame_depth / 2.0;

    Component frame_component;
    frame_component.label = Label::window_frame;
    frame_component.polygon = corners_at(frame, hole, front);
    const std::int32_t window_frame = add_component(world, std::move(frame_component));
    const std::uint32_t bars = add_part(world, window_frame, Material::lacquer);
    add_frame_boxes(world, bars, frame, hole, width, front - window_frame_depth, front);
    for (int i = 1; i <= opening.mullions; ++i) {
        const double x =
            glazing.x_low + (glazing.x_high - glazing.x_low) * i / (opening.mullions + 1);
        add_box(world, bars, frame, {x - width * 0.4, front - 0.06, glazing.z_low},
                {x + width * 0.4, front - 0.006, glazing.z_high});
    }

    Component window_component;
    window_component.label = Label::window;
    window_component.polygon = corners_at(frame, glazing, pane_y);
    const std::int32_t window = add_component(world, std::move(window_component));
    const std::uint32_t pane = add_part(world, window, Material::glass);
    world.parts[pane].transparency = opening.transparency;
    add_sheet(world, pane, frame, glazing, pane_y);
    if (opening.blind > 0.0) add_blind(world, opening, frame, window, hole);

    const std::uint32_t reveal =
        add_part(world, wall, Material::paint, label_bit(Label::window_frame));
    add_tunnel(world, reveal, frame, hole, 0.0, -site.thickness);
    if (opening.sill > 0.3) {
        Component sill;
        sill.kind = "sill";
        const std::uint32_t board = add_part(
            world, add_component(world, std::move(sill)), Material::tile,
            static_cast<LabelSet>(label_bit(Label::wall) | label_bit(Label::window_frame)));
        add_box(world, board, frame, {-half - 0.03, front + 0.001, opening.sill - 0.026},
                {half + 0.03, random.uniform(0.03, 0.12), opening.sill + 0.004});
    }
}

void add_niche(SimulatedWorld& world, const OpeningPlan& opening, const OpeningSite& site) {
    const double half = opening.width / 2.0;
    const WallArea hole{-half, half, opening.sill, opening.sill + opening.height};
    Component component;
    component.kind = "niche";
    component.polygon = corners_at(site.world_from_site, hole, -opening.recess);
    const std::uint32_t part = add_part(world, add_component(world, std::move(component)),
                                        Material::paint, label_bit(Label::wall));
    add_tunnel(world, part, site.world_from_site, hole, 0.0, -opening.recess);
    add_sheet(world, part, site.world_from_site, hole, -opening.recess);
}

}  // namespace

std::vector<DoorLeaf> door_leaves(const OpeningPlan& opening, const OpeningSite& site) {
    const WallArea closed = closed_leaf(opening);
    const double y_low = leaf_back(opening, site);
    const double swing = opening.opens_into_room ? 1.0 : -1.0;
    const double angle = opening.leaf == LeafState::closed ? 0.0 : radians(opening.leaf_angle);
    const double hinge_side = opening.is_hinged_left ? 1.0 : -1.0;
    if (!opening.is_double) return {{closed, y_low, hinge_side, angle, swing}};
    // The passive leaf stays where it is unless the door stands wide open.
    const double passive_angle = opening.leaf == LeafState::open ? angle : 0.0;
    WallArea left = closed;
    left.x_low = leaf_gap / 2.0;
    WallArea right = closed;
    right.x_high = -leaf_gap / 2.0;
    return {{left, y_low, 1.0, hinge_side > 0.0 ? angle : passive_angle, swing},
            {right, y_low, -1.0, hinge_side < 0.0 ? angle : passive_angle, swing}};
}

Transform frame_of_leaf(const Transform& world_from_site, const DoorLeaf& leaf) {
    const double y = leaf.swing > 0.0 ? leaf.y_low + leaf_thickness : leaf.y_low;
    const Vector3d hinge(leaf.hinge_side > 0.0 ? leaf.area.x_high : leaf.area.x_low, y, 0.0);
    Transform frame = world_from_site;
    frame.translate(hinge);
    frame.rotate(Eigen::AngleAxisd(-leaf.hinge_side * leaf.swing * leaf.angle, Vector3d::UnitZ()));
    frame.translate(-hinge);
    return frame;
}

std::int32_t add_opening(SimulatedWorld& world, const OpeningPlan& opening, const OpeningSite& site,
                         std::int32_t wall, std::int32_t floor) {
    switch (opening.kind) {
        case OpeningKind::window:
            add_window(world, opening, site, wall);
            return -1;
        case OpeningKind::niche:
            add_niche(world, opening, site);
            return -1;
        case OpeningKind::door:
        case OpeningKind::passage:
            break;
    }
    add_threshold(world, opening, site, floor);
    if (opening.frame_width > 0.0) {
        add_door_frame(world, opening, site);
    } else {
        add_bare_lining(world, opening, site, wall);
    }
    return opening.kind == OpeningKind::door ? add_door(world, opening, site)
                                             : add_passage(world, opening, site);
}

}  // namespace roomscribe
