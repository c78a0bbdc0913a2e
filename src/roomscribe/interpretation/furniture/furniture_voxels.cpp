// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/furniture/furniture_voxels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/core/units.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t chunk = 2048;
/// m above the floor. Lower, it is the floor's own unevenness, a rug or a threshold.
constexpr double min_height = 0.05;
/// m below the ceiling. Lamps and cornices.
constexpr double ceiling_margin = 0.1;
/// Boards sag and scanners lean: a plane so much out of level or plumb still is a board or a front.
const double plane_cos = std::cos(radians(12.0));
const double plane_sin = std::sin(radians(12.0));
/// A voxel's own normal bends at edges and on cushions.
const double voxel_cos = std::cos(radians(30.0));
const double voxel_sin = std::sin(radians(30.0));
/// m: what lies so near a wall's face besides its tolerance is its own relief (skirting boards are
/// 16 to 35 mm) and ties together what stands along the wall.
constexpr double wall_relief = 0.03;
/// m2. Fronts, boards and seats have more; leaves and limbs less.
constexpr double min_planar_area = 0.05;
/// A surface that runs straight through a voxel has 8 neighbours beside it, its rim 5, its end 3.
constexpr std::size_t min_core_neighbors = 4;
/// Diagonal of a voxel and a bit, in its edges: neighbours are what touches, and one gap between.
constexpr double reach_in_voxels = 2.0;

/// Cells as wide as the reach, sorted, so that a voxel's neighbours are in 27 of them.
class CellTable {
  public:
    CellTable(const std::vector<FurnitureVoxel>& voxels, double cell_size) : cell_size_(cell_size) {
        entries_.reserve(voxels.size());
        for (std::uint32_t i = 0; i < voxels.size(); ++i)
            entries_.push_back({cell_of(voxels[i].place), i});
        std::sort(entries_.begin(), entries_.end());
    }

    /// Calls `visit(number)` for all voxels in the cells around a place.
    template <typename Visit>
    void around(const Eigen::Vector3d& place, Visit&& visit) const {
        const Cell cell = cell_of(place);
        for (int dx = -1; dx <= 1; ++dx) {
            for (int dy = -1; dy <= 1; ++dy) {
                const Cell low{cell[0] + dx, cell[1] + dy, cell[2] - 1};
                auto entry = std::lower_bound(entries_.begin(), entries_.end(), Entry{low, 0U});
                for (; entry != entries_.end() && entry->cell[0] == low[0] &&
                       entry->cell[1] == low[1] && entry->cell[2] <= cell[2] + 1;
                     ++entry) {
                    visit(entry->voxel);
                }
            }
        }
    }

  private:
    using Cell = std::array<std::int32_t, 3>;
    struct Entry {
        Cell cell;
        std::uint32_t voxel;
        bool operator<(const Entry& other) const {
            return cell != other.cell ? cell < other.cell : voxel < other.voxel;
        }
    };

    Cell cell_of(const Eigen::Vector3d& place) const {
        Cell cell{};
        for (int i = 0; i < 3; ++i)
            cell[static_cast<std::size_t>(i)] =
                static_cast<std::int32_t>(std::floor(place[i] / cell_size_));
        return cell;
    }

    double cell_size_;
    std::vector<Entry> entries_;
};

/// Whether a wall of the room stands between a place in it and one beside it.
bool is_behind_wall(const StoreyLayout& storey, std::int32_t room, const Eigen::Matrix3d& axes,
                    const Eigen::Vector2d& inside, const Eigen::Vector2d& outside) {
    constexpr double tolerance = 0.05;
    for (const WallFace& face : storey.faces) {
        if (face.room != room) continue;
        const Eigen::Vector2d normal = (axes * face.plane.normal).head<2>();
        if (normal.dot(outside) - face.plane.offset > -tolerance) continue;
        if (normal.dot(inside) - face.plane.offset < -tolerance) continue;
        const double along = (axes * face.along).head<2>().dot(outside);
        if (along >= face.start && along <= face.end) return true;
    }
    return false;
}

/// The room at a place; where none is, the one that is open to it within a wardrobe's depth: what
/// stands along a wall hides the floor below it and the wall behind.
std::int32_t room_of(const StoreyLayout& storey, const Eigen::Matrix3d& axes,
                     const Eigen::Vector2d& place) {
    const std::int32_t room = storey.plan.room_at(place);
    if (room != no_room) return room;
    constexpr double max_depth = 0.7;
    constexpr double step = 0.1;
    constexpr std::array<std::array<double, 2>, 4> directions{
        {{1.0, 0.0}, {-1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}}};
    for (double reach = step; reach <= max_depth; reach += step) {
        for (const auto& [x, y] : directions) {
            const Eigen::Vector2d inside = place + reach * Eigen::Vector2d(x, y);
            const std::int32_t near = storey.plan.room_at(inside);
            if (near != no_room && !is_behind_wall(storey, near, axes, inside, place)) return near;
        }
    }
    return no_room;
}

/// Finds storey and room of a place.
bool find_room(const RoomSurfaces& surfaces, FurnitureVoxel& voxel) {
    const Eigen::Matrix3d axes = surfaces.room_from_map.linear();
    double lowest = std::numeric_limits<double>::infinity();
    for (std::uint32_t s = 0; s < surfaces.storeys.size(); ++s) {
        const std::int32_t room = room_of(surfaces.storeys[s], axes, voxel.place.head<2>());
        if (room == no_room) continue;
        const PlanRoom& seen = surfaces.storeys[s].plan.rooms[static_cast<std::size_t>(room)];
        const double height = voxel.place.z() - seen.floor_height;
        if (height < min_height || height >= lowest) continue;
        if (seen.ceiling_height && voxel.place.z() > *seen.ceiling_height - ceiling_margin)
            continue;
        lowest = height;
        voxel.storey = s;
        voxel.room = room;
        voxel.height = height;
    }
    return std::isfinite(lowest);
}

