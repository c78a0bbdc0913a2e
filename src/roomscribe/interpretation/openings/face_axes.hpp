// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "roomscribe/interpretation/rooms/wall_faces.hpp"

namespace roomscribe {

/// Where a point lies by a wall's face.
struct FacePlace {
    float along = 0.0F;  ///< m along the face's `along`
    float above = 0.0F;  ///< m along its `up`
    float depth = 0.0F;  ///< m behind the face
};

/// The axes of a wall's face, for many points: in float, as millimetres matter and micrometres not.
class FaceAxes {
  public:
    explicit FaceAxes(const WallFace& face)
        : normal_(face.plane.normal.cast<float>()),
          offset_(static_cast<float>(face.plane.offset)),
          along_(face.along.cast<float>()),
          up_(face.up.cast<float>()) {}

    FacePlace place_of(const Eigen::Vector3f& point) const {
        return {along_.dot(point), up_.dot(point), offset_ - normal_.dot(point)};
    }

  private:
    Eigen::Vector3f normal_;
    float offset_;
    Eigen::Vector3f along_;
    Eigen::Vector3f up_;
};

}  // namespace roomscribe
