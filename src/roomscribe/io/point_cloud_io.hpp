// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "roomscribe/core/context.hpp"
#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/io/point_fields.hpp"
#include "roomscribe/model/scan.hpp"

namespace roomscribe {

// The format is told by the extension, in upper or lower case. What each one carries:
//
//           read                                 write                  besides the positions
//   .pcd    ascii, binary, binary_compressed     the same               all (1)
//   .ply    ascii, binary little/big endian      the same               all (2)
//   .3d     3DTK's UOS text                      the same               intensity (3)
//   .e57    all scans, every coding of numbers   one scan               all but sensor pose (4)
//   .las    1.0 to 1.4, point formats 0 to 10    1.4, formats 6 and 7   all (5)
//   .ptx    all scans of the file                no                     intensity, colours, grid
//   .xyz .txt .asc .csv .pts   guessed columns   all but .pts           all but grid, pose (6)
//   .npy    N x 3 to 6, guessed columns          no                     as text
//   .obj    vertices                             no                     colours
//   .tilt   planar scans with tilts (7)          no                     grid, sensor pose
//   .bag    ROS 1: PointCloud2, LaserScan (9)    no                     all (clouds); grid
//   .png    a depth image of 16 bits (8)         no                     grid, sensor pose
//   folder  with depth.txt (TUM RGB-D) or        no                     grid, pose
//           camera-intrinsics.txt (8),
//           or with scans.tilt (7)
//   .vtk    legacy points, ascii and binary      no                     nothing
//
// "All" are normals, colours, intensities, the scan grid, the sensor pose, and any other property
// as a channel under its own name and type. Conversions between PCD and PLY keep all of them.
// (1) VIEWPOINT is the sensor pose. "0 0 0 1 0 0 0" is what writers put there when they know
//     nothing, so it gives none; any other viewpoint does, at the origin too.
// (2) The sensor pose is PCL's `camera` element, in float32; the grid is `obj_info num_rows` and
//     `num_cols`. List properties and other elements (faces) are dropped. A channel of n values
//     per point is written as n properties name_0, name_1, ...; a 64-bit integer as double.
// (3) Centimetres, left-handed, y up in the file; see uos.hpp.
// (4) See e57.hpp.
// (5) No grid, no pose, and no points without coordinates; see las.hpp.
// (6) See text_points.hpp.
// (7) See tilted_scans.hpp.
// (8) See depth_images.hpp.
// (9) See rosbag.hpp.
//
// `x y z` may be of any type. `nx ny nz` or `normal_x normal_y normal_z` of a floating type are the
// normals; `red green blue` of uchar, or a packed 4-byte `rgb` or `rgba`, the colours (alpha is
// dropped); `intensity` or CloudCompare's `scalar_Intensity`, of any type, the intensity. What does
// not fit these is a channel; fields named "_" are padding.
//
// float32 positions keep their bits. Positions of a wider type that begin more than 1000 m from
// the origin lose a global shift, see PointCloud::global_shift; it is restored when writing, as
// float64. NaN and infinite points keep their place.

/// How the numbers stand in the file.
enum class Encoding {
    automatic,  ///< binary (little endian) where the format has it, else ascii
    ascii,
    binary,             ///< little endian
    binary_compressed,  ///< PCD: LZF
    binary_big_endian   ///< PLY
};

struct WriteOptions {
    Encoding encoding = Encoding::automatic;
};

/// What is in a file, for people.
struct FileSummary {
    std::string name;      ///< what the file calls the scan; mostly empty
    std::string format;    ///< "PCD", "PLY", "E57", "LAS", "PTX", "PTS", "text", "UOS", "VTK",
                           ///< "OBJ", "depth image", "tilted scans", "ROS bag"
    std::string encoding;  ///< as the format calls it: "binary_compressed"
    std::size_t num_points = 0;
    std::vector<Field> fields;  ///< of a point, in file order, those that are not read too
    std::optional<ScanGrid> grid;
    std::optional<Transform> sensor_pose;  ///< in the file's coordinates
    std::optional<Transform>
        map_from_scan;           ///< likewise, where the file says where the scan stands
    Eigen::AlignedBox3d bounds;  ///< of the finite points, in metres; empty if none is
    std::size_t num_non_finite = 0;
    std::vector<std::string> warnings;  ///< such as "the coordinates look like millimetres"
};

/// One scan of a file, and where it stands if the file says so.
struct StoredScan {
    Scan scan;
    /// The scan's frame -> the file's map, less map_shift.
    std::optional<Transform> map_from_scan;
    /// Far maps are kept small: the file's map coordinates = map_from_scan * positions + map_shift.
    /// The same for all scans of a file.
    Eigen::Vector3d map_shift = Eigen::Vector3d::Zero();
};

/// The file that names the scans of a folder that is read as scans; any other path as it is.
std::filesystem::path index_of_scans(const std::filesystem::path& path);

/// Whether files with this extension may say where their scans stand.
bool may_hold_poses(const std::filesystem::path& path);

/// Reads all scans of a file, at least one, in its order. Their names are the file's name without
/// folders; where there are several, with '#' and the scan's own name or, if it has none or others
/// have the same, its number, from 1. Throws as read_scan does.
std::vector<StoredScan> read_scans(const std::filesystem::path& path, const Context& context = {});

/// Reads a file as one scan: of several scans the file must say how they stand, and they are put
/// one after another into one map. Its name is the file's name without folders. Throws IoError if
/// the file cannot be read, is not what its extension says, is cut off or malformed, or has more
/// than 2^32 - 1 points. The memory taken never exceeds a small multiple of the file's real size (a
/// large one for binary_compressed, whose compression is at most 88-fold).
Scan read_scan(const std::filesystem::path& path, const Context& context = {});

/// Writes one cloud; the file appears whole or not at all (see AtomicFile). What the format cannot
/// carry is dropped. Throws InvalidArgument for an extension or encoding that cannot be written, an
/// array that is not as long as the positions, or a channel whose name is not a word; IoError if
/// the disk refuses.
void write_point_cloud(const std::filesystem::path& path, const PointCloud& cloud,
                       const WriteOptions& options = {}, const Context& context = {});

/// Reads the whole file and says what is in each of its scans. It keeps no points, so that the
/// memory does not grow with the file, but for binary_compressed PCD and planar scans. Throws as
/// read_scan does.
std::vector<FileSummary> summarize_file(const std::filesystem::path& path,
                                        const Context& context = {});

}  // namespace roomscribe
