// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "cli/explanation.hpp"
#include "roomscribe/export/json.hpp"

namespace roomscribe::cli {

/// Why a scan has its place, or none: what registration.json tells of it and its links.
Explanation explain_scan(const RegistrationRecord& registration, std::size_t scan);

/// One line for every scan.
std::string registration_table(const RegistrationRecord& registration);

}  // namespace roomscribe::cli
