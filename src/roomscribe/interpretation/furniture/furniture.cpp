// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/furniture/furniture.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "roomscribe/interpretation/furniture/furniture_voxels.hpp"
#include "roomscribe/interpretation/furniture/level_slabs.hpp"
#include "roomscribe/interpretation/furniture/piece_drafts.hpp"
#include "roomscribe/interpretation/furniture/piece_kinds.hpp"
#include "roomscribe/interpretation/furniture/tall_pieces.hpp"

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

}  // namespace

Furniture find_furniture(const ScanMap& map, const SurfaceSample& sample,
                         std::span<const PlanarPatch> patches, const RoomSurfaces& surfaces,
                         std::span<const Label> labels, std::int32_t first_instance,
                         const Context& context) {
    Furniture result;
    result.component_of_voxel.assign(sample.cloud.size(), -1);
    FurnitureVoxels all = gather_furniture_voxels(sample, patches, surfaces, labels, context);
    std::vector<PieceDraft> drafts = draft_tall_pieces(all, surfaces);
    for (PieceDraft& draft : draft_hanging_pieces(all))
        drafts.push_back(std::move(draft));
    const std::vector<LevelSlab> slabs = find_level_slabs(all, sample.voxel_size);
    const Eigen::Matrix3d axes = surfaces.room_from_map.linear();
    int count = 0;
    for (PieceDraft& draft : draft_pieces(all, slabs))
        drafts.push_back(std::move(draft));
    for (const PieceDraft& draft : drafts) {
        const PieceForm form = measure_form(all, slabs, draft, surfaces);
        const PieceVerdict verdict = judge_piece(form);
        if (!verdict.is_furniture) continue;
        const FurnitureVoxel& some = all.voxels[draft.voxels.front()];
        Component piece;
        piece.id = fmt::format("furniture-{}", ++count);
        piece.label = Label::furniture;
        piece.kind = verdict.kind;
        piece.instance = first_instance++;
        piece.parent = surfaces.storeys[some.storey].room_ids[static_cast<std::size_t>(some.room)];
        piece.box = box_of(all, draft, form, axes, sample.voxel_size);
        piece.confidence = verdict.confidence;
        piece.verdict = verdict.alternative.empty() ? Verdict::accepted : Verdict::doubtful;
        piece.evidence.rule = verdict.rule;
        piece.evidence.alternative = verdict.alternative;
        for (const std::uint32_t i : draft.voxels)
            result.component_of_voxel[all.voxels[i].voxel] =
                static_cast<std::int32_t>(result.components.size());
        result.components.push_back(std::move(piece));
    }
    std::vector<std::uint64_t> points(result.components.size(), 0);
    for (std::size_t i = 0; i < map.cloud.size(); ++i) {
        const std::uint32_t voxel = sample.voxel_of_point[i];
        if (voxel == no_voxel || labels[i] != Label::unknown) continue;
        const std::int32_t component = result.component_of_voxel[voxel];
        if (component >= 0) ++points[static_cast<std::size_t>(component)];
    }
    for (std::size_t i = 0; i < points.size(); ++i)
        result.components[i].evidence.points = points[i];
    return result;
}

void label_furniture(const SurfaceSample& sample, const Furniture& furniture, PointLabels& labels) {
    for (std::size_t i = 0; i < labels.labels.size(); ++i) {
        const std::uint32_t voxel = sample.voxel_of_point[i];
        if (voxel == no_voxel || labels.labels[i] != Label::unknown) continue;
        const std::int32_t number = furniture.component_of_voxel[voxel];
        if (number < 0) continue;
        const Component& component = furniture.components[static_cast<std::size_t>(number)];
        labels.labels[i] = component.label;
        labels.instances[i] = component.instance;
        labels.confidences[i] =
            component.label == Label::unknown ? 0.0F : static_cast<float>(component.confidence);
    }
}

}  // namespace roomscribe
