// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/furnishing/furniture_fronts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "roomscribe/core/units.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double handle_edge = 0.045;      // from a door's edge to the middle of its handle
constexpr double handle_end_space = 0.05;  // from a door's upper or lower edge to the handle
constexpr double framed_recess = 0.006;
constexpr double front_frame = 0.065;

enum class FrontKind : std::uint8_t { door, drawer, flap };

struct Front {
    FaceArea area;  ///< without the gaps
    FrontKind kind = FrontKind::door;
    bool is_hinged_at_low_y = true;
    double opening = 0.0;  ///< rad for a door, m for a drawer
};

/// Item from front: turned about the outer edge on the hinge's side, as overlay hinges do, or
/// pulled out.
Transform front_pose(const Front& front) {
    if (front.kind == FrontKind::drawer) return moved({front.opening, 0.0, 0.0});
    if (front.kind == FrontKind::flap || front.opening == 0.0) return Transform::Identity();
    const double hinge_y = front.is_hinged_at_low_y ? front.area.low.x() : front.area.high.x();
    const Vector3d hinge(front.area.x, hinge_y, 0.0);
    const double angle = front.is_hinged_at_low_y ? -front.opening : front.opening;
    return moved_and_turned(hinge, Vector3d::UnitZ(), angle) * moved(-hinge);
}

/// Frame of a handle at a place of the face; x along y or z of the item.
Transform handle_pose(const Front& front, double y, double z, bool is_upright) {
    Transform pose = moved({front.area.x, y, z});
    pose.linear().col(0) = is_upright ? Vector3d::UnitZ() : Vector3d::UnitY();
    pose.linear().col(2) = Vector3d::UnitX();
    pose.linear().col(1) = pose.linear().col(2).cross(pose.linear().col(0));
    return front_pose(front) * pose;
}

double reach_height(const ItemBuilder& builder) {
    return 1.05 - builder.item().elevation;
}

double door_handle_height(const ItemBuilder& builder, const FaceArea& area, HandleHeight height,
                          double length) {
    const double lowest = area.low.y() + handle_end_space + length / 2.0;
    const double highest = area.high.y() - handle_end_space - length / 2.0;
    if (lowest > highest) return (lowest + highest) / 2.0;
    switch (height) {
        case HandleHeight::high:
            return highest;
        case HandleHeight::low:
            return lowest;
        case HandleHeight::in_reach:
            break;
    }
    return std::clamp(reach_height(builder), lowest, highest);
}

void add_door_handle(ItemBuilder& builder, const Front& front, const FrontStyle& style,
                     const std::string& face) {
    const FaceArea& area = front.area;
    const bool is_flap = front.kind == FrontKind::flap;
    const bool is_lever = style.handle.shape == HandleShape::lever;
    const bool is_level = is_flap || style.has_level_door_handles;
    const HandleStyle handle = fitted_handle(
        style.handle, is_level ? 0.8 * area.width() : area.height() - 2.0 * handle_end_space);
    const double opening_side = front.is_hinged_at_low_y ? 1.0 : -1.0;
    const double middle = (area.low.x() + area.high.x()) / 2.0;
    double y = middle + opening_side * (area.width() / 2.0 - handle_edge);
    double z = door_handle_height(builder, area, style.handle_height, handle.length());
    if (is_level && !is_lever) {
        const double inset = handle_edge - 0.01 + handle.length() / 2.0;
        y = is_flap ? middle : middle + opening_side * (area.width() / 2.0 - inset);
        z = door_handle_height(builder, area, style.handle_height, handle.diameter);
    }
    Transform pose = handle_pose(front, y, z, !is_level && !is_lever);
    if (is_lever && opening_side > 0.0) {
        // A lever points at the hinge.
        pose = pose * moved_and_turned(Vector3d::Zero(), Vector3d::UnitZ(), radians(180.0));
    }
    add_handle(builder.world(), builder.world_from_item() * pose, handle, face);
}

void add_drawer_handles(ItemBuilder& builder, const Front& front, const FrontStyle& style,
                        const std::string& face) {
    const FaceArea& area = front.area;
    const bool is_wide = area.width() > 0.75 && style.handle.hole_spacing < 0.2;
    const int count = is_wide ? 2 : 1;
    const HandleStyle handle = fitted_handle(style.handle, 0.7 * area.width() / count);
    const double below_edge = std::min(0.045, area.height() / 2.0);
    const double z =
        style.has_handles_above ? area.high.y() - below_edge : (area.low.y() + area.high.y()) / 2.0;
    for (int i = 0; i < count; ++i) {
        const double share = is_wide ? (i == 0 ? 0.22 : 0.78) : 0.5;
        const double y = area.low.x() + share * area.width();
        add_handle(builder.world(), builder.world_from_item() * handle_pose(front, y, z, false),
                   handle, face);
    }
}

