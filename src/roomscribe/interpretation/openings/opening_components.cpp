// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/openings/opening_components.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace roomscribe {
namespace {

using Eigen::Vector3d;

/// m behind the face: between the casings of a wall of usual thickness.
constexpr double usual_frame_depth = 0.06;

/// Where no casing was seen, the frame of a leaf deep in the wall is set as deep.
double depth_of_frame(const WallOpening& opening) {
    const bool is_at_leaf =
        !opening.has_casing && !opening.is_open && opening.depth > 2.0 * usual_frame_depth;
    return is_at_leaf ? opening.depth : usual_frame_depth;
}

/// The components of the openings, and the rooms that they lead to.
class ComponentBuilder {
  public:
    explicit ComponentBuilder(RoomSurfaces& surfaces) : surfaces_(surfaces) {
        for (const RoomSurface& surface : surfaces.surfaces)
            next_instance_ = std::max(next_instance_, surface.component.instance + 1);
    }

    void add(WallOpening& opening, std::vector<Component>& components) {
        const StoreyLayout& layout = surfaces_.storeys[opening.storey];
        const WallFace& face = face_of(opening, surfaces_);
        const std::size_t surface = opening.is_in_roof ? layout.ceiling_of_slope[opening.face]
                                                       : layout.wall_of_face[opening.face];
        const std::string wall = surfaces_.surfaces[surface].component.id;
        const auto push = [&](Label label, const WallRectangle& rectangle, double depth) {
            Component component;
            component.label = label;
            const bool is_passage = label == Label::unknown;
            if (is_passage) component.kind = "opening";
            component.id = fmt::format("{}-{}", is_passage ? component.kind : label_name(label),
                                       ++counts_[static_cast<std::size_t>(label)]);
            component.instance = next_instance_++;
            component.parent = wall;
            const Vector3d on_plane = (face.plane.offset - depth) * face.plane.normal;
            const auto corner = [&](double along, double height) -> Vector3d {
                return on_plane + along * face.along + height * face.up;
            };
            component.polygon = {
                corner(rectangle.start, rectangle.bottom), corner(rectangle.end, rectangle.bottom),
                corner(rectangle.end, rectangle.top), corner(rectangle.start, rectangle.top)};
            component.confidence = opening.confidence;
            component.verdict = opening.alternative.empty() ? Verdict::accepted : Verdict::doubtful;
            component.evidence.alternative = opening.alternative;
            component.evidence.coverage = opening.coverage;
            component.evidence.occluded = opening.hidden;
            component.evidence.rule = opening.rule;
            opening.components.push_back(components.size());
            components.push_back(std::move(component));
        };
        const WallRectangle& hole = opening.hole;
        const double width = opening.frame_width;
        switch (opening.type) {
            case OpeningType::window:
                push(Label::window, hole.grown(-width, -width, -width), opening.depth);
                push(Label::window_frame, hole, opening.frame_depth);
                break;
            case OpeningType::door:
                push(Label::door, hole, opening.depth);
                push(Label::door_frame, hole.grown(width, 0.0, width), depth_of_frame(opening));
                connect(opening, layout, components[opening.components[0]].id);
                break;
            case OpeningType::passage:
                push(Label::unknown, hole, opening.depth);
                // Ways without a leaf are plastered as often as not.
                if (opening.has_casing)
                    push(Label::door_frame, hole.grown(width, 0.0, width), usual_frame_depth);
                connect(opening, layout, components[opening.components[0]].id);
                break;
        }
    }

  private:
    void connect(const WallOpening& opening, const StoreyLayout& layout, const std::string& id) {
        const std::int32_t before = layout.faces[opening.face].room;
        if (before == no_room || opening.room_behind == no_room) return;
        const std::string& here = layout.room_ids[static_cast<std::size_t>(before)];
        const std::string& there = layout.room_ids[static_cast<std::size_t>(opening.room_behind)];
        for (Room& room : surfaces_.rooms) {
            if (room.id == here) room.neighbors.push_back({there, id});
            if (room.id == there) room.neighbors.push_back({here, id});
        }
    }

    RoomSurfaces& surfaces_;
    std::int32_t next_instance_ = 0;
    std::array<int, num_labels> counts_{};
};

}  // namespace

std::vector<Component> make_opening_components(std::span<WallOpening> openings,
                                               RoomSurfaces& surfaces) {
    std::vector<Component> components;
    ComponentBuilder builder(surfaces);
    for (WallOpening& opening : openings)
        builder.add(opening, components);
    return components;
}

}  // namespace roomscribe
