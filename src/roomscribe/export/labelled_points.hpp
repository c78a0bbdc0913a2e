// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "roomscribe/export/building.hpp"
#include "roomscribe/geometry/point_cloud.hpp"

namespace roomscribe {

/// Id of the 40 classes of NYU depth v2 that ScanNet uses, by label and, for furniture, kind; 0 for
/// what has none. Source: Gupta et al. (CVPR 2013), scannetv2-labels.combined.tsv.
std::uint16_t nyu40_id(Label label, std::string_view kind);

/// The class of S3DIS (Armeni et al., CVPR 2016), of 13 with "clutter".
std::string_view s3dis_class(Label label, std::string_view kind);

/// The points of a map in the room frame, with what they are.
struct LabelledPoints {
    PointCloud cloud;
    std::vector<Label> labels;
    std::vector<std::int32_t> instances;  ///< Component::instance, -1 where none
};

/// Reads the channels `label` and `instance` of a map as labels.ply has it, drops points without
/// coordinates and all other channels, and moves the rest into the room frame. Points without
/// colour get that of their label. Throws InvalidArgument if the cloud has no such channels.
LabelledPoints labelled_points(PointCloud cloud, const Transform& room_from_map);

/// As ScanNet's *_labels.ply: colours, and the channels `label` (nyu40) and `instance` (from 1; 0
/// where none), both of 16 bits.
PointCloud scannet_cloud(LabelledPoints points, const Building& building);

/// One file of S3DIS and the points that go into it.
struct S3disFile {
    std::string path;  ///< "room-1/room-1.txt", "room-1/Annotations/chair_1.txt"
    std::vector<std::uint32_t> points;
};

/// A file per room, and per thing in it. A point is in the room of its thing, else in the one that
/// it lies in, else in "room_0".
std::vector<S3disFile> s3dis_files(const LabelledPoints& points, const Building& building);

/// Lines "x y z r g b".
std::string s3dis_text(const PointCloud& cloud, std::span<const std::uint32_t> points);

}  // namespace roomscribe
