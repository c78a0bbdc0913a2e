// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/rooms/wall_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include <Eigen/Geometry>

#include "roomscribe/core/quantile.hpp"
#include "roomscribe/core/units.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Share of a face's voxels that its extent leaves out at either end: strays.
constexpr double stray_share = 0.005;
/// m2. Less of a wall is not worth a name: the strip beside a door is 10 cm wide.
constexpr double min_face_area = 0.2;
/// m2. A door leaf has 1.6 m2, the front of a desk less than 1.
constexpr double min_closing_area = 1.0;
/// m. Skirtings, cables and boxes hide a wall's foot.
constexpr double foot_reach = 0.3;
/// m. Narrower faces are reveals and the sides of posts.
constexpr double min_face_width = 0.35;
/// m. Wardrobes, shafts and columns are no deeper: what is narrower is more likely a side of these
/// than a wall, unless it was seen up to the ceiling or is a piece of a longer wall.
constexpr double min_wall_width = 0.7;
/// m. Leaves and panes lie no deeper in their wall.
constexpr double max_inset = 0.3;
/// m. Cupboards are 0.2 to 0.9 m deep, and leave this much of the wall behind them to see.
constexpr double max_furniture_depth = 1.0;
constexpr double min_clearance = 0.15;

/// m. What stands between two rooms and is so high is no furniture.
constexpr double min_parting_height = 2.0;

/// m, in which it is told where along a wall something was seen.
constexpr double column_width = 0.1;

/// m. Leaves of doors: 0.56 to 1.11 wide and 1.98 to 2.24 high (DIN 18101), and the noise at their
/// edges; their hinges lie in the wall's plane or a wall's depth behind it.
constexpr double min_leaf_width = 0.5;
constexpr double max_leaf_width = 1.25;
constexpr double max_leaf_height = 2.35;
constexpr double max_hinge_depth = 0.3;
/// At the height of people, above the floor.
constexpr double body_bottom = 0.5;
constexpr double body_top = 1.8;

enum class AboveFace : std::uint8_t { surface, free, unseen };

class FaceFinder {
  public:
    FaceFinder(std::span<const Ray> rays, const SurfaceSample& sample,
               std::span<const PlanarPatch> patches, const FloorPlan& plan,
               const Eigen::Matrix3d& room_from_map, const RoomSurfacesSettings& settings)
        : rays_(rays),
          sample_(sample),
          patches_(patches),
          plan_(plan),
          room_from_map_(room_from_map),
          up_(room_from_map.row(2).transpose()),
          settings_(settings) {}

    void add(const UprightSurface& surface) {
        add_side(surface, surface.plane);
        if (may_face_both_ways(surface)) add_side(surface, surface.plane.flipped());
    }
    std::vector<WallFace> take();

  private:
    bool may_face_both_ways(const UprightSurface& surface) const;
    std::int32_t room_before(const Vector3d& point, const Vector3d& normal) const;
    bool is_closed_behind(const Vector3d& point, const Vector3d& normal, std::int32_t room) const;
    void add_side(const UprightSurface& surface, const Plane& plane);
    void split(std::int32_t room, const Plane& plane, double rms,
               std::vector<std::pair<double, std::uint32_t>> voxels);
    template <typename Test>
    double share_behind(const WallFace& face, double nearest, double farthest, Test&& test) const;
    bool is_last(const WallFace& face) const;
    bool has_level_behind(const WallFace& face) const;
    bool parts_rooms(const WallFace& face) const;
    std::optional<double> ceiling_over(const WallFace& face) const;
    AboveFace look_above(const WallFace& face, std::optional<double> ceiling) const;
    bool is_knee_wall(const WallFace& face, std::optional<double> ceiling) const;
    bool is_wall(const WallFace& face, std::optional<double> ceiling) const;
    bool is_closed_between(const WallFace& wall, double from, double to) const;
    std::set<int> columns_of(const WallFace& face, const Vector3d& along, double from,
                             double to) const;
    double shared_columns(const WallFace& wall, const WallFace& face) const;
    bool continues(const WallFace& wall, const WallFace& face) const;
    void absorb(WallFace& wall, const WallFace& face) const;
    bool belongs_to(const WallFace& face, const WallFace& wall) const;
    bool is_leaf_of(const WallFace& face, const WallFace& wall) const;

    std::span<const Ray> rays_;
    const SurfaceSample& sample_;
    std::span<const PlanarPatch> patches_;
    const FloorPlan& plan_;
    Eigen::Matrix3d room_from_map_;
    Vector3d up_;
    const RoomSurfacesSettings& settings_;
    std::vector<WallFace> faces_;
};

