// SPDX-License-Identifier: MIT
#include "roomscribe/registration/alignment/icp_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/parallel.hpp"
#include "roomscribe/core/quantile.hpp"

namespace roomscribe {
namespace {

double median_variance(std::span<const float> deviations) {
    std::vector<float> known;
    std::copy_if(deviations.begin(), deviations.end(), std::back_inserter(known),
                 [](float deviation) { return std::isfinite(deviation); });
    const double deviation = static_cast<double>(median(known));
    return deviation * deviation;
}

double variance_of(std::span<const float> deviations, std::size_t i) {
    if (deviations.empty()) return 0.0;
    return static_cast<double>(deviations[i]) * static_cast<double>(deviations[i]);
}

Eigen::Matrix3d outer_square(const Eigen::Vector3d& v) {
    return v * v.transpose();
}

}  // namespace

Eigen::Matrix3d IcpPair::generalized_metric() const {
    constexpr double epsilon = 1e-3;  // Segal et al.'s
    const Eigen::Matrix3d covariance =
        2.0 * Eigen::Matrix3d::Identity() -
        (1.0 - epsilon) * (outer_square(target_normal) + outer_square(source_normal));
    return 2.0 * epsilon * covariance.inverse();
}

double IcpPair::residual(IcpMethod method) const {
    switch (method) {
        case IcpMethod::point_to_point:
            return offset.norm();
        case IcpMethod::point_to_plane:
            return target_normal.dot(offset);
        case IcpMethod::generalized:
            return std::sqrt(std::max(0.0, offset.dot(generalized_metric() * offset)));
    }
    return 0.0;
}

double IcpPair::offset_along_surface() const {
    return (offset - target_normal.dot(offset) * target_normal).norm();
}

IcpPairing::IcpPairing(const IcpSource& source, const IcpTarget& target,
                       const IcpSettings& settings)
    : source_(source),
      target_(target),
      settings_(settings),
      closest_points_(target.positions, target.tree, source.positions.size()),
      targets_(source.positions.size(), ClosestPoints::none),
      residuals_(source.positions.size(), 0.0F) {
    if (settings.method == IcpMethod::point_to_plane && target.normals.empty()) {
        throw InvalidArgument("method", "point_to_plane", "used with target normals");
    }
    if (settings.method == IcpMethod::generalized &&
        (target.normals.empty() || source.normals.empty())) {
        throw InvalidArgument("method", "generalized", "used with normals of both sides");
    }
    if (source.deviations.empty() && target.deviations.empty()) return;
    typical_variance_ = median_variance(source.deviations) + median_variance(target.deviations);
    if (typical_variance_ > 0.0) precisions_.assign(source.positions.size(), 1.0F);
}

IcpPair IcpPairing::pair_with(std::size_t i, std::uint32_t target) const {
    IcpPair pair;
    pair.moved = pose_ * source_.positions[i].cast<double>();
    pair.offset = pair.moved - target_.positions[target].cast<double>();
    pair.target_normal.setZero();
    pair.source_normal.setZero();
    if (settings_.method != IcpMethod::point_to_point) {
        pair.target_normal = target_.normals[target].cast<double>();
    }
    if (settings_.method == IcpMethod::generalized) {
        pair.source_normal = pose_.linear() * source_.normals[i].cast<double>();
    }
    return pair;
}

IcpPair IcpPairing::pair(std::size_t i) const {
    return pair_with(i, targets_[i]);
}

void IcpPairing::pair_range(std::size_t begin, std::size_t end, float reach) {
    const bool with_normals = !source_.normals.empty() && !target_.normals.empty();
    const double min_cosine = std::cos(std::min(settings_.max_normal_angle, 3.1415));
    for (std::size_t i = begin; i < end; ++i) {
        targets_[i] = ClosestPoints::none;
        const Eigen::Vector3d moved = pose_ * source_.positions[i].cast<double>();
        const std::uint32_t target = closest_points_.find(i, moved.cast<float>(), reach);
        if (target == ClosestPoints::none) continue;
        if (with_normals) {
            const Eigen::Vector3d turned = pose_.linear() * source_.normals[i].cast<double>();
            // Negated so that a NaN normal takes no part.
            if (!(turned.dot(target_.normals[target].cast<double>()) >= min_cosine)) continue;
        }
        const IcpPair pair = pair_with(i, target);
        const auto residual = static_cast<float>(pair.residual(settings_.method));
        if (!std::isfinite(residual)) continue;
        if (settings_.max_offset_along_surface &&
            pair.offset_along_surface() > *settings_.max_offset_along_surface) {
            continue;
        }
        if (!precisions_.empty()) {
            const double variance =
                variance_of(source_.deviations, i) + variance_of(target_.deviations, target);
            if (!std::isfinite(variance)) continue;
            // No pair is trusted more than four times as much as a typical one.
            precisions_[i] = static_cast<float>(typical_variance_ /
                                                std::max(variance, 0.25 * typical_variance_));
        }
        targets_[i] = target;
        residuals_[i] = residual;
    }
}

void IcpPairing::update(const Transform& target_from_source, double reach, const Context& context) {
    pose_ = target_from_source;
    parallel_for(context, num_sources(), 2048, [&](std::size_t begin, std::size_t end) {
        pair_range(begin, end, static_cast<float>(reach));
    });
    std::vector<float> sizes;
    sizes.reserve(num_sources());
    for (std::size_t i = 0; i < num_sources(); ++i) {
        if (!has_pair(i)) continue;
        const float size = std::abs(residuals_[i]);
        sizes.push_back(precisions_.empty() ? size : size * std::sqrt(precisions_[i]));
    }
    scale_ = deviation_per_median * quantile(sizes, 0.5);
    largest_kept_ = settings_.trimmed_share > 0.0 ? quantile(sizes, 1.0 - settings_.trimmed_share)
                                                  : std::numeric_limits<double>::infinity();
}

double IcpPairing::weight(std::size_t i) const {
    if (!has_pair(i)) return 0.0;
    const double precision = precisions_.empty() ? 1.0 : static_cast<double>(precisions_[i]);
    const double size = std::abs(residual(i)) * std::sqrt(precision);
    if (size > largest_kept_) return 0.0;
    if (settings_.kernel == RobustKernel::none) return precision;
    // Residuals of exactly aligned copies are rounding, about which a kernel has nothing to say.
    const double scale = std::max(settings_.kernel_scale.value_or(scale_), 1e-7);
    return precision * robust_weight(settings_.kernel, size / scale);
}

double IcpPairing::distance_scale() const {
    std::vector<float> distances;
    distances.reserve(num_sources());
    for (std::size_t i = 0; i < num_sources(); ++i) {
        if (has_pair(i)) distances.push_back(static_cast<float>(pair(i).offset.norm()));
    }
    return deviation_per_median * quantile(distances, 0.5);
}

}  // namespace roomscribe
