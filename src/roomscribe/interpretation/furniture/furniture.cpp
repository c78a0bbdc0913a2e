// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/furniture/furniture.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "roomscribe/interpretation/furniture/chair_backs.hpp"
#include "roomscribe/interpretation/furniture/furniture_voxels.hpp"
#include "roomscribe/interpretation/furniture/hidden_seats.hpp"
#include "roomscribe/interpretation/furniture/level_slabs.hpp"
#include "roomscribe/interpretation/furniture/pedestals.hpp"
#include "roomscribe/interpretation/furniture/piece_backs.hpp"
#include "roomscribe/interpretation/furniture/piece_drafts.hpp"
#include "roomscribe/interpretation/furniture/piece_faces.hpp"
#include "roomscribe/interpretation/furniture/piece_kinds.hpp"
#include "roomscribe/interpretation/furniture/shelf_contents.hpp"
#include "roomscribe/interpretation/furniture/tall_pieces.hpp"
#include "roomscribe/interpretation/furniture/worktop_rows.hpp"

namespace roomscribe {
namespace {

/// The box around a piece: its plan rectangle, from the floor to its top.
OrientedBox box_of(const FurnitureVoxels& all, const PieceDraft& draft, const PieceForm& form,
                   const Eigen::Matrix3d& axes, double voxel_size) {
    const FurnitureVoxel& some = all.voxels[draft.voxels.front()];
    const double floor = some.place.z() - some.height;
    // What stands reaches the floor, though voxels begin above it.
    const double bottom = form.bottom < 0.3 ? 0.0 : form.bottom - voxel_size / 2.0;
    OrientedBox box;
    const auto in_map = [&](double x, double y, double z) -> Eigen::Vector3d {
        return axes.transpose() * Eigen::Vector3d(x, y, z);
    };
    const PlanRectangle& plan = form.rectangle;
    box.center = in_map(plan.center.x(), plan.center.y(), floor + 0.5 * (bottom + form.top));
    box.axes = {in_map(plan.axis.x(), plan.axis.y(), 0.0),
                in_map(plan.across().x(), plan.across().y(), 0.0), in_map(0.0, 0.0, 1.0)};
    box.size = {plan.length, plan.width, form.top - bottom};
    return box;
}

/// Gives closed and tall drafts what lies behind them at the wall: their backs, which hang together
/// with all that stands along it.
void add_backs(const FurnitureVoxels& all, const RoomSurfaces& surfaces,
               std::vector<PieceDraft>& drafts) {
    constexpr double min_tall = 1.25;  // m above the floor, see tall_pieces.cpp
    std::vector<bool> is_taken(all.voxels.size(), false);
    for (const PieceDraft& draft : drafts) {
        for (const std::uint32_t i : draft.voxels)
            is_taken[i] = true;
    }
    std::vector<std::uint32_t> near_wall;
    for (std::uint32_t i = 0; i < all.voxels.size(); ++i) {
        if (all.voxels[i].is_near_wall && !is_taken[i]) near_wall.push_back(i);
    }
    for (PieceDraft& draft : drafts) {
        if (draft.voxels.empty()) continue;
        double top = 0.0;
        double bottom = min_tall;
        std::vector<Eigen::Vector2d> places;
        for (const std::uint32_t i : draft.voxels) {
            top = std::max(top, all.voxels[i].height);
            bottom = std::min(bottom, all.voxels[i].height);
            places.emplace_back(all.voxels[i].place.head<2>());
        }
        if (top < min_tall) continue;
        const FurnitureVoxel& some = all.voxels[draft.voxels.front()];
        const PlanRectangle rectangle =
            extended_to_wall(smallest_rectangle(places), surfaces, some);
        for (const std::uint32_t i : near_wall) {
            const FurnitureVoxel& voxel = all.voxels[i];
            if (is_taken[i] || voxel.room != some.room || voxel.storey != some.storey) continue;
            if (voxel.height < bottom || voxel.height > top) continue;
            if (rectangle.distance(voxel.place.head<2>()) > 0.5 * all.reach) continue;
            is_taken[i] = true;
            draft.voxels.push_back(i);
        }
        std::sort(draft.voxels.begin(), draft.voxels.end());
    }
}

/// Makes the components of pieces and their faces.
class FurnitureBuilder {
  public:
    FurnitureBuilder(const SurfaceSample& sample, const FurnitureVoxels& all,
                     std::span<const LevelSlab> slabs, const RoomSurfaces& surfaces,
                     std::span<const PlanarPatch> patches, double voxel_size,
                     std::int32_t first_instance)
        : sample_(sample),
          all_(all),
          slabs_(slabs),
          surfaces_(surfaces),
          patches_(patches),
          axes_(surfaces.room_from_map.linear()),
          voxel_size_(voxel_size),
          next_instance_(first_instance) {}

