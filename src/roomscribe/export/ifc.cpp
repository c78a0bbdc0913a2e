// SPDX-License-Identifier: MIT
#include "roomscribe/export/ifc.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "roomscribe/export/ifc_geometry.hpp"
#include "roomscribe/export/json.hpp"
#include "roomscribe/export/planar_pieces.hpp"
#include "roomscribe/export/wall_openings.hpp"
#include "roomscribe/geometry/polygon.hpp"

namespace roomscribe {
namespace {

/// What a scan does not show the back of; each says so in its properties.
constexpr double nominal_slab = 0.1;
constexpr double nominal_covering = 0.01;
constexpr double nominal_leaf = 0.04;
constexpr double nominal_pane = 0.02;
/// An opening sticks out of both faces of its wall, so that no skin is left.
constexpr double void_overhang = 0.1;

/// A value with its IFC type: "IFCREAL(0.9)".
using Properties = std::vector<std::pair<std::string, std::string>>;

std::string label_value(std::string_view text) {
    return fmt::format("IFCLABEL({})", step_text(text));
}
std::string text_value(std::string_view text) {
    return fmt::format("IFCTEXT({})", step_text(text));
}
std::string real_value(double value) {
    return fmt::format("IFCREAL({})", step_real(value));
}
std::string length_value(double value) {
    return fmt::format("IFCLENGTHMEASURE({})", step_real(value));
}

struct Quantity {
    enum class Kind : std::uint8_t { length, area, volume } kind;
    const char* name;
    double value;
};

Eigen::Vector3d flat(const Eigen::Vector2d& v) {
    return {v.x(), v.y(), 0.0};
}

/// Furniture types of IFC4; what it has no word for is said in ObjectType.
std::string furniture_type(const std::string& kind) {
    static const std::map<std::string, std::string> types{
        {"chair", ".CHAIR."}, {"office_chair", ".CHAIR."}, {"armchair", ".CHAIR."},
        {"table", ".TABLE."}, {"desk", ".DESK."},          {"bed", ".BED."},
        {"shelf", ".SHELF."}, {"sofa", ".SOFA."}};
    const auto found = types.find(kind);
    return found == types.end() ? ".USERDEFINED." : found->second;
}

class IfcWriter {
  public:
    explicit IfcWriter(const Building& building)
        : building_(building),
          seed_(ifc_global_id(scene_to_json(building.scene))),
          geometry_(file_),
          is_placed_(building.scene.components.size(), false) {}

    std::string write(const IfcOrigin& origin) {
        add_project();
        for (std::size_t i = 0; i < building_.storeys.size(); ++i)
            add_rooms(i);
        for (std::size_t i = 0; i < building_.walls.size(); ++i)
            add_wall(i);
        for (const Opening& opening : building_.openings)
            add_opening(opening);
        add_joins();
        for (std::size_t i = 0; i < building_.scene.components.size(); ++i)
            add_component(i);
        for (std::size_t i = 0; i < contained_.size(); ++i)
            add_containment(i);
        return file_.text(header(origin));
    }

  private:
    const Component& component(std::size_t index) const {
        return building_.scene.components[index];
    }
    double elevation(std::size_t storey) const { return building_.storeys[storey].elevation; }

    std::string guid(std::string_view key) const {
        return step_text(ifc_global_id(fmt::format("{}/{}", seed_, key)));
    }

    static std::string header(const IfcOrigin& origin) {
        return fmt::format(
            "FILE_DESCRIPTION(('ViewDefinition [ReferenceView_V1.2]'),'2;1');\n"
            "FILE_NAME({},{},(''),(''),{},{},'');\nFILE_SCHEMA(('IFC4'));\n",
            step_text(origin.file_name), step_text(origin.time_stamp),
            step_text("roomscribe " + origin.version), step_text("roomscribe " + origin.version));
    }

