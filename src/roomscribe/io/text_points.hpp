// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "roomscribe/core/context.hpp"
#include "roomscribe/io/file_contents.hpp"

namespace roomscribe {

/// Text with one point per line: XYZ, TXT, ASC, CSV, and Leica's PTS, in which a line with the
/// number of points stands before them (several such parts are one cloud). The separator, a header
/// line and the columns are guessed (guessed_columns.hpp); what was guessed goes to
/// Context::on_message and to the warnings. Lines that begin with # or // are skipped at the top;
/// the last of them may name the columns. Columns that mean nothing are channels of float64.
FileContents read_text_points(const std::filesystem::path& path, PointsAs as,
                              const Context& context);

/// Writes every property as columns, and their names before them: "# x y z intensity" and blanks,
/// or commas and a plain header line for .csv. Numbers have all their digits.
void write_text_points(const std::filesystem::path& path, const PointCloud& cloud,
                       const Context& context);

}  // namespace roomscribe