    void add(PieceDraft& draft, Furniture& result) {
        PieceForm form = measure_form(all_, slabs_, draft, surfaces_);
        const PieceVerdict verdict = judge_piece(form);
        if (!verdict.is_furniture) {
            if (!verdict.kind.empty()) add_thing(draft, form, verdict, result);
            return;
        }
        if (verdict.confidence < min_piece_confidence) {
            for (const std::uint32_t i : draft.voxels)
                result.component_of_voxel[all_.voxels[i].voxel] = unnamed_furniture;
            return;
        }
        if (verdict.kind == "shelf" && form.is_at_wall) {
            const FurnitureVoxel& some = all_.voxels[draft.voxels.front()];
            for (const std::uint32_t v : find_back_on_wall(sample_, surfaces_, form, some)) {
                if (result.component_of_voxel[v] >= 0) continue;
                result.component_of_voxel[v] = static_cast<std::int32_t>(result.components.size());
                result.backs.push_back(v);
            }
        }
        if (verdict.kind == "shelf") drop_shelf_contents(all_, form, draft);
        if (is_flat_on_top(verdict.kind)) drop_things_on_top(form, draft);
        const std::size_t number = result.components.size();
        Component piece = make_component(draft, verdict, Label::furniture);
        piece.box = box_of(all_, draft, form, axes_, voxel_size_);
        assign(draft, number, result);
        const std::string id = piece.id;
        result.components.push_back(std::move(piece));
        add_top(draft, verdict, id, result);
        const Eigen::Vector3d off_wall(form.off_wall.x(), form.off_wall.y(), 0.0);
        const bool may_be_closed = is_table_like(verdict.kind);
        if (!has_fronts(verdict.kind) && !may_be_closed) return;
        auto side =
            find_front_side(all_, draft, form, patches_, axes_, axes_.transpose() * off_wall);
        if (!side || (may_be_closed && !closes_piece(all_, draft, form, *side, axes_))) return;
        side->piece = number;
        sides_.push_back(std::move(*side));
    }

    void add_fronts(const PointCloud& map, const SurfaceSample& sample, Furniture& result) {
        const Eigen::Vector3d up = axes_.row(2).transpose();
        for (const FrontPanel& panel : find_front_panels(map, sample, sides_, up)) {
            const FrontSide& side = sides_[panel.side];
            const Component& piece = result.components[side.piece];
            Component face = make_face(piece.id, panel.kind, piece);
            const auto corner = [&](double along, double above) -> Eigen::Vector3d {
                return side.plane.offset * side.plane.normal + along * side.along + above * up;
            };
            const WallRectangle& extent = panel.extent;
            face.polygon = {corner(extent.start, extent.bottom), corner(extent.end, extent.bottom),
                            corner(extent.end, extent.top), corner(extent.start, extent.top)};
            face.evidence.rule = "upright front of a closed piece";
            face.evidence.rms = panel.rms;
            if (panel.may_be_several) {
                face.verdict = Verdict::doubtful;
                face.evidence.alternative = "several fronts";
            }
            MountingFace mounting;
            mounting.plane = side.plane;
            mounting.along = side.along;
            mounting.extent = extent;
            mounting.rms = panel.rms;
            mounting.may_be_several = panel.may_be_several;
            mounting.component = result.components.size();
            result.fronts.push_back(mounting);
            result.components.push_back(std::move(face));
        }
    }

