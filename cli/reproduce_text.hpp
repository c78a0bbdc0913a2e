// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <string>

#include "roomscribe/reproduction/paper_tables.hpp"

namespace roomscribe::cli {

/// Ours, a row per data set and per method.
using TableOne = std::array<DescriptorComparison, 3>;
using TableTwo = std::array<AlignmentComparison, 3>;

/// What the scans of each row are, for people.
using RowSources = std::array<std::string, 3>;

std::string table_1_text(const TableOne& rows, const RowSources& sources);
std::string table_1_json(const TableOne& rows, const RowSources& sources);
std::string table_2_text(const TableTwo& rows, const std::string& source);
std::string table_2_json(const TableTwo& rows, const std::string& source);

}  // namespace roomscribe::cli
