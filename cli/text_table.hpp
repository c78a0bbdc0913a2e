// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace roomscribe::cli {

/// Columns of text, as wide as their widest cell.
class TextTable {
  public:
    /// One letter a column: 'l' to align it left, 'r' to align it right.
    explicit TextTable(std::string alignment) : alignment_(std::move(alignment)) {}

    /// Precondition: one cell per column.
    void add_row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }

    std::string to_text() const;

  private:
    std::string alignment_;
    std::vector<std::vector<std::string>> rows_;
};

}  // namespace roomscribe::cli
