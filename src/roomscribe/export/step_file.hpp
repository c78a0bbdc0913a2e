// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace roomscribe {

/// The data section of a STEP file (ISO 10303-21) as it grows: entities get the numbers 1, 2, ...
class StepFile {
  public:
    /// Adds "IFCWALL" with its arguments, which are given as STEP writes them, and returns "#7".
    std::string add(std::string_view entity, std::initializer_list<std::string> arguments);

    /// The whole file. `header` is what stands between HEADER; and ENDSEC;.
    std::string text(std::string_view header) const;

  private:
    std::string data_;
    std::size_t num_entities_ = 0;
};

/// A text in quotes: quotes and backslashes doubled, what is not ASCII as \X2\...\X0\. Bytes that
/// are not UTF-8 become '?'.
std::string step_text(std::string_view text);

/// "1.25", "3."; with at most 9 decimals.
std::string step_real(double value);

/// "(#1,#2)"
std::string step_list(std::span<const std::string> elements);

/// "(1.,0.,2.5)"
std::string step_numbers(const Eigen::VectorXd& numbers);

/// A GlobalId of IFC: 128 bits that follow from the text alone, in the 22 characters that IFC has
/// for them.
std::string ifc_global_id(std::string_view text);

}  // namespace roomscribe
