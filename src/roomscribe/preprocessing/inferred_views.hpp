// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/model/scan.hpp"

namespace roomscribe {

/// Places from which the points of sections without a scanner may have been seen: free places
/// within rooms, so many that they see nearly all that can be seen from any. What a surface is seen
/// from says which side of it is its front, and what lies between is free: the evidence of rays,
/// where nobody kept them. It is weaker: nothing was seen where nobody looked, too.
///
/// A place is within a room if there is floor below it and mostly something around it; whether a
/// ceiling was scanned does not matter. Points seen from none of the places are in no view; of very
/// many points an even share is.
///
/// `up`: a unit vector. Empty if all sections have a scanner, nothing is within a room, or a
/// quarter of the points lie more than 6 cm apart: the two faces of a wall cannot be told from each
/// other.
std::vector<InferredView> infer_views(const ScanMap& map, const Eigen::Vector3d& up,
                                      const Context& context = {});

}  // namespace roomscribe