    void add_project() {
        std::vector<std::string> units;
        for (const auto& [kind, name] :
             {std::pair{".LENGTHUNIT.", ".METRE."}, std::pair{".AREAUNIT.", ".SQUARE_METRE."},
              std::pair{".VOLUMEUNIT.", ".CUBIC_METRE."},
              std::pair{".PLANEANGLEUNIT.", ".RADIAN."}}) {
            units.push_back(file_.add("IFCSIUNIT", {"*", kind, "$", name}));
        }
        const std::string assignment = file_.add("IFCUNITASSIGNMENT", {step_list(units)});
        const std::string project =
            file_.add("IFCPROJECT", {guid("project"), "$", "'Scanned building'", "$", "$", "$", "$",
                                     "(" + geometry_.context() + ")", assignment});
        const std::string site_place = geometry_.placement("$");
        const std::string site =
            file_.add("IFCSITE", {guid("site"), "$", "'Site'", "$", "$", site_place, "$", "$",
                                  ".ELEMENT.", "$", "$", "$", "$", "$"});
        const std::string building_place = geometry_.placement(site_place);
        const std::string building =
            file_.add("IFCBUILDING", {guid("building"), "$", "'Building'", "$", "$", building_place,
                                      "$", "$", ".ELEMENT.", "$", "$", "$"});
        std::vector<std::string> storeys;
        for (std::size_t i = 0; i < building_.storeys.size(); ++i) {
            storey_places_.push_back(
                geometry_.placement(building_place, {{0.0, 0.0, elevation(i)}}));
            storeys.push_back(
                file_.add("IFCBUILDINGSTOREY",
                          {guid(fmt::format("storey-{}", i + 1)), "$",
                           step_text(fmt::format("Storey {}", i + 1)), "$", "$",
                           storey_places_.back(), "$", "$", ".ELEMENT.", step_real(elevation(i))}));
        }
        aggregate("project-site", project, {site});
        aggregate("site-building", site, {building});
        aggregate("building-storeys", building, storeys);
        storeys_ = storeys;
        contained_.resize(storeys.size());
    }

    void aggregate(std::string_view key, const std::string& whole,
                   const std::vector<std::string>& parts) {
        if (parts.empty()) return;
        file_.add("IFCRELAGGREGATES", {guid(key), "$", "$", "$", whole, step_list(parts)});
    }

    void define(const std::string& object, std::string_view key, const std::string& definition) {
        file_.add("IFCRELDEFINESBYPROPERTIES", {guid(fmt::format("{}/defines", key)), "$", "$", "$",
                                                "(" + object + ")", definition});
    }

    void add_properties(const std::string& object, std::string_view key,
                        const Properties& properties) {
        std::vector<std::string> values;
        for (const auto& [name, value] : properties) {
            values.push_back(
                file_.add("IFCPROPERTYSINGLEVALUE", {step_text(name), "$", value, "$"}));
        }
        const std::string id = fmt::format("{}/Pset_Roomscribe", key);
        define(object, id,
               file_.add("IFCPROPERTYSET",
                         {guid(id), "$", "'Pset_Roomscribe'", "$", step_list(values)}));
    }

    void add_quantities(const std::string& object, std::string_view key, const char* set,
                        const std::vector<Quantity>& quantities) {
        std::vector<std::string> values;
        for (const Quantity& quantity : quantities) {
            const char* entity = quantity.kind == Quantity::Kind::length ? "IFCQUANTITYLENGTH"
                                 : quantity.kind == Quantity::Kind::area ? "IFCQUANTITYAREA"
                                                                         : "IFCQUANTITYVOLUME";
            values.push_back(file_.add(
                entity, {step_text(quantity.name), "$", "$", step_real(quantity.value), "$"}));
        }
        const std::string id = fmt::format("{}/{}", key, set);
        define(object, id,
               file_.add("IFCELEMENTQUANTITY",
                         {guid(id), "$", step_text(set), "$", "$", step_list(values)}));
    }

    Properties properties_of(const Component& component) const {
        Properties properties{{"Id", label_value(component.id)},
                              {"Label", label_value(label_name(component.label))},
                              {"Confidence", real_value(component.confidence)},
                              {"Verdict", label_value(verdict_name(component.verdict))}};
        const auto add = [&](const char* name, const std::string& text) {
            if (!text.empty()) properties.emplace_back(name, text_value(text));
        };
        add("Kind", component.kind);
        add("Parent", component.parent);
        add("Evidence", component.evidence.rule);
        add("Alternative", component.evidence.alternative);
        return properties;
    }

