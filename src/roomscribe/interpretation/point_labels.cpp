// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/point_labels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/parallel.hpp"
#include "roomscribe/interpretation/openings/face_axes.hpp"
#include "roomscribe/interpretation/openings/window_parts.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t chunk = 8192;
/// Beyond this many standard deviations, a point of a plane is a stray.
constexpr double max_deviations = 2.5;
constexpr std::uint32_t no_patch = std::numeric_limits<std::uint32_t>::max();

/// The test of one point against one surface, in float: millimetres matter, micrometres do not.
struct SurfaceTest {
    Eigen::Vector3f normal;
    float offset;
    float tolerance;
    /// Two directions along the plane, in which the polygon is given.
    Eigen::Vector3f u;
    Eigen::Vector3f v;
    float margin;  ///< m, beyond the polygon
    std::vector<Eigen::Vector2f> corners;

    float distance(const Eigen::Vector3f& point) const {
        return std::abs(normal.dot(point) - offset);
    }
    bool is_inside(const Eigen::Vector3f& point) const;
};

/// Even-odd rule, or near an edge.
bool SurfaceTest::is_inside(const Eigen::Vector3f& point) const {
    const Eigen::Vector2f p(u.dot(point), v.dot(point));
    bool inside = false;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Eigen::Vector2f& a = corners[i];
        const Eigen::Vector2f edge = corners[i + 1 == corners.size() ? 0 : i + 1] - a;
        const Eigen::Vector2f from_a = p - a;
        const float along =
            std::clamp(from_a.dot(edge) / std::max(edge.squaredNorm(), 1e-12F), 0.0F, 1.0F);
        if ((from_a - along * edge).squaredNorm() <= margin * margin) return true;
        if ((from_a.y() < 0.0F) == (from_a.y() < edge.y())) continue;
        if (from_a.x() < edge.x() * from_a.y() / edge.y()) inside = !inside;
    }
    return inside;
}

SurfaceTest make_test(const RoomSurface& surface, double tolerance, double margin) {
    SurfaceTest test;
    test.normal = surface.plane.normal.cast<float>();
    test.offset = static_cast<float>(surface.plane.offset);
    test.tolerance = static_cast<float>(tolerance);
    const PlaneAxes axes = plane_axes(surface.plane.normal);
    test.u = axes.u.cast<float>();
    test.v = axes.v.cast<float>();
    test.margin = static_cast<float>(margin);
    for (const Eigen::Vector3d& corner : surface.component.polygon)
        test.corners.emplace_back(corner.dot(axes.u), corner.dot(axes.v));
    return test;
}

class Labeller {
  public:
    Labeller(const SurfaceSample& sample, std::span<const PlanarPatch> patches,
             const RoomSurfaces& surfaces, const PointLabelSettings& settings)
        : sample_(sample), patches_(patches), surfaces_(surfaces.surfaces) {
        patch_of_voxel_.assign(sample.cloud.size(), no_patch);
        surface_of_voxel_.assign(sample.cloud.size(), -1);
        for (std::size_t s = 0; s < surfaces_.size(); ++s) {
            const double rms = surfaces_[s].component.evidence.rms.value_or(0.0);
            const double tolerance = settings.distance_tolerance.value_or(
                std::max(sample.tolerance, max_deviations * rms));
            tests_.push_back(make_test(surfaces_[s], tolerance, sample.spacing));
            for (const std::uint32_t voxel : surfaces_[s].voxels)
                surface_of_voxel_[voxel] = static_cast<std::int32_t>(s);
        }
        for (std::uint32_t patch = 0; patch < patches.size(); ++patch) {
            for (const std::uint32_t voxel : patches[patch].points)
                patch_of_voxel_[voxel] = patch;
        }
    }

    /// Surfaces that any point of the voxel may belong to.
    void candidates(std::uint32_t voxel, std::vector<std::uint16_t>& result) const {
        result.clear();
        const Eigen::Vector3f& center = sample_.cloud.positions[voxel];
        // The centroid and any point of a voxel are at most its diagonal apart.
        const float reach = static_cast<float>(std::sqrt(3.0) * sample_.voxel_size);
        for (std::size_t s = 0; s < tests_.size(); ++s) {
            if (tests_[s].distance(center) <= tests_[s].tolerance + reach) {
                result.push_back(static_cast<std::uint16_t>(s));
            }
        }
    }

