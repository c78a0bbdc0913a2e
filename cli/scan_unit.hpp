// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/derived_value.hpp"
#include "roomscribe/core/length_unit.hpp"
#include "roomscribe/model/scan.hpp"
#include "roomscribe/pipeline/reconstruct.hpp"

namespace roomscribe::cli {

/// The unit that scans came in, and how it is known.
struct ScanUnit {
    LengthUnit unit = LengthUnit::metre;
    std::string reason;  ///< in words; empty for metres that nothing speaks against
};

/// Brings scans into metres. Their unit is `given`, else that of the first scan which tells one
/// (estimate_length_unit). Throws IoError for a scan that fits no building in metres where none
/// tells. `paths` are the scans' files.
ScanUnit convert_to_metres(std::vector<Scan>& scans, std::span<const std::string> paths,
                           std::optional<LengthUnit> given, const Context& context);

/// Brings poses of these scans into metres.
void convert_to_metres(std::span<std::optional<Transform>> poses, const ScanUnit& unit);

/// What run.json says of a unit other than metres.
std::optional<DerivedValue> unit_as_derived_value(const ScanUnit& unit);

/// One line if the rooms that were found would rather be in feet; else empty.
std::string doubt_about_feet(const Reconstruction& reconstruction);

}  // namespace roomscribe::cli
