// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/scanning/visibility.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/parallel.hpp"
#include "roomscribe/simulation/scanning/line_of_sight.hpp"
#include "roomscribe/simulation/scanning/scanner.hpp"
#include "roomscribe/simulation/scanning/scanner_model.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

constexpr std::size_t samples_wanted = 300;
/// A thing of fewer than 10 points is not to count as a miss, and 0.3 is where misses begin
/// (docs/evaluation.md).
constexpr double enough_points = 10.0 / 0.3;
constexpr double touching = 0.02;
/// A polygon may lie inside the leaf, or on the body, of what it stands for.
constexpr double reach = 0.01;

using Corners = std::array<Vector3d, 3>;

struct Sample {
    Vector3d position;
    Vector3d normal;
};

double area(const Corners& c) {
    return 0.5 * (c[1] - c[0]).cross(c[2] - c[0]).norm();
}

/// Points spread over triangles: one stretch of the summed area each, at a place in its triangle
/// that a low-discrepancy sequence (R2, Roberts 2018) gives.
std::vector<Sample> sample_triangles(std::span<const Corners> triangles) {
    double total = 0.0;
    for (const Corners& corners : triangles)
        total += area(corners);
    std::vector<Sample> samples;
    if (!(total > 0.0)) return samples;
    const double step = total / static_cast<double>(samples_wanted);
    double next = 0.5 * step;
    double passed = 0.0;
    for (const Corners& c : triangles) {
        passed += area(c);
        for (; next < passed && samples.size() < samples_wanted; next += step) {
            const auto i = static_cast<double>(samples.size() + 1);
            double a = std::fmod(0.7548776662466927 * i, 1.0);
            double b = std::fmod(0.5698402909980532 * i, 1.0);
            if (a + b > 1.0) {
                a = 1.0 - a;
                b = 1.0 - b;
            }
            samples.push_back({c[0] + a * (c[1] - c[0]) + b * (c[2] - c[0]),
                               (c[1] - c[0]).cross(c[2] - c[0]).normalized()});
        }
    }
    return samples;
}

bool is_opening(const Component& component) {
    return component.label == Label::door || component.label == Label::window;
}

bool is_frame(const Component& component) {
    return component.label == Label::door_frame || component.label == Label::window_frame;
}

bool is_furniture_face(const Component& component) {
    return component.label == Label::furniture && !component.polygon.empty();
}

/// For every component, itself and those above it by `parent`.
std::vector<std::vector<std::int32_t>> owners_of(const Scene& scene) {
    std::map<std::string, std::int32_t> by_id;
    for (std::size_t i = 0; i < scene.components.size(); ++i)
        by_id[scene.components[i].id] = static_cast<std::int32_t>(i);
    std::vector<std::vector<std::int32_t>> owners(scene.components.size());
    for (std::size_t i = 0; i < owners.size(); ++i) {
        auto at = static_cast<std::int32_t>(i);
        while (std::find(owners[i].begin(), owners[i].end(), at) == owners[i].end()) {
            owners[i].push_back(at);
            const auto above = by_id.find(scene.components[static_cast<std::size_t>(at)].parent);
            if (above == by_id.end()) break;
            at = above->second;
        }
    }
    return owners;
}

struct Viewpoint {
    Vector3d position;
    Transform scan_from_world;
};

class Visibility {
  public:
    Visibility(const RayCaster& caster, ScannerKind scanner, double coarseness,
               std::span<const Station> stations)
        : caster_(caster),
          model_(scanner_model(scanner, coarseness)),
          owners_(owners_of(caster.world().scene)),
          triangles_(owners_.size()) {
        const SimulatedWorld& world = caster.world();
        for (const Station& station : stations) {
            const Transform pose = scanner_pose(scanner, station);
            viewpoints_.push_back({pose.translation(), pose.inverse()});
        }
        for (std::size_t i = 0; i < world.triangles.size(); ++i) {
            const std::int32_t component = world.parts[world.part_of_triangle[i]].component;
            if (component < 0) continue;
            Corners corners;
            for (std::size_t k = 0; k < 3; ++k)
                corners[k] = world.vertices[world.triangles[i][k]].cast<double>();
            triangles_[static_cast<std::size_t>(component)].push_back(corners);
        }
    }

    double share(std::size_t index) const {
        const Component& component = caster_.world().scene.components[index];
        std::vector<Sample> samples = sample(index);
        if (!is_frame(component) || component.polygon.size() < 3) return share_seen(index, samples);
        // Sides of a frame: what looks along its polygon's normal, and against it.
        const std::vector<Vector3d>& polygon = component.polygon;
        const Vector3d axis = (polygon[1] - polygon[0]).cross(polygon[2] - polygon[0]).normalized();
        std::array<std::vector<Sample>, 2> sides;
        for (const Sample& sample : samples) {
            const double along = sample.normal.dot(axis);
            if (std::abs(along) > 0.7) sides[along > 0.0 ? 0 : 1].push_back(sample);
        }
        if (sides[0].empty() && sides[1].empty()) return share_seen(index, samples);
        return std::max(share_seen(index, sides[0]), share_seen(index, sides[1]));
    }