bool is_near_wall(const RoomSurfaces& surfaces, const FurnitureVoxel& voxel,
                  const Eigen::Vector3d& position, double tolerance) {
    for (const WallFace& face : surfaces.storeys[voxel.storey].faces) {
        const double reach = std::max(tolerance, 2.5 * face.rms) + wall_relief;
        if (std::abs(face.plane.signed_distance(position)) > reach) continue;
        const double along = face.along.dot(position);
        if (along >= face.start && along <= face.end) return true;
    }
    return false;
}

void find_neighbors(FurnitureVoxels& all, const Context& context) {
    const std::size_t count = all.voxels.size();
    const CellTable cells(all.voxels, all.reach);
    std::vector<std::vector<std::uint32_t>> lists(count);
    parallel_for(context, count, chunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Eigen::Vector3d& place = all.voxels[i].place;
            cells.around(place, [&](std::uint32_t other) {
                if (other == i) return;
                if ((all.voxels[other].place - place).squaredNorm() <= all.reach * all.reach)
                    lists[i].push_back(other);
            });
            std::sort(lists[i].begin(), lists[i].end());
        }
    });
    all.first.assign(1, 0);
    for (const auto& list : lists) {
        all.neighbors.insert(all.neighbors.end(), list.begin(), list.end());
        all.first.push_back(all.neighbors.size());
    }
}

}  // namespace

FurnitureVoxels gather_furniture_voxels(const SurfaceSample& sample,
                                        std::span<const PlanarPatch> patches,
                                        const RoomSurfaces& surfaces, std::span<const Label> labels,
                                        const Context& context) {
    const std::size_t num_voxels = sample.cloud.size();
    std::vector<std::uint32_t> num_points(num_voxels, 0);
    std::vector<std::uint32_t> num_unknown(num_voxels, 0);
    for (std::size_t i = 0; i < labels.size(); ++i) {
        const std::uint32_t voxel = sample.voxel_of_point[i];
        if (voxel == no_voxel) continue;
        ++num_points[voxel];
        num_unknown[voxel] += labels[i] == Label::unknown ? 1U : 0U;
    }
    const Eigen::Matrix3d axes = surfaces.room_from_map.linear();
    std::vector<const PlanarPatch*> patch_of_voxel(num_voxels, nullptr);
    for (const PlanarPatch& patch : patches) {
        for (const std::uint32_t voxel : patch.points)
            patch_of_voxel[voxel] = &patch;
    }

    FurnitureVoxels all;
    for (std::uint32_t v = 0; v < num_voxels; ++v) {
        if (2 * num_unknown[v] < num_points[v]) continue;
        const Eigen::Vector3d position = sample.cloud.positions[v].cast<double>();
        FurnitureVoxel voxel;
        voxel.voxel = v;
        voxel.place = axes * position;
        if (!find_room(surfaces, voxel)) continue;
        voxel.noise = static_cast<double>(sample.noise_of_voxel[v]);
        const PlanarPatch* patch = patch_of_voxel[v];
        const Eigen::Vector3d normal =
            patch ? patch->plane.normal : sample.cloud.normals[v].cast<double>();
        const double rise = std::abs(axes.row(2).dot(normal));
        voxel.is_level = rise >= (patch ? plane_cos : voxel_cos);
        voxel.is_upright = rise <= (patch ? plane_sin : voxel_sin);
        if (patch) voxel.patch = static_cast<std::uint32_t>(patch - patches.data());
        voxel.is_planar = patch != nullptr && patch->area >= min_planar_area;
        voxel.looks_down = sample.normals_face_scanner && axes.row(2).dot(normal) < 0.0;
        voxel.is_near_wall = is_near_wall(surfaces, voxel, position, sample.tolerance);
        voxel.is_core = !voxel.is_near_wall;
        all.voxels.push_back(voxel);
    }
    all.reach = reach_in_voxels * std::max(sample.voxel_size, sample.spacing);
    find_neighbors(all, context);
    for (std::uint32_t i = 0; i < all.voxels.size(); ++i) {
        FurnitureVoxel& voxel = all.voxels[i];
        voxel.is_stray = voxel.is_core && all.neighbors_of(i).size() < min_core_neighbors;
        voxel.is_core = voxel.is_core && !voxel.is_stray;
    }
    return all;
}

std::vector<std::vector<std::uint32_t>> connected_voxels(const FurnitureVoxels& all,
                                                         std::span<const std::uint32_t> candidates,
                                                         std::vector<bool>& belongs) {
    std::vector<std::vector<std::uint32_t>> sets;
    std::vector<std::uint32_t> stack;
    for (const std::uint32_t seed : candidates) {
        if (!belongs[seed]) continue;
        std::vector<std::uint32_t>& members = sets.emplace_back();
        belongs[seed] = false;
        stack.push_back(seed);
        while (!stack.empty()) {
            const std::uint32_t at = stack.back();
            stack.pop_back();
            members.push_back(at);
            for (const std::uint32_t next : all.neighbors_of(at)) {
                if (!belongs[next]) continue;
                belongs[next] = false;
                stack.push_back(next);
            }
        }
        std::sort(members.begin(), members.end());
    }
    return sets;
}

std::vector<Eigen::Vector2d> places_of(const FurnitureVoxels& all,
                                       std::span<const std::uint32_t> members) {
    std::vector<Eigen::Vector2d> places;
    places.reserve(members.size());
    for (const std::uint32_t i : members)
        places.emplace_back(all.voxels[i].place.head<2>());
    return places;
}

}  // namespace roomscribe