    /// Number of the surface that a point belongs to, or -1, and how far off it is in tolerances.
    std::pair<std::int32_t, float> assign(const Eigen::Vector3f& point, std::uint32_t voxel,
                                          std::span<const std::uint16_t> candidates) const {
        std::pair<std::int32_t, float> best{-1, 1.0F};
        // Its own patch first: then most other surfaces are out of the question.
        const std::uint32_t patch = patch_of_voxel_[voxel];
        const std::int32_t own = patch == no_patch ? -1 : surface_of_voxel_[voxel];
        if (own >= 0) {
            const Plane& plane = patches_[patch].plane;
            const auto deviation = static_cast<float>(
                std::abs(plane.signed_distance(point.cast<double>())) /
                static_cast<double>(tests_[static_cast<std::size_t>(own)].tolerance));
            if (deviation <= best.second) best = {own, deviation};
        }
        for (const std::uint16_t s : candidates) {
            const SurfaceTest& test = tests_[s];
            const float deviation = test.distance(point) / test.tolerance;
            const bool is_nearer = best.first < 0 ? deviation <= 1.0F : deviation < best.second;
            if (is_nearer && (s == own || test.is_inside(point))) best = {s, deviation};
        }
        return best;
    }

  private:
    const SurfaceSample& sample_;
    std::span<const PlanarPatch> patches_;
    std::span<const RoomSurface> surfaces_;
    std::vector<SurfaceTest> tests_;
    std::vector<std::uint32_t> patch_of_voxel_;
    std::vector<std::int32_t> surface_of_voxel_;
};

/// The candidates of every voxel, one list after another.
struct CandidateTable {
    std::vector<std::uint32_t> first;
    std::vector<std::uint16_t> surfaces;

    std::span<const std::uint16_t> of(std::uint32_t voxel) const {
        return {surfaces.data() + first[voxel], first[voxel + 1] - first[voxel]};
    }
};

CandidateTable find_candidates(const Labeller& labeller, std::size_t num_voxels) {
    CandidateTable table;
    table.first.reserve(num_voxels + 1);
    table.first.push_back(0);
    std::vector<std::uint16_t> found;
    for (std::uint32_t voxel = 0; voxel < num_voxels; ++voxel) {
        labeller.candidates(voxel, found);
        table.surfaces.insert(table.surfaces.end(), found.begin(), found.end());
        table.first.push_back(static_cast<std::uint32_t>(table.surfaces.size()));
    }
    return table;
}

/// Tells what a point near an opening belongs to.
class OpeningTest {
  public:
    OpeningTest(const WallOpening& opening, const RoomSurfaces& surfaces,
                std::span<const Component> components)
        : opening_(opening),
          surround_(opening.components.size() > 1 ? components[opening.components[1]]
                                                  : wall_of(opening, surfaces)),
          filling_(components[opening.components[0]]),
          axes_(face_of(opening, surfaces)),
          leaf_(opening.hole),
          frame_(opening.type == OpeningType::window
                     ? leaf_.grown(hole_slack, hole_slack, hole_slack)
                     : leaf_.grown(opening.frame_width, 0.0, opening.frame_width)) {}

    const WallOpening& opening() const { return opening_; }

    FacePlace place_of(const Eigen::Vector3f& point) const { return axes_.place_of(point); }

    /// In the wall, in or just beside the hole or the casing, or on a leaf that stands out.
    bool reaches(const FacePlace& place) const {
        const float nearest = std::min(0.0F, static_cast<float>(opening_.depth)) - max_casing;
        return place.depth <= static_cast<float>(max_wall_depth) && place.depth >= nearest &&
               is_in(frame_, place);
    }

    /// Leaf, pane or passage.
    const Component& filling() const { return filling_; }
    /// The frame; the wall of a passage without one.
    const Component& surround() const { return surround_; }

