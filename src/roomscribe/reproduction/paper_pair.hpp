// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/settings.hpp"
#include "roomscribe/geometry/search_tree.hpp"
#include "roomscribe/model/scan.hpp"
#include "roomscribe/registration/pair/scan_features.hpp"

namespace roomscribe {

struct PaperPairSettings {
    int num_points = 10'000;
    int num_keypoints = 100;

    void visit(SettingVisitor& visitor) {
        visitor(num_points, {.name = "num_points",
                             .unit = "",
                             .min = 100,
                             .max = 1e8,
                             .doc = "Scans are thinned to about so many points (the paper's "
                                    "\"around 10K\")."});
        visitor(num_keypoints, {.name = "num_keypoints",
                                .unit = "",
                                .min = 3,
                                .max = 1e6,
                                .doc = "NARF keypoints of a scan that are wanted (the paper's "
                                       "\"magnitude of 0.1 K\")."});
    }
};

/// A scan as the paper's experiments have it.
struct PaperScan {
    std::vector<Eigen::Vector3f> positions;  ///< thinned, finite
    std::vector<Eigen::Vector3f> normals;
    SearchTree tree;
    NarfView view;  ///< of all the scan's rays

    SurfaceView surface() const { return {positions, normals, tree}; }
};

/// Two scans and the sizes that they share, so that their descriptors can be compared.
struct PaperPair {
    PaperScan source;
    PaperScan target;
    double spacing = 0.0;       ///< m, of neighbouring points: the voxel of the thinning
    double support_size = 0.0;  ///< m, of NARF keypoints and descriptors

    double fpfh_radius() const { return 5.0 * spacing; }
    double inlier_distance() const { return 1.5 * spacing; }  ///< of sample-consensus rejection
};

/// Thins both scans by one voxel grid, estimates normals and looks for keypoints. Of support sizes
/// from 1 m down to 0.2 m the largest is taken that gives both scans the wanted number of
/// keypoints, else the one that gives most: "several values for this parameter were tested in order
/// to gain a sufficient number of keypoints" (section 3.3). The best are kept where there are more.
/// Throws InvalidArgument for a scan with fewer than 100 finite points.
PaperPair make_paper_pair(const Scan& source, const Scan& target,
                          const PaperPairSettings& settings = {}, const Context& context = {});

}  // namespace roomscribe
