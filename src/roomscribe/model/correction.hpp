// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "roomscribe/model/scene.hpp"

namespace roomscribe {

enum class CorrectionAction : std::uint8_t {
    pin,      ///< it is there, and is what it is said to be
    reject,   ///< there is no such thing
    relabel,  ///< it is something else
    set_size  ///< it is as large as this
};

/// What somebody says of one element of a result. Ids change from run to run, so the element is
/// told by its label and where it lies.
struct Correction {
    CorrectionAction action = CorrectionAction::pin;
    Component element =
        {};  ///< as the result had it: label, and polygon or box; in the map's frame
    Label label = Label::unknown;  ///< of relabel
    std::string kind = {};         ///< of relabel
    /// m, of set_size: width and height of a polygon, extents along the axes of a box.
    std::vector<double> size = {};
};

}  // namespace roomscribe
