// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/geometry/search_tree.hpp"
#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/registration/alignment/robust_kernel.hpp"

namespace roomscribe {

enum class IcpMethod : std::uint8_t {
    point_to_point,  ///< the paper's equation (1)
    point_to_plane,  ///< distances along the target's normals (Chen and Medioni 1992)
    generalized,     ///< distances along both normals (Segal, Haehnel and Thrun 2009)
};

inline std::span<const std::string_view> enumerator_names(IcpMethod) {
    static constexpr std::array<std::string_view, 3> names{"point_to_point", "point_to_plane",
                                                           "generalized"};
    return names;
}

struct IcpSettings {
    IcpMethod method = IcpMethod::point_to_plane;
    double max_correspondence_distance = 1.0;
    int max_iterations = 100;
    double min_error_change = 1e-6;
    double max_normal_angle = 0.7;
    std::optional<double> max_offset_along_surface = {};
    RobustKernel kernel = RobustKernel::none;
    std::optional<double> kernel_scale = {};
    double trimmed_share = 0.0;
    double reach_shrink = 1.0;

    void visit(SettingVisitor& visitor) {
        visitor(method, {.name = "method", .unit = "", .doc = "What an iteration minimises."});
        visitor(max_correspondence_distance,
                {.name = "max_correspondence_distance",
                 .unit = "m",
                 .min = 1e-9,
                 .max = 1e6,
                 .doc = "A point whose nearest target point is farther takes no part. The paper's "
                        "is 1 m."});
        visitor(max_iterations, {.name = "max_iterations",
                                 .unit = "",
                                 .min = 1,
                                 .max = 100'000,
                                 .doc = "The paper's is 100."});
        visitor(
            min_error_change,
            {.name = "min_error_change",
             .unit = "m",
             .min = 0.0,
             .max = 1e3,
             .doc = "Stop when the root mean square error changes by less, and the motion of an "
                    "iteration moves no point by more than ten times this."});
        visitor(max_normal_angle,
                {.name = "max_normal_angle",
                 .unit = "rad",
                 .min = 0.0,
                 .max = 3.15,
                 .doc = "Points whose normals differ by more take no part, where both sides have "
                        "normals."});
        visitor(max_offset_along_surface,
                {.name = "max_offset_along_surface",
                 .unit = "m",
                 .min = 1e-9,
                 .max = 1e6,
                 .doc = "A point whose nearest target point lies farther off along the target's "
                        "surface takes no part: it lies beyond the edge of what the target saw, "
                        "and would pull the surfaces over each other. auto: no limit."});
        visitor(kernel,
                {.name = "kernel",
                 .unit = "",
                 .doc = "How much a pair counts by its residual (Zhang 1997): all alike, or less "
                        "the larger the residual."});
        visitor(kernel_scale,
                {.name = "kernel_scale",
                 .unit = "m",
                 .min = 1e-9,
                 .max = 1e3,
                 .doc = "Standard deviation of the residuals, for the kernel; the guess must then "
                        "be about as good. auto: from the median of each iteration's residuals."});
        visitor(trimmed_share,
                {.name = "trimmed_share",
                 .unit = "",
                 .min = 0.0,
                 .max = 0.9,
                 .doc = "The share of the pairs, those with the largest residuals, that is left "
                        "out (Chetverikov et al. 2002)."});
        visitor(reach_shrink,
                {.name = "reach_shrink",
                 .unit = "",
                 .min = 0.1,
                 .max = 1.0,
                 .doc = "Coarse to fine: the correspondence distance shrinks by this factor per "
                        "iteration, down to three robust standard deviations of the distances of "
                        "the pairs. 1: it stays."});
    }
};

enum class IcpStop : std::uint8_t {
    converged,       ///< error change < min_error_change, step < 10 min_error_change
    max_iterations,  ///< iterations = max_iterations
    too_few_pairs,   ///< fewer than 6 pairs within reach: nothing to align
};
std::string_view icp_stop_name(IcpStop stop);

struct IcpResult {
    Transform target_from_source = Transform::Identity();
    std::size_t num_pairs = 0;   ///< of the last iteration
    double rmse = 0.0;           ///< m, of what the method minimises, over the pairs
    std::vector<double> errors;  ///< m, rmse at the start of every iteration
    /// J^T W J of the residuals with respect to a twist (rotation vector about the origin of the
    /// target frame, translation) at the result: with the noise, what is known of the pose.
    Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
    IcpStop stop = IcpStop::too_few_pairs;
    double scale = 0.0;  ///< m, robust standard deviation of the residuals (from their median)
    double reach = 0.0;  ///< m, the correspondence distance of the last iteration
};

/// Points with their unit normals (or none; NaN where unknown), and a tree over them.
struct IcpTarget {
    std::span<const Eigen::Vector3f> positions;
    std::span<const Eigen::Vector3f> normals;
    const SearchTree& tree;
    /// m, standard deviation of each point across its surface: a pair counts by the inverse of its
    /// variance. Empty: all alike.
    std::span<const float> deviations = {};
};
struct IcpSource {
    std::span<const Eigen::Vector3f> positions;
    std::span<const Eigen::Vector3f> normals;
    std::span<const float> deviations = {};  ///< as of the target
};

/// Iterative Closest Point from an initial guess (steps 4 to 7 of the paper's Algorithm 1; Besl and
/// McKay 1992): closest points, then the motion that minimises their distance, until the error
/// stands still. Each pair counts by its kernel's weight (iteratively reweighted least squares).
/// Never returns a silent identity: see `stop` and `num_pairs`.
/// Throws InvalidArgument if point_to_plane is asked for without target normals, or generalized
/// without both sides' normals.
IcpResult align_icp(const IcpSource& source, const IcpTarget& target,
                    const Transform& target_from_source_guess, const IcpSettings& settings = {},
                    const Context& context = {});

}  // namespace roomscribe
