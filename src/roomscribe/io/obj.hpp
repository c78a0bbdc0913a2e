// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "roomscribe/core/context.hpp"
#include "roomscribe/io/file_contents.hpp"

namespace roomscribe {

/// The vertices of a Wavefront OBJ file: lines "v x y z", "v x y z w" (w is dropped), or
/// "v x y z r g b" with colours from 0 to 1, which become 0 to 255 if every vertex has them. Faces,
/// normals and textures are not read: surfaces are what roomscribe finds. Throws IoError for a
/// vertex of another count of numbers, or none.
FileContents read_obj(const std::filesystem::path& path, PointsAs as, const Context& context);

}  // namespace roomscribe
