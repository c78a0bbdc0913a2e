// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/geometry/search_tree.hpp"
#include "roomscribe/geometry/transform.hpp"

namespace roomscribe {

enum class IcpMethod : std::uint8_t {
    point_to_point,  ///< the paper's equation (1)
    point_to_plane,  ///< distances along the target's normals (Chen and Medioni 1992)
};

inline std::span<const std::string_view> enumerator_names(IcpMethod) {
    static constexpr std::array<std::string_view, 2> names{"point_to_point", "point_to_plane"};
    return names;
}

struct IcpSettings {
    IcpMethod method = IcpMethod::point_to_plane;
    double max_correspondence_distance = 1.0;
    int max_iterations = 100;
    double min_error_change = 1e-6;
    double max_normal_angle = 0.7;

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
    /// J^T J of the residuals with respect to a twist (rotation vector about the origin of the
    /// target frame, translation) at the result: with the noise, what is known of the pose.
    Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
    IcpStop stop = IcpStop::too_few_pairs;
};

/// Points with their unit normals (or none; NaN where unknown), and a tree over them.
struct IcpTarget {
    std::span<const Eigen::Vector3f> positions;
    std::span<const Eigen::Vector3f> normals;
    const SearchTree& tree;
};
struct IcpSource {
    std::span<const Eigen::Vector3f> positions;
    std::span<const Eigen::Vector3f> normals;
};

/// Iterative Closest Point from an initial guess (steps 4 to 7 of the paper's Algorithm 1; Besl and
/// McKay 1992): closest points, then the motion that minimises their distance, until the error
/// stands still. Never returns a silent identity: see `stop` and `num_pairs`.
/// Throws InvalidArgument if point_to_plane is asked for without target normals.
IcpResult align_icp(const IcpSource& source, const IcpTarget& target,
                    const Transform& target_from_source_guess, const IcpSettings& settings = {},
                    const Context& context = {});

}  // namespace roomscribe
