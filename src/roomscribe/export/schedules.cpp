// SPDX-License-Identifier: MIT
#include "roomscribe/export/schedules.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "roomscribe/export/wall_openings.hpp"
#include "roomscribe/geometry/polygon.hpp"

namespace roomscribe {
namespace {

using Row = std::vector<std::string>;

std::string cell(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text)
        quoted.append(c == '"' ? 2 : 1, c);
    return quoted + "\"";
}

std::string number(double value) {
    // -0 is 0.
    return fmt::format("{:.4f}", std::round(value * 1e4) / 1e4 + 0.0);
}

void append(Row& row, const Eigen::Vector3d& v) {
    row.insert(row.end(), {number(v.x()), number(v.y()), number(v.z())});
}

std::string csv(const std::string& heading, const std::vector<Row>& rows) {
    std::string text = heading + "\r\n";
    for (const Row& row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i)
            text += (i > 0 ? "," : "") + cell(row[i]);
        text += "\r\n";
    }
    return text;
}

std::string room_name(const Building& building, std::size_t component) {
    const auto room = building.room_of[component];
    return room ? building.scene.rooms[*room].id : "";
}

std::string storey_name(std::size_t storey) {
    return fmt::format("{}", storey + 1);
}

void append_trust(Row& row, const Component& component) {
    row.insert(row.end(),
               {number(component.confidence), std::string(verdict_name(component.verdict)),
                component.evidence.alternative});
}

Schedule rooms_schedule(const Building& building) {
    std::vector<Row> rows;
    for (std::size_t storey = 0; storey < building.storeys.size(); ++storey) {
        for (const std::size_t index : building.storeys[storey].rooms) {
            const Room& room = building.scene.rooms[index];
            const std::vector<Eigen::Vector2d> plan = plan_of_room(room);
            double perimeter = 0.0;
            for (std::size_t i = 0; i < plan.size(); ++i)
                perimeter += (plan[(i + 1) % plan.size()] - plan[i]).norm();
            std::string neighbors;
            for (const RoomNeighbor& neighbor : room.neighbors) {
                if (!neighbors.empty()) neighbors += " ";
                neighbors += neighbor.room;
            }
            rows.push_back({room.id, storey_name(storey), number(room.floor_height),
                            number(room.ceiling_height),
                            number(room.ceiling_height - room.floor_height), number(room.area),
                            number(room.volume), number(perimeter), neighbors});
        }
    }
    return {"rooms.csv", csv("id,storey,floor_m,ceiling_m,height_m,area_m2,volume_m3,perimeter_m,"
                             "neighbours",
                             rows)};
}

Schedule walls_schedule(const Building& building) {
    std::vector<Row> rows;
    std::vector<std::optional<std::size_t>> wall_of(building.scene.components.size());
    std::vector<std::size_t> face_of(building.scene.components.size());
    for (std::size_t i = 0; i < building.walls.size(); ++i) {
        for (std::size_t face = 0; face < building.walls[i].faces.size(); ++face) {
            wall_of[building.walls[i].faces[face].component] = i;
            face_of[building.walls[i].faces[face].component] = face;
        }
    }
    for (std::size_t i = 0; i < building.scene.components.size(); ++i) {
        const Component& component = building.scene.components[i];
        if (component.label != Label::wall) continue;
        const ComponentSize size = flat_size(component);
        Row row{component.id, room_name(building, i), number(size.width), number(size.height),
                number(area_vector(component.polygon).norm())};
        if (wall_of[i]) {
            const Wall& wall = building.walls[*wall_of[i]];
            double net = 0.0;
            for (const SpacePolygon& piece : pieces_of_face(building, *wall_of[i], face_of[i]))
                net += area_vector(piece).norm();
            std::string others;
            for (const FaceInPlan& face : wall.faces) {
                if (face.component == i) continue;
                if (!others.empty()) others += " ";
                others += building.scene.components[face.component].id;
            }
            row.insert(row.end(),
                       {number(net), number(wall.thickness),
                        std::string(thickness_source_name(wall.thickness_source)), others});
        } else {
            row.resize(row.size() + 4);
        }
        append_trust(row, component);
        rows.push_back(std::move(row));
    }
    return {"walls.csv", csv("id,room,width_m,height_m,area_m2,net_area_m2,thickness_m,"
                             "thickness_source,same_wall_as,confidence,verdict,alternative",
                             rows)};
}

