// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "roomscribe/evaluation/prediction.hpp"
#include "roomscribe/evaluation/protocol.hpp"

namespace roomscribe::test {

/// Truth made of points that stand in the middle of voxels, so that IoUs are counts of points.
class BlockScene {
  public:
    GroundTruth truth;

    BlockScene() {
        truth.map_from_scan = {Transform::Identity()};
        truth.map.sections.push_back({"scan", 0, 0, std::nullopt});
    }

    /// Adds a component with instance number 10 + its index. Returns it.
    Component& add(const std::string& id, Label label, const std::string& parent = "") {
        Component component;
        component.id = id;
        component.label = label;
        component.parent = parent;
        component.instance = 10 + static_cast<std::int32_t>(truth.scene.components.size());
        component.visible = 1.0;
        component.confidence = 1.0;
        component.verdict = Verdict::accepted;
        truth.scene.components.push_back(component);
        return truth.scene.components.back();
    }

    /// Adds `count` points in a row of voxels of their own. Returns the number of the first one.
    std::size_t add_points(std::size_t count, Label label, std::int32_t instance,
                           LabelSet also_right = 0) {
        const std::size_t first = truth.labels.size();
        for (std::size_t i = 0; i < count; ++i) {
            const auto x =
                static_cast<float>((0.5 + static_cast<double>(i)) * protocol::voxel_size);
            truth.map.cloud.positions.emplace_back(x, row_, 0.02F);
            truth.labels.push_back(label);
            truth.instances.push_back(instance);
            truth.acceptable.push_back(static_cast<LabelSet>(label_bit(label) | also_right));
        }
        row_ += 1.0F;
        truth.map.sections[0].count = static_cast<std::uint32_t>(truth.labels.size());
        return first;
    }

    /// A component with points.
    std::size_t add_block(const std::string& id, Label label, std::size_t count,
                          const std::string& parent = "") {
        const std::int32_t instance = add(id, label, parent).instance;
        return add_points(count, label, instance);
    }

  private:
    float row_ = 0.02F;
};

/// Truth as a result.
inline Prediction prediction_of(const GroundTruth& truth) {
    Prediction prediction;
    prediction.scene = truth.scene;
    prediction.labels =
        PointLabels{truth.labels, truth.instances, std::vector<float>(truth.labels.size(), 1.0F)};
    for (const Transform& pose : truth.map_from_scan)
        prediction.map_from_scan.emplace_back(pose);
    return prediction;
}

/// Gives points another label and instance.
inline void relabel(Prediction& prediction, std::size_t first, std::size_t count, Label label,
                    std::int32_t instance) {
    for (std::size_t i = first; i < first + count; ++i) {
        prediction.labels->labels.at(i) = label;
        prediction.labels->instances.at(i) = instance;
    }
}

/// Corners of a rectangle that begins at `corner` and goes along x and z.
inline std::vector<Eigen::Vector3d> upright_rectangle(const Eigen::Vector3d& corner, double width,
                                                      double height) {
    const Eigen::Vector3d x(width, 0, 0);
    const Eigen::Vector3d z(0, 0, height);
    return {corner, corner + x, corner + x + z, corner + z};
}

}  // namespace roomscribe::test
