// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/furnishing/item_builder.hpp"

#include "roomscribe/core/units.hpp"

namespace roomscribe {

using Eigen::Vector3d;

ItemBuilder::ItemBuilder(SimulatedWorld& world, const ItemPlan& item)
    : world_(world),
      item_(item),
      world_from_item_(moved_and_turned({item.at.x(), item.at.y(), item.elevation},
                                        Vector3d::UnitZ(), radians(item.turn))),
      random_(item.style, 2),
      first_triangle_(world.triangles.size()),
      noted_vertices_(world.vertices.size()) {}

void ItemBuilder::begin(Label label, std::string_view kind, LabelSet also_right) {
    Component component;
    component.label = label;
    component.kind = kind;
    current_ = add_component(world_, std::move(component));
    also_right_ = also_right;
    begun_.push_back(current_);
}

std::int32_t ItemBuilder::add_face(std::string_view kind, const std::vector<Vector3d>& polygon,
                                   bool is_open) {
    Component face;
    face.label = Label::furniture;
    face.kind = kind;
    face.parent = id_of(current_);
    for (const Vector3d& corner : polygon)
        face.polygon.emplace_back(world_from_item_ * corner);
    const std::int32_t index = add_component(world_, std::move(face));
    if (!is_open) widened_[index] = current_;
    return index;
}

const std::string& ItemBuilder::id_of(std::int32_t component) const {
    return world_.scene.components[static_cast<std::size_t>(component)].id;
}

std::uint32_t ItemBuilder::part_of(std::int32_t component, Material material) {
    const auto key = std::make_pair(component, material);
    if (const auto known = parts_.find(key); known != parts_.end()) return known->second;
    const std::uint32_t part = component < 0
                                   ? add_clutter_part(world_, material)
                                   : add_part(world_, component, material,
                                              component == current_ ? also_right_ : LabelSet{0});
    parts_.emplace(key, part);
    return part;
}

void ItemBuilder::box(std::uint32_t part, const Vector3d& low, const Vector3d& high) {
    note_shape();
    add_box(world_, part, world_from_item_, low, high);
    note_shape();
}

void ItemBuilder::box(std::uint32_t part, const Transform& pose, const Vector3d& low,
                      const Vector3d& high) {
    note_shape();
    add_box(world_, part, world_from_item_ * pose, low, high);
    note_shape();
}

void ItemBuilder::cylinder(std::uint32_t part, const Vector3d& start, const Vector3d& end,
                           double radius, int sides) {
    note_shape();
    add_cylinder(world_, part, world_from_item_ * start, world_from_item_ * end, radius, sides);
    note_shape();
}

void ItemBuilder::ellipsoid(std::uint32_t part, const Vector3d& center, const Vector3d& radii,
                            int sides) {
    ellipsoid(part, moved(center), radii, sides);
}

void ItemBuilder::ellipsoid(std::uint32_t part, const Transform& pose, const Vector3d& radii,
                            int sides) {
    note_shape();
    add_ellipsoid(world_, part, world_from_item_ * pose, radii, sides);
    note_shape();
}

void ItemBuilder::quad(std::uint32_t part, const std::array<Vector3d, 4>& corners) {
    note_shape();
    add_quad(world_, part, world_from_item_ * corners[0], world_from_item_ * corners[1],
             world_from_item_ * corners[2], world_from_item_ * corners[3]);
    note_shape();
}

void ItemBuilder::top(Material material, const Vector3d& low, const Vector3d& high) {
    const double z = high.z();
    const std::int32_t face = add_face("top", {{low.x(), low.y(), z},
                                               {high.x(), low.y(), z},
                                               {high.x(), high.y(), z},
                                               {low.x(), high.y(), z}});
    box(part_of(face, material), low, high);
}

void ItemBuilder::note_shape() {
    if (noted_vertices_ == world_.vertices.size()) return;
    const Transform item_from_world = world_from_item_.inverse();
    Eigen::AlignedBox3d extent;
    for (; noted_vertices_ < world_.vertices.size(); ++noted_vertices_)
        extent.extend(item_from_world * world_.vertices[noted_vertices_].cast<double>());
    shapes_.push_back(extent);
}

void ItemBuilder::finish() {
    note_shape();
    const Transform item_from_world = world_from_item_.inverse();
    std::map<std::int32_t, Eigen::AlignedBox3d> extents;
    for (std::size_t i = first_triangle_; i < world_.triangles.size(); ++i) {
        std::int32_t owner = world_.parts[world_.part_of_triangle[i]].component;
        if (const auto piece = widened_.find(owner); piece != widened_.end()) owner = piece->second;
        for (const std::uint32_t vertex : world_.triangles[i]) {
            extents[owner].extend(item_from_world * world_.vertices[vertex].cast<double>());
        }
    }
    for (const std::int32_t component : begun_) {
        const Eigen::AlignedBox3d& extent = extents[component];
        if (extent.isEmpty()) continue;
        OrientedBox oriented;
        oriented.center = world_from_item_ * extent.center();
        for (int axis = 0; axis < 3; ++axis)
            oriented.axes[static_cast<std::size_t>(axis)] = world_from_item_.linear().col(axis);
        oriented.size = extent.sizes();
        world_.scene.components[static_cast<std::size_t>(component)].box = oriented;
    }
}

Transform moved(const Vector3d& shift) {
    Transform transform = Transform::Identity();
    transform.translation() = shift;
    return transform;
}

Transform moved_and_turned(const Vector3d& shift, const Vector3d& axis, double angle) {
    Transform transform = moved(shift);
    transform.linear() = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    return transform;
}

}  // namespace roomscribe