bool FaceFinder::may_face_both_ways(const UprightSurface& surface) const {
    if (!sample_.normals_face_scanner) return true;
    double area = 0.0;
    for (const std::uint32_t patch : surface.patches)
        area += patches_[patch].may_face_both_ways ? patches_[patch].area : 0.0;
    return area > 0.5 * surface.area;
}

std::int32_t FaceFinder::room_before(const Vector3d& point, const Vector3d& normal) const {
    // What stands before the wall may hide floor and ceiling to its depth.
    for (double depth = 1.5 * plan_.cell_size(); depth <= max_furniture_depth;
         depth += plan_.cell_size()) {
        const Vector3d place = room_from_map_ * (point + depth * normal);
        const std::int32_t room = plan_.room_at(place.head<2>());
        if (room != no_room) return room;
        if (plan_.is_barrier_at(place.head<2>())) return no_room;
    }
    return no_room;
}

bool FaceFinder::is_closed_behind(const Vector3d& point, const Vector3d& normal,
                                  std::int32_t room) const {
    int same = 0;
    for (const double cells : {2.0, 3.0}) {
        const Vector3d place = room_from_map_ * (point - cells * plan_.cell_size() * normal);
        same += plan_.room_at(place.head<2>()) == room ? 1 : 0;
    }
    return same < 2;
}

void FaceFinder::add_side(const UprightSurface& surface, const Plane& plane) {
    const Vector3d along = up_.cross(plane.normal);
    std::map<std::int32_t, std::vector<std::pair<double, std::uint32_t>>> by_room;
    for (const std::uint32_t patch : surface.patches) {
        for (const std::uint32_t voxel : patches_[patch].points) {
            const Vector3d point = sample_.cloud.positions[voxel].cast<double>();
            const std::int32_t room = room_before(point, plane.normal);
            if (room == no_room || !is_closed_behind(point, plane.normal, room)) continue;
            by_room[room].emplace_back(point.dot(along), voxel);
        }
    }
    for (auto& [room, voxels] : by_room)
        split(room, plane, surface.rms, std::move(voxels));
}

/// A face for each run without a gap wider than an opening.
void FaceFinder::split(std::int32_t room, const Plane& plane, double rms,
                       std::vector<std::pair<double, std::uint32_t>> voxels) {
    std::sort(voxels.begin(), voxels.end());
    const double voxel_area = sample_.spacing * sample_.spacing;
    for (std::size_t begin = 0; begin < voxels.size();) {
        std::size_t end = begin + 1;
        while (end < voxels.size() &&
               voxels[end].first - voxels[end - 1].first <= settings_.max_gap) {
            ++end;
        }
        WallFace face;
        face.room = room;
        face.plane = plane;
        face.along = up_.cross(plane.normal);
        face.up = up_;
        face.rms = rms;
        std::vector<double> heights;
        std::vector<double> places;
        std::vector<float> noises;
        for (std::size_t i = begin; i < end; ++i) {
            face.voxels.push_back(voxels[i].second);
            places.push_back(voxels[i].first);
            heights.push_back(sample_.cloud.positions[voxels[i].second].cast<double>().dot(up_));
            noises.push_back(sample_.noise_of_voxel[voxels[i].second]);
        }
        begin = end;
        face.start = quantile(places, stray_share);
        face.end = quantile(places, 1.0 - stray_share);
        face.bottom = quantile(heights, stray_share);
        face.top = quantile(heights, 1.0 - stray_share);
        face.area = voxel_area * static_cast<double>(face.voxels.size());
        face.noise = static_cast<double>(median(noises));
        const PlanRoom& seen = plan_.rooms[static_cast<std::size_t>(room)];
        face.reaches_floor = face.bottom <= seen.floor_height + foot_reach;
        const std::optional<double> ceiling = ceiling_over(face);
        face.reaches_ceiling = ceiling && face.top >= *ceiling - settings_.ceiling_reach;
        if (face.area >= min_face_area && face.width() >= min_face_width && is_wall(face, ceiling))
            faces_.push_back(std::move(face));
    }
}

/// Share of the face's voxels behind which `test(place)` holds somewhere.
template <typename Test>
double FaceFinder::share_behind(const WallFace& face, double nearest, double farthest,
                                Test&& test) const {
    const Vector2d backwards = -(room_from_map_ * face.plane.normal).head<2>();
    std::size_t count = 0;
    for (const std::uint32_t voxel : face.voxels) {
        const Vector3d point = room_from_map_ * sample_.cloud.positions[voxel].cast<double>();
        count += plan_.any_along(point.head<2>(), backwards, nearest, farthest, test) ? 1 : 0;
    }
    return static_cast<double>(count) / static_cast<double>(face.voxels.size());
}

