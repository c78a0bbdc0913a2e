// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "roomscribe/simulation/scenario.hpp"

namespace roomscribe {

/// A scenario as people write and read it: JSON with the field names of scenario.hpp; what has its
/// default value is left out.
std::string scenario_to_json(const Scenario& scenario);

/// Reads it. Throws IoError, which names `path`, for text that is not JSON (with the byte), and for
/// a key that is not known, a value of another kind or a number that is not finite (with its place,
/// as in openings[3].width).
Scenario scenario_from_json(std::string_view text, const std::string& path = "scenario");

}  // namespace roomscribe
