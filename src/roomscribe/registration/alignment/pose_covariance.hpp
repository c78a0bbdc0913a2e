// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/geometry/transform.hpp"
#include "roomscribe/registration/alignment/icp.hpp"

namespace roomscribe {

enum class CovarianceMethod : std::uint8_t {
    /// The paper's equation (2): the Cramer-Rao bound, noise^2 (sum J^T J)^-1. With point_to_point,
    /// J = [-A I] of the points' skew matrices A, as printed there.
    fisher_information,
    /// H^-1 G cov(z) G^T H^-1 with H and G the cost's second derivatives with respect to the pose,
    /// and to the pose and the points of both scans (Censi 2007; in closed form Prakhya et al.
    /// 2015), of Gauss-Newton: the points' noise is independent, pairs and normals stand still.
    noise_propagation,
    /// H^-1 M H^-1 with M from the residuals' own variance and spatial correlation. Neighbouring
    /// points share the error of their surface, so there are fewer observations than points.
    correlated_residuals,
};

inline std::span<const std::string_view> enumerator_names(CovarianceMethod) {
    static constexpr std::array<std::string_view, 3> names{
        "fisher_information", "noise_propagation", "correlated_residuals"};
    return names;
}

struct PoseCovarianceSettings {
    CovarianceMethod method = CovarianceMethod::correlated_residuals;
    double shared_error = 1.0;

    void visit(SettingVisitor& visitor) {
        visitor(method, {.name = "method", .unit = "", .doc = "What the covariance follows from."});
        visitor(shared_error,
                {.name = "shared_error",
                 .unit = "",
                 .min = 0.0,
                 .max = 10.0,
                 .doc = "Of correlated_residuals: errors that whole surfaces share and that the "
                        "alignment hides from its residuals, as a multiple of the normals' noise "
                        "times the distance of paired points along the surface."});
    }
};

struct PoseCovariance {
    /// Of a small motion (rotation vector about the origin of the target frame, translation) that
    /// leads from the pose to the truth: rad2 / rad m / m2. Along a direction that nothing holds,
    /// the extent of the points squared.
    Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
    /// Unit twists of the same kind along which the surfaces hold no more than the noise of the
    /// normals alone would make believe: a corridor's axis. Two independent normals per pair, the
    /// source's and the target's, tell one from the other.
    std::vector<Eigen::Matrix<double, 6, 1>> unobservable;
};

/// Covariance of a pose that align_icp found with these settings. `noise` (m): standard deviation
/// of a point, of use to the first two methods. Residuals are the offsets along the target's
/// normals, or along all three axes for point_to_point. With fewer than 6 pairs nothing is held.
/// Throws InvalidArgument as align_icp does, and if noise is negative.
PoseCovariance estimate_pose_covariance(const IcpSource& source, const IcpTarget& target,
                                        const Transform& target_from_source,
                                        const IcpSettings& icp_settings, double noise,
                                        const PoseCovarianceSettings& settings = {},
                                        const Context& context = {});

}  // namespace roomscribe
