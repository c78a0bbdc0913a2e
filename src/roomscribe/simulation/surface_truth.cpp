// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/surface_truth.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>

#include <Eigen/Eigenvalues>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/simulation/scanning/ray_caster.hpp"
#include "roomscribe/simulation/scanning/scanner_model.hpp"
#include "roomscribe/simulation/simulated_world.hpp"

namespace roomscribe {
namespace {

using Box = Eigen::AlignedBox3d;

/// What no scanner here resolves: gaps between fronts, steps between sheets.
constexpr double max_gap = 0.015;
constexpr double max_step = 0.002;
constexpr double max_bend = radians(1.5);
/// Facets of round things are no planar surface.
constexpr double min_facet = 1e-4;

struct Facet {
    std::array<Eigen::Vector3d, 3> corners;
    Plane plane;
    double area = 0.0;
    Box box;
};

Facet facet_of(const SimulatedWorld& world, std::size_t triangle) {
    Facet facet;
    for (std::size_t i = 0; i < 3; ++i) {
        facet.corners[i] = world.vertices[world.triangles[triangle][i]].cast<double>();
        facet.box.extend(facet.corners[i]);
    }
    const Eigen::Vector3d across =
        (facet.corners[1] - facet.corners[0]).cross(facet.corners[2] - facet.corners[0]);
    facet.area = 0.5 * across.norm();
    facet.plane.normal = across.normalized();
    facet.plane.offset = facet.plane.normal.dot(facet.corners[0]);
    facet.box.min().array() -= 0.5 * max_gap;
    facet.box.max().array() += 0.5 * max_gap;
    return facet;
}

/// A corner of one lies on the other, or so near that no scanner sees the gap or the step.
bool touches(const Facet& a, const Facet& b) {
    return std::any_of(a.corners.begin(), a.corners.end(), [&](const auto& corner) {
        return b.box.contains(corner) && std::abs(b.plane.signed_distance(corner)) <= max_step;
    });
}

/// Plastered walls are uneven: their facets meet at small angles.
bool are_one_surface(const Facet& a, const Facet& b) {
    return a.box.intersects(b.box) &&
           std::abs(a.plane.normal.dot(b.plane.normal)) >= std::cos(max_bend) &&
           (touches(a, b) || touches(b, a));
}

/// Sums over the area of triangles, for their least-squares plane.
struct AreaMoments {
    double area = 0.0;
    Eigen::Vector3d first = Eigen::Vector3d::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();

    void add(const Facet& facet) {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
        for (const Eigen::Vector3d& corner : facet.corners) {
            sum += corner;
            squares += corner * corner.transpose();
        }
        area += facet.area;
        first += facet.area / 3.0 * sum;
        second += facet.area / 12.0 * (squares + sum * sum.transpose());
    }

    Plane plane() const {
        const Eigen::Vector3d middle = first / area;
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(second / area -
                                                                    middle * middle.transpose());
        const Eigen::Vector3d normal = solver.eigenvectors().col(0);
        return {normal, normal.dot(middle)};
    }
};

/// The rectangle that facets fill, if they do: along their longest edge.
std::optional<Quadrilateral> rectangle_of(std::span<const Facet* const> facets,
                                          const Plane& plane) {
    Eigen::Vector3d along = Eigen::Vector3d::Zero();
    double area = 0.0;
    for (const Facet* facet : facets) {
        area += facet->area;
        for (std::size_t i = 0; i < 3; ++i) {
            const Eigen::Vector3d edge = facet->corners[(i + 1) % 3] - facet->corners[i];
            // The diagonal of a rectangle is longer than its sides, but has the right angle
            // opposite.
            const Eigen::Vector3d a = facet->corners[i] - facet->corners[(i + 2) % 3];
            const Eigen::Vector3d b = facet->corners[(i + 1) % 3] - facet->corners[(i + 2) % 3];
            const bool is_diagonal = std::abs(a.normalized().dot(b.normalized())) < 1e-3;
            if (!is_diagonal && edge.squaredNorm() > along.squaredNorm()) along = edge;
        }
    }
    if (along.isZero()) return std::nullopt;
    const Eigen::Vector3d u = (along - along.dot(plane.normal) * plane.normal).normalized();
    const Eigen::Vector3d v = plane.normal.cross(u);
    Eigen::AlignedBox2d box;
    for (const Facet* facet : facets) {
        for (const Eigen::Vector3d& corner : facet->corners)
            box.extend(Eigen::Vector2d(corner.dot(u), corner.dot(v)));
    }
    constexpr double min_fill = 0.97;
    if (area < min_fill * box.volume() || area > box.volume() / min_fill) return std::nullopt;
    const auto place = [&](double x, double y) {
        return Eigen::Vector3d(x * u + y * v + plane.offset * plane.normal);
    };
    return Quadrilateral{{place(box.min().x(), box.min().y()), place(box.max().x(), box.min().y()),
                          place(box.max().x(), box.max().y()),
                          place(box.min().x(), box.max().y())}};
}

/// Which triangles make one surface: a number per triangle, -1 for the facets of round things.
class SurfaceGroups {
  public:
    explicit SurfaceGroups(const SimulatedWorld& world) : root_(world.triangles.size()) {
        std::iota(root_.begin(), root_.end(), std::size_t{0});
        facets_.reserve(root_.size());
        for (std::size_t i = 0; i < root_.size(); ++i)
            facets_.push_back(facet_of(world, i));
        join_neighbors();
    }

