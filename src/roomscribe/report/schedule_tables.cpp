// SPDX-License-Identifier: MIT
#include "roomscribe/report/schedule_tables.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "roomscribe/export/building.hpp"
#include "roomscribe/report/html_text.hpp"

namespace roomscribe {
namespace {

constexpr const char* none = "\u2013";

std::string what_of(const Component& component) {
    return in_words(component.kind.empty() ? label_name(component.label)
                                           : std::string_view(component.kind));
}

std::string room_name(const Building& building, std::size_t component) {
    const auto room = building.room_of[component];
    return room ? building.scene.rooms[*room].id : none;
}

/// On one line.
void put_name(HtmlTable& table, const std::string& name) {
    table.html(fmt::format("<span class=\"nowrap\">{}</span>", escape_html(name)));
}

std::string motion_of(const Component& component) {
    return component.opens ? std::string(motion_kind_name(component.opens->kind)) : none;
}

}  // namespace

std::string openings_table(const Scene& scene) {
    const Building building = describe_building(scene);
    HtmlTable table("Width and height are those of the leaf or the glass.",
                    {{"Element", false},
                     {"What", false},
                     {"Room", false},
                     {"Width (m)", true},
                     {"Height (m)", true},
                     {"Above floor (m)", true},
                     {"Width of frame (m)", true},
                     {"Height of frame (m)", true},
                     {"Opens", false}});
    for (std::size_t i = 0; i < building.scene.components.size(); ++i) {
        const Component& component = building.scene.components[i];
        if (component.label != Label::door && component.label != Label::window) continue;
        if (component.polygon.empty()) continue;
        const ComponentSize size = flat_size(component);
        double lowest = std::numeric_limits<double>::infinity();
        for (const Eigen::Vector3d& corner : component.polygon)
            lowest = std::min(lowest, corner.z());
        table.begin_row();
        table.html(escape_html(component.id), component.id);
        table.html(fmt::format("<span class=\"nowrap\"><i class=\"swatch label-{}\"></i>{}</span>",
                               label_name(component.label), escape_html(what_of(component))));
        put_name(table, room_name(building, i));
        table.number(size.width, 3);
        table.number(size.height, 3);
        table.number(lowest - floor_below(building, i), 3);
        const Component* frame = frame_around(building, i);
        const ComponentSize outer = frame != nullptr ? flat_size(*frame) : ComponentSize{};
        table.number(frame != nullptr ? std::optional(outer.width) : std::nullopt, 3);
        table.number(frame != nullptr ? std::optional(outer.height) : std::nullopt, 3);
        table.text(motion_of(component));
    }
    return table.finish();
}

std::string handles_table(const Scene& scene) {
    const Building building = describe_building(scene);
    HtmlTable table(
        "Where a gripper takes hold, in the room frame. It comes along the approach, with its "
        "fingers as far apart as the grip.",
        {{"Handle", false},
         {"What", false},
         {"On", false},
         {"Room", false},
         {"x (m)", true},
         {"y (m)", true},
         {"z (m)", true},
         {"Approach (x, y, z)", true},
         {"Grip (mm)", true},
         {"Opens", false}});
    for (std::size_t i = 0; i < building.scene.components.size(); ++i) {
        const Component& component = building.scene.components[i];
        if (component.label != Label::handle) continue;
        table.begin_row();
        table.html(escape_html(component.id), component.id);
        put_name(table, what_of(component));
        put_name(table, component.parent.empty() ? none : component.parent);
        put_name(table, room_name(building, i));
        const auto& grasp = component.grasp;
        for (const Eigen::Index axis : {0, 1, 2})
            table.number(grasp ? std::optional(grasp->position(axis)) : std::nullopt, 3);
        if (grasp) {
            const Eigen::Vector3d& way = grasp->approach;
            table.html(fmt::format("{} {} {}", decimal(way.x(), 2), decimal(way.y(), 2),
                                   decimal(way.z(), 2)));
        } else {
            table.text(none);
        }
        table.number(grasp ? std::optional(1000.0 * grasp->opening) : std::nullopt, 0);
        table.text(motion_of(component));
    }
    return table.finish();
}

}  // namespace roomscribe
