// SPDX-License-Identifier: MIT
#include "roomscribe/report/report_views.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "roomscribe/core/quantile.hpp"

namespace roomscribe {
namespace {

constexpr double margin = 0.35;  // m around what is shown

/// The middle 98 % of the points along each axis, from at most 200,000 of them.
Eigen::AlignedBox3d box_of_points(const Reconstruction& reconstruction) {
    constexpr std::size_t max_sample = 200'000;
    const std::vector<Eigen::Vector3f>& points = reconstruction.map.cloud.positions;
    const std::size_t step = points.size() / max_sample + 1;
    std::array<std::vector<double>, 3> values;
    for (std::size_t i = 0; i < points.size(); i += step) {
        if (!is_finite(points[i])) continue;
        const Eigen::Vector3d p = reconstruction.scene.room_from_map * points[i].cast<double>();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            values[axis].push_back(p(static_cast<Eigen::Index>(axis)));
        }
    }
    Eigen::AlignedBox3d box;
    if (values[0].empty()) return box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.min()(static_cast<Eigen::Index>(axis)) = quantile(values[axis], 0.01);
        box.max()(static_cast<Eigen::Index>(axis)) = quantile(values[axis], 0.99);
    }
    return box;
}

Eigen::AlignedBox3d with_margin(Eigen::AlignedBox3d box) {
    if (box.isEmpty()) box = Eigen::AlignedBox3d(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
    return {box.min() - Eigen::Vector3d::Constant(margin),
            box.max() + Eigen::Vector3d::Constant(margin)};
}

/// A view whose picture edges and depth are room axes; the rows of `view_from_room` say which.
RoomView view_along(const Reconstruction& reconstruction, const Eigen::Matrix3d& view_from_room,
                    const Eigen::AlignedBox3d& box, std::size_t width) {
    const auto axis_of = [&view_from_room](Eigen::Index row) {
        PictureAxis axis;
        const Eigen::RowVector3d direction = view_from_room.row(row);
        direction.cwiseAbs().maxCoeff(&axis.axis);
        axis.sign = direction(axis.axis);
        return axis;
    };
    Transform rotation = Transform::Identity();
    rotation.linear() = view_from_room;
    const Eigen::Vector3d corner = view_from_room * box.min();
    const Eigen::Vector3d opposite = view_from_room * box.max();
    RoomView view;
    view.view.view_from_cloud = rotation * reconstruction.scene.room_from_map;
    view.view.low = corner.cwiseMin(opposite);
    view.view.high = corner.cwiseMax(opposite);
    view.view.width = width;
    view.horizontal = axis_of(0);
    view.vertical = axis_of(1);
    return view;
}

}  // namespace

bool has_labels(const Reconstruction& reconstruction) {
    const std::size_t size = reconstruction.map.cloud.size();
    return size > 0 && reconstruction.labels.labels.size() == size;
}

Eigen::AlignedBox3d interesting_box(const Reconstruction& reconstruction) {
    const Scene& scene = reconstruction.scene;
    Eigen::AlignedBox3d box;
    for (const Room& room : scene.rooms) {
        for (const Eigen::Vector3d& corner : room.polygon) {
            Eigen::Vector3d in_room = scene.room_from_map * corner;
            in_room.z() = room.floor_height;
            box.extend(in_room);
            in_room.z() = room.ceiling_height;
            box.extend(in_room);
        }
    }
    for (const Component& component : scene.components) {
        if (component.verdict == Verdict::rejected) continue;
        for (const Eigen::Vector3d& corner : component.polygon) {
            box.extend(Eigen::Vector3d(scene.room_from_map * corner));
        }
    }
    if (box.isEmpty()) box = box_of_points(reconstruction);
    return with_margin(box);
}

Eigen::AlignedBox3d scanned_box(const Reconstruction& reconstruction) {
    Eigen::AlignedBox3d box = interesting_box(reconstruction);
    for (const MapSection& section : reconstruction.map.sections) {
        if (!section.sensor_position) continue;
        box.extend(Eigen::Vector3d(reconstruction.scene.room_from_map * *section.sensor_position));
    }
    return with_margin(box);
}

RoomView plan_view(const Reconstruction& reconstruction, const Eigen::AlignedBox3d& box,
                   std::size_t width) {
    const Eigen::Vector3d sizes = interesting_box(reconstruction).sizes();
    Eigen::Matrix3d view_from_room = Eigen::Matrix3d::Identity();
    if (sizes.y() > sizes.x()) view_from_room << 0, 1, 0, -1, 0, 0, 0, 0, 1;
    return view_along(reconstruction, view_from_room, box, width);
}

RoomView section_view(const Reconstruction& reconstruction, const Eigen::AlignedBox3d& box,
                      std::size_t width) {
    Eigen::Matrix3d view_from_room;
    Eigen::AlignedBox3d behind = box;
    if (box.sizes().y() > box.sizes().x()) {
        view_from_room << 0, 1, 0, 0, 0, 1, 1, 0, 0;
        behind.max().x() = box.center().x();
    } else {
        view_from_room << 1, 0, 0, 0, 0, 1, 0, -1, 0;
        behind.min().y() = box.center().y();
    }
    return view_along(reconstruction, view_from_room, behind, width);
}

}  // namespace roomscribe
