// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace roomscribe {

/// The 3D view of reports as JavaScript, made from the folder `viewer` when the program was built.
/// Empty where npm or esbuild was not there then.
std::string viewer_script();

/// "three.js 0.187.0", or empty likewise.
std::string viewer_libraries();

}  // namespace roomscribe
