// SPDX-License-Identifier: MIT
#include "roomscribe/io/rosbag.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/point_decoder.hpp"
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

double time_at(const RosMessage& message, const std::string& path) {
    const std::vector<double> stamp = message.numbers(path);
    return stamp.size() == 2 ? stamp[0] + 1e-9 * stamp[1] : 0.0;
}

/// Names of frames were once written with a slash.
std::string frame_at(const RosMessage& message, const std::string& path) {
    std::string frame = message.text(path).value_or("");
    if (frame.starts_with('/')) frame.erase(0, 1);
    return frame;
}

/// Where in its message a LaserScan is.
struct LaserPaths {
    std::string scan;   ///< prefix of its fields: "laserScan.", or nothing
    std::string angle;  ///< of the scanner; empty if the message does not say it
};

std::optional<LaserPaths> find_laser(const RosMessage& message) {
    LaserPaths paths;
    bool found = false;
    for (const RosField& field : message.fields()) {
        if (found || !field.path.ends_with("ranges") || field.type != ScalarType::float32) continue;
        const std::string prefix = field.path.substr(0, field.path.size() - 6);
        if (!prefix.empty() && prefix.back() != '.') continue;
        paths.scan = prefix;
        found = message.number(prefix + "angle_min") && message.number(prefix + "angle_increment");
    }
    if (!found) return std::nullopt;
    for (const RosField& field : message.fields()) {
        if (field.path.starts_with(paths.scan) || field.count != 1) continue;
        std::string name = field.path;
        for (char& c : name)
            c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        const auto has = [&name](const char* word) { return name.find(word) != std::string::npos; };
        if (has("angle") || has("tilt") || has("pitch")) {
            paths.angle = field.path;
            break;
        }
    }
    return paths;
}

/// A planar scan, as it was recorded.
struct LaserScan {
    double time = 0.0;
    std::string frame;
    double start = 0.0;
    double step = 0.0;
    double ray_time = 0.0;
    double min_range = 0.0;
    double max_range = 0.0;
    double angle = 0.0;  ///< of the scanner, in whatever unit
    std::vector<float> ranges;
    std::vector<float> intensities;
};

std::vector<float> floats(const RosMessage& message, const std::string& path) {
    const std::vector<double> numbers = message.numbers(path);
    return {numbers.begin(), numbers.end()};
}

LaserScan laser_scan(const RosMessage& message, const LaserPaths& paths) {
    const auto number = [&](const char* name) {
        return message.number(paths.scan + name).value_or(0.0);
    };
    LaserScan scan;
    scan.time = time_at(message, paths.scan + "header.stamp");
    scan.frame = frame_at(message, paths.scan + "header.frame_id");
    scan.start = number("angle_min");
    scan.step = number("angle_increment");
    scan.ray_time = number("time_increment");
    scan.min_range = number("range_min");
    scan.max_range = number("range_max");
    if (!paths.angle.empty()) scan.angle = message.number(paths.angle).value_or(0.0);
    scan.ranges = floats(message, paths.scan + "ranges");
    scan.intensities = floats(message, paths.scan + "intensities");
    return scan;
}

/// The planar scans of a topic.
struct LaserTopic {
    LaserPaths paths;
    std::vector<LaserScan> scans;
};

/// Where the scanner was at the first and at the last ray of a scan.
struct Sweep {
    Transform first;
    Transform last;
};

class BagReader {
  public:
    BagReader(const std::filesystem::path& path, const Context& context)
        : file_(path, rosbag_format), context_(context) {}

