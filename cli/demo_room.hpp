// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "roomscribe/model/scan.hpp"

namespace roomscribe::cli {

/// Three scans of a furnished room of 5.6 x 4.2 x 2.6 m that exists nowhere, as a laser scanner
/// would leave them: each in the scanner's own frame, which is turned and a few degrees off level,
/// with 5 mm of noise along the ray and NaN where a ray leaves through the window. Always the same.
std::vector<Scan> scan_demo_room();

}  // namespace roomscribe::cli
