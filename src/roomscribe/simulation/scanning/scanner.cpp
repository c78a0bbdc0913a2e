// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/scanning/scanner.hpp"

#include <limits>

#include "roomscribe/core/units.hpp"
#include "roomscribe/simulation/scanning/depth_camera.hpp"
#include "roomscribe/simulation/scanning/lidar.hpp"
#include "roomscribe/simulation/scanning/scanner_model.hpp"

namespace roomscribe {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

Transform scanner_pose(ScannerKind scanner, const Station& station) {
    Transform world_from_scan = Transform::Identity();
    world_from_scan.translate(station.at);
    world_from_scan.rotate(AngleAxisd(radians(station.heading), Vector3d::UnitZ()));
    world_from_scan.rotate(AngleAxisd(radians(station.pitch), Vector3d::UnitY()));
    world_from_scan.rotate(AngleAxisd(radians(station.roll), Vector3d::UnitX()));
    if (scanner == ScannerKind::structured_light) {
        Eigen::Matrix3d body_from_camera;
        body_from_camera.col(0) = -Vector3d::UnitY();
        body_from_camera.col(1) = -Vector3d::UnitZ();
        body_from_camera.col(2) = Vector3d::UnitX();
        world_from_scan.rotate(body_from_camera);
    }
    return world_from_scan;
}

bool is_in_view(ScannerKind scanner, const Vector3d& point_in_scan) {
    return is_in_view(scanner_model(scanner), point_in_scan);
}

SimulatedScan scan_world(const RayCaster& caster, ScannerKind scanner, double coarseness,
                         const Station& station, std::uint64_t seed, const Context& context) {
    const ScannerModel model = scanner_model(scanner, coarseness);
    const std::size_t count = model.num_rows() * model.num_columns;
    SimulatedScan scan;
    scan.world_from_scan = scanner_pose(scanner, station);
    PointCloud& cloud = scan.scan.cloud;
    cloud.grid = ScanGrid{model.num_rows(), model.num_columns};
    cloud.sensor_pose = Transform::Identity();
    cloud.positions.assign(count,
                           Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
    scan.labels.assign(count, Label::unknown);
    scan.instances.assign(count, -1);
    scan.acceptable.assign(count, label_bit(Label::unknown));
    if (model.pattern == ScanPattern::image) {
        scan_by_pattern(scan, caster, model, seed, context);
    } else {
        cloud.intensities.assign(count, 0.0F);
        scan_by_beams(scan, caster, model, seed, context);
    }
    return scan;
}

}  // namespace roomscribe