    std::vector<FileContents> read() {
        look_through();
        if (!num_clouds_.empty()) return read_clouds();
        transforms_.finish();
        std::vector<FileContents> contents;
        for (const auto& [topic, laser] : lasers_)
            contents.push_back(assemble(topic, laser));
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
                        keep_laser(connection.topic, message);
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
            transforms_.add(frame_at(message, prefix + "header.frame_id"),
                            frame_at(message, prefix + "child_frame_id"),
                            time_at(message, prefix + "header.stamp"), pose);
        }
    }

    void keep_laser(const std::string& topic, const RosMessage& message) {
        const std::optional<LaserPaths> paths = find_laser(message);
        if (!paths) return;
        LaserTopic& laser = lasers_[topic];
        laser.paths = *paths;
        laser.scans.push_back(laser_scan(message, *paths));
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
                    all.push_back(cloud_of(message));
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

    FileContents cloud_of(const RosMessage& message) const {
        const auto number = [&](const std::string& path) {
            return static_cast<std::size_t>(message.number(path).value_or(0.0));
        };
        std::vector<Field> fields;
        std::vector<std::size_t> offsets;
        const std::size_t step = number("point_step");
        constexpr std::array types{ScalarType::int8,    ScalarType::uint8,  ScalarType::int16,
                                   ScalarType::uint16,  ScalarType::int32,  ScalarType::uint32,
                                   ScalarType::float32, ScalarType::float64};
        for (std::size_t i = 0;; ++i) {
            const std::string prefix = fmt::format("fields[{}].", i);
            const std::optional<std::string> name = message.text(prefix + "name");
            if (!name) break;
            const std::size_t type = number(prefix + "datatype");
            // Some drivers leave the count out.
            const std::size_t count = std::max<std::size_t>(1, number(prefix + "count"));
            if (type < 1 || type > types.size()) fail("a PointCloud2 has a field of no type");
            const bool is_word = !name->empty() && std::all_of(name->begin(), name->end(),
                                                               [](char c) { return c > ' '; });
            fields.push_back({is_word ? *name : "_", types[type - 1], count});
            offsets.push_back(number(prefix + "offset"));
            if (count > step || offsets.back() + fields.back().bytes() > step) {
                fail("a PointCloud2 has a field beyond its points");
            }
        }
        if (!PointDecoder::has_positions(fields)) fail("a PointCloud2 has no fields x, y and z");
        const std::size_t width = number("width");
        const std::size_t height = number("height");
        const std::size_t row_step = number("row_step");
        const RosField* const data = message.find("data");
        const std::size_t size = data == nullptr ? 0 : data->bytes.size();
        if (height > 0 &&
            (width > row_step / std::max<std::size_t>(1, step) ||
             height > size / std::max<std::size_t>(1, row_step)) &&
            width > 0) {
            fail("a PointCloud2 has fewer bytes than its points take");
        }
        const std::size_t num_points = width * height;
        PointDecoder decoder(fields, num_points);
        const bool is_big = message.number("is_bigendian").value_or(0.0) != 0.0;
        for (std::size_t row = 0; row < height && width > 0; ++row) {
            std::vector<FieldSource> sources;
            for (const std::size_t offset : offsets)
                sources.push_back({data->bytes.data() + row * row_step + offset, step});
            decoder.decode(sources, row * width, width,
                           is_big ? std::endian::big : std::endian::little, context_);
        }
        std::optional<ScanGrid> grid;
        if (height > 1 && width > 1) grid = ScanGrid{height, width};
        FileContents contents;
        contents.cloud = decoder.finish(std::nullopt, grid);
        contents.format = rosbag_format;
        contents.encoding = "PointCloud2";
        contents.fields = std::move(fields);
        return contents;
    }

    FileContents assemble(const std::string& topic, const LaserTopic& laser) {
        FileContents contents;
        contents.name = name_of(topic);
        contents.format = rosbag_format;
        contents.encoding = "LaserScan";
        contents.fields = {{"range", ScalarType::float32, 1}};
        const std::vector<std::optional<Sweep>> sweeps =
            laser.paths.angle.empty() ? sweeps_by_transforms(topic, laser, contents)
                                      : sweeps_by_angle(laser, contents);
        PointCloud& cloud = contents.cloud;
        const std::size_t num_rays = laser.scans.front().ranges.size();
        bool is_grid = true;
        bool has_intensities = true;
        std::size_t num_used = 0;
        for (std::size_t i = 0; i < sweeps.size(); ++i) {
            if (!sweeps[i]) continue;
            const LaserScan& scan = laser.scans[i];
            add_points(scan, *sweeps[i], cloud);
            cloud.intensities.insert(cloud.intensities.end(), scan.intensities.begin(),
                                     scan.intensities.end());
            is_grid = is_grid && scan.ranges.size() == num_rays;
            has_intensities = has_intensities && scan.intensities.size() == scan.ranges.size();
            ++num_used;
        }
        if (num_used == 0) fail("no transform says how the scanner was turned: topic " + topic);
        if (num_used < sweeps.size()) {
            contents.warnings.push_back(fmt::format("{} of {} planar scans have no transform",
                                                    sweeps.size() - num_used, sweeps.size()));
        }
        if (is_grid && num_rays > 1 && num_used > 1) cloud.grid = ScanGrid{num_used, num_rays};
        if (has_intensities) {
            contents.fields.push_back({"intensity", ScalarType::float32, 1});
        } else {
            cloud.intensities.clear();
        }
        return contents;
    }

    std::vector<std::optional<Sweep>> sweeps_by_angle(const LaserTopic& laser,
                                                      FileContents& contents) const {
        double largest = 0.0;
        for (const LaserScan& scan : laser.scans)
            largest = std::max(largest, std::abs(scan.angle));
        const bool in_degrees = largest > 2.0 * std::numbers::pi;
        std::vector<std::optional<Sweep>> sweeps;
        for (const LaserScan& scan : laser.scans) {
            const double tilt = in_degrees ? radians(scan.angle) : scan.angle;
            Transform pose = Transform::Identity();
            if (std::isfinite(tilt))
                pose.linear() =
                    Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitY()).toRotationMatrix();
            sweeps.emplace_back(Sweep{pose, pose});
        }
        contents.warnings.push_back(
            fmt::format("{} planar scans are assembled by {}, taken for {} nose down",
                        laser.scans.size(), laser.paths.angle, in_degrees ? "degrees" : "radians"));
        contents.cloud.sensor_pose = Transform::Identity();
        return sweeps;
    }

    std::vector<std::optional<Sweep>> sweeps_by_transforms(const std::string& topic,
                                                           const LaserTopic& laser,
                                                           FileContents& contents) const {
        const std::string& frame = laser.scans.front().frame;
        if (!transforms_.has(frame)) {
            fail(fmt::format("topic {}: no transform of /tf says how frame '{}' was turned", topic,
                             frame));
        }
        std::vector<std::optional<Sweep>> sweeps;
        std::vector<Eigen::Vector3d> places;
        for (const LaserScan& scan : laser.scans) {
            const double duration = scan.ray_time * static_cast<double>(scan.ranges.size());
            const auto first = transforms_.root_from(scan.frame, scan.time);
            const auto last = transforms_.root_from(scan.frame, scan.time + duration);
            sweeps.emplace_back();
            if (!first || !last) continue;
            sweeps.back() = Sweep{*first, *last};
            places.push_back(first->translation());
        }
        const std::string root = transforms_.root_of(frame);
        contents.warnings.push_back(fmt::format("{} planar scans are assembled by /tf in frame {}",
                                                laser.scans.size(), root));
        if (!places.empty()) {
            Eigen::Vector3d sum = Eigen::Vector3d::Zero();
            for (const Eigen::Vector3d& place : places)
                sum += place;
            contents.cloud.sensor_pose =
                Transform(Eigen::Translation3d(sum / static_cast<double>(places.size())));
        }
        return sweeps;
    }

    static void add_points(const LaserScan& scan, const Sweep& sweep, PointCloud& cloud) {
        const bool is_still = sweep.first.isApprox(sweep.last, 0.0);
        const auto num_rays = static_cast<double>(scan.ranges.size());
        for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
            const double range = static_cast<double>(scan.ranges[i]);
            const bool returned =
                std::isfinite(range) && range >= scan.min_range && range <= scan.max_range;
            if (!returned) {
                cloud.positions.push_back(Eigen::Vector3f::Constant(std::nanf("")));
                continue;
            }
            const double bearing = scan.start + static_cast<double>(i) * scan.step;
            const Eigen::Vector3d point =
                range * Eigen::Vector3d(std::cos(bearing), std::sin(bearing), 0.0);
            const Transform pose =
                is_still ? sweep.first
                         : between(sweep.first, sweep.last, static_cast<double>(i) / num_rays);
            cloud.positions.emplace_back((pose * point).cast<float>());
        }
    }

    MappedFile file_;
    const Context& context_;
    std::map<std::string, RosDefinition> definitions_;  ///< by their text
    std::map<std::string, std::size_t> num_clouds_;     ///< by topic
    std::map<std::string, LaserTopic> lasers_;          ///< by topic
    TfTree transforms_;
};

}  // namespace

std::vector<FileContents> read_rosbag(const std::filesystem::path& path, const Context& context) {
    return BagReader(path, context).read();
}

}  // namespace roomscribe
