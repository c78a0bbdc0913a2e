// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/paper_rules/label_by_rules.hpp"

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/interpretation/paper_rules/openings_by_rules.hpp"
#include "roomscribe/interpretation/paper_rules/room_by_pass_through.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

constexpr std::size_t no_component = static_cast<std::size_t>(-1);

/// By label: the accuracies of the paper's Table 4.
constexpr std::array<double, num_labels> paper_accuracy{0.0, 1.0, 1.0, 0.94, 0.8,
                                                        0.8, 0.4, 0.8, 0.94, 0.93};

/// An opening and the numbers of its components.
struct LabelledOpening {
    RuleOpening opening;
    std::size_t leaf = 0;
    std::size_t frame = no_component;
};

bool is_in(const WallRectangle& rectangle, double along, double height) {
    return along >= rectangle.start && along <= rectangle.end && height >= rectangle.bottom &&
           height <= rectangle.top;
}

class RuleLabeller {
  public:
    RuleLabeller(const PointCloud& map, std::span<const PlanarPatch> planes,
                 const Eigen::Matrix3d& room_from_map)
        : map_(map),
          planes_(planes),
          room_from_map_(room_from_map),
          up_(room_from_map.row(2).transpose()),
          component_of_plane_(planes.size(), no_component) {}

    void add_room(const RuleRoom& room) {
        add_level(Label::floor, room.floor,
                  "level plane in the lowest slice along z (pass-through filter)");
        add_level(Label::ceiling, room.ceiling,
                  "level plane in the highest slice along z (pass-through filter)");
        for (const RuleWall& wall : room.walls) {
            Component& component =
                add(Label::wall, {wall.plane},
                    "upright plane along x or y that reaches the ceiling (rules i and ii)");
            component.polygon = polygon_on(wall, {wall.extent, 0.0});
        }
        set_frame(room);
    }

    /// Precondition: add_room was called with this room.
    void add_openings(std::span<const RuleOpening> openings, const RuleRoom& room) {
        for (const RuleOpening& opening : openings) {
            const RuleWall& wall = room.walls[opening.wall];
            const std::string parent = scene_.components[component_of_plane_[wall.plane]].id;
            const bool is_door = opening.type == OpeningType::door;
            LabelledOpening labelled{opening, scene_.components.size(), no_component};
            Component& leaf =
                is_door ? add(Label::door, {},
                              "quadrilateral of a door's size in a wall, very close to the floor "
                              "(rules iii and iv)")
                        : add(Label::window, {},
                              "quadrilateral of a window's size in a wall, closer to the ceiling, "
                              "embedded (rules iv and v)");
            leaf.polygon = polygon_on(wall, opening.leaf);
            leaf.parent = parent;
            if (opening.frame) {
                labelled.frame = scene_.components.size();
                Component& frame = add(is_door ? Label::door_frame : Label::window_frame, {},
                                       "quadrilateral around that of the opening");
                frame.polygon = polygon_on(wall, *opening.frame);
                frame.parent = parent;
            }
            openings_.push_back(labelled);
        }
    }

    PointLabels label_points(const RuleRoom& room, double plane_tolerance, double wall_depth,
                             const Context& context);

    Scene take_scene() { return std::move(scene_); }

  private:
    Component& add(Label label, std::span<const std::uint32_t> planes, std::string rule) {
        Component component;
        component.label = label;
        component.id =
            fmt::format("{}-{}", label_name(label), ++counts_[static_cast<std::size_t>(label)]);
        component.instance = static_cast<std::int32_t>(scene_.components.size());
        component.confidence = paper_accuracy[static_cast<std::size_t>(label)];
        component.verdict = Verdict::accepted;
        component.evidence.rule = std::move(rule);
        if (!planes.empty()) component.evidence.rms = planes_[planes.front()].rms;
        for (const std::uint32_t plane : planes)
            component_of_plane_[plane] = scene_.components.size();
        scene_.components.push_back(std::move(component));
        return scene_.components.back();
    }
    Component& add(Label label, std::initializer_list<std::uint32_t> planes, std::string rule) {
        return add(label, std::span<const std::uint32_t>(planes.begin(), planes.size()),
                   std::move(rule));
    }

    /// One floor or ceiling of all its planes: a rectangle along x and y (rule ii).
    void add_level(Label label, std::span<const std::uint32_t> planes, std::string rule) {
        if (planes.empty()) return;
        Component& component = add(label, planes, std::move(rule));
        Eigen::AlignedBox2d box;
        for (const std::uint32_t plane : planes) {
            for (const std::uint32_t point : planes_[plane].points) {
                box.extend(
                    (room_from_map_ * map_.positions[point].cast<double>()).head<2>().eval());
            }
        }
        const Plane& plane = planes_[planes.front()].plane;
        for (const auto corner : {Eigen::AlignedBox2d::BottomLeft, Eigen::AlignedBox2d::BottomRight,
                                  Eigen::AlignedBox2d::TopRight, Eigen::AlignedBox2d::TopLeft}) {
            const Eigen::Vector2d place = box.corner(corner);
            const Vector3d point = room_from_map_.transpose() * Vector3d(place.x(), place.y(), 0.0);
            // Straight up or down to the plane.
            component.polygon.emplace_back(point - plane.signed_distance(point) /
                                                       plane.normal.dot(up_) * up_);
        }
    }