    /// The component that a place in reach belongs to, or nothing. Not for windows.
    const Component* component_of(const FacePlace& place) const {
        const auto leaf_depth = static_cast<float>(opening_.depth);
        if (!is_in(leaf_, place)) return &surround_;
        // The lining lies along the sides, before and behind the leaf.
        const bool is_at_side = std::min({place.along - leaf_.start, leaf_.end - place.along,
                                          leaf_.top - place.above}) < lining_width;
        // What stands in a passage is no part of it.
        if (opening_.type == OpeningType::passage && !is_at_side) return nullptr;
        const bool is_leaf = std::abs(place.depth - leaf_depth) <= leaf_reach;
        return is_at_side && (opening_.is_open || !is_leaf) ? &surround_ : &filling_;
    }

    /// Within an open leaf, which is a slab whose one side or other was seen.
    bool is_in_open_leaf(const FacePlace& place) const {
        if (place.above > static_cast<float>(leaf_.top) + edge_slack) return false;
        const Eigen::Vector2f at(place.along, place.depth);
        return std::any_of(opening_.open_leaves.begin(), opening_.open_leaves.end(),
                           [&](const OpenLeafSide& side) {
                               const Eigen::Vector2f hinge = side.hinge.cast<float>();
                               const Eigen::Vector2f way = side.free_edge.cast<float>() - hinge;
                               const float width = way.norm();
                               const float along = way.dot(at - hinge) / width;
                               return along >= 0.0F && along <= width + edge_slack &&
                                      (hinge + along / width * way - at).norm() <= leaf_reach;
                           });
    }

    HolePoint place_in_hole(const Eigen::Vector3f& point) const {
        const FacePlace place = place_of(point);
        return {place.along - static_cast<float>(leaf_.start),
                place.above - static_cast<float>(leaf_.bottom), place.depth};
    }

  private:
    static constexpr float max_casing = 0.04F;    // m out of the wall
    static constexpr double hole_slack = 0.03;    // m: a hole is known to about a cell
    static constexpr double lining_width = 0.08;  // m, of what rays see of it aslant
    static constexpr float leaf_reach = 0.06F;    // m: of a leaf, its panels and noise
    static constexpr float edge_slack = 0.03F;    // m: of an open leaf's edges

    static bool is_in(const WallRectangle& rectangle, const FacePlace& place) {
        return place.along >= rectangle.start && place.along <= rectangle.end &&
               place.above >= rectangle.bottom && place.above <= rectangle.top;
    }

    static const Component& wall_of(const WallOpening& opening, const RoomSurfaces& surfaces) {
        const StoreyLayout& layout = surfaces.storeys[opening.storey];
        return surfaces.surfaces[layout.wall_of_face[opening.face]].component;
    }

    const WallOpening& opening_;
    const Component& surround_;
    const Component& filling_;
    FaceAxes axes_;
    WallRectangle leaf_;
    WallRectangle frame_;
};

/// A point in reach of a window.
struct WindowPoint {
    std::size_t point = 0;
    std::size_t test = 0;
};

