// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace roomscribe {

/// The style sheet of the report: light and dark, screen and paper.
std::string report_style();

/// Makes the tables sortable by a click on a column's head; the report is whole without it.
std::string_view report_script();

}  // namespace roomscribe