/// Doors or windows.
Schedule openings_schedule(const Building& building, Label label, const char* file_name) {
    std::vector<Row> rows;
    for (std::size_t i = 0; i < building.scene.components.size(); ++i) {
        const Component& component = building.scene.components[i];
        if (component.label != label) continue;
        const ComponentSize size = flat_size(component);
        Row row{component.id,
                component.kind,
                component.parent,
                room_name(building, i),
                number(size.width),
                number(size.height),
                number(area_vector(component.polygon).norm())};
        double lowest = component.polygon.empty() ? 0.0 : component.polygon.front().z();
        for (const Eigen::Vector3d& corner : component.polygon)
            lowest = std::min(lowest, corner.z());
        row.push_back(number(lowest - floor_below(building, i)));
        if (const Component* frame = frame_around(building, i)) {
            const ComponentSize outer = flat_size(*frame);
            row.insert(row.end(), {frame->id, number(outer.width), number(outer.height)});
        } else {
            row.resize(row.size() + 3);
        }
        row.emplace_back(component.opens ? motion_kind_name(component.opens->kind) : "");
        append_trust(row, component);
        rows.push_back(std::move(row));
    }
    return {file_name, csv("id,kind,parent,room,width_m,height_m,area_m2,above_floor_m,frame,"
                           "frame_width_m,frame_height_m,opens,confidence,verdict,alternative",
                           rows)};
}

Schedule furniture_schedule(const Building& building) {
    std::vector<Row> rows;
    for (std::size_t i = 0; i < building.scene.components.size(); ++i) {
        const Component& component = building.scene.components[i];
        if (component.label != Label::furniture) continue;
        Row row{component.id, component.kind, component.parent, room_name(building, i)};
        if (component.box) {
            const BoxSize size = box_size(*component.box);
            row.insert(row.end(),
                       {number(size.width), number(size.depth), number(size.height), ""});
            append(row, component.box->center);
        } else {
            const ComponentSize size = flat_size(component);
            row.insert(row.end(), {number(size.width), "", number(size.height),
                                   number(area_vector(component.polygon).norm())});
            Eigen::Vector3d center = Eigen::Vector3d::Zero();
            for (const Eigen::Vector3d& corner : component.polygon)
                center += corner / static_cast<double>(component.polygon.size());
            append(row, center);
        }
        row.emplace_back(component.opens ? motion_kind_name(component.opens->kind) : "");
        append_trust(row, component);
        rows.push_back(std::move(row));
    }
    return {"furniture.csv", csv("id,kind,parent,room,width_m,depth_m,height_m,area_m2,x_m,y_m,z_m,"
                                 "opens,confidence,verdict,alternative",
                                 rows)};
}

Schedule handles_schedule(const Building& building) {
    std::vector<Row> rows;
    for (std::size_t i = 0; i < building.scene.components.size(); ++i) {
        const Component& component = building.scene.components[i];
        if (component.label != Label::handle) continue;
        Row row{component.id, component.kind, component.parent, room_name(building, i)};
        if (component.box) {
            const BoxSize size = box_size(*component.box);
            row.insert(row.end(), {number(size.width), number(size.depth), number(size.height)});
        } else {
            row.resize(row.size() + 3);
        }
        if (component.grasp) {
            append(row, component.grasp->position);
            append(row, component.grasp->axis);
            append(row, component.grasp->approach);
            row.push_back(number(component.grasp->opening));
        } else {
            row.resize(row.size() + 10);
        }
        row.emplace_back(component.opens ? motion_kind_name(component.opens->kind) : "");
        append_trust(row, component);
        rows.push_back(std::move(row));
    }
    return {"handles.csv",
            csv("id,kind,parent,room,width_m,depth_m,height_m,grasp_x_m,grasp_y_m,grasp_z_m,"
                "axis_x,axis_y,axis_z,approach_x,approach_y,approach_z,opening_m,opens,confidence,"
                "verdict,alternative",
                rows)};
}

}  // namespace

std::vector<Schedule> building_to_schedules(const Building& building) {
    return {rooms_schedule(building),
            walls_schedule(building),
            openings_schedule(building, Label::door, "doors.csv"),
            openings_schedule(building, Label::window, "windows.csv"),
            furniture_schedule(building),
            handles_schedule(building)};
}

}  // namespace roomscribe
