// SPDX-License-Identifier: MIT
#include "roomscribe/structure/plane_hough.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/preprocessing/voxel_grid.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t chunk = 16384;
constexpr std::size_t max_voters = 20'000;
constexpr std::size_t num_refined = 8;
constexpr int max_refinements = 20;

/// Unit vectors spread evenly over the half-sphere z >= 0 (Fibonacci lattice).
std::vector<Eigen::Vector3f> spread_directions(double step) {
    const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
    const auto count = static_cast<std::size_t>(std::ceil(2.0 * std::numbers::pi / (step * step)));
    std::vector<Eigen::Vector3f> directions;
    directions.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double z = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
        const double around = golden_angle * static_cast<double>(i);
        const double radius = std::sqrt(1.0 - z * z);
        const Eigen::Vector3d direction(radius * std::cos(around), radius * std::sin(around), z);
        directions.emplace_back(direction.cast<float>());
    }
    return directions;
}

/// Points that stand for those around them.
struct Voter {
    Eigen::Vector3f position;
    std::int32_t weight;
};

/// Few enough voters, evenly spread, each with a vote for every point that it stands for.
std::vector<Voter> choose_voters(const PointCloud& cloud, double tolerance,
                                 const Context& context) {
    VoxelGrid grid = downsample_voxel_grid(cloud, {.voxel_size = tolerance}, context);
    for (double size = 1.5 * tolerance; grid.cloud.size() > max_voters; size *= 1.5)
        grid = downsample_voxel_grid(cloud, {.voxel_size = size}, context);
    std::vector<Voter> voters;
    voters.reserve(grid.cloud.size());
    for (std::size_t i = 0; i < grid.cloud.size(); ++i) {
        voters.push_back({grid.cloud.positions[i], static_cast<std::int32_t>(grid.num_points[i])});
    }
    return voters;
}

class Accumulator {
  public:
    Accumulator(std::vector<Voter> voters, const PlaneHoughSettings& settings,
                const Context& context)
        : voters_(std::move(voters)),
          context_(context),
          directions_(spread_directions(settings.angle_step)) {
        for (const Voter& voter : voters_)
            middle_ += voter.position / static_cast<float>(voters_.size());
        float reach = 0.0F;
        for (const Voter& voter : voters_)
            reach = std::max(reach, (voter.position - middle_).norm());
        // Neighbouring directions part by half a step times the reach; finer offsets tell no more.
        bin_size_ =
            static_cast<float>(std::max(2.0 * settings.detection.distance_tolerance,
                                        0.25 * settings.angle_step * static_cast<double>(reach)));
        reach_ = reach + bin_size_;
        num_bins_ = static_cast<std::size_t>(2.0F * reach_ / bin_size_) + 2;
        votes_.assign(directions_.size() * num_bins_, 0);
        vote(voters_, 1);
    }

    /// Planes of the cells with the most votes, no two of them side by side.
    std::vector<Plane> best_cells() const {
        std::vector<std::pair<std::int32_t, std::size_t>> best_of(directions_.size());
        for (std::size_t d = 0; d < directions_.size(); ++d) {
            const auto begin = votes_.begin() + static_cast<std::ptrdiff_t>(d * num_bins_);
            const auto most =
                std::max_element(begin, begin + static_cast<std::ptrdiff_t>(num_bins_));
            best_of[d] = {-*most, d * num_bins_ + static_cast<std::size_t>(most - begin)};
        }
        std::sort(best_of.begin(), best_of.end());
        std::vector<Plane> planes;
        for (const auto& [votes, cell] : best_of) {
            if (votes == 0 || planes.size() == num_refined) break;
            const Plane plane = plane_of(cell);
            constexpr double min_cosine = 0.996;  // 5 degrees
            const bool is_new = std::none_of(planes.begin(), planes.end(), [&](const Plane& other) {
                return std::abs(other.normal.dot(plane.normal)) > min_cosine &&
                       std::abs(other.signed_distance(plane.project(middle_.cast<double>()))) <
                           2.0 * static_cast<double>(bin_size_);
            });
            if (is_new) planes.push_back(plane);
        }
        return planes;
    }