  private:
    std::vector<Sample> sample(std::size_t index) const {
        const Component& component = caster_.world().scene.components[index];
        const bool by_polygon = (is_opening(component) || is_furniture_face(component)) &&
                                component.polygon.size() >= 3;
        if (!by_polygon) return sample_triangles(triangles_[index]);
        std::vector<Corners> fan;
        for (std::size_t i = 1; i + 1 < component.polygon.size(); ++i)
            fan.push_back({component.polygon[0], component.polygon[i], component.polygon[i + 1]});
        return sample_triangles(fan);
    }

    double share_seen(std::size_t index, std::span<const Sample> samples) const {
        const Component& component = caster_.world().scene.components[index];
        const bool is_piece = component.label == Label::furniture && component.polygon.empty();
        std::size_t seen = 0;
        std::size_t counted = 0;
        for (const Sample& sample : samples) {
            if (is_piece && touches(sample, index)) continue;
            ++counted;
            if (std::any_of(viewpoints_.begin(), viewpoints_.end(), [&](const Viewpoint& from) {
                    return sees(from, sample.position, index);
                })) {
                ++seen;
            }
        }
        return counted == 0 ? 0.0 : static_cast<double>(seen) / static_cast<double>(counted);
    }

    bool belongs_to(std::uint32_t part, std::size_t index) const {
        const std::int32_t component = caster_.world().parts[part].component;
        if (component < 0) return false;
        const auto& owners = owners_[static_cast<std::size_t>(component)];
        return std::find(owners.begin(), owners.end(), static_cast<std::int32_t>(index)) !=
               owners.end();
    }

    bool sees(const Viewpoint& from, const Vector3d& point, std::size_t index) const {
        if (!is_in_view(model_, from.scan_from_world * point)) return false;
        // Its own body does not hide a piece's top, and yet nobody sees it from below.
        const Component& component = caster_.world().scene.components[index];
        if (component.kind == "top" && from.position.z() < point.z()) return false;
        return is_in_sight(caster_, from.position, point, reach, [&](std::uint32_t part) {
            return is_pane(caster_.world().parts[part]) || belongs_to(part, index);
        });
    }

    bool touches(const Sample& sample, std::size_t index) const {
        const auto is_own = [&](std::uint32_t part) { return belongs_to(part, index); };
        constexpr double back = 0.001;  // so that what coincides is ahead
        for (const Vector3d& out : {sample.normal, Vector3d(-sample.normal)}) {
            const auto hit = caster_.cast_past(is_own, sample.position - back * out, out, 0.0);
            if (hit && hit->distance < touching + back) return true;
        }
        return false;
    }

    const RayCaster& caster_;
    ScannerModel model_;
    std::vector<std::vector<std::int32_t>> owners_;
    std::vector<std::vector<Corners>> triangles_;
    std::vector<Viewpoint> viewpoints_;
};

/// Points on its faces and handles are points on a piece of furniture.
std::vector<std::size_t> points_with_parts(const Scene& scene,
                                           std::span<const std::size_t> points) {
    std::unordered_map<std::string_view, std::size_t> furniture;
    for (std::size_t i = 0; i < scene.components.size(); ++i) {
        const Component& component = scene.components[i];
        if (component.label == Label::furniture) furniture.emplace(component.id, i);
    }
    std::vector<std::size_t> sums(points.begin(), points.end());
    for (std::size_t i = 0; i < scene.components.size(); ++i) {
        auto whole = furniture.find(scene.components[i].parent);
        while (whole != furniture.end()) {
            sums[whole->second] += points[i];
            whole = furniture.find(scene.components[whole->second].parent);
        }
    }
    return sums;
}

}  // namespace

void measure_visibility(Scene& scene, const RayCaster& caster, ScannerKind scanner,
                        double coarseness, std::span<const Station> stations,
                        std::span<const std::size_t> points, const Context& context) {
    const std::size_t count = caster.world().scene.components.size();
    if (scene.components.size() != count || points.size() != count) {
        throw InvalidArgument(
            "components, points", fmt::format("{}, {}", scene.components.size(), points.size()),
            fmt::format("{} each, as many as the caster's world has components", count));
    }
    const Visibility visibility(caster, scanner, coarseness, stations);
    const std::vector<std::size_t> points_of_whole = points_with_parts(scene, points);
    parallel_for(context, count, 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            double share = visibility.share(i);
            if (!is_opening(scene.components[i]))
                share *= std::min(1.0, static_cast<double>(points_of_whole[i]) / enough_points);
            scene.components[i].visible = share;
        }
    });
}

}  // namespace roomscribe