    /// Arguments that all elements begin with, up to Tag.
    std::string add_element(const char* entity, const std::string& key, const std::string& kind,
                            const std::string& place, const std::string& shape,
                            const std::vector<std::string>& rest) {
        const std::string type = kind.empty() ? "$" : step_text(kind);
        return file_.add(entity, {guid(key), "$", step_text(key), "$", type, place, shape,
                                  step_text(key), fmt::format("{}", fmt::join(rest, ","))});
    }

    void add_rooms(std::size_t storey) {
        std::vector<std::string> spaces;
        for (const std::size_t index : building_.storeys[storey].rooms) {
            const Room& room = building_.scene.rooms[index];
            const double height = room.ceiling_height - room.floor_height;
            const std::string place = geometry_.placement(
                storey_places_[storey], {{0.0, 0.0, room.floor_height - elevation(storey)}});
            std::string shape = "$";
            const PlanePolygon outline = clean_outline(plan_of_room(room));
            if (outline.size() >= 3 && height > 0.0)
                shape = geometry_.shape({geometry_.prism({}, outline, height)});
            const std::string space =
                file_.add("IFCSPACE", {guid(room.id), "$", step_text(room.id), "$", "$", place,
                                       shape, step_text(room.id), ".ELEMENT.", ".INTERNAL.", "$"});
            spaces.push_back(space);
            using Kind = Quantity::Kind;
            add_quantities(space, room.id, "Qto_SpaceBaseQuantities",
                           {{Kind::length, "Height", height},
                            {Kind::area, "GrossFloorArea", room.area},
                            {Kind::area, "NetFloorArea", room.area},
                            {Kind::volume, "GrossVolume", room.volume},
                            {Kind::volume, "NetVolume", room.volume}});
            Properties properties{{"Id", label_value(room.id)}};
            for (const RoomNeighbor& neighbor : room.neighbors) {
                properties.emplace_back(
                    fmt::format("Neighbour{}", properties.size()),
                    label_value(
                        neighbor.through.empty()
                            ? neighbor.room
                            : fmt::format("{} through {}", neighbor.room, neighbor.through)));
            }
            add_properties(space, room.id, properties);
        }
        aggregate(fmt::format("storey-{}-spaces", storey + 1), storeys_[storey], spaces);
    }

    /// A face that is no rectangle, under a slanted ceiling, gives the wall its elevation.
    const Component* slanted_face(const Wall& wall) const {
        for (const FaceInPlan& face : wall.faces) {
            const Component& component = this->component(face.component);
            const double rectangle = (face.end - face.start).norm() * (face.top - face.bottom);
            const double area = area_vector(component.polygon).norm();
            // Corners of a rectangle that was fitted differ from it by less.
            constexpr double off_square = 0.02;
            if (area < (1.0 - off_square) * rectangle) return &component;
        }
        return nullptr;
    }

    std::string wall_body(const Wall& wall) {
        const double half = 0.5 * wall.thickness;
        if (const Component* face = slanted_face(wall)) {
            PlanePolygon outline;
            for (const Eigen::Vector3d& corner : face->polygon) {
                outline.emplace_back(wall.along().dot(corner.head<2>() - wall.start),
                                     corner.z() - wall.bottom);
            }
            if (signed_area(outline) < 0.0) std::reverse(outline.begin(), outline.end());
            // Drawn upright, extruded across the wall from its left face to its right.
            const IfcPlace place{half * Eigen::Vector3d::UnitY(), -Eigen::Vector3d::UnitY(),
                                 Eigen::Vector3d::UnitX()};
            return geometry_.prism(place, clean_outline(outline), wall.thickness, Label::wall);
        }
        return geometry_.box({}, {wall.body_from, -half}, {wall.body_to, half},
                             wall.top - wall.bottom, Label::wall);
    }