  private:
    /// Kinds whose top ends them; of seats and beds backs rise above.
    static bool is_flat_on_top(std::string_view kind) {
        constexpr std::array<std::string_view, 5> kinds{"tv_unit", "bench", "coffee_table",
                                                        "nightstand", "cabinet"};
        return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
    }

    /// What a piece with fronts is taken for of which little more than the top was seen.
    static bool is_table_like(std::string_view kind) {
        constexpr std::array<std::string_view, 4> kinds{"table", "desk", "coffee_table", "bench"};
        return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
    }

    /// Screens and lamps on the main slab.
    void drop_things_on_top(PieceForm& form, PieceDraft& draft) const {
        constexpr double slack = 0.04;
        if (draft.slabs.empty()) return;
        const double top = slabs_[draft.slabs.front()].height + slack;
        std::erase_if(draft.voxels, [&](std::uint32_t i) {
            return all_.voxels[i].height > top + all_.voxels[i].noise;
        });
        form.top = std::min(form.top, top);
    }

    Component make_component(const PieceDraft& draft, const PieceVerdict& verdict, Label label) {
        const FurnitureVoxel& some = all_.voxels[draft.voxels.front()];
        Component component;
        component.label = label;
        component.id = label == Label::furniture ? fmt::format("furniture-{}", ++num_furniture_)
                                                 : fmt::format("thing-{}", ++num_things_);
        component.kind = verdict.kind;
        component.instance = next_instance_++;
        component.parent =
            surfaces_.storeys[some.storey].room_ids[static_cast<std::size_t>(some.room)];
        component.confidence = verdict.confidence;
        component.verdict = verdict.alternative.empty() ? Verdict::accepted : Verdict::doubtful;
        component.evidence.rule = verdict.rule;
        component.evidence.alternative = verdict.alternative;
        return component;
    }

    Component make_face(const std::string& parent, std::string_view kind, const Component& piece) {
        Component face;
        face.label = Label::furniture;
        face.id = fmt::format("furniture-{}", ++num_furniture_);
        face.kind = kind;
        face.instance = next_instance_++;
        face.parent = parent;
        face.confidence = piece.confidence;
        face.verdict = piece.verdict;
        face.evidence.alternative = piece.evidence.alternative;
        return face;
    }

    void assign(const PieceDraft& draft, std::size_t number, Furniture& result) const {
        for (const std::uint32_t i : draft.voxels)
            result.component_of_voxel[all_.voxels[i].voxel] = static_cast<std::int32_t>(number);
    }

    void add_thing(const PieceDraft& draft, const PieceForm& form, const PieceVerdict& verdict,
                   Furniture& result) {
        Component thing = make_component(draft, verdict, Label::unknown);
        thing.box = box_of(all_, draft, form, axes_, voxel_size_);
        assign(draft, result.components.size(), result);
        result.components.push_back(std::move(thing));
    }

    /// The top of what has one that is used: not of seats, nor of what is taller than people reach.
    void add_top(const PieceDraft& draft, const PieceVerdict& verdict, const std::string& parent,
                 Furniture& result) {
        constexpr std::array<std::string_view, 11> with_top{
            "table",      "desk",    "counter", "cabinet",      "base_unit", "drawer_unit",
            "nightstand", "tv_unit", "bench",   "coffee_table", "wall_shelf"};
        const bool has_top =
            std::find(with_top.begin(), with_top.end(), verdict.kind) != with_top.end();
        if (!has_top || draft.slabs.empty()) return;
        const LevelSlab& slab = slabs_[draft.slabs.front()];
        const FurnitureVoxel& some = all_.voxels[slab.voxels.front()];
        const double z = some.place.z() - some.height + slab.height;
        Component face = make_face(parent, "top", result.components.back());
        // Voxels at the rim lie half of their edge within it.
        const PlanRectangle& plan = slab.rectangle;
        const Eigen::Vector2d u = 0.5 * (plan.length + 0.5 * voxel_size_) * plan.axis;
        const Eigen::Vector2d v = 0.5 * (plan.width + 0.5 * voxel_size_) * plan.across();
        for (const Eigen::Vector2d& corner : {Eigen::Vector2d(-u - v), Eigen::Vector2d(u - v),
                                              Eigen::Vector2d(u + v), Eigen::Vector2d(v - u)}) {
            const Eigen::Vector2d place = plan.center + corner;
            face.polygon.emplace_back(axes_.transpose() * Eigen::Vector3d(place.x(), place.y(), z));
        }
        face.evidence.rule = "level top of a piece";
        face.evidence.coverage = std::min(1.0, slab.area / std::max(plan.area(), 1e-9));
        result.components.push_back(std::move(face));
    }

