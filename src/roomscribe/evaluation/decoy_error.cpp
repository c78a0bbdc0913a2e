// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/decoy_error.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "roomscribe/evaluation/component_fit.hpp"
#include "roomscribe/evaluation/protocol.hpp"
#include "roomscribe/geometry/plane.hpp"

namespace roomscribe {
namespace {

using Corners = std::vector<Eigen::Vector3d>;

constexpr std::array<std::pair<std::string_view, DecoyKind>, 12> decoy_words{{
    {"picture", DecoyKind::picture},
    {"painting", DecoyKind::picture},
    {"poster", DecoyKind::picture},
    {"board", DecoyKind::board},
    {"whiteboard", DecoyKind::board},
    {"blackboard", DecoyKind::board},
    {"notice_board", DecoyKind::board},
    {"mirror", DecoyKind::mirror},
    {"screen", DecoyKind::screen},
    {"tv_screen", DecoyKind::screen},
    {"tv", DecoyKind::screen},
    {"niche", DecoyKind::niche},
}};

/// The side of a box that is seen when it hangs on a wall: across its shortest axis.
Corners broad_side(const OrientedBox& box) {
    Eigen::Index thin = 0;
    box.size.minCoeff(&thin);
    const auto half = [&](Eigen::Index axis) -> Eigen::Vector3d {
        return box.size(axis) / 2.0 * box.axes[static_cast<std::size_t>(axis)];
    };
    const Eigen::Vector3d u = half((thin + 1) % 3);
    const Eigen::Vector3d v = half((thin + 2) % 3);
    return {box.center - u - v, box.center + u - v, box.center + u + v, box.center - u + v};
}

Corners rectangle_of(const Component& component) {
    if (!component.polygon.empty() || !component.box) return component.polygon;
    return broad_side(*component.box);
}

std::optional<DecoyKind> decoy_kind_of(const Component& component) {
    if (component.label != Label::unknown) return std::nullopt;
    return decoy_kind_from(component.kind);
}

bool is_true_opening(const Component& component) {
    return protocol::contains(protocol::rectangle_labels, component.label) ||
           (component.label == Label::unknown && component.kind == "opening");
}

bool is_enough(double share) {
    return share >= protocol::min_share - protocol::rounding;
}

/// Shares that two rectangles have of each other.
struct Shares {
    double of_truth = 0.0;
    double of_detected = 0.0;
};

Shares shares_of(const Component& of_truth, const Component& detected) {
    const auto overlap =
        overlap_of_polygons(rectangle_of(of_truth), detected.polygon, protocol::max_decoy_distance);
    if (!overlap || overlap->true_area <= 0.0 || overlap->detected_area <= 0.0) return {};
    return {overlap->shared / overlap->true_area, overlap->shared / overlap->detected_area};
}

/// Finds out what detections lie on.
class GroundFinder {
  public:
    /// `true_scene` is that of `truth` in the result's frame.
    GroundFinder(const GroundTruth& truth, const Scene& true_scene,
                 const Transform& predicted_from_true)
        : truth_(truth), scene_(true_scene), predicted_from_true_(predicted_from_true) {}

    /// `taken` collects the numbers of the decoys that the detection is on.
    DetectedOpening find(const Component& detected, std::set<std::size_t>& taken) const {
        DetectedOpening site{detected.id, OpeningGround::elsewhere, ""};
        const auto lies_on = [&](const Component& component, OpeningGround ground) {
            site.ground = ground;
            site.true_id = component.id;
        };
        if (const Component* opening = most_shared(detected, is_true_opening)) {
            lies_on(*opening, OpeningGround::opening);
            return site;
        }
        for (std::size_t i = 0; i < scene_.components.size(); ++i) {
            const Component& decoy = scene_.components[i];
            if (!decoy_kind_of(decoy)) continue;
            const Shares shares = shares_of(decoy, detected);
            if (!is_enough(shares.of_truth) && !is_enough(shares.of_detected)) continue;
            taken.insert(i);
            lies_on(decoy, OpeningGround::decoy);
        }
        if (site.ground == OpeningGround::decoy) return site;
        const auto is_wall = [](const Component& c) { return c.label == Label::wall; };
        if (const Component* wall = most_shared(detected, is_wall)) {
            lies_on(*wall, is_seen(*wall, detected) ? OpeningGround::seen_wall
                                                    : OpeningGround::hidden_wall);
        }
        return site;
    }