    std::vector<Vector3d> polygon_on(const RuleWall& wall, const RuleRectangle& rectangle) const {
        const Vector3d level_normal = (wall.face.normal - wall.face.normal.dot(up_) * up_);
        const auto corner = [&](double along, double height) -> Vector3d {
            const Vector3d point = along * wall.along + height * up_;
            // Straight across to the plane, which may lean a little.
            const double distance = wall.face.signed_distance(point) + rectangle.depth;
            return point - distance / level_normal.dot(wall.face.normal) * level_normal;
        };
        const WallRectangle& e = rectangle.extent;
        return {corner(e.start, e.bottom), corner(e.end, e.bottom), corner(e.end, e.top),
                corner(e.start, e.top)};
    }

    void set_frame(const RuleRoom& room) {
        Eigen::AlignedBox3d box;
        for (const Component& component : scene_.components) {
            for (const Vector3d& corner : component.polygon)
                box.extend(room_from_map_ * corner);
        }
        scene_.room_from_map.linear() = room_from_map_;
        if (box.isEmpty()) return;
        scene_.room_from_map.translation() =
            -Vector3d(box.min().x(), box.min().y(), room.floor_height.value_or(room.bottom));
    }

    const PointCloud& map_;
    std::span<const PlanarPatch> planes_;
    Eigen::Matrix3d room_from_map_;
    Vector3d up_;
    Scene scene_;
    std::vector<std::size_t> component_of_plane_;
    std::vector<LabelledOpening> openings_;
    std::array<int, num_labels> counts_{};
};

PointLabels RuleLabeller::label_points(const RuleRoom& room, double plane_tolerance,
                                       double wall_depth, const Context& context) {
    std::vector<std::size_t> component_of(map_.size(), no_component);
    for (std::size_t plane = 0; plane < planes_.size(); ++plane) {
        for (const std::uint32_t point : planes_[plane].points)
            component_of[point] = component_of_plane_[plane];
    }
    const auto opening_at = [&](const Vector3d& point) {
        for (const LabelledOpening& labelled : openings_) {
            const RuleOpening& opening = labelled.opening;
            const RuleWall& wall = room.walls[opening.wall];
            const double depth = -wall.face.signed_distance(point);
            if (!(depth >= -plane_tolerance && depth <= wall_depth)) continue;
            const double along = point.dot(wall.along);
            const double height = point.dot(up_);
            // Lines run through the middle of the rim's points.
            const auto holds = [&](const RuleRectangle& rectangle) {
                return is_in(
                    rectangle.extent.grown(plane_tolerance, plane_tolerance, plane_tolerance),
                    along, height);
            };
            if (holds(opening.leaf)) return labelled.leaf;
            if (opening.frame && holds(*opening.frame)) return labelled.frame;
        }
        return no_component;
    };
    PointLabels result;
    result.labels.assign(map_.size(), Label::unknown);
    result.instances.assign(map_.size(), -1);
    result.confidences.assign(map_.size(), 0.0F);
    parallel_for(context, map_.size(), 8192, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            std::size_t number = component_of[i];
            const bool is_level =
                number != no_component && (scene_.components[number].label == Label::floor ||
                                           scene_.components[number].label == Label::ceiling);
            if (!is_level) {
                const std::size_t opening = opening_at(map_.positions[i].cast<double>());
                if (opening != no_component) number = opening;
            }
            if (number == no_component) continue;
            const Component& component = scene_.components[number];
            result.labels[i] = component.label;
            result.instances[i] = component.instance;
            result.confidences[i] = static_cast<float>(component.confidence);
        }
    });
    return result;
}

}  // namespace

RuleLabels label_by_rules(const PointCloud& map, std::span<const PlanarPatch> planes,
                          std::span<const PlaneQuadrilateral> quadrilaterals,
                          const Eigen::Matrix3d& room_from_map, double plane_tolerance,
                          const PaperRulesSettings& settings, const Context& context) {
    const Vector3d up = room_from_map.row(2).transpose();
    const RuleRoom room = find_room_by_pass_through(map, planes, room_from_map, settings);
    context.throw_if_cancelled();
    RuleLabeller labeller(map, planes, room_from_map);
    labeller.add_room(room);
    labeller.add_openings(
        find_openings_by_rules(map, planes, quadrilaterals, room, up, plane_tolerance, settings),
        room);
    RuleLabels result;
    result.labels = labeller.label_points(room, plane_tolerance, settings.wall_depth, context);
    result.scene = labeller.take_scene();
    return result;
}

}  // namespace roomscribe
