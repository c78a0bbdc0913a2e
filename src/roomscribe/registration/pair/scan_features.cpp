// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/scan_features.hpp"

#include <algorithm>

#include "roomscribe/registration/features/fpfh_descriptor.hpp"
#include "roomscribe/registration/features/narf_descriptor.hpp"

namespace roomscribe {

NarfView find_narf_view(const Scan& scan, const NarfKeypointSettings& settings,
                        const Context& context) {
    NarfView view;
    view.image = make_range_image(scan, {.source = RangeImageSource::grid}, context);
    view.keypoints = detect_narf_keypoints(view.image, settings, context);
    return view;
}

DescribedPoints describe_by_fpfh(const SurfaceView& surface,
                                 std::span<const std::uint32_t> keypoints, double radius,
                                 const Context& context) {
    DescribedPoints described;
    for (const std::uint32_t keypoint : keypoints) {
        described.positions.push_back(surface.positions[keypoint]);
        described.normals.push_back(surface.normals[keypoint]);
    }
    described.descriptors = compute_fpfh(surface.positions, surface.normals, surface.tree,
                                         keypoints, {.radius = radius}, context);
    return described;
}

DescribedPoints describe_by_narf(const NarfView& view, const SurfaceView& surface,
                                 double support_size, const Context& context) {
    DescribedPoints described;
    if (surface.tree.size() == 0) return described;
    std::vector<std::uint32_t> pixels;
    for (const NarfKeypoint& keypoint : view.keypoints)
        pixels.push_back(keypoint.pixel);
    const NarfDescriptors narf =
        compute_narf(view.image, pixels, {.support_size = support_size}, context);
    for (const std::uint32_t keypoint : narf.keypoints) {
        const Eigen::Vector3f position = view.keypoints[keypoint].position;
        described.positions.push_back(position);
        described.normals.push_back(surface.normals[surface.tree.nearest(position).index]);
    }
    described.descriptors = narf.values;
    return described;
}

std::vector<std::uint32_t> nearest_points(const SurfaceView& surface,
                                          std::span<const NarfKeypoint> keypoints) {
    std::vector<std::uint32_t> points;
    if (surface.tree.size() == 0) return points;
    for (const NarfKeypoint& keypoint : keypoints)
        points.push_back(surface.tree.nearest(keypoint.position).index);
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    return points;
}

}  // namespace roomscribe