/// The drawer behind a front that is pulled out: it belongs to the front.
void add_drawer_box(ItemBuilder& builder, std::uint32_t part, const Front& front,
                    const FrontStyle& style) {
    const Vector2d low = front.area.low + Vector2d(0.02, 0.015);
    const Vector2d high = front.area.high - Vector2d(0.02, 0.04);
    const double back = front.area.x - style.thickness - style.setback - 0.05;
    const double inner = front.area.x + front.opening - style.thickness - 0.001;
    builder.box(part, {back, low.x(), low.y()}, {inner, high.x(), low.y() + 0.012});
    builder.box(part, {back, low.x(), low.y()}, {inner, low.x() + 0.014, high.y()});
    builder.box(part, {back, high.x() - 0.014, low.y()}, {inner, high.x(), high.y()});
}

void add_front_panel(ItemBuilder& builder, std::uint32_t part, const Front& front,
                     const FrontStyle& style) {
    const FaceArea& area = front.area;
    const Transform pose = front_pose(front);
    const double back = area.x - style.thickness;
    const bool is_framed = style.is_framed && front.kind == FrontKind::door &&
                           std::min(area.width(), area.height()) > 0.25;
    const double panel = is_framed ? area.x - framed_recess : area.x;
    builder.box(part, pose, {back, area.low.x(), area.low.y()},
                {panel, area.high.x(), area.high.y()});
    if (!is_framed) return;
    const double y0 = area.low.x();
    const double y1 = area.high.x();
    const double z0 = area.low.y();
    const double z1 = area.high.y();
    builder.box(part, pose, {back, y0, z0}, {area.x, y0 + front_frame, z1});
    builder.box(part, pose, {back, y1 - front_frame, z0}, {area.x, y1, z1});
    builder.box(part, pose, {back, y0, z0}, {area.x, y1, z0 + front_frame});
    builder.box(part, pose, {back, y0, z1 - front_frame}, {area.x, y1, z1});
}

void add_front(ItemBuilder& builder, const Front& front, const FrontStyle& style) {
    const FaceArea& area = front.area;
    const Transform pose = front_pose(front);
    const std::int32_t face =
        builder.add_face(front.kind == FrontKind::drawer ? "drawer" : "door",
                         {pose * Vector3d(area.x, area.low.x(), area.low.y()),
                          pose * Vector3d(area.x, area.high.x(), area.low.y()),
                          pose * Vector3d(area.x, area.high.x(), area.high.y()),
                          pose * Vector3d(area.x, area.low.x(), area.high.y())},
                         front.opening > 0.0);
    const std::uint32_t part = builder.part_of(face, style.material);
    add_front_panel(builder, part, front, style);
    const std::string id = builder.id_of(face);
    if (front.kind == FrontKind::drawer) {
        add_drawer_handles(builder, front, style, id);
        if (front.opening > 0.0) add_drawer_box(builder, part, front, style);
    } else {
        add_door_handle(builder, front, style, id);
    }
}

/// Collects the fronts of a bay before anything is built, since an open door wants a hollow
/// carcass.
class BayPlan {
  public:
    BayPlan(ItemBuilder& builder, const FrontStyle& style) : builder_(builder), style_(style) {}

    void door(const FaceArea& area, bool is_hinged_at_low_y) {
        Front front{.area = without_gap(area), .is_hinged_at_low_y = is_hinged_at_low_y};
        if (builder_.chance(style_.ajar_share)) {
            // Most stand ajar, few wide open.
            const double share = builder_.pick(0.0, 1.0);
            front.opening = radians(5.0 + 75.0 * share * share);
            is_hollow = true;
        }
        fronts.push_back(front);
    }
    void double_door(const FaceArea& area) {
        FaceArea right = area;
        FaceArea left = area;
        right.high.x() = left.low.x() = (area.low.x() + area.high.x()) / 2.0;
        door(right, true);
        door(left, false);
    }
    void drawer(const FaceArea& area) {
        Front front{.area = without_gap(area), .kind = FrontKind::drawer};
        if (builder_.chance(style_.ajar_share / 2.0) && !has_open_drawer_) {
            front.opening = builder_.pick(0.03, 0.25);
            has_open_drawer_ = true;
        }
        fronts.push_back(front);
    }
    void flap(const FaceArea& area) {
        fronts.push_back({.area = without_gap(area), .kind = FrontKind::flap});
    }

