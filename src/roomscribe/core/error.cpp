// SPDX-License-Identifier: MIT
#include "roomscribe/core/error.hpp"

#include <utility>

#include <fmt/format.h>

namespace roomscribe {
namespace {

std::string describe_place(const FilePosition& position) {
    if (position.line) return fmt::format(", line {}", *position.line);
    if (position.byte) return fmt::format(", byte {}", *position.byte);
    return "";
}

std::string describe_format(std::string_view format) {
    return format.empty() ? "" : fmt::format(" ({})", format);
}

}  // namespace

InvalidArgument::InvalidArgument(std::string_view parameter, std::string_view value,
                                 std::string_view allowed)
    : Error(fmt::format("{} = {}: must be {}", parameter, value, allowed)) {}

IoError::IoError(std::string path, std::string_view format, FilePosition position,
                 std::string_view reason, std::string_view cure)
    : Error(fmt::format("{}{}{}: {}; {}", path, describe_format(format), describe_place(position),
                        reason, cure)),
      path_(std::move(path)) {}

}  // namespace roomscribe
