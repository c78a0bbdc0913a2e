// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <string>

#include "roomscribe/evaluation/detection_error.hpp"
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

/// Our halves of the paper's Table 4: the same scenes interpreted twice.
struct TableFour {
    std::array<DetectionCounts, num_labels> by_paper{};    ///< by the paper's rules
    std::array<DetectionCounts, num_labels> by_default{};  ///< by default
    std::size_t num_scenes = 0;
};

std::string table_4_text(const TableFour& table);
std::string table_4_json(const TableFour& table);

}  // namespace roomscribe::cli