    const SurfaceSample& sample_;
    const FurnitureVoxels& all_;
    std::span<const LevelSlab> slabs_;
    const RoomSurfaces& surfaces_;
    std::span<const PlanarPatch> patches_;
    Eigen::Matrix3d axes_;
    double voxel_size_;
    std::int32_t next_instance_;
    int num_furniture_ = 0;
    int num_things_ = 0;
    std::vector<FrontSide> sides_;
};

/// The surfaces of Algorithm 5 as components: level ones are tables and other tops, upright ones
/// faces of furniture.
Furniture find_surfaces_of_paper(const ScanMap& map, const SurfaceSample& sample,
                                 const FurnitureVoxels& all, const RoomSurfaces& surfaces,
                                 std::span<const Label> labels, std::int32_t first_instance,
                                 std::uint64_t seed, const FurnitureSurfaceSettings& settings,
                                 const Context& context) {
    std::vector<const FurnitureVoxel*> voxel_of_sample(sample.cloud.size(), nullptr);
    for (const FurnitureVoxel& voxel : all.voxels)
        voxel_of_sample[voxel.voxel] = &voxel;
    PointCloud left;
    std::vector<std::uint32_t> voxels;
    for (std::size_t i = 0; i < map.cloud.size(); ++i) {
        const std::uint32_t voxel = sample.voxel_of_point[i];
        if (voxel == no_voxel || labels[i] != Label::unknown || !voxel_of_sample[voxel]) continue;
        left.positions.push_back(map.cloud.positions[i]);
        voxels.push_back(voxel);
    }
    const Eigen::Matrix3d axes = surfaces.room_from_map.linear();
    const FurnitureSurfaces found = detect_furniture_surfaces(left, axes, seed, settings, context);
    Furniture result;
    result.component_of_voxel.assign(sample.cloud.size(), -1);
    std::vector<std::int32_t> surface_of_point(found.cloud.size(), -1);
    for (std::size_t s = 0; s < found.surfaces.size(); ++s) {
        const FurnitureSurface& surface = found.surfaces[s];
        const bool is_level = surface.axis == 2;
        Component component;
        component.label = Label::furniture;
        component.id = fmt::format("furniture-{}", s + 1);
        component.kind = is_level ? "table" : "front";
        component.instance = first_instance + static_cast<std::int32_t>(s);
        component.confidence = 0.5;
        component.verdict = Verdict::accepted;
        component.evidence.rule = is_level ? "level cluster on a plane along the room's axes"
                                           : "upright cluster on a plane along the room's axes";
        const Eigen::Vector3d normal = surface.plane.normal;
        const Eigen::Vector3d along =
            is_level ? Eigen::Vector3d(axes.row(0).transpose())
                     : Eigen::Vector3d(axes.row(2).transpose().cross(normal).normalized());
        const Eigen::Vector3d up = normal.cross(along);
        Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9);
        Eigen::Vector2d high = -low;
        for (const std::uint32_t point : surface.points) {
            surface_of_point[point] = static_cast<std::int32_t>(s);
            const Eigen::Vector3d position = found.cloud.positions[point].cast<double>();
            const Eigen::Vector2d place(along.dot(position), up.dot(position));
            low = low.cwiseMin(place);
            high = high.cwiseMax(place);
        }
        const auto corner = [&](double x, double y) -> Eigen::Vector3d {
            return surface.plane.offset * normal + x * along + y * up;
        };
        component.polygon = {corner(low.x(), low.y()), corner(high.x(), low.y()),
                             corner(high.x(), high.y()), corner(low.x(), high.y())};
        result.components.push_back(std::move(component));
    }
    for (std::size_t i = 0; i < voxels.size(); ++i) {
        const std::uint32_t voxel = found.voxel_of_point[i];
        if (voxel == no_voxel || surface_of_point[voxel] < 0) continue;
        const std::int32_t surface = surface_of_point[voxel];
        result.component_of_voxel[voxels[i]] = surface;
        const FurnitureVoxel& some = *voxel_of_sample[voxels[i]];
        result.components[static_cast<std::size_t>(surface)].parent =
            surfaces.storeys[some.storey].room_ids[static_cast<std::size_t>(some.room)];
    }
    return result;
}

}  // namespace

