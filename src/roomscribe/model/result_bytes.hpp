// SPDX-License-Identifier: MIT
#pragma once

#include "roomscribe/core/derived_value.hpp"
#include "roomscribe/model/byte_archive.hpp"
#include "roomscribe/model/registration_result.hpp"
#include "roomscribe/model/scene.hpp"
#include "roomscribe/model/surface_outlines.hpp"

/// The fields of results, for ByteSink and ByteSource.
namespace roomscribe {

template <typename Archive, Either<DerivedValue> Value>
void exchange(Archive& archive, Value& derived) {
    archive(derived.name, derived.value, derived.unit, derived.reason);
}

template <typename Archive, Either<RegistrationLink> Value>
void exchange(Archive& archive, Value& link) {
    archive(link.source, link.target, link.target_from_source, link.verdict, link.probability,
            link.loops, link.overlap, link.agreement, link.rmse, link.inliers, link.covariance,
            link.unobservable, link.rivals, link.stop_reason);
}

template <typename Archive, Either<Registration> Value>
void exchange(Archive& archive, Value& registration) {
    archive(registration.map_from_scan, registration.apart_from_scan, registration.covariances,
            registration.is_doubtful, registration.links, registration.components,
            registration.residuals, registration.overlaps);
}

template <typename Archive, Either<Evidence> Value>
void exchange(Archive& archive, Value& evidence) {
    archive(evidence.rule, evidence.points, evidence.coverage, evidence.occluded, evidence.rms,
            evidence.alternative, evidence.scans);
}

template <typename Archive, Either<OrientedBox> Value>
void exchange(Archive& archive, Value& box) {
    archive(box.center, box.axes, box.size);
}

template <typename Archive, Either<Grasp> Value>
void exchange(Archive& archive, Value& grasp) {
    archive(grasp.position, grasp.axis, grasp.approach, grasp.opening);
}

template <typename Archive, Either<OpeningMotion> Value>
void exchange(Archive& archive, Value& motion) {
    archive(motion.kind, motion.point, motion.direction, motion.confidence);
}

template <typename Archive, Either<Component> Value>
void exchange(Archive& archive, Value& component) {
    archive(component.id, component.label, component.kind, component.instance, component.parent,
            component.polygon, component.box, component.grasp, component.opens, component.visible,
            component.confidence, component.verdict, component.evidence);
}

template <typename Archive, Either<RoomNeighbor> Value>
void exchange(Archive& archive, Value& neighbor) {
    archive(neighbor.room, neighbor.through);
}

template <typename Archive, Either<Room> Value>
void exchange(Archive& archive, Value& room) {
    archive(room.id, room.polygon, room.floor_height, room.ceiling_height, room.area, room.volume,
            room.walls, room.neighbors);
}

template <typename Archive, Either<Scene> Value>
void exchange(Archive& archive, Value& scene) {
    archive(scene.room_from_map, scene.components, scene.rooms);
}

template <typename Archive, Either<PointLabels> Value>
void exchange(Archive& archive, Value& labels) {
    archive(labels.labels, labels.instances, labels.confidences);
}

template <typename Archive, Either<OutlinedPatch> Value>
void exchange(Archive& archive, Value& patch) {
    archive(patch.normal, patch.points, patch.boundary, patch.lines, patch.rectangles);
}

}  // namespace roomscribe
