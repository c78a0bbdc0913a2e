// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/registration/features/correspondence_rejection.hpp"
#include "roomscribe/registration/features/correspondences.hpp"

namespace roomscribe {

/// Points of a scan with what tells them apart: as many positions as normals and descriptors.
struct DescribedPoints {
    std::vector<Eigen::Vector3f> positions;
    std::vector<Eigen::Vector3f> normals;  ///< unit, or NaN
    Eigen::MatrixXf descriptors;           ///< one column per point, of any one kind
};

/// The points whose descriptors match_descriptors pairs, in its order; those without a normal on
/// either side are left out. Precondition: descriptors of one kind.
std::vector<PointMatch> match_points(const DescribedPoints& source, const DescribedPoints& target,
                                     const MatchSettings& settings = {},
                                     const Context& context = {});

}  // namespace roomscribe