    std::vector<Front> fronts;
    bool is_hollow = false;

  private:
    FaceArea without_gap(FaceArea area) const {
        const Vector2d half(style_.gap / 2.0, style_.gap / 2.0);
        area.low += half;
        area.high -= half;
        return area;
    }

    ItemBuilder& builder_;
    const FrontStyle& style_;
    bool has_open_drawer_ = false;
};

void plan_drawers(BayPlan& plan, const FaceArea& area, int count, double graded) {
    // From the top down each is higher than the one above by the same share.
    double sum = 0.0;
    for (int i = 0; i < count; ++i)
        sum += 1.0 + graded * i;
    double z = area.high.y();
    for (int i = 0; i < count; ++i) {
        FaceArea drawer = area;
        drawer.high.y() = z;
        z = i + 1 == count ? area.low.y() : z - area.height() * (1.0 + graded * i) / sum;
        drawer.low.y() = z;
        plan.drawer(drawer);
    }
}

/// A black glass door, and above it a panel of buttons that is part of the piece.
void add_oven(ItemBuilder& builder, const FaceArea& area, FrontStyle style, BayPlan& plan) {
    FaceArea glass = area;
    glass.high.y() -= 0.1;
    builder.box(builder.part(Material::black_plastic),
                {area.x - style.thickness, area.low.x() + 0.002, glass.high.y() + 0.002},
                {area.x, area.high.x() - 0.002, area.high.y() - 0.002});
    plan.flap(glass);
}

FaceArea upper_part(FaceArea area, double height) {
    area.low.y() = area.high.y() - height;
    return area;
}

FaceArea lower_part(FaceArea area, double height) {
    area.high.y() -= height;
    return area;
}

FrontStyle oven_style(FrontStyle style) {
    style.material = Material::screen;
    style.is_framed = false;
    style.handle = {.shape = HandleShape::bar,
                    .hole_spacing = 0.320,
                    .overhang = 0.04,
                    .diameter = 0.014,
                    .projection = 0.04};
    return style;
}

}  // namespace

FrontStyle choose_front_style(Random& random, Material material) {
    FrontStyle style;
    constexpr std::array thicknesses{0.016, 0.018, 0.019, 0.022};
    style.thickness = thicknesses[random.below(thicknesses.size())];
    style.gap = random.uniform(0.003, 0.005);
    style.material = material;
    style.carcass = material == Material::dark_wood ? Material::dark_wood : Material::wood;
    style.handle = choose_handle(random);
    style.is_framed = random.uniform() < 0.25;
    style.has_handles_above = random.uniform() < 0.5;
    style.has_level_door_handles = random.uniform() < 0.2;
    return style;
}

void add_bay(ItemBuilder& builder, const FaceArea& area, BayContent content,
             const FrontStyle& bay_style, int num_drawers) {
    const FrontStyle style = content == BayContent::oven ? oven_style(bay_style) : bay_style;
    BayPlan plan(builder, style);
    const double drawer_height = std::min(0.16, area.height() / 3.0);
    const bool is_hinged_at_low_y = builder.chance(0.5);
    switch (content) {
        case BayContent::door:
            plan.door(area, is_hinged_at_low_y);
            break;
        case BayContent::double_door:
            plan.double_door(area);
            break;
        case BayContent::drawers:
            plan_drawers(plan, area, num_drawers, builder.chance(0.5) ? 0.0 : 0.5);
            break;
        case BayContent::drawer_and_door:
            plan.drawer(upper_part(area, drawer_height));
            plan.door(lower_part(area, drawer_height), is_hinged_at_low_y);
            break;
        case BayContent::drawer_and_double_door:
            plan.drawer(upper_part(area, drawer_height));
            plan.double_door(lower_part(area, drawer_height));
            break;
        case BayContent::oven:
            add_oven(builder, area, style, plan);
            break;
        case BayContent::flap:
            plan.flap(area);
            break;
        case BayContent::shelves:
            plan.is_hollow = true;
            break;
    }
    add_carcass(builder, area, style, plan.is_hollow);
    for (const Front& front : plan.fronts)
        add_front(builder, front, style);
}

}  // namespace roomscribe