    void add_wall(std::size_t index) {
        const Wall& wall = building_.walls[index];
        const std::string place = geometry_.placement(
            storey_places_[wall.storey],
            {flat(wall.start) + (wall.bottom - elevation(wall.storey)) * Eigen::Vector3d::UnitZ(),
             Eigen::Vector3d::UnitZ(), flat(wall.along())});
        const std::string shape = geometry_.shape({wall_body(wall)}, wall.length());
        const std::string element =
            add_element("IFCWALL", wall.id, "", place, shape, {".NOTDEFINED."});
        wall_places_.push_back(place);
        walls_.push_back(element);
        contained_[wall.storey].push_back(element);

        Properties properties = properties_of(component(wall.faces.front().component));
        properties.emplace_back("ThicknessSource",
                                label_value(thickness_source_name(wall.thickness_source)));
        for (std::size_t i = 0; i < wall.faces.size(); ++i) {
            const FaceInPlan& face = wall.faces[i];
            const ComponentSize size = flat_size(component(face.component));
            const std::string name = fmt::format("Face{}", i + 1);
            properties.emplace_back(name, label_value(component(face.component).id));
            properties.emplace_back(name + "Width", length_value(size.width));
            properties.emplace_back(name + "Height", length_value(size.height));
        }
        add_properties(element, wall.id, properties);

        const double length = wall.body_to - wall.body_from;
        const double height = wall.top - wall.bottom;
        const double gross = length * height;
        const double net = gross - area_of_openings(building_, index);
        using Kind = Quantity::Kind;
        std::vector<Quantity> quantities{{Kind::length, "Length", length},
                                         {Kind::length, "Width", wall.thickness},
                                         {Kind::length, "Height", height}};
        if (slanted_face(wall) == nullptr) {
            quantities.push_back({Kind::area, "GrossSideArea", gross});
            quantities.push_back({Kind::area, "NetSideArea", net});
            quantities.push_back({Kind::volume, "GrossVolume", gross * wall.thickness});
            quantities.push_back({Kind::volume, "NetVolume", net * wall.thickness});
        }
        add_quantities(element, wall.id, "Qto_WallBaseQuantities", quantities);
    }

    void add_joins() {
        for (std::size_t i = 0; i < building_.walls.size(); ++i) {
            for (const WallJoin& join : building_.walls[i].joins) {
                // Two ends that meet are one relation.
                const bool other_end = join.place != WallJoin::Place::along;
                const auto& back = building_.walls[join.wall].joins;
                const bool is_mutual =
                    other_end && std::any_of(back.begin(), back.end(), [&](const WallJoin& other) {
                        return other.wall == i &&
                               other.at_start == (join.place == WallJoin::Place::start);
                    });
                if (is_mutual && join.wall < i) continue;
                const char* of_this = join.at_start ? ".ATSTART." : ".ATEND.";
                const char* of_other = join.place == WallJoin::Place::along   ? ".ATPATH."
                                       : join.place == WallJoin::Place::start ? ".ATSTART."
                                                                              : ".ATEND.";
                const std::string key = fmt::format("{}/{}/{}", building_.walls[i].id,
                                                    building_.walls[join.wall].id, of_this);
                file_.add("IFCRELCONNECTSPATHELEMENTS",
                          {guid(key), "$", "$", "$", "$", walls_[i], walls_[join.wall], "()", "()",
                           of_other, of_this});
            }
        }
    }

    void add_opening(const Opening& opening) {
        const Wall& wall = building_.walls[opening.wall];
        const std::string key = "opening of " + component(opening.component()).id;
        const std::string place = geometry_.placement(
            wall_places_[opening.wall], {{opening.from, 0.0, opening.bottom - wall.bottom}});
        const double width = opening.to - opening.from;
        const double height = opening.top - opening.bottom;
        if (width <= 0.0 || height <= 0.0) return;
        // A leaf may lie beside the body of its wall, as far as the lining goes.
        const double reach = 0.5 * wall.thickness + void_overhang;
        const std::string shape =
            geometry_.shape({geometry_.box({}, {0.0, -reach}, {width, reach}, height)});
        const std::string hole =
            add_element("IFCOPENINGELEMENT", key, "", place, shape, {".OPENING."});
        file_.add("IFCRELVOIDSELEMENT",
                  {guid(key + "/voids"), "$", "$", "$", walls_[opening.wall], hole});
        if (opening.filling) add_filling(opening, hole, place);
    }