Furniture find_furniture(const ScanMap& map, const SurfaceSample& sample,
                         std::span<const PlanarPatch> patches, const RoomSurfaces& surfaces,
                         std::span<const Label> labels, std::int32_t first_instance,
                         std::uint64_t seed, const FurnitureSettings& settings,
                         const Context& context) {
    check_settings(settings);
    FurnitureVoxels all = gather_furniture_voxels(sample, patches, surfaces, labels, context);
    if (settings.method == FurnitureMethod::algorithm_5) {
        return find_surfaces_of_paper(map, sample, all, surfaces, labels, first_instance, seed,
                                      settings.algorithm_5, context);
    }
    Furniture result;
    result.component_of_voxel.assign(sample.cloud.size(), -1);
    std::vector<PieceDraft> drafts = draft_tall_pieces(all, surfaces);
    for (PieceDraft& draft : draft_hanging_pieces(all))
        drafts.push_back(std::move(draft));
    context.throw_if_cancelled();
    const std::vector<LevelSlab> slabs = find_level_slabs(all, sample.voxel_size);
    for (PieceDraft& draft : draft_pieces(all, slabs))
        drafts.push_back(std::move(draft));
    part_pedestals(all, slabs, drafts);
    part_chairs(all, slabs, drafts);
    complete_chairs(all, slabs, surfaces, drafts);
    context.throw_if_cancelled();
    join_worktop_rows(all, slabs, surfaces, drafts);
    add_backs(all, surfaces, drafts);
    FurnitureBuilder builder(sample, all, slabs, surfaces, patches, sample.voxel_size,
                             first_instance);
    for (PieceDraft& draft : drafts) {
        if (!draft.voxels.empty()) builder.add(draft, result);
    }
    std::sort(result.backs.begin(), result.backs.end());
    builder.add_fronts(map.cloud, sample, result);
    return result;
}

void label_furniture(const SurfaceSample& sample, const Furniture& furniture, PointLabels& labels) {
    std::vector<bool> is_back(sample.cloud.size(), false);
    for (const std::uint32_t voxel : furniture.backs)
        is_back[voxel] = true;
    for (std::size_t i = 0; i < labels.labels.size(); ++i) {
        const std::uint32_t voxel = sample.voxel_of_point[i];
        if (voxel == no_voxel) continue;
        const bool is_free = labels.labels[i] == Label::unknown ||
                             (labels.labels[i] == Label::wall && is_back[voxel]);
        if (!is_free) continue;
        const std::int32_t number = furniture.component_of_voxel[voxel];
        if (number == unnamed_furniture) {
            labels.labels[i] = Label::furniture;
            labels.confidences[i] = static_cast<float>(min_piece_confidence);
        }
        if (number < 0) continue;
        const Component& component = furniture.components[static_cast<std::size_t>(number)];
        labels.labels[i] = component.label;
        labels.instances[i] = component.instance;
        labels.confidences[i] =
            component.label == Label::unknown ? 0.0F : static_cast<float>(component.confidence);
    }
}

}  // namespace roomscribe
