// SPDX-License-Identifier: MIT
#include "roomscribe/pipeline/corrections.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "roomscribe/core/units.hpp"
#include "roomscribe/geometry/polygon.hpp"

namespace roomscribe {
namespace {

// By these the evaluation tells that an opening and a handle are the same.
constexpr double max_angle = radians(10.0);
constexpr double max_plane_distance = 0.15;  // m
constexpr double min_box_distance = 0.05;    // m

Eigen::Vector3d middle_of(const Component& component) {
    if (component.box) return component.box->center;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& corner : component.polygon)
        sum += corner;
    return sum / static_cast<double>(std::max<std::size_t>(component.polygon.size(), 1));
}

/// The level and the upright direction in the plane of something flat; of something level, those of
/// its first edge.
struct FlatAxes {
    Eigen::Vector3d across;
    Eigen::Vector3d up;
};

FlatAxes axes_of(const std::vector<Eigen::Vector3d>& polygon, const Eigen::Vector3d& up) {
    const Eigen::Vector3d normal = area_vector(polygon).normalized();
    Eigen::Vector3d across = up.cross(normal);
    if (across.norm() < 0.3) across = polygon[1] - polygon[0];
    across.normalize();
    return {across, normal.cross(across)};
}

/// From the least to the greatest along a direction.
std::array<double, 2> range_along(const std::vector<Eigen::Vector3d>& polygon,
                                  const Eigen::Vector3d& direction) {
    std::array<double, 2> range{direction.dot(polygon[0]), direction.dot(polygon[0])};
    for (const Eigen::Vector3d& corner : polygon) {
        range[0] = std::min(range[0], direction.dot(corner));
        range[1] = std::max(range[1], direction.dot(corner));
    }
    return range;
}

/// How far the middles are apart, if the component answers to the element.
std::optional<double> distance_to(const Component& element, const Component& component,
                                  const Eigen::Vector3d& up) {
    if (component.label != element.label || component.verdict == Verdict::rejected)
        return std::nullopt;
    const Eigen::Vector3d way = middle_of(component) - middle_of(element);
    const double distance = way.norm();
    if (element.box && component.box) {
        std::array<double, 3> sizes{element.box->size.x(), element.box->size.y(),
                                    element.box->size.z()};
        std::sort(sizes.begin(), sizes.end());
        const bool is_near = distance <= std::max(min_box_distance, sizes[1] / 2.0);
        return is_near ? std::optional(distance) : std::nullopt;
    }
    if (element.polygon.size() < 3 || component.polygon.size() < 3) return std::nullopt;
    const Eigen::Vector3d normal = area_vector(element.polygon).normalized();
    const Eigen::Vector3d other = area_vector(component.polygon).normalized();
    const FlatAxes axes = axes_of(element.polygon, up);
    const auto width = range_along(element.polygon, axes.across);
    const auto height = range_along(element.polygon, axes.up);
    const double longer = std::max(width[1] - width[0], height[1] - height[0]);
    const bool answers = std::abs(normal.dot(other)) >= std::cos(max_angle) &&
                         std::abs(normal.dot(way)) <= max_plane_distance &&
                         distance <= longer / 2.0;
    return answers ? std::optional(distance) : std::nullopt;
}

class Corrector {
  public:
    explicit Corrector(Reconstruction& reconstruction)
        : scene_(reconstruction.scene),
          labels_(reconstruction.labels),
          up_(scene_.room_from_map.linear().row(2).transpose()) {}

    /// False if nothing answers to it.
    bool apply(const Correction& correction) {
        const std::optional<std::size_t> found = find(correction.element);
        if (!found) {
            if (correction.action != CorrectionAction::pin) return false;
            add(correction.element);
            return true;
        }
        Component& component = scene_.components[*found];
        switch (correction.action) {
            case CorrectionAction::pin:
                note(component, "pinned by hand");
                break;
            case CorrectionAction::reject:
                reject(*found);
                break;
            case CorrectionAction::relabel:
                relabel(component, correction);
                break;
            case CorrectionAction::set_size:
                resize(component, correction.size);
                break;
        }
        return true;
    }

  private:
    std::optional<std::size_t> find(const Component& element) const {
        std::optional<std::size_t> nearest;
        double least = 0.0;
        for (std::size_t i = 0; i < scene_.components.size(); ++i) {
            const auto distance = distance_to(element, scene_.components[i], up_);
            if (!distance || (nearest && *distance >= least)) continue;
            nearest = i;
            least = *distance;
        }
        return nearest;
    }

    static void note(Component& component, std::string_view what) {
        component.verdict = Verdict::accepted;
        component.confidence = 1.0;
        component.evidence.alternative.clear();
        std::string& rule = component.evidence.rule;
        rule = rule.empty() ? std::string(what) : fmt::format("{}; {}", rule, what);
    }

    std::string free_id(Label label) const {
        for (std::size_t number = 1;; ++number) {
            std::string id = fmt::format("{}-{}", label_name(label), number);
            const auto has_it = [&id](const Component& component) { return component.id == id; };
            if (std::none_of(scene_.components.begin(), scene_.components.end(), has_it)) return id;
        }
    }

