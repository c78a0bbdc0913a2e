// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "roomscribe/core/context.hpp"
#include "roomscribe/io/byte_reader.hpp"

namespace roomscribe {

inline constexpr std::string_view rosbag_format = "ROS bag";

/// What messages of one kind have in common.
struct BagConnection {
    std::string topic;       ///< "/scan"
    std::string type;        ///< "sensor_msgs/LaserScan"
    std::string definition;  ///< its text, with those of all types in it
};

/// Calls `use` for every message of a ROS 1 bag (version 2.0) in the order of the file, which is
/// that of recording. Chunks may be uncompressed, bz2 or lz4. The index is not read. The bytes live
/// as long as the call. Throws IoError for what is no such bag, or is damaged. Source:
/// wiki.ros.org/Bags/Format/2.0.
using UseMessage = std::function<void(const BagConnection&, std::span<const std::byte> message)>;
void for_each_bag_message(const MappedFile& file, const Context& context, const UseMessage& use);

}  // namespace roomscribe
