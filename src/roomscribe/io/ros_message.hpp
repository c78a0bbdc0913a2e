// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "roomscribe/geometry/point_cloud.hpp"

namespace roomscribe {

/// A field of a message: `count` values of one type, little endian; text is uint8.
struct RosField {
    std::string path;  ///< "transforms[0].header.frame_id"
    ScalarType type = ScalarType::uint8;
    std::size_t count = 0;
    std::span<const std::byte> bytes;
};

/// A member of a message type: "float32[] ranges".
struct RosMember {
    std::string type;
    std::string name;
    bool is_array = false;
    std::optional<std::size_t> length;  ///< of an array of fixed length
};

/// The text of a message type, then those of the types within, each after a line of "=" and one
/// that names it, as members by the types' names; that of the message itself has none. Throws
/// Error, with the reason, for what is no such text.
using RosDefinition = std::map<std::string, std::vector<RosMember>>;
RosDefinition parse_ros_definition(std::string_view text);

/// The fields of one ROS 1 message, read by the definition that a bag carries, so that types of
/// anybody's own are read like the common ones.
class RosMessage {
  public:
    /// Throws Error, with the reason, if definition and bytes do not agree.
    RosMessage(const RosDefinition& definition, std::span<const std::byte> bytes);

    std::span<const RosField> fields() const { return fields_; }
    /// nullptr if there is none of that path.
    const RosField* find(std::string_view path) const;
    /// Empty if there is none, or none of values of that kind.
    std::optional<double> number(std::string_view path) const;
    std::optional<std::string> text(std::string_view path) const;
    std::vector<double> numbers(std::string_view path) const;
    /// Seconds; 0 where there is no such time.
    double time(std::string_view path) const;
    /// The name of a frame without the slash that it once began with.
    std::string frame(std::string_view path) const;

  private:
    std::vector<RosField> fields_;
    std::vector<std::size_t> by_path_;  ///< numbers of the fields, sorted by path
};

}  // namespace roomscribe