/// Whether the building seems to end at the face: behind it lies neither floor nor ceiling, as it
/// does behind furniture, nor a wall.
bool FaceFinder::is_last(const WallFace& face) const {
    constexpr double max_share = 0.2;
    return share_behind(face, 2.5 * plan_.cell_size(), max_furniture_depth,
                        [&](const Vector2d& place) {
                            return plan_.has_level_at(place) || plan_.is_barrier_at(place);
                        }) <= max_share;
}

/// Whether behind most of the face floor or ceiling was seen.
bool FaceFinder::has_level_behind(const WallFace& face) const {
    constexpr double farthest = 0.4;
    return share_behind(face, 2.0 * plan_.cell_size(), farthest,
                        [&](const Vector2d& place) { return plan_.has_level_at(place); }) > 0.5;
}

/// Whether behind most of the face lies another room.
bool FaceFinder::parts_rooms(const WallFace& face) const {
    constexpr double farthest = 0.4;
    return share_behind(face, 2.0 * plan_.cell_size(), farthest, [&](const Vector2d& place) {
               const std::int32_t room = plan_.room_at(place);
               return room != no_room && room != face.room;
           }) > 0.5;
}

/// Height of the ceiling along the face; where little of that was seen, the room's lowest.
std::optional<double> FaceFinder::ceiling_over(const WallFace& face) const {
    const double step = plan_.cell_size();
    std::vector<double> heights;
    std::size_t count = 0;
    for (double along = face.start; along <= face.end; along += step) {
        const Vector3d foot = face.plane.offset * face.plane.normal + along * face.along;
        const Vector2d place = (room_from_map_ * foot).head<2>();
        const auto slope = plan_.slope_near(place, ceiling_cells);
        const auto height = slope ? slope : plan_.ceiling_near(place, ceiling_cells);
        if (height) heights.push_back(*height);
        ++count;
    }
    if (2 * heights.size() >= count) return median(heights);
    return plan_.rooms[static_cast<std::size_t>(face.room)].lowest_ceiling;
}

/// What becomes of rays above the face, under the ceiling: they go on over furniture and over
/// leaves that stand open.
AboveFace FaceFinder::look_above(const WallFace& face, std::optional<double> ceiling) const {
    constexpr double margin = 0.05;
    constexpr double lintel = 0.3;  // m, of what is looked at where no ceiling tells
    constexpr std::size_t min_rays = 8;
    WallRectangle above{face.start, face.end, face.top + margin, 0.0};
    above.top = ceiling ? *ceiling - margin : above.bottom + lintel;
    if (above.height() < margin) return AboveFace::surface;
    const RayCount count =
        count_rays(rays_, {face.plane, face.along, up_, above}, 2.0 * sample_.tolerance);
    if (count.passed >= min_rays && count.passed >= count.ended) return AboveFace::free;
    return count.passed + count.ended < min_rays ? AboveFace::unseen : AboveFace::surface;
}

/// Up to a roof's slope that is lower there than ceilings are; the last thing that was seen, though
/// furniture may hide its foot.
bool FaceFinder::is_knee_wall(const WallFace& face, std::optional<double> ceiling) const {
    constexpr double min_height = 0.2;  // m, of what is seen over a bed
    const double floor = plan_.rooms[static_cast<std::size_t>(face.room)].floor_height;
    return ceiling && *ceiling < floor + settings_.min_room_height && face.reaches_ceiling &&
           face.top - face.bottom >= min_height && is_last(face);
}

/// Walls reach the ceiling and are more than a beam; where that cannot be seen, they are taller
/// than furniture, unless the view ends there, and the last thing that was seen.
bool FaceFinder::is_wall(const WallFace& face, std::optional<double> ceiling) const {
    const PlanRoom& room = plan_.rooms[static_cast<std::size_t>(face.room)];
    const double height = face.top - face.bottom;
    const AboveFace above = look_above(face, ceiling);
    if (above == AboveFace::free) return false;
    if (height < settings_.min_wall_height && !is_knee_wall(face, ceiling)) return false;
    // Beams, ducts and soffits end above the floor, which goes on under them.
    if (face.reaches_ceiling) return face.reaches_floor || !has_level_behind(face);
    if (!ceiling && height >= settings_.min_free_wall_height) return true;
    // Where scanners are known, rays tell.
    if (sample_.sensor_positions.empty() && height >= min_parting_height && parts_rooms(face))
        return true;
    const bool is_tall = face.top >= room.floor_height + settings_.min_closing_top ||
                         (!rays_.empty() && above == AboveFace::unseen);
    return face.area >= min_closing_area && is_tall && is_last(face);
}

