// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/model/label.hpp"
#include "roomscribe/reproduction/simulated_pairs.hpp"

namespace roomscribe {

/// Per descriptor: NARF, then FPFH.
struct DescriptorFigures {
    std::array<double, 2> seconds{};  ///< T
    std::array<double, 2> fitness{};  ///< S, m2
};

/// Our half of a row of the paper's Table 1.
struct DescriptorComparison {
    /// T: mean over ten runs of the time for the descriptors of one scan at its keypoints, on one
    /// thread, with range image, normals and search tree at hand. S: mean squared distance of all
    /// points of the source scan to the nearest of the target scan after the initial alignment,
    /// median over ten seeds of the sample consensus; infinite if most give no alignment.
    DescriptorFigures ours;
    /// Of ten seeds, those whose initial alignment is within 0.3 m and 5 degrees of the truth.
    std::array<std::optional<int>, 2> num_aligned{};
    std::optional<double> true_fitness;  ///< m2, S of the true pose
    double num_points = 0.0;             ///< mean of the two scans
    double num_keypoints = 0.0;
};

/// What the paper's Table 1 says of its rows: indoor cluttered, indoor plane, outdoor.
inline constexpr std::array<std::string_view, 3> table_1_rows{"Id cluttered", "Id plane", "Od"};
inline constexpr std::array<DescriptorFigures, 3> table_1_of_paper{{
    {{0.19, 45.0}, {0.071, 0.032}},
    {{0.12, 12.0}, {0.094, 0.057}},
    {{0.11, 26.0}, {0.083, 0.044}},
}};

/// NARF and FPFH at the same NARF keypoints.
DescriptorComparison compare_descriptors(const ScanPair& scans, const Context& context = {});

/// Mean and standard deviation of the absolute error along the target scan's axes, m.
struct AxisErrors {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Vector3d deviation = Eigen::Vector3d::Zero();
};

/// A row of the paper's Table 2.
struct AlignmentComparison {
    std::size_t num_pairs = 0;
    std::size_t num_aligned = 0;  ///< within 0.3 m and 5 degrees: the errors are theirs
    AxisErrors errors;
    Eigen::Vector3d predicted = Eigen::Vector3d::Zero();  ///< m, mean sigma by equation (2)
};

inline constexpr std::array<std::string_view, 3> table_2_rows{"ICP NARF", "ICP FPFH",
                                                              "ICP combined"};
/// The paper's figures, m.
std::array<AxisErrors, 3> table_2_of_paper();

/// Table 2 on pairs whose true pose is known: Algorithm 1 with NARF, FPFH and both.
/// Precondition: every pair has its true pose.
std::array<AlignmentComparison, 3> compare_alignments(std::span<const ScanPair> pairs,
                                                      const Context& context = {});

/// A row of the paper's Table 4. Its accuracy is correct / ground_truth.
struct DetectionFigures {
    Label label = Label::unknown;
    int ground_truth = 0;
    int correct = 0;
    int scenes = 0;  ///< that the label is present in
};

inline constexpr std::array<DetectionFigures, 9> table_4_of_paper{{
    {Label::floor, 11, 11, 11},
    {Label::ceiling, 11, 11, 11},
    {Label::wall, 53, 50, 13},
    {Label::door, 10, 8, 6},
    {Label::door_frame, 10, 8, 6},
    {Label::window, 10, 8, 4},
    {Label::window_frame, 10, 4, 4},
    {Label::furniture, 35, 33, 8},
    {Label::handle, 27, 25, 2},
}};

}  // namespace roomscribe
