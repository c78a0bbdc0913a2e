// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "roomscribe/core/random.hpp"
#include "roomscribe/simulation/scenario.hpp"
#include "roomscribe/simulation/simulated_world.hpp"

namespace roomscribe {

/// A rectangular face of an item in the item's frame: it looks along x at `x`, from `low` to `high`
/// in y and z.
struct FaceArea {
    double x = 0.0;
    Eigen::Vector2d low = Eigen::Vector2d::Zero();
    Eigen::Vector2d high = Eigen::Vector2d::Zero();

    double width() const { return high.x() - low.x(); }
    double height() const { return high.y() - low.y(); }
};

/// Builds one item in its own frame: x to where its front looks, y to its left, z up, the origin
/// in the middle of its footprint at its underside. Shapes go to a part; parts belong to the
/// component begun last, or to nothing (clutter) before the first.
class ItemBuilder {
  public:
    /// The sizes of the item must be set.
    ItemBuilder(SimulatedWorld& world, const ItemPlan& item);

    const ItemPlan& item() const { return item_; }
    double depth() const { return item_.size.x(); }
    double width() const { return item_.size.y(); }
    double height() const { return item_.size.z(); }
    const Transform& world_from_item() const { return world_from_item_; }
    SimulatedWorld& world() { return world_; }

    Random& random() { return random_; }
    bool chance(double share) { return random_.uniform() < share; }
    double pick(double low, double high) { return random_.uniform(low, high); }
    /// One of 0 ... count - 1.
    int choose(int count) {
        return static_cast<int>(random_.below(static_cast<std::uint32_t>(count)));
    }

    /// Starts a component. Its box is that of its shapes, along the item's axes.
    void begin(Label label, std::string_view kind, LabelSet also_right = 0);
    /// A furniture component (door, drawer, top) of the component begun last. A face that stands
    /// open does not widen the piece's box.
    std::int32_t add_face(std::string_view kind, const std::vector<Eigen::Vector3d>& polygon,
                          bool is_open = false);
    const std::string& id_of(std::int32_t component) const;

    /// Of the component begun last, or clutter before the first.
    std::uint32_t part(Material material) { return part_of(current_, material); }
    std::uint32_t part_of(std::int32_t component, Material material);
    std::uint32_t clutter(Material material) { return part_of(-1, material); }

    void box(std::uint32_t part, const Eigen::Vector3d& low, const Eigen::Vector3d& high);
    /// The box in a frame of its own, `pose` being item from that frame.
    void box(std::uint32_t part, const Transform& pose, const Eigen::Vector3d& low,
             const Eigen::Vector3d& high);
    void cylinder(std::uint32_t part, const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                  double radius, int sides = 12);
    void ellipsoid(std::uint32_t part, const Eigen::Vector3d& center, const Eigen::Vector3d& radii,
                   int sides = 12);
    void ellipsoid(std::uint32_t part, const Transform& pose, const Eigen::Vector3d& radii,
                   int sides = 12);
    /// Four corners in order, seen from both sides.
    void quad(std::uint32_t part, const std::array<Eigen::Vector3d, 4>& corners);

    /// A plate that is a face of kind "top".
    void top(Material material, const Eigen::Vector3d& low, const Eigen::Vector3d& high);

    /// Sets the boxes of the components begun. Call once, at the end.
    void finish();

    /// A box around each shape, in the item's frame.
    const std::vector<Eigen::AlignedBox3d>& shapes() const { return shapes_; }

  private:
    /// Notes the extent of the vertices since the last call, handles' too, which others add.
    void note_shape();

    SimulatedWorld& world_;
    ItemPlan item_;
    Transform world_from_item_;
    Random random_;
    std::size_t first_triangle_;
    std::size_t noted_vertices_;
    std::vector<Eigen::AlignedBox3d> shapes_;
    std::int32_t current_ = -1;
    LabelSet also_right_ = 0;
    std::map<std::pair<std::int32_t, Material>, std::uint32_t> parts_;
    std::map<std::int32_t, std::int32_t> widened_;  ///< closed face -> the piece that it is part of
    std::vector<std::int32_t> begun_;
};

/// A shift.
Transform moved(const Eigen::Vector3d& shift);
/// A shift after a turn about an axis by an angle in radians.
Transform moved_and_turned(const Eigen::Vector3d& shift, const Eigen::Vector3d& axis, double angle);

}  // namespace roomscribe
