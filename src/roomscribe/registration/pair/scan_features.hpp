// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/geometry/search_tree.hpp"
#include "roomscribe/model/scan.hpp"
#include "roomscribe/registration/features/described_points.hpp"
#include "roomscribe/registration/features/narf_keypoints.hpp"
#include "roomscribe/registration/range_image/range_image.hpp"

namespace roomscribe {

/// What the points of two scans are matched by (paper, section 3.3).
enum class PairFeatures : std::uint8_t {
    fpfh,          ///< FPFH at the scan's most distinctive points
    fpfh_at_narf,  ///< FPFH at NARF keypoints, as the paper's maps were registered
    narf,          ///< NARF at NARF keypoints, by the Manhattan metric
    combined,      ///< the matches of `fpfh` and those of `narf`
};

inline std::span<const std::string_view> enumerator_names(PairFeatures) {
    static constexpr std::array<std::string_view, 4> names{"fpfh", "fpfh_at_narf", "narf",
                                                           "combined"};
    return names;
}

constexpr bool uses_fpfh(PairFeatures features) {
    return features != PairFeatures::narf;
}
constexpr bool uses_narf(PairFeatures features) {
    return features == PairFeatures::narf || features == PairFeatures::combined;
}
constexpr bool uses_narf_keypoints(PairFeatures features) {
    return features != PairFeatures::fpfh;
}

/// Points of a surface with their unit normals (NaN where unknown) and a tree over them.
struct SurfaceView {
    std::span<const Eigen::Vector3f> positions;
    std::span<const Eigen::Vector3f> normals;
    const SearchTree& tree;
};

/// A scan as its scanner saw it, and what is of interest there.
struct NarfView {
    RangeImage image;  ///< from the scanner's grid, where there is one
    std::vector<NarfKeypoint> keypoints;
};
NarfView find_narf_view(const Scan& scan, const NarfKeypointSettings& settings = {},
                        const Context& context = {});

/// FPFH at points of the surface, by their numbers.
DescribedPoints describe_by_fpfh(const SurfaceView& surface,
                                 std::span<const std::uint32_t> keypoints, double radius,
                                 const Context& context = {});

/// NARF at the keypoints of a view. The normals are those of the surface's nearest points, as the
/// positions are not: a keypoint with several dominant orientations has several descriptors.
DescribedPoints describe_by_narf(const NarfView& view, const SurfaceView& surface,
                                 double support_size, const Context& context = {});

/// The points of the surface that are nearest to the keypoints, ascending, none twice.
std::vector<std::uint32_t> nearest_points(const SurfaceView& surface,
                                          std::span<const NarfKeypoint> keypoints);

}  // namespace roomscribe
