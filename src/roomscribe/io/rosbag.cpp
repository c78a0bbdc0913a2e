// SPDX-License-Identifier: MIT
#include "roomscribe/io/rosbag.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/laser_topic.hpp"
#include "roomscribe/io/point_cloud2.hpp"
#include "roomscribe/io/ros_message.hpp"
#include "roomscribe/io/rosbag_records.hpp"
#include "roomscribe/io/tf_tree.hpp"

namespace roomscribe {
namespace {

constexpr std::string_view cloud_type = "sensor_msgs/PointCloud2";
constexpr std::size_t max_clouds = 100;
constexpr std::string_view cure =
    "record PointCloud2, or LaserScan with /tf or with the angle of the scanner in the message";

bool is_transforms(const BagConnection& connection) {
    return connection.type == "tf2_msgs/TFMessage" || connection.type == "tf/tfMessage";
}

class BagReader {
  public:
    BagReader(const std::filesystem::path& path, PointsAs as, const Context& context)
        : file_(path, rosbag_format), as_(as), context_(context) {}

    std::vector<FileContents> read() {
        look_through();
        if (!num_clouds_.empty()) return read_clouds();
        transforms_.finish();
        std::vector<FileContents> contents;
        for (auto& [topic, laser] : lasers_) {
            if (laser.scans.empty()) continue;
            laser.topic = name_of(topic);
            try {
                contents.push_back(assemble_laser_scans(laser, transforms_));
                keep_points(as_, contents.back());
            } catch (const Error& error) {
                fail(fmt::format("topic {}: {}", topic, error.what()));
            }
        }
        if (contents.empty()) fail("there is no PointCloud2 and no LaserScan with ranges in it");
        return contents;
    }

  private:
    [[noreturn]] void fail(std::string_view reason) const {
        throw IoError(file_.path(), rosbag_format, {}, reason, cure);
    }

    /// Calls `use` with a message; what does not agree with its definition is the file's fault.
    template <typename Use>
    void with_message(const BagConnection& connection, std::span<const std::byte> bytes,
                      const Use& use) {
        try {
            const auto known = definitions_.find(connection.definition);
            const RosDefinition& definition =
                known != definitions_.end()
                    ? known->second
                    : definitions_
                          .emplace(connection.definition,
                                   parse_ros_definition(connection.definition))
                          .first->second;
            use(RosMessage(definition, bytes));
        } catch (const IoError&) {
            throw;
        } catch (const Error& error) {
            fail(fmt::format("topic {}: {}", connection.topic, error.what()));
        }
    }

    /// Counts clouds, and keeps transforms and planar scans.
    void look_through() {
        for_each_bag_message(
            file_, context_,
            [this](const BagConnection& connection, std::span<const std::byte> bytes) {
                if (connection.type == cloud_type) {
                    ++num_clouds_[connection.topic];
                } else if (is_transforms(connection)) {
                    with_message(connection, bytes,
                                 [this](const RosMessage& message) { keep_transforms(message); });
                } else if (num_clouds_.empty() && may_be_laser(connection)) {
                    with_message(connection, bytes, [&](const RosMessage& message) {
                        add_laser_scan(message, lasers_[connection.topic]);
                    });
                }
            });
    }

    static bool may_be_laser(const BagConnection& connection) {
        return connection.definition.find("float32[] ranges") != std::string::npos;
    }

    void keep_transforms(const RosMessage& message) {
        for (std::size_t i = 0;; ++i) {
            const std::string prefix = fmt::format("transforms[{}].", i);
            const auto child = message.find(prefix + "child_frame_id");
            if (child == nullptr) return;
            const auto number = [&](const char* name) {
                return message.number(prefix + "transform." + name)
                    .value_or(std::numeric_limits<double>::quiet_NaN());
            };
            const Eigen::Quaterniond turn(number("rotation.w"), number("rotation.x"),
                                          number("rotation.y"), number("rotation.z"));
            const Eigen::Vector3d place(number("translation.x"), number("translation.y"),
                                        number("translation.z"));
            if (!place.allFinite() || !(std::abs(turn.norm() - 1.0) < 0.1)) continue;
            Transform pose = Transform::Identity();
            pose.linear() = turn.normalized().toRotationMatrix();
            pose.translation() = place;
            transforms_.add(message.frame(prefix + "header.frame_id"),
                            message.frame(prefix + "child_frame_id"),
                            message.time(prefix + "header.stamp"), pose);
        }
    }

    std::vector<FileContents> read_clouds() {
        std::map<std::string, std::size_t> num_seen;
        std::vector<FileContents> all;
        for_each_bag_message(
            file_, context_,
            [&](const BagConnection& connection, std::span<const std::byte> bytes) {
                if (connection.type != cloud_type) return;
                const std::size_t count = num_clouds_.at(connection.topic);
                const std::size_t wanted = std::min(count, max_clouds);
                const std::size_t i = num_seen[connection.topic]++;
                // Of many clouds the first of each of `wanted` equal parts.
                if (i > 0 && i * wanted / count == (i - 1) * wanted / count) return;
                with_message(connection, bytes, [&](const RosMessage& message) {
                    all.push_back(read_point_cloud2(message, as_, context_));
                    all.back().name = count == 1
                                          ? name_of(connection.topic)
                                          : fmt::format("{}-{}", name_of(connection.topic), i + 1);
                    if (count > wanted) {
                        all.back().warnings.push_back(fmt::format(
                            "{} of the {} clouds of {} are read", wanted, count, connection.topic));
                    }
                });
            });
        return all;
    }

    static std::string name_of(const std::string& topic) {
        return topic.starts_with('/') ? topic.substr(1) : topic;
    }

    MappedFile file_;
    PointsAs as_;
    const Context& context_;
    std::map<std::string, RosDefinition> definitions_;  ///< by their text
    std::map<std::string, std::size_t> num_clouds_;     ///< by topic
    std::map<std::string, LaserTopic> lasers_;          ///< by topic
    TfTree transforms_;
};

}  // namespace

std::vector<FileContents> read_rosbag(const std::filesystem::path& path, PointsAs as,
                                      const Context& context) {
    return BagReader(path, as, context).read();
}

}  // namespace roomscribe