/// Gives the points of doors, windows and their frames to these.
void label_openings(const PointCloud& map, const SurfaceSample& sample,
                    std::span<const PlanarPatch> patches, const RoomSurfaces& surfaces,
                    const Openings& openings, PointLabels& labels, const Context& context) {
    std::vector<OpeningTest> tests;
    tests.reserve(openings.openings.size());
    for (const WallOpening& opening : openings.openings)
        tests.emplace_back(opening, surfaces, openings.components);
    std::vector<bool> is_of_leaf(sample.cloud.size(), false);
    for (const WallOpening& opening : openings.openings) {
        for (const OpenLeafSide& side : opening.open_leaves) {
            for (const std::uint32_t voxel : patches[side.patch].points)
                is_of_leaf[voxel] = true;
        }
    }
    const auto give = [&](std::size_t point, const Component& component) {
        labels.labels[point] = component.label;
        labels.instances[point] = component.instance;
        labels.confidences[point] = static_cast<float>(component.confidence);
    };
    const auto find_test = [&](const auto& holds) -> const OpeningTest* {
        const auto found = std::find_if(tests.begin(), tests.end(), holds);
        return found == tests.end() ? nullptr : &*found;
    };
    std::vector<std::vector<WindowPoint>> at_windows((map.size() + chunk - 1) / chunk);
    parallel_for(context, map.size(), chunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t voxel = sample.voxel_of_point[i];
            if (voxel == no_voxel) continue;
            const bool is_level =
                labels.labels[i] == Label::floor || labels.labels[i] == Label::ceiling;
            if (is_level) continue;
            const auto in_leaf = [&](const OpeningTest& test) {
                return test.is_in_open_leaf(test.place_of(map.positions[i]));
            };
            // Seen sides of open leaves, then what is in the wall, then edges of leaves.
            const OpeningTest* door = nullptr;
            if (is_of_leaf[voxel]) door = find_test(in_leaf);
            if (door != nullptr) {
                give(i, door->filling());
                continue;
            }
            bool is_given = false;
            for (std::size_t t = 0; t < tests.size() && !is_given; ++t) {
                const FacePlace place = tests[t].place_of(map.positions[i]);
                if (!tests[t].reaches(place)) continue;
                if (tests[t].opening().type == OpeningType::window) {
                    at_windows[begin / chunk].push_back({i, t});
                    is_given = true;
                } else if (const Component* component = tests[t].component_of(place)) {
                    give(i, *component);
                    is_given = true;
                }
            }
            if (is_given || labels.labels[i] != Label::unknown) continue;
            door = find_test(in_leaf);
            if (door != nullptr) give(i, door->filling());
        }
    });
    // What of a window is frame and what is pane is told by all of its points together.
    std::vector<std::vector<std::size_t>> points_of_test(tests.size());
    for (const std::vector<WindowPoint>& part : at_windows) {
        for (const WindowPoint& found : part)
            points_of_test[found.test].push_back(found.point);
    }
    for (std::size_t t = 0; t < tests.size(); ++t) {
        const std::vector<std::size_t>& points = points_of_test[t];
        if (points.empty()) continue;
        std::vector<HolePoint> in_hole;
        in_hole.reserve(points.size());
        double noise = 0.0;
        for (const std::size_t i : points) {
            in_hole.push_back(tests[t].place_in_hole(map.positions[i]));
            noise += static_cast<double>(sample.noise_of_voxel[sample.voxel_of_point[i]]);
        }
        const WallOpening& opening = tests[t].opening();
        const std::vector<WindowPart> parts =
            sort_window_points(in_hole,
                               {opening.hole.width(), opening.hole.height(), opening.frame_width,
                                opening.frame_depth, opening.depth},
                               noise / static_cast<double>(points.size()));
        for (std::size_t k = 0; k < points.size(); ++k) {
            if (parts[k] != WindowPart::reveal)
                give(points[k],
                     parts[k] == WindowPart::pane ? tests[t].filling() : tests[t].surround());
        }
    }
}

}  // namespace

PointLabels label_points(const PointCloud& map, const SurfaceSample& sample,
                         std::span<const PlanarPatch> patches, const RoomSurfaces& surfaces,
                         const Openings& openings, const PointLabelSettings& settings,
                         const Context& context) {
    check_settings(settings);
    if (sample.voxel_of_point.size() != map.size()) {
        throw InvalidArgument("map", std::to_string(map.size()) + " points",
                              "the points that the sample was made of");
    }
    PointLabels result;
    result.labels.assign(map.size(), Label::unknown);
    result.instances.assign(map.size(), -1);
    result.confidences.assign(map.size(), 0.0F);
    const Labeller labeller(sample, patches, surfaces, settings);
    const CandidateTable candidates = find_candidates(labeller, sample.cloud.size());
    parallel_for(context, map.size(), chunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t voxel = sample.voxel_of_point[i];
            if (voxel == no_voxel) continue;
            const auto [surface, deviation] =
                labeller.assign(map.positions[i], voxel, candidates.of(voxel));
            if (surface < 0) continue;
            const Component& component =
                surfaces.surfaces[static_cast<std::size_t>(surface)].component;
            const bool is_hung = !surfaces.is_hung.empty() && surfaces.is_hung[voxel];
            if (component.label == Label::wall && is_hung) continue;
            result.labels[i] = component.label;
            result.instances[i] = component.instance;
            // At the tolerance, half of the confidence is left.
            result.confidences[i] =
                static_cast<float>(component.confidence) * (1.0F - 0.5F * deviation * deviation);
        }
    });
    label_openings(map, sample, patches, surfaces, openings, result, context);
    return result;
}

}  // namespace roomscribe
