// SPDX-License-Identifier: MIT
#include "roomscribe/pipeline/file_coordinates.hpp"

#include <utility>

namespace roomscribe {

Transform in_file_coordinates(const Transform& target_from_source,
                              const Eigen::Vector3d& target_shift,
                              const Eigen::Vector3d& source_shift) {
    return Eigen::Translation3d(target_shift) * target_from_source *
           Eigen::Translation3d(-source_shift);
}

Scene in_file_coordinates(Scene scene, const Eigen::Vector3d& shift) {
    return transformed_scene(std::move(scene), Transform(Eigen::Translation3d(shift)));
}

}  // namespace roomscribe
