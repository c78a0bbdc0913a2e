// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace roomscribe {

/// One face of a wall as it stands in the plan.
struct FaceInPlan {
    std::size_t component = 0;  ///< into Scene::components
    /// m, its ends; the room that it faces lies to the left of the way from start to end.
    Eigen::Vector2d start = Eigen::Vector2d::Zero();
    Eigen::Vector2d end = Eigen::Vector2d::Zero();
    double bottom = 0.0;
    double top = 0.0;
};

enum class ThicknessSource : std::uint8_t {
    measured,  ///< between two faces, seen from both sides
    openings,  ///< one face is known: as deep as its doors and windows lie
    nominal,   ///< one face is known, and nothing of the other
};
std::string_view thickness_source_name(ThicknessSource source);

/// How the end of a wall, or its stretch, meets another.
struct WallJoin {
    std::size_t wall = 0;   ///< the other
    bool at_start = false;  ///< of this one; else at its end
    enum class Place : std::uint8_t { start, end, along } place = Place::along;  ///< on the other
};

/// A wall as builders know it, from its faces: one, or several that stand back to back.
struct Wall {
    std::string id;                 ///< of its longest face
    std::vector<FaceInPlan> faces;  ///< the longest first
    std::size_t storey = 0;
    /// m, the ends of its axis, which runs in its middle; the first face is to the left of it.
    Eigen::Vector2d start = Eigen::Vector2d::Zero();
    Eigen::Vector2d end = Eigen::Vector2d::Zero();
    double thickness = 0.0;
    ThicknessSource thickness_source = ThicknessSource::nominal;
    double bottom = 0.0;
    double top = 0.0;
    /// m along the axis: where its body begins and ends. Bodies of walls that meet do not overlap.
    double body_from = 0.0;
    double body_to = 0.0;
    std::vector<WallJoin> joins;

    double length() const { return (end - start).norm(); }
    Eigen::Vector2d along() const { return (end - start).normalized(); }
    Eigen::Vector2d left() const { return {-along().y(), along().x()}; }
};

/// Faces that stand back to back within 0.6 m become one wall; so do further faces in its two
/// planes. A lone face gets a nominal thickness behind it. Walls come in the order of their longest
/// faces, with `id` left empty, and without joins.
std::vector<Wall> pair_faces(const std::vector<FaceInPlan>& faces);

/// Makes the ends of walls of one storey that almost meet meet: their axes cross, and the body of
/// one ends where that of the other begins.
void join_walls(std::vector<Wall>& walls);

}  // namespace roomscribe