    /// A flat upright component as a body in the frame of its opening: `thickness` about its plane.
    std::string panel(const Opening& opening, const Component& component, double thickness,
                      Label color) {
        const Wall& wall = building_.walls[opening.wall];
        const Eigen::Vector3d normal = area_vector(component.polygon).normalized();
        Eigen::Matrix3d wall_from_world;
        wall_from_world.row(0) = flat(wall.along());
        wall_from_world.row(1) = flat(wall.left());
        wall_from_world.row(2) = Eigen::Vector3d::UnitZ();
        const Eigen::Vector3d origin = flat(wall.start + opening.from * wall.along()) +
                                       opening.bottom * Eigen::Vector3d::UnitZ();
        const Eigen::Vector3d z = wall_from_world * normal;
        const Eigen::Vector3d x = Eigen::Vector3d::UnitZ().cross(z).normalized();
        const Eigen::Vector3d y = z.cross(x);
        const Eigen::Vector3d first = wall_from_world * (component.polygon.front() - origin);
        PlanePolygon outline;
        for (const Eigen::Vector3d& corner : component.polygon) {
            const Eigen::Vector3d local = wall_from_world * (corner - origin) - first;
            outline.emplace_back(x.dot(local), y.dot(local));
        }
        if (signed_area(outline) < 0.0) std::reverse(outline.begin(), outline.end());
        return geometry_.prism({first - 0.5 * thickness * z, z, x}, clean_outline(outline),
                               thickness, color);
    }

    std::string add_door_or_window(const Component& filling, const std::string& place,
                                   const std::string& body) {
        const bool is_door = filling.label == Label::door;
        const ComponentSize size = flat_size(filling);
        const std::string shape = geometry_.shape({body});
        return add_element(is_door ? "IFCDOOR" : "IFCWINDOW", filling.id, filling.kind, place,
                           shape,
                           {step_real(size.height), step_real(size.width),
                            is_door ? ".DOOR." : ".WINDOW.", ".NOTDEFINED.", "$"});
    }

    void add_filling(const Opening& opening, const std::string& hole,
                     const std::string& hole_place) {
        const Component& filling = component(*opening.filling);
        is_placed_[*opening.filling] = true;
        const double thickness = filling.label == Label::door ? nominal_leaf : nominal_pane;
        const std::string body = panel(opening, filling, thickness, filling.label);
        const std::string element =
            add_door_or_window(filling, geometry_.placement(hole_place), body);
        file_.add("IFCRELFILLSELEMENT",
                  {guid(filling.id + "/fills"), "$", "$", "$", hole, element});
        contained_[building_.walls[opening.wall].storey].push_back(element);
        Properties properties = properties_of(filling);
        properties.emplace_back("BodyThickness", label_value("nominal"));
        if (opening.frame) {
            const ComponentSize outer = flat_size(component(*opening.frame));
            properties.emplace_back("Frame", label_value(component(*opening.frame).id));
            properties.emplace_back("FrameWidth", length_value(outer.width));
            properties.emplace_back("FrameHeight", length_value(outer.height));
        }
        add_properties(element, filling.id, properties);
    }

    /// What has a polygon, `thickness` deep behind it, seen from the room, or before it.
    std::string sheet(const std::vector<Eigen::Vector3d>& polygon, const Eigen::Vector3d& towards,
                      double thickness, Label color, double storey_elevation) {
        Eigen::Vector3d z = area_vector(polygon).normalized();
        if (z.dot(towards) < 0.0) z = -z;
        Eigen::Vector3d x = z.unitOrthogonal();
        if (std::abs(z.z()) > 0.7) x = (Eigen::Vector3d::UnitX() - z.x() * z).normalized();
        const Eigen::Vector3d y = z.cross(x);
        PlanePolygon outline;
        for (const Eigen::Vector3d& corner : polygon) {
            const Eigen::Vector3d local = corner - polygon.front();
            outline.emplace_back(x.dot(local), y.dot(local));
        }
        if (signed_area(outline) < 0.0) std::reverse(outline.begin(), outline.end());
        const Eigen::Vector3d origin =
            polygon.front() - storey_elevation * Eigen::Vector3d::UnitZ();
        return geometry_.prism({origin, z, x}, clean_outline(outline), thickness, color);
    }

    /// A door or window that lies in no wall that was found.
    void add_lone_filling(std::size_t index) {
        const Component& filling = component(index);
        if (is_placed_[index] || area_vector(filling.polygon).norm() < 1e-6) return;
        const std::size_t storey = building_.storey_of[index];
        const std::string body = sheet(filling.polygon, area_vector(filling.polygon), nominal_pane,
                                       filling.label, elevation(storey));
        const std::string element =
            add_door_or_window(filling, geometry_.placement(storey_places_[storey]), body);
        contained_[storey].push_back(element);
        add_properties(element, filling.id, properties_of(filling));
    }

