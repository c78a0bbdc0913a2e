// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>

#include "roomscribe/core/context.hpp"
#include "roomscribe/io/file_contents.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "roomscribe/io/point_encoder.hpp"

namespace roomscribe {

/// Stanford polygon files: read_scan and write_point_cloud for one format. The points are the
/// element `vertex`, wherever it stands and whatever the order of its properties. The sensor pose
/// is the element `camera` of PCL (view_px ... z_axisz, the axes as the rows of the rotation),
/// unless that is the identity, which PCL writes when it knows nothing.
/// Source: G. Turk, "The PLY Polygon File Format" (1994); pcl::PLYReader / PLYWriter.
FileContents read_ply(const std::filesystem::path& path, PointsAs as, const Context& context);
void write_ply(const std::filesystem::path& path, const PointCloud& cloud, Encoding encoding,
               const Context& context);

/// The same with more properties, one value per point each, behind those of the cloud. A channel of
/// the cloud that has one of their names is renamed: "input_label".
void write_ply(const std::filesystem::path& path, const PointCloud& cloud,
               std::span<const ChannelView> more, Encoding encoding, const Context& context);

}  // namespace roomscribe