/// A leaf or a pane in the wall, or the front of what stands before it: parallel, within the wall's
/// extent, and lower. Panes as high as the wall show less of themselves than the wall does.
bool FaceFinder::belongs_to(const WallFace& face, const WallFace& wall) const {
    if (face.room != wall.room) return false;
    const bool is_lower = face.top <= wall.top - min_clearance;
    if (face.plane.normal.dot(wall.plane.normal) < std::cos(radians(15.0))) return false;
    const Vector3d middle =
        0.5 * (face.start + face.end) * face.along + face.plane.offset * face.plane.normal;
    const double before = wall.plane.signed_distance(middle);
    if (before < -max_inset || before > max_furniture_depth) return false;
    const bool is_inset = before < -sample_.tolerance && face.area < 0.6 * wall.area;
    if (!is_lower && !is_inset) return false;
    const double center = middle.dot(wall.along);
    const double half = 0.5 * face.width();
    const double overlap = std::min(center + half, wall.end) - std::max(center - half, wall.start);
    return overlap >= 0.6 * face.width();
}

/// Whether the room ends at the wall's line between two places along it, as it does behind what
/// stands before a wall.
bool FaceFinder::is_closed_between(const WallFace& wall, double from, double to) const {
    constexpr double min_share = 0.8;
    int closed = 0;
    int count = 0;
    for (double along = from; along <= to; along += plan_.cell_size()) {
        const Vector3d point = wall.plane.offset * wall.plane.normal + along * wall.along;
        closed += is_closed_behind(point, wall.plane.normal, wall.room) ? 1 : 0;
        ++count;
    }
    return closed >= min_share * count;
}

/// The columns in a direction in which a face was seen between two heights.
std::set<int> FaceFinder::columns_of(const WallFace& face, const Vector3d& along, double from,
                                     double to) const {
    std::set<int> columns;
    for (const std::uint32_t voxel : face.voxels) {
        const Vector3d point = sample_.cloud.positions[voxel].cast<double>();
        const double height = point.dot(up_);
        if (height >= from && height <= to)
            columns.insert(static_cast<int>(std::floor(point.dot(along) / column_width)));
    }
    return columns;
}

/// Share of the columns in which the face was seen where the wall was seen as well.
double FaceFinder::shared_columns(const WallFace& wall, const WallFace& face) const {
    constexpr double any = std::numeric_limits<double>::infinity();
    const std::set<int> of_wall = columns_of(wall, wall.along, -any, any);
    const std::set<int> of_face = columns_of(face, wall.along, -any, any);
    const auto shared = std::count_if(of_face.begin(), of_face.end(),
                                      [&](int column) { return of_wall.count(column) > 0; });
    return static_cast<double>(shared) / static_cast<double>(of_face.size());
}

/// Whether the face is a piece of the wall that noise or furniture parted from it: both of its ends
/// lie on the wall's plane by two errors, and the room does not go on between the two; or it lies
/// close before or behind the wall, both as high, as the layers do in which depth cameras see what
/// is far.
bool FaceFinder::continues(const WallFace& wall, const WallFace& face) const {
    if (face.room != wall.room) return false;
    if (face.plane.normal.dot(wall.plane.normal) < std::cos(radians(15.0))) return false;
    const Vector3d middle =
        face.plane.offset * face.plane.normal + 0.5 * (face.start + face.end) * face.along;
    if (std::abs(wall.plane.signed_distance(middle)) <= max_inset &&
        face.top > wall.top - min_clearance && shared_columns(wall, face) >= 0.5) {
        return true;
    }
    const double tolerance = 2.0 * plane_tolerance(std::max(wall.noise, face.noise));
    std::array<double, 2> ends{};
    for (std::size_t side = 0; side < 2; ++side) {
        const Vector3d end = face.plane.offset * face.plane.normal +
                             (side == 0 ? face.start : face.end) * face.along;
        if (std::abs(wall.plane.signed_distance(end)) > tolerance) return false;
        ends[side] = end.dot(wall.along);
    }
    const double gap = std::max(ends[0] - wall.end, wall.start - ends[1]);
    if (gap <= settings_.max_gap) return true;
    return ends[0] > wall.end ? is_closed_between(wall, wall.end, ends[0])
                              : is_closed_between(wall, ends[1], wall.start);
}

