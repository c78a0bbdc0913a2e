// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "roomscribe/io/point_cloud_io.hpp"
#include "roomscribe/model/label.hpp"
#include "support/simulated_rooms.hpp"
#include "system/program.hpp"

namespace roomscribe::test {
namespace {

template <typename Value>
std::vector<Value> values_of(const PointCloud& cloud, const std::string& name, ScalarType type) {
    const auto channel = std::find_if(cloud.channels.begin(), cloud.channels.end(),
                                      [&](const Channel& c) { return c.name == name; });
    EXPECT_NE(channel, cloud.channels.end()) << name;
    if (channel == cloud.channels.end()) return {};
    EXPECT_EQ(channel->type, type) << name;
    std::vector<Value> values(cloud.size());
    EXPECT_EQ(channel->values.size(), values.size() * sizeof(Value)) << name;
    if (channel->values.size() == values.size() * sizeof(Value))
        std::memcpy(values.data(), channel->values.data(), channel->values.size());
    return values;
}

/// labels.ply and scene.json of an interpreted room.
struct Interpretation {
    PointCloud points;
    std::vector<std::uint8_t> labels;
    std::vector<std::int32_t> instances;
    std::vector<float> confidences;
    nlohmann::json scene;

    explicit Interpretation(const std::filesystem::path& folder)
        : points(read_scan(folder / "labels.ply").cloud),
          labels(values_of<std::uint8_t>(points, "label", ScalarType::uint8)),
          instances(values_of<std::int32_t>(points, "instance", ScalarType::int32)),
          confidences(values_of<float>(points, "confidence", ScalarType::float32)),
          scene(read_json(folder / "scene.json")) {}
};

/// The furnished room as three whole scans: every ray, also those without return, of which a few
/// more are lost in different ways.
class InterpretWholeScans : public testing::Test {
  protected:
    InterpretWholeScans() {
        const float nan = std::numeric_limits<float>::quiet_NaN();
        const float infinity = std::numeric_limits<float>::infinity();
        scans_ = scan_furnished_room(1);
        std::vector<std::string> arguments{"interpret"};
        for (Scan& scan : scans_) {
            auto& positions = scan.cloud.positions;
            for (std::size_t i = 0; i < positions.size(); i += 101)
                positions[i] = {nan, nan, nan};
            positions[1] = {nan, 0.0F, 1.0F};
            positions[2] = {1.0F, infinity, 0.0F};
            arguments.push_back((folder_ / scan.name).string());
            write_point_cloud(arguments.back(), scan.cloud);
        }
        // The others have no place, so that all of their points are without coordinates.
        std::ofstream poses(folder_ / "poses.txt");
        for (std::size_t i = 0; i < scans_.size(); ++i)
            poses << (i == 0 ? "1 0 0 0 0 1 0 0 0 0 1 0\n"
                             : "nan nan nan nan nan nan nan nan nan nan nan nan\n");
        poses.close();
        arguments.insert(arguments.end(), {"--poses", (folder_ / "poses.txt").string(), "-o",
                                           (folder_ / "out").string()});
        const ProgramResult result = roomscribe(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
    }

    std::size_t num_points() const {
        std::size_t count = 0;
        for (const Scan& scan : scans_)
            count += scan.cloud.size();
        return count;
    }

    TemporaryFolder folder_;
    std::vector<Scan> scans_;
};

TEST_F(InterpretWholeScans, LabelEveryRayAndNothingThatDidNotReturn) {
    const Interpretation found(folder_ / "out");
    ASSERT_EQ(found.points.size(), num_points());
    std::size_t num_lost = 0;
    std::size_t num_labelled = 0;
    for (std::size_t i = 0; i < found.points.size(); ++i) {
        // Scans after the first have no place.
        const bool is_lost =
            i >= scans_[0].cloud.size() || !is_finite(scans_[0].cloud.positions[i]);
        num_lost += is_lost ? 1U : 0U;
        num_labelled += found.labels[i] != 0 ? 1U : 0U;
        ASSERT_LT(found.labels[i], num_labels);
        if (is_lost) {
            ASSERT_EQ(found.labels[i], 0U) << i;
            ASSERT_EQ(found.instances[i], -1) << i;
            ASSERT_EQ(found.confidences[i], 0.0F) << i;
        } else {
            ASSERT_TRUE(is_finite(found.points.positions[i])) << i;
        }
        ASSERT_GE(found.confidences[i], 0.0F);
        ASSERT_LE(found.confidences[i], 1.0F);
        if (found.labels[i] == 0) {
            ASSERT_EQ(found.instances[i], -1) << i;
            ASSERT_EQ(found.confidences[i], 0.0F) << i;
        }
    }
    EXPECT_GT(num_lost, scans_[0].cloud.size() / 101);
    EXPECT_GT(num_labelled, scans_[0].cloud.size() / 2);
}

TEST_F(InterpretWholeScans, TellTheSameInPointsAndInTheScene) {
    const Interpretation found(folder_ / "out");
    std::map<std::int32_t, std::map<std::string, std::size_t>> labels_of_instance;
    for (std::size_t i = 0; i < found.points.size(); ++i) {
        if (found.instances[i] < 0) continue;
        ++labels_of_instance[found.instances[i]]
                            [std::string(label_name(static_cast<Label>(found.labels[i])))];
    }
    std::size_t num_with_points = 0;
    for (const auto& component : found.scene.at("components")) {
        const std::string label = component.at("label");
        const auto& evidence = component.at("evidence");
        const auto points = labels_of_instance.extract(component.at("instance"));
        const std::size_t own = points.empty() ? 0 : points.mapped()[label];
        if (!points.empty()) {
            EXPECT_EQ(points.mapped().size(), 1U) << component;
        }
        // A piece of furniture has the points of its faces too.
        if (label == "furniture") {
            EXPECT_GE(evidence.at("points"), own) << component;
        } else {
            EXPECT_EQ(evidence.at("points"), own) << component;
        }
        if (own == 0) continue;
        ++num_with_points;
        EXPECT_EQ(evidence.at("scans"), 1) << component;
        EXPECT_NE(evidence.at("rule"), "") << component;
        const bool is_surface = label == "floor" || label == "ceiling" || label == "wall";
        if (is_surface || label == "door") {
            EXPECT_TRUE(evidence.contains("rms")) << component;
        }
        if (is_surface || label == "door" || label == "window") {
            EXPECT_TRUE(evidence.contains("coverage")) << component;
        }
    }
    EXPECT_GT(num_with_points, 5U);
    // No point belongs to what is not listed.
    EXPECT_TRUE(labels_of_instance.empty());
}

}  // namespace
}  // namespace roomscribe::test