    std::vector<std::int32_t> number(std::vector<TrueSurface>& surfaces) {
        std::vector<std::int32_t> number_of(root_.size(), -1);
        std::vector<AreaMoments> moments;
        std::vector<std::vector<const Facet*>> facets_of;
        for (std::size_t i = 0; i < root_.size(); ++i) {
            if (facets_[i].area < min_facet) continue;
            std::int32_t& number = number_of[find(i)];
            if (number < 0) {
                number = static_cast<std::int32_t>(moments.size());
                moments.emplace_back();
                facets_of.emplace_back();
            }
            moments[static_cast<std::size_t>(number)].add(facets_[i]);
            facets_of[static_cast<std::size_t>(number)].push_back(&facets_[i]);
        }
        for (std::size_t n = 0; n < moments.size(); ++n) {
            const Plane plane = moments[n].plane();
            surfaces.push_back({plane, moments[n].area, rectangle_of(facets_of[n], plane)});
        }
        for (std::size_t i = 0; i < root_.size(); ++i) {
            if (facets_[i].area >= min_facet) number_of[i] = number_of[find(i)];
        }
        return number_of;
    }

  private:
    std::size_t find(std::size_t i) {
        while (root_[i] != i) {
            root_[i] = root_[root_[i]];
            i = root_[i];
        }
        return i;
    }

    void join_neighbors() {
        constexpr double cell_size = 0.5;
        const auto cell = [](double value) {
            return static_cast<int>(std::floor(value / cell_size));
        };
        std::map<std::tuple<int, int, int>, std::vector<std::size_t>> cells;
        for (std::size_t i = 0; i < facets_.size(); ++i) {
            if (facets_[i].area < min_facet) continue;
            const Box& box = facets_[i].box;
            for (int x = cell(box.min().x()); x <= cell(box.max().x()); ++x) {
                for (int y = cell(box.min().y()); y <= cell(box.max().y()); ++y) {
                    for (int z = cell(box.min().z()); z <= cell(box.max().z()); ++z) {
                        cells[{x, y, z}].push_back(i);
                    }
                }
            }
        }
        for (const auto& [place, members] : cells) {
            for (std::size_t a = 0; a < members.size(); ++a) {
                for (std::size_t b = a + 1; b < members.size(); ++b) {
                    if (find(members[a]) != find(members[b]) &&
                        are_one_surface(facets_[members[a]], facets_[members[b]])) {
                        root_[find(members[b])] = find(members[a]);
                    }
                }
            }
        }
    }

    std::vector<std::size_t> root_;
    std::vector<Facet> facets_;
};

/// How far a point may be measured from the surface it lies on, at this range.
double measuring_tolerance(const ScannerModel& model, double range) {
    constexpr double deviations = 4.0;
    const double least = 0.005;
    if (model.pattern == ScanPattern::image) {
        const double depth_per_disparity = range * range / (model.focal_length * model.baseline);
        return least +
               depth_per_disparity * (model.disparity_step + deviations * model.disparity_noise);
    }
    return least + deviations * std::hypot(model.range_noise, model.row_bias) +
           2.0 * model.darkness_bias;
}

}  // namespace

SurfaceTruth find_surface_truth(const Scenario& scenario, const SimulatedScene& scene,
                                const Context& context) {
    const SimulatedWorld world = build_world(scenario);
    const RayCaster caster(world);
    const ScannerModel model = scanner_model(scenario.scanner, scenario.coarseness);
    const Transform world_from_map = scene.truth.scene.room_from_map;
    SurfaceTruth truth;
    SurfaceGroups groups(world);
    const std::vector<std::int32_t> surface_of_triangle = groups.number(truth.surfaces);
    const ScanMap& map = scene.truth.map;
    const auto is_pane = [&](std::uint32_t part) { return world.parts[part].transparency > 0.0; };
    truth.surface_of_point.assign(map.cloud.size(), -1);
    for (std::size_t s = 0; s < map.sections.size(); ++s) {
        const MapSection& section = map.sections[s];
        const Eigen::Vector3d sensor = world_from_map * *section.sensor_position;
        parallel_for(context, section.count, 1024, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = section.first + begin; i < section.first + end; ++i) {
                if (!is_finite(map.cloud.positions[i])) continue;
                const Eigen::Vector3d ray =
                    world_from_map * map.cloud.positions[i].cast<double>() - sensor;
                const double range = ray.norm();
                const auto is_there = [&](const std::optional<RayHit>& hit) {
                    return hit && std::abs(hit->distance - range) * hit->cosine <=
                                      measuring_tolerance(model, range);
                };
                auto hit = caster.cast(sensor, ray / range);
                if (!is_there(hit)) hit = caster.cast_past(is_pane, sensor, ray / range);
                if (is_there(hit)) truth.surface_of_point[i] = surface_of_triangle[hit->triangle];
            }
        });
    }
    const Transform map_from_world = world_from_map.inverse();
    for (TrueSurface& surface : truth.surfaces) {
        const Eigen::Vector3d on_plane = surface.plane.offset * surface.plane.normal;
        surface.plane.normal = map_from_world.linear() * surface.plane.normal;
        surface.plane.offset = surface.plane.normal.dot(map_from_world * on_plane);
        if (!surface.rectangle) continue;
        for (Eigen::Vector3d& corner : surface.rectangle->corners)
            corner = map_from_world * corner;
    }
    return truth;
}

}  // namespace roomscribe
