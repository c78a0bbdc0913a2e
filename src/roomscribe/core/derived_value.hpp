// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace roomscribe {

/// A value that the program chose from the data, and why: what `roomscribe explain` prints.
struct DerivedValue {
    std::string name;  ///< "registration.voxel_size"
    double value = 0.0;
    std::string unit;
    std::string reason;  ///< "4 x the point spacing of the sparsest scan, 0.021 m"
};

}  // namespace roomscribe
