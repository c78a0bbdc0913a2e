// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/io/file_contents.hpp"

namespace roomscribe {

/// A depth image: a PNG of one channel of 16 bits, a value a pixel of depth along the camera's
/// axis, 0 or 65535 where there is none. The camera's numbers stand beside it in
/// NAME.intrinsics.txt, intrinsics.txt or camera-intrinsics.txt: "fx fy cx cy" in pixels, and how
/// many steps make a metre (default 1000, as depth cameras write), or the camera's 3x3 matrix. The
/// frame is the camera's (x right, y down, z ahead); the cloud has the image's grid and its sensor
/// pose is the origin. Without the numbers it throws IoError.
FileContents read_depth_image(const std::filesystem::path& path, PointsAs as,
                              const Context& context);

/// A folder as the TUM RGB-D benchmark has them: depth.txt names the images, "time file" a line;
/// groundtruth.txt, if there is one, says where the camera was, "time x y z qx qy qz qw". An image
/// takes the pose nearest in time, at most 20 ms off, else none. intrinsics.txt as above, else the
/// benchmark's own default (525 525 319.5 239.5, 5000 steps a metre) with a warning. Of more than
/// 100 images 100 are taken, evenly, with a warning.
/// Source: Sturm et al., "A benchmark for the evaluation of RGB-D SLAM systems", IROS 2012.
std::vector<FileContents> read_tum_folder(const std::filesystem::path& folder, PointsAs as,
                                          const Context& context);

/// What the list of images in such a folder is called.
inline constexpr const char* tum_index = "depth.txt";

/// A folder as 7-Scenes, 3DMatch and what follows them have it: camera-intrinsics.txt with the
/// camera's matrix, and NAME.depth.png, in the order of their names, each with NAME.pose.txt (a 4x4
/// matrix, camera -> world) if its pose is known. The images may lie in folders inside it, as
/// sequences do. Of more than 100 images 100 are taken, evenly, with a warning. Without images it
/// throws IoError. Source: Shotton et al., "Scene coordinate regression forests for camera
/// relocalization in RGB-D images", CVPR 2013.
std::vector<FileContents> read_frames_folder(const std::filesystem::path& folder, PointsAs as,
                                             const Context& context);

/// What the camera's matrix in such a folder is called.
inline constexpr const char* frames_index = "camera-intrinsics.txt";

}  // namespace roomscribe