  private:
    /// The true component that has the most of a detection, and at least half.
    template <typename Predicate>
    const Component* most_shared(const Component& detected, Predicate takes_part) const {
        const Component* best = nullptr;
        double most = 0.0;
        for (const Component& component : scene_.components) {
            if (!takes_part(component)) continue;
            const double share = shares_of(component, detected).of_detected;
            if (share <= most || !is_enough(share)) continue;
            most = share;
            best = &component;
        }
        return best;
    }

    /// Whether points that truth has on a wall fill half of a rectangle's cells. What stands before
    /// the wall hides it; what hangs on it without a label does not.
    bool is_seen(const Component& wall, const Component& detected) const {
        const std::optional<Plane> plane = plane_of_polygon(wall.polygon);
        const Eigen::Vector3d& corner = detected.polygon.front();
        const Eigen::Vector3d along = detected.polygon[1] - corner;
        const Eigen::Vector3d across = detected.polygon.back() - corner;
        const auto cells_along = [](const Eigen::Vector3d& side) {
            return std::max(1.0, std::round(side.norm() / protocol::wall_cell_size));
        };
        const double columns = cells_along(along);
        const double rows = cells_along(across);
        std::set<std::pair<int, int>> filled;
        for (std::size_t i = 0; i < truth_.labels.size(); ++i) {
            const bool is_on_wall = truth_.labels[i] == Label::wall
                                        ? truth_.instances[i] == wall.instance
                                        : truth_.labels[i] == Label::unknown;
            if (!is_on_wall) continue;
            const Eigen::Vector3d position =
                predicted_from_true_ * truth_.map.cloud.positions[i].cast<double>();
            const double u = (position - corner).dot(along) / along.squaredNorm();
            const double v = (position - corner).dot(across) / across.squaredNorm();
            // What is not a number fails every comparison.
            if (!(u >= 0.0 && u < 1.0 && v >= 0.0 && v < 1.0)) continue;
            if (std::abs(plane->signed_distance(position)) > protocol::max_wall_distance) continue;
            filled.emplace(static_cast<int>(u * columns), static_cast<int>(v * rows));
        }
        return is_enough(static_cast<double>(filled.size()) / (columns * rows));
    }

    const GroundTruth& truth_;
    const Scene& scene_;
    Transform predicted_from_true_;
};

}  // namespace

std::optional<DecoyKind> decoy_kind_from(std::string_view component_kind) {
    const auto* word = std::find_if(decoy_words.begin(), decoy_words.end(),
                                    [&](const auto& w) { return w.first == component_kind; });
    if (word == decoy_words.end()) return std::nullopt;
    return word->second;
}

std::optional<double> DecoyCounts::share() const {
    if (there == 0) return std::nullopt;
    return static_cast<double>(taken) / static_cast<double>(there);
}

DecoyCounts& DecoyCounts::operator+=(const DecoyCounts& other) {
    there += other.there;
    taken += other.taken;
    return *this;
}

DecoyError evaluate_decoys(const GroundTruth& truth, const Prediction& prediction) {
    const Transform predicted_from_true = predicted_from_true_map(truth, prediction);
    const Scene true_scene = transformed_scene(truth.scene, predicted_from_true);
    const GroundFinder finder(truth, true_scene, predicted_from_true);
    DecoyError error;
    std::set<std::size_t> taken;
    for (const Component& detected : prediction.scene->components) {
        const bool is_opening = detected.label == Label::door || detected.label == Label::window;
        if (!is_opening || detected.verdict == Verdict::rejected) continue;
        error.openings.push_back(finder.find(detected, taken));
    }
    for (std::size_t i = 0; i < true_scene.components.size(); ++i) {
        const Component& decoy = true_scene.components[i];
        const std::optional<DecoyKind> kind = decoy_kind_of(decoy);
        if (!kind || decoy.visible.value_or(1.0) < protocol::min_visible - protocol::rounding)
            continue;
        DecoyCounts& counts = error.per_kind[static_cast<std::size_t>(*kind)];
        ++counts.there;
        counts.taken += taken.contains(i) ? 1U : 0U;
    }
    return error;
}

}  // namespace roomscribe