    void add_sheet(std::size_t index, const char* entity, const char* type,
                   const Eigen::Vector3d& towards, double thickness) {
        const Component& component = this->component(index);
        if (area_vector(component.polygon).norm() < 1e-6) return;
        const std::size_t storey = building_.storey_of[index];
        const std::string shape = geometry_.shape(
            {sheet(component.polygon, towards, thickness, component.label, elevation(storey))});
        const std::string element =
            add_element(entity, component.id, component.kind,
                        geometry_.placement(storey_places_[storey]), shape, {type});
        contained_[storey].push_back(element);
        Properties properties = properties_of(component);
        properties.emplace_back("ThicknessSource", label_value("nominal"));
        add_properties(element, component.id, properties);
    }

    void add_box(std::size_t index, const char* entity, const std::string& type) {
        const Component& component = this->component(index);
        const OrientedBox& box = *component.box;
        if ((box.size.array() <= 0.0).any()) return;
        const std::size_t storey = building_.storey_of[index];
        std::size_t up = 0;
        for (const std::size_t axis : {std::size_t{1}, std::size_t{2}}) {
            if (std::abs(box.axes[axis].z()) > std::abs(box.axes[up].z())) up = axis;
        }
        const double sign = box.axes[up].z() < 0.0 ? -1.0 : 1.0;
        const std::size_t along = (up + 1) % 3;
        const auto size = [&](std::size_t axis) {
            return box.size(static_cast<Eigen::Index>(axis));
        };
        const Eigen::Vector3d z = sign * box.axes[up];
        const Eigen::Vector3d origin =
            box.center - 0.5 * size(up) * z - elevation(storey) * Eigen::Vector3d::UnitZ();
        const Eigen::Vector2d half(0.5 * size(along), 0.5 * size((up + 2) % 3));
        const std::string body = geometry_.box({}, -half, half, size(up), component.label);
        const std::string shape = geometry_.shape({body});
        // A type of its own must say which.
        const std::string known_type = component.kind.empty() ? ".NOTDEFINED." : type;
        const std::string element =
            add_element(entity, component.id, component.kind,
                        geometry_.placement(storey_places_[storey], {origin, z, box.axes[along]}),
                        shape, {known_type});
        contained_[storey].push_back(element);
        add_properties(element, component.id, properties_of(component));
    }

    void add_component(std::size_t index) {
        const Component& component = this->component(index);
        const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
        switch (component.label) {
            case Label::floor:
                return add_sheet(index, "IFCSLAB", ".FLOOR.", down, nominal_slab);
            case Label::ceiling:
                return add_sheet(index, "IFCCOVERING", ".CEILING.", -down, nominal_covering);
            case Label::furniture:
                if (component.box) add_box(index, "IFCFURNITURE", furniture_type(component.kind));
                return;
            case Label::handle:
                if (component.box) add_box(index, "IFCDISCRETEACCESSORY", ".USERDEFINED.");
                return;
            case Label::unknown:
                if (component.box) add_box(index, "IFCBUILDINGELEMENTPROXY", ".NOTDEFINED.");
                return;
            case Label::door:
            case Label::window:
                return add_lone_filling(index);
            default:
                return;  // Walls are there already; a frame is as large as its opening.
        }
    }

    void add_containment(std::size_t storey) {
        if (contained_[storey].empty()) return;
        file_.add("IFCRELCONTAINEDINSPATIALSTRUCTURE",
                  {guid(fmt::format("storey-{}-elements", storey + 1)), "$", "$", "$",
                   step_list(contained_[storey]), storeys_[storey]});
    }

    const Building& building_;
    std::string seed_;
    StepFile file_;
    IfcGeometry geometry_;
    std::vector<std::string> storeys_;
    std::vector<std::string> storey_places_;
    std::vector<std::string> walls_;
    std::vector<std::string> wall_places_;
    std::vector<bool> is_placed_;                      ///< per component, of doors and windows
    std::vector<std::vector<std::string>> contained_;  ///< per storey
};

}  // namespace

std::string building_to_ifc(const Building& building, const IfcOrigin& origin) {
    return IfcWriter(building).write(origin);
}

}  // namespace roomscribe
