// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/simulated_world.hpp"

#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/geometry/plane.hpp"
#include "roomscribe/geometry/polygon.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

std::uint32_t add_vertex(SimulatedWorld& world, const Vector3d& position) {
    world.vertices.emplace_back(position.cast<float>());
    return static_cast<std::uint32_t>(world.vertices.size() - 1);
}

void add_triangle(SimulatedWorld& world, std::uint32_t part, std::uint32_t a, std::uint32_t b,
                  std::uint32_t c) {
    world.triangles.push_back({a, b, c});
    world.part_of_triangle.push_back(part);
}

bool is_ear(std::span<const Vector2d> corners, std::span<const std::uint32_t> ring,
            std::size_t tip) {
    const std::size_t count = ring.size();
    const Vector2d& a = corners[ring[(tip + count - 1) % count]];
    const Vector2d& b = corners[ring[tip]];
    const Vector2d& c = corners[ring[(tip + 1) % count]];
    if (cross(b - a, c - b) <= 0.0) return false;
    for (std::size_t i = 2; i + 1 < count; ++i) {
        const Vector2d& other = corners[ring[(tip + i) % count]];
        if (cross(b - a, other - a) >= 0.0 && cross(c - b, other - b) >= 0.0 &&
            cross(a - c, other - c) >= 0.0) {
            return false;
        }
    }
    return true;
}

/// The sides of a stack of rings of equal length, each with the next, and a closed lid on the first
/// and the last.
void add_rings(SimulatedWorld& world, std::uint32_t part,
               std::span<const std::vector<Vector3d>> rings) {
    for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
        const std::size_t sides = rings[i].size();
        for (std::size_t j = 0; j < sides; ++j) {
            const std::size_t next = (j + 1) % sides;
            add_quad(world, part, rings[i][j], rings[i][next], rings[i + 1][next], rings[i + 1][j]);
        }
    }
    add_polygon(world, part, rings.front());
    add_polygon(world, part, rings.back());
}

std::vector<Vector3d> ring(const Vector3d& center, const Vector3d& u, const Vector3d& v,
                           int sides) {
    std::vector<Vector3d> corners;
    for (int i = 0; i < sides; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / sides;
        corners.emplace_back(center + std::cos(angle) * u + std::sin(angle) * v);
    }
    return corners;
}

}  // namespace

std::int32_t add_component(SimulatedWorld& world, Component component) {
    const auto index = static_cast<std::int32_t>(world.scene.components.size());
    component.instance = index;
    if (component.id.empty()) {
        const bool is_named_by_kind = component.label == Label::unknown && !component.kind.empty();
        component.id = fmt::format(
            "{}-{}",
            is_named_by_kind ? std::string_view(component.kind) : label_name(component.label),
            index);
    }
    component.confidence = 1.0;
    component.verdict = Verdict::accepted;
    world.scene.components.push_back(std::move(component));
    return index;
}

std::uint32_t add_part(SimulatedWorld& world, std::int32_t component, Material material,
                       LabelSet also_right) {
    const Label label = world.scene.components[static_cast<std::size_t>(component)].label;
    world.parts.push_back({.component = component,
                           .label = label,
                           .acceptable = static_cast<LabelSet>(label_bit(label) | also_right),
                           .material = material});
    return static_cast<std::uint32_t>(world.parts.size() - 1);
}

std::uint32_t add_clutter_part(SimulatedWorld& world, Material material) {
    world.parts.push_back({.material = material});
    return static_cast<std::uint32_t>(world.parts.size() - 1);
}

void add_polygon(SimulatedWorld& world, std::uint32_t part, std::span<const Vector3d> corners) {
    const Vector3d normal = area_vector(corners).normalized();
    const auto [u, v] = plane_axes(normal);
    std::vector<Vector2d> flat;
    std::vector<std::uint32_t> vertices;
    for (const Vector3d& corner : corners) {
        flat.emplace_back(u.dot(corner), v.dot(corner));
        vertices.push_back(add_vertex(world, corner));
    }
    std::vector<std::uint32_t> ring(corners.size());
    std::iota(ring.begin(), ring.end(), 0U);
    while (ring.size() > 2) {
        std::size_t tip = 0;
        while (tip < ring.size() && !is_ear(flat, ring, tip))
            ++tip;
        if (tip == ring.size()) {
            throw InvalidArgument("corners", fmt::format("{} corners", corners.size()),
                                  "a simple polygon");
        }
        const std::size_t count = ring.size();
        add_triangle(world, part, vertices[ring[(tip + count - 1) % count]], vertices[ring[tip]],
                     vertices[ring[(tip + 1) % count]]);
        ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(tip));
    }
}

void add_quad(SimulatedWorld& world, std::uint32_t part, const Vector3d& a, const Vector3d& b,
              const Vector3d& c, const Vector3d& d) {
    const std::uint32_t first = add_vertex(world, a);
    add_vertex(world, b);
    add_vertex(world, c);
    add_vertex(world, d);
    add_triangle(world, part, first, first + 1, first + 2);
    add_triangle(world, part, first, first + 2, first + 3);
}

void add_box(SimulatedWorld& world, std::uint32_t part, const Transform& world_from_local,
             const Vector3d& low, const Vector3d& high) {
    const auto corner = [&](bool x, bool y, bool z) -> Vector3d {
        return world_from_local *
               Vector3d(x ? high.x() : low.x(), y ? high.y() : low.y(), z ? high.z() : low.z());
    };
    const auto face = [&](std::array<std::array<bool, 3>, 4> c) {
        add_quad(world, part, corner(c[0][0], c[0][1], c[0][2]), corner(c[1][0], c[1][1], c[1][2]),
                 corner(c[2][0], c[2][1], c[2][2]), corner(c[3][0], c[3][1], c[3][2]));
    };
    face(
        {{{false, false, false}, {false, true, false}, {true, true, false}, {true, false, false}}});
    face({{{false, false, true}, {true, false, true}, {true, true, true}, {false, true, true}}});
    face(
        {{{false, false, false}, {true, false, false}, {true, false, true}, {false, false, true}}});
    face({{{false, true, false}, {false, true, true}, {true, true, true}, {true, true, false}}});
    face(
        {{{false, false, false}, {false, false, true}, {false, true, true}, {false, true, false}}});
    face({{{true, false, false}, {true, true, false}, {true, true, true}, {true, false, true}}});
}

void add_cylinder(SimulatedWorld& world, std::uint32_t part, const Vector3d& start,
                  const Vector3d& end, double radius, int sides) {
    const auto [u, v] = plane_axes((end - start).normalized());
    const std::array rings{ring(start, radius * u, radius * v, sides),
                           ring(end, radius * u, radius * v, sides)};
    add_rings(world, part, rings);
}

void add_ellipsoid(SimulatedWorld& world, std::uint32_t part, const Transform& world_from_local,
                   const Vector3d& radii, int sides) {
    const int num_rings = sides / 2;
    std::vector<std::vector<Vector3d>> rings;
    for (int i = 0; i < num_rings; ++i) {
        // Half a step off the poles, so that no ring shrinks to a point.
        const double angle = std::numbers::pi * ((i + 0.5) / num_rings - 0.5);
        const Vector3d center(0.0, 0.0, radii.z() * std::sin(angle));
        rings.push_back(ring(center, Vector3d(radii.x() * std::cos(angle), 0.0, 0.0),
                             Vector3d(0.0, radii.y() * std::cos(angle), 0.0), sides));
        for (Vector3d& corner : rings.back())
            corner = world_from_local * corner;
    }
    add_rings(world, part, rings);
}

}  // namespace roomscribe
