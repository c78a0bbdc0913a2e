// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace roomscribe {

/// Base of everything that roomscribe throws on purpose. An algorithm that ran but found little
/// does not throw: its result says so in a stop reason.
class Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// A broken precondition or a setting out of range. The message names the parameter, its value and
/// what is allowed.
class InvalidArgument : public Error {
  public:
    InvalidArgument(std::string_view parameter, std::string_view value, std::string_view allowed);
};

/// Where in a file something is wrong: at a byte, in a line (counted from 1), or in the file whole.
struct FilePosition {
    std::optional<std::uint64_t> byte = {};
    std::optional<std::uint64_t> line = {};
};

/// A file that is missing, truncated, malformed or hostile, or that cannot be written. The message
/// is one line: path, format, place, reason, cure.
class IoError : public Error {
  public:
    IoError(std::string path, std::string_view format, FilePosition position,
            std::string_view reason, std::string_view cure);

    const std::string& path() const { return path_; }

  private:
    std::string path_;
};

/// The caller asked to stop (Context::cancel).
class Cancelled : public Error {
  public:
    Cancelled() : Error("cancelled") {}
};

}  // namespace roomscribe
