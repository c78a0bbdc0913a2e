// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "roomscribe/export/storey_plan.hpp"

namespace roomscribe {

/// Floor plans as an ASCII DXF of release 12, which every CAD program reads: model space in metres
/// ($INSUNITS 6), one layer per PlanLayer. What is dashed has the line type DASHED. Storeys stand
/// beside each other as plan_shifts has it; the first is at its own place in the room frame.
std::string plans_to_dxf(const std::vector<StoreyPlan>& plans);

}  // namespace roomscribe