void FaceFinder::absorb(WallFace& wall, const WallFace& face) const {
    const Vector3d foot = face.plane.offset * face.plane.normal;
    wall.start = std::min(wall.start, (foot + face.start * face.along).dot(wall.along));
    wall.end = std::max(wall.end, (foot + face.end * face.along).dot(wall.along));
    wall.bottom = std::min(wall.bottom, face.bottom);
    wall.top = std::max(wall.top, face.top);
    wall.area += face.area;
    wall.reaches_floor = wall.reaches_floor || face.reaches_floor;
    wall.reaches_ceiling = wall.reaches_ceiling || face.reaches_ceiling;
    wall.voxels.insert(wall.voxels.end(), face.voxels.begin(), face.voxels.end());
}

/// Whether the face is a leaf that stands open or ajar in a hole of the wall: of a leaf's size,
/// lower than the wall, an end in the wall and the other off it, and beside that end the wall goes
/// on but shows no surface at the height of people.
bool FaceFinder::is_leaf_of(const WallFace& face, const WallFace& wall) const {
    constexpr double max_solid_share = 0.3;
    const double floor = plan_.rooms[static_cast<std::size_t>(face.room)].floor_height;
    if (face.width() < min_leaf_width || face.width() > max_leaf_width) return false;
    if (face.top > floor + max_leaf_height || face.top > wall.top - min_clearance) return false;
    std::array<Vector3d, 2> ends;
    for (std::size_t side = 0; side < 2; ++side) {
        ends[side] = face.plane.offset * face.plane.normal +
                     (side == 0 ? face.start : face.end) * face.along;
    }
    const auto depth = [&](const Vector3d& end) {
        return std::abs(wall.plane.signed_distance(end));
    };
    if (depth(ends[0]) > depth(ends[1])) std::swap(ends[0], ends[1]);
    if (depth(ends[0]) > max_hinge_depth || depth(ends[1]) < depth(ends[0]) + 0.1) return false;

    const std::set<int> solid = columns_of(wall, wall.along, floor + body_bottom, floor + body_top);
    const double hinge = ends[0].dot(wall.along);
    for (const double side : {-1.0, 1.0}) {
        const double far = hinge + side * face.width();
        if (std::min(hinge, far) < wall.start || std::max(hinge, far) > wall.end) continue;
        int num_solid = 0;
        int count = 0;
        for (double along = 0.5 * column_width; along < face.width(); along += column_width) {
            const double place = hinge + side * along;
            num_solid +=
                static_cast<int>(solid.count(static_cast<int>(std::floor(place / column_width))));
            ++count;
        }
        if (num_solid <= max_solid_share * count) return true;
    }
    return false;
}

std::vector<WallFace> FaceFinder::take() {
    const auto by_area = [](const WallFace& a, const WallFace& b) { return a.area > b.area; };
    std::stable_sort(faces_.begin(), faces_.end(), by_area);
    std::vector<WallFace> walls;
    for (const WallFace& face : faces_) {
        const auto wall = std::find_if(walls.begin(), walls.end(), [&](const WallFace& known) {
            return continues(known, face);
        });
        if (wall == walls.end()) {
            walls.push_back(face);
        } else {
            absorb(*wall, face);
        }
    }
    std::stable_sort(walls.begin(), walls.end(), by_area);
    std::vector<WallFace> kept;
    for (const WallFace& face : walls) {
        if (face.width() < min_wall_width && !face.reaches_ceiling) continue;
        const bool has_wall = std::any_of(walls.begin(), walls.end(), [&](const WallFace& wall) {
            return belongs_to(face, wall) || is_leaf_of(face, wall);
        });
        if (!has_wall) kept.push_back(face);
    }
    return kept;
}

}  // namespace

std::vector<WallFace> find_wall_faces(std::span<const Ray> rays, const SurfaceSample& sample,
                                      std::span<const PlanarPatch> patches,
                                      std::span<const UprightSurface> surfaces,
                                      const FloorPlan& plan, const Eigen::Matrix3d& room_from_map,
                                      const RoomSurfacesSettings& settings) {
    FaceFinder finder(rays, sample, patches, plan, room_from_map, settings);
    for (const UprightSurface& surface : surfaces)
        finder.add(surface);
    return finder.take();
}

}  // namespace roomscribe