    /// Takes back the votes of the voters near a plane.
    void take_out(const Plane& plane, double tolerance) {
        const auto gone = std::partition(voters_.begin(), voters_.end(), [&](const Voter& voter) {
            return std::abs(plane.signed_distance(voter.position.cast<double>())) > tolerance;
        });
        vote(std::vector<Voter>(gone, voters_.end()), -1);
        voters_.erase(gone, voters_.end());
    }

    double bin_size() const { return static_cast<double>(bin_size_); }

  private:
    Plane plane_of(std::size_t cell) const {
        Plane plane;
        plane.normal = directions_[cell / num_bins_].cast<double>().normalized();
        plane.offset = plane.normal.dot(middle_.cast<double>()) +
                       (static_cast<double>(cell % num_bins_) + 0.5) * bin_size() -
                       static_cast<double>(reach_);
        return plane;
    }

    void vote(const std::vector<Voter>& voters, std::int32_t sign) {
        parallel_for(context_, directions_.size(), 64, [&](std::size_t begin, std::size_t end) {
            for (std::size_t d = begin; d < end; ++d) {
                std::int32_t* const row = votes_.data() + d * num_bins_;
                for (const Voter& voter : voters) {
                    const float offset = directions_[d].dot(voter.position - middle_) + reach_;
                    row[static_cast<std::size_t>(offset / bin_size_)] += sign * voter.weight;
                }
            }
        });
    }

    std::vector<Voter> voters_;
    const Context& context_;
    std::vector<Eigen::Vector3f> directions_;
    Eigen::Vector3f middle_ = Eigen::Vector3f::Zero();
    float reach_ = 0.0F;
    float bin_size_ = 1.0F;
    std::size_t num_bins_ = 0;
    std::vector<std::int32_t> votes_;  ///< direction by direction
};

PlaneMoments moments_near(const PointCloud& cloud, std::span<const std::uint32_t> points,
                          const Plane& plane, double tolerance, const Context& context) {
    return parallel_reduce(
        context, points.size(), chunk, PlaneMoments{},
        [&](std::size_t begin, std::size_t end) {
            PlaneMoments moments;
            for (std::size_t i = begin; i < end; ++i) {
                const Eigen::Vector3d point = cloud.positions[points[i]].cast<double>();
                if (std::abs(plane.signed_distance(point)) <= tolerance) moments.add(point);
            }
            return moments;
        },
        [](PlaneMoments a, const PlaneMoments& b) { return a += b; });
}

struct Candidate {
    Plane plane;
    std::size_t num_inliers = 0;
};

/// Least squares over the inliers, from those of a cell down to those of the tolerance, until their
/// number does not grow any more.
Candidate refine(const PointCloud& cloud, std::span<const std::uint32_t> points, Plane plane,
                 double wide, double tolerance, const Context& context) {
    Candidate best;
    double reach = wide;
    for (int i = 0; i < max_refinements; ++i) {
        const PlaneMoments moments = moments_near(cloud, points, plane, reach, context);
        if (reach <= tolerance) {
            if (moments.count <= best.num_inliers) break;
            best = {plane, moments.count};
        }
        const auto fit = moments.fit();
        if (!fit) break;
        plane = fit->plane;
        reach = std::max(tolerance, 0.6 * reach);
    }
    return best;
}

}  // namespace

PlaneDetectionResult detect_planes_hough(const PointCloud& cloud,
                                         const PlaneHoughSettings& settings,
                                         const Context& context) {
    check_settings(settings);
    const double tolerance = settings.detection.distance_tolerance;
    std::optional<Accumulator> accumulator;
    const auto find_plane = [&](std::span<const std::uint32_t> left) {
        if (!accumulator)
            accumulator.emplace(choose_voters(cloud, tolerance, context), settings, context);
        Candidate best;
        for (const Plane& plane : accumulator->best_cells()) {
            const Candidate candidate =
                refine(cloud, left, plane, std::max(tolerance, accumulator->bin_size()), tolerance,
                       context);
            if (candidate.num_inliers > best.num_inliers) best = candidate;
        }
        accumulator->take_out(best.plane, tolerance);
        return best.num_inliers > 0 ? std::optional(best.plane) : std::nullopt;
    };
    return take_out_planes(cloud, find_plane, settings.detection, context);
}

}  // namespace roomscribe
