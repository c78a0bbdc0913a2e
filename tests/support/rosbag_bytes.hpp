// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace roomscribe::test {

/// Bytes of ROS 1 messages and bags, little endian.
class RosBytes {
  public:
    template <typename Value>
    RosBytes& add(Value value) {
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value));
        return *this;
    }
    RosBytes& add_text(std::string_view text) {
        add(static_cast<std::uint32_t>(text.size()));
        bytes_ += text;
        return *this;
    }
    RosBytes& add_header(double time, std::string_view frame) {
        add(std::uint32_t{0}).add(static_cast<std::uint32_t>(time));
        add(static_cast<std::uint32_t>(1e9 * (time - static_cast<std::uint32_t>(time))));
        return add_text(frame);
    }
    const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
};

inline std::string bag_field(std::string_view name, std::string_view value) {
    return RosBytes().add_text(std::string(name) + "=" + std::string(value)).bytes();
}
template <typename Value>
std::string bag_number(std::string_view name, Value value) {
    return bag_field(name, RosBytes().add(value).bytes());
}
inline std::string bag_record(const std::string& header, const std::string& data) {
    return RosBytes().add_text(header).add_text(data).bytes();
}

/// Messages of one topic, in the order of the bag.
struct BagTopic {
    std::string topic;
    std::string type;
    std::string definition;
    std::vector<std::string> messages;
};

/// A bag of one chunk. `pack` compresses it as the name says.
inline std::string bag_of(
    const std::vector<BagTopic>& topics, const std::string& compression = "none",
    const std::function<std::string(const std::string&)>& pack = [](const std::string& chunk) {
        return chunk;
    }) {
    std::string chunk;
    for (std::uint32_t i = 0; i < topics.size(); ++i) {
        const BagTopic& topic = topics[i];
        chunk += bag_record(bag_number("op", std::uint8_t{7}) + bag_number("conn", i) +
                                bag_field("topic", topic.topic),
                            bag_field("topic", topic.topic) + bag_field("type", topic.type) +
                                bag_field("md5sum", "*") +
                                bag_field("message_definition", topic.definition));
        for (const std::string& message : topic.messages) {
            chunk += bag_record(bag_number("op", std::uint8_t{2}) + bag_number("conn", i) +
                                    bag_number("time", std::uint64_t{0}),
                                message);
        }
    }
    return "#ROSBAG V2.0\n" +
           bag_record(bag_number("op", std::uint8_t{3}) + bag_number("index_pos", std::uint64_t{0}),
                      std::string(32, ' ')) +
           bag_record(bag_number("op", std::uint8_t{5}) + bag_field("compression", compression) +
                          bag_number("size", static_cast<std::uint32_t>(chunk.size())),
                      pack(chunk));
}

inline constexpr std::string_view header_definition =
    "================================================================================\n"
    "MSG: std_msgs/Header\n# a comment\nuint32 seq\ntime stamp\nstring frame_id\n";
inline constexpr std::string_view laser_definition =
    "Header header\nfloat32 angle_min # rad\nfloat32 angle_max\nfloat32 angle_increment\n"
    "float32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\n"
    "float32[] ranges\nfloat32[] intensities\n";

/// A sensor_msgs/LaserScan of rays from -90 degrees on, 90 degrees apart.
inline std::string laser_message(double time, std::string_view frame,
                                 const std::vector<float>& ranges, float ray_time = 0.0F) {
    constexpr float quarter = 1.57079632679F;
    RosBytes message;
    message.add_header(time, frame);
    for (const float value : {-quarter, quarter, quarter, ray_time, 0.1F, 0.05F, 10.0F})
        message.add(value);
    message.add(static_cast<std::uint32_t>(ranges.size()));
    for (const float range : ranges)
        message.add(range);
    return message.add(std::uint32_t{0}).bytes();
}

inline BagTopic laser_topic(std::vector<std::string> messages) {
    return {"/scan", "sensor_msgs/LaserScan",
            std::string(laser_definition) + std::string(header_definition), std::move(messages)};
}

/// A pose of `child` in `parent`.
struct BagPose {
    double time;
    std::string parent;
    std::string child;
    std::vector<double> place_and_turn;  ///< x y z, then the quaternion x y z w
};

inline BagTopic tf_topic(const std::vector<BagPose>& poses) {
    BagTopic topic{
        "/tf",
        "tf2_msgs/TFMessage",
        "geometry_msgs/TransformStamped[] transforms\n"
        "===\nMSG: geometry_msgs/TransformStamped\nHeader header\nstring child_frame_id\n"
        "Transform transform\n"
        "===\nMSG: geometry_msgs/Transform\nVector3 translation\nQuaternion rotation\n"
        "===\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"
        "===\nMSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n" +
            std::string(header_definition),
        {}};
    for (const BagPose& pose : poses) {
        RosBytes message;
        message.add(std::uint32_t{1}).add_header(pose.time, pose.parent).add_text(pose.child);
        for (const double value : pose.place_and_turn)
            message.add(value);
        topic.messages.push_back(message.bytes());
    }
    return topic;
}

/// A sensor_msgs/PointCloud2 of 2 x `width` points (column, row, 0.5) with a ring number, whose
/// rows have 4 bytes of padding.
inline std::string cloud_message(std::uint32_t width) {
    RosBytes message;
    message.add_header(1.0, "map").add(std::uint32_t{2}).add(width).add(std::uint32_t{4});
    const char* const names[] = {"x", "y", "z", "ring"};
    for (std::uint32_t i = 0; i < 4; ++i) {
        message.add_text(names[i]).add(4 * i);
        message.add(static_cast<std::uint8_t>(i < 3 ? 7 : 4)).add(std::uint32_t{1});
    }
    message.add(std::uint8_t{0}).add(std::uint32_t{16}).add(16 * width + 4);
    message.add(2 * (16 * width + 4));
    for (std::uint32_t row = 0; row < 2; ++row) {
        for (std::uint32_t column = 0; column < width; ++column) {
            message.add(static_cast<float>(column)).add(static_cast<float>(row)).add(0.5F);
            message.add(static_cast<std::uint16_t>(row)).add(std::uint16_t{0});
        }
        message.add(std::uint32_t{0xFFFFFFFF});
    }
    return message.add(std::uint8_t{1}).bytes();
}

inline BagTopic cloud_topic(std::vector<std::string> messages) {
    return {"/points", "sensor_msgs/PointCloud2",
            "Header header\nuint32 height\nuint32 width\nPointField[] fields\nbool is_bigendian\n"
            "uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n" +
                std::string(header_definition) +
                "===\nMSG: sensor_msgs/PointField\nuint8 INT8 = 1\nuint8 FLOAT32=7\nstring name\n"
                "uint32 offset\nuint8 datatype\nuint32 count\n",
            std::move(messages)};
}

}  // namespace roomscribe::test