    void add(const Component& element) {
        Component component = element;
        component.id = free_id(element.label);
        component.instance = 0;
        for (const Component& other : scene_.components)
            component.instance = std::max(component.instance, other.instance + 1);
        const bool has_parent =
            std::any_of(scene_.components.begin(), scene_.components.end(),
                        [&](const Component& other) { return other.id == element.parent; }) ||
            std::any_of(scene_.rooms.begin(), scene_.rooms.end(),
                        [&](const Room& room) { return room.id == element.parent; });
        if (!has_parent) component.parent.clear();
        component.evidence = {};
        note(component, "pinned by hand, and not found in the points of this run");
        scene_.components.push_back(std::move(component));
    }

    void label_points(std::int32_t instance, Label label, std::int32_t new_instance) {
        if (instance < 0) return;
        for (std::size_t i = 0; i < labels_.instances.size(); ++i) {
            if (labels_.instances[i] != instance) continue;
            labels_.labels[i] = label;
            labels_.instances[i] = new_instance;
            labels_.confidences[i] = label == Label::unknown ? 0.0F : 1.0F;
        }
    }

    void reject(std::size_t index) {
        Component& component = scene_.components[index];
        component.verdict = Verdict::rejected;
        component.confidence = 0.0;
        component.evidence.rule += "; rejected by hand";
        label_points(component.instance, Label::unknown, -1);
        const std::string id = component.id;
        for (Room& room : scene_.rooms) {
            std::erase(room.walls, id);
            std::erase_if(room.neighbors,
                          [&id](const RoomNeighbor& next) { return next.through == id; });
        }
        for (std::size_t i = 0; i < scene_.components.size(); ++i) {
            const Component& part = scene_.components[i];
            if (part.parent == id && part.verdict != Verdict::rejected) reject(i);
        }
    }

    void relabel(Component& component, const Correction& correction) {
        const std::string before = component.id;
        component.label = correction.label;
        component.kind = correction.kind;
        component.id = free_id(correction.label);
        note(component, fmt::format("{} until it was relabelled by hand", before));
        label_points(component.instance, correction.label, component.instance);
        for (Component& part : scene_.components)
            if (part.parent == before) part.parent = component.id;
        for (Room& room : scene_.rooms) {
            if (correction.label == Label::wall) {
                std::replace(room.walls.begin(), room.walls.end(), before, component.id);
            } else {
                std::erase(room.walls, before);
            }
            for (RoomNeighbor& next : room.neighbors)
                if (next.through == before) next.through = component.id;
        }
    }

    /// What stands grows from its foot, all else from its middle.
    void resize(Component& component, const std::vector<double>& size) {
        note(component, "size set by hand");
        if (component.box) {
            OrientedBox& box = *component.box;
            const Eigen::Vector3d before = box.size;
            box.size = {size[0], size[1], size[2]};
            if (component.label != Label::furniture) return;
            for (Eigen::Index axis = 0; axis < 3; ++axis) {
                const Eigen::Vector3d& direction = box.axes[static_cast<std::size_t>(axis)];
                const double upright = direction.dot(up_);
                if (std::abs(upright) < 0.9) continue;
                box.center +=
                    std::copysign(0.5, upright) * (box.size(axis) - before(axis)) * direction;
            }
            return;
        }
        const FlatAxes axes = axes_of(component.polygon, up_);
        const auto width = range_along(component.polygon, axes.across);
        const auto height = range_along(component.polygon, axes.up);
        const bool stands = std::abs(axes.up.dot(up_)) > 0.9;
        const double middle = (width[0] + width[1]) / 2.0;
        const bool is_foot_low = axes.up.dot(up_) > 0.0;
        const double foot =
            stands ? (is_foot_low ? height[0] : height[1]) : (height[0] + height[1]) / 2.0;
        const double by_width = size[0] / (width[1] - width[0]);
        const double by_height = size[1] / (height[1] - height[0]);
        for (Eigen::Vector3d& corner : component.polygon) {
            corner += (by_width - 1.0) * (axes.across.dot(corner) - middle) * axes.across +
                      (by_height - 1.0) * (axes.up.dot(corner) - foot) * axes.up;
        }
    }

    Scene& scene_;
    PointLabels& labels_;
    Eigen::Vector3d up_;
};

constexpr std::array<std::string_view, 4> action_names{"pin", "reject", "relabel", "set_size"};

}  // namespace

CorrectionOutcome apply_corrections(Reconstruction& reconstruction,
                                    std::span<const Correction> corrections) {
    CorrectionOutcome outcome;
    Corrector corrector(reconstruction);
    for (std::size_t i = 0; i < corrections.size(); ++i) {
        if (corrector.apply(corrections[i])) {
            ++outcome.num_applied;
            continue;
        }
        const Component& element = corrections[i].element;
        const Eigen::Vector3d middle = middle_of(element);
        outcome.unmatched.push_back(
            fmt::format("corrections[{}]: no {} lies around ({:.2f}, {:.2f}, {:.2f}) to {}", i,
                        label_name(element.label), middle.x(), middle.y(), middle.z(),
                        action_names[static_cast<std::size_t>(corrections[i].action)]));
    }
    return outcome;
}

}  // namespace roomscribe
