// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "roomscribe/export/storey_plan.hpp"

namespace roomscribe {

/// Floor plans as one SVG sheet at 1:50: its units are millimetres on paper, 20 to a metre, in its
/// viewBox, width and height. A group per storey, and in it one per layer; shapes have the id of
/// what they show as data-id.
std::string plans_to_svg(const std::vector<StoreyPlan>& plans);

}  // namespace roomscribe
