// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "roomscribe/model/registration_result.hpp"
#include "roomscribe/preprocessing/scanner_up.hpp"

namespace roomscribe {

/// Where accepted links show that the scanners were mounted alike, on tripods or a robot, a pose
/// that tilts two of them against each other is none, though rooms laid on their side fit, too.
/// Such a link becomes ambiguous with its rivals that do not tilt, or rejected. Frames of cameras
/// are left as they are. True if a link is no longer accepted. Nothing happens with less than two
/// accepted links, or if one of five tilts the scanners: they were turned at will. `ups` has one
/// entry per scan.
bool drop_tilted_poses(std::vector<RegistrationLink>& links, std::span<const UsualUp> ups);

}  // namespace roomscribe
