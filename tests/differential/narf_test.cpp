// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <pcl/features/narf.h>
#include <pcl/features/range_image_border_extractor.h>
#include <pcl/keypoints/narf_keypoint.h>
#include <pcl/range_image/range_image.h>

#include "rival_clouds.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/registration/features/narf_descriptor.hpp"
#include "roomscribe/registration/features/narf_keypoints.hpp"

namespace roomscribe {
namespace {

constexpr double resolution = radians(0.7);
constexpr double support_size = 0.5;

/// One scan for both libraries, turned into a camera's frame: PCL takes y for "down" whatever frame
/// its image is in.
struct Rivals {
    Scan scan;
    pcl::RangeImage theirs;
    RangeImage ours;

    explicit Rivals(const PointCloud& cloud) {
        scan.cloud.positions = cloud.positions;
        Transform camera_from_laser = Transform::Identity();
        camera_from_laser.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
        transform_in_place(scan.cloud, camera_from_laser);
        const auto angle = static_cast<float>(resolution);
        theirs.createFromPointCloud(*test::to_pcl(scan.cloud.positions), angle, angle,
                                    static_cast<float>(2.0 * std::numbers::pi),
                                    static_cast<float>(std::numbers::pi));
        ours = make_range_image(scan,
                                {.frame = SensorFrame::camera, .angular_resolution = resolution});
    }

    /// Their image as ours, for what comes after it.
    RangeImage same_image() const {
        RangeImage image = ours;
        image.width = static_cast<int>(theirs.width);
        image.height = static_cast<int>(theirs.height);
        image.projection.first_x = theirs.getImageOffsetX() * resolution - std::numbers::pi;
        image.projection.first_y = theirs.getImageOffsetY() * resolution - std::numbers::pi / 2;
        image.ranges.clear();
        image.points.clear();
        for (const pcl::PointWithRange& point : theirs.points) {
            image.ranges.push_back(point.range);
            image.points.emplace_back(point.x, point.y, point.z);
        }
        return image;
    }
};

std::vector<Rivals> rivals() {
    std::vector<Rivals> all;
    const Transform pose(Eigen::Translation3d(1.5, 1.5, 1.4));
    all.emplace_back(
        test::finite_part(test::simulate_scan(test::l_shaped_room(), pose, 1, 4.0).cloud));
    const auto real = test::real_scan("registration/pcl_room_scan/room_scan1.pcd");
    if (!real.empty()) all.emplace_back(test::finite_part(read_scan(real).cloud));
    return all;
}

double share(std::size_t part, std::size_t whole) {
    return static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(whole, 1));
}

TEST(RangeImageAgainstPcl, PixelsAgree) {
    for (const Rivals& rival : rivals()) {
        const RangeImage theirs = rival.same_image();
        ASSERT_EQ(theirs.width, rival.ours.width);
        ASSERT_EQ(theirs.height, rival.ours.height);
        EXPECT_NEAR(theirs.projection.first_x, rival.ours.projection.first_x, 1e-9);
        EXPECT_NEAR(theirs.projection.first_y, rival.ours.projection.first_y, 1e-9);
        std::size_t num_valid = 0;
        std::size_t num_same = 0;
        for (std::size_t i = 0; i < theirs.size(); ++i) {
            if (!theirs.has_range(i) && !rival.ours.has_range(i)) continue;
            ++num_valid;
            if (std::abs(theirs.ranges[i] - rival.ours.ranges[i]) > 1e-4F) continue;
            ++num_same;
            EXPECT_LT((theirs.points[i] - rival.ours.points[i]).norm(), 2e-4F);
        }
        // PCL looks angles up in tables of 20,001 values: a point within 0.003 degrees of a pixel's
        // border may fall into the next.
        EXPECT_GT(share(num_same, num_valid), 0.98);
    }
}

TEST(RangeImageBordersAgainstPcl, TraitsAndSurfaceChangesAgree) {
    for (const Rivals& rival : rivals()) {
        const RangeImage image = rival.same_image();
        const RangeImageBorders ours = find_range_image_borders(image);
        pcl::RangeImageBorderExtractor extractor(&rival.theirs);
        const float* scores = extractor.getSurfaceChangeScores();
        const Eigen::Vector3f* directions = extractor.getSurfaceChangeDirections();
        const auto& descriptions = extractor.getBorderDescriptions();
        std::size_t num_other_traits = 0;
        std::size_t num_changes = 0;
        std::size_t num_other_changes = 0;
        for (std::size_t i = 0; i < image.size(); ++i) {
            const auto& traits = descriptions.points[i].traits;
            const int theirs = (traits[pcl::BORDER_TRAIT__OBSTACLE_BORDER] ? obstacle_border : 0) |
                               (traits[pcl::BORDER_TRAIT__SHADOW_BORDER] ? shadow_border : 0) |
                               (traits[pcl::BORDER_TRAIT__VEIL_POINT] ? veil_point : 0);
            if (theirs != ours.traits[i]) ++num_other_traits;
            if (std::max(scores[i], ours.surface_change_scores[i]) < 0.11F) continue;
            ++num_changes;
            const bool is_same_way =
                std::abs(directions[i].dot(ours.surface_change_directions[i])) > 0.99F;
            if (std::abs(scores[i] - ours.surface_change_scores[i]) > 1e-3F || !is_same_way) {
                ++num_other_changes;
            }
        }
        EXPECT_LT(share(num_other_traits, image.size()), 1e-4);
        EXPECT_GT(num_changes, 1000U);
        // PCL's closed-form eigenvectors in float32 lose a normal now and then.
        EXPECT_LT(share(num_other_changes, num_changes), 0.015);
    }
}

/// A direction of change and its opposite are the same, but PCL's acos() keeps only the horizontal
/// part of it as the scanner sees it: what points down is mirrored, and two changes at right angles
/// may seem to have one direction. Turned upwards beforehand, directions pass PCL unharmed.
void turn_upwards(pcl::RangeImageBorderExtractor& extractor, const RangeImage& image) {
    Eigen::Vector3f* directions = extractor.getSurfaceChangeDirections();
    for (std::size_t i = 0; i < image.size(); ++i) {
        if (!image.has_range(i)) continue;
        const Eigen::Vector3f ray = image.points[i] - image.sensor_position;
        const Eigen::Vector3f above = ray.cross(image.up.cross(ray));
        if (directions[i].dot(above) < 0.0F) directions[i] = -directions[i];
    }
}

struct KeypointAgreement {
    double found = 0.0;   ///< share of theirs that are ours, within 2 pixels
    double shared = 0.0;  ///< share of ours that are theirs
};

KeypointAgreement compare_keypoints(const Rivals& rival, bool with_mended_directions) {
    const RangeImage image = rival.same_image();
    pcl::RangeImageBorderExtractor extractor(&rival.theirs);
    if (with_mended_directions) turn_upwards(extractor, image);
    pcl::NarfKeypoint detector(&extractor, static_cast<float>(support_size));
    const auto& theirs = detector.getInterestPoints();
    const auto ours = detect_narf_keypoints(image, {.support_size = support_size});
    const auto is_same = [&](const auto& their, const NarfKeypoint& our) {
        const float reach = 2.5F * static_cast<float>(resolution) * image.ranges[our.pixel];
        return (our.position - Eigen::Vector3f(their.getVector3fMap())).norm() < reach;
    };
    std::size_t num_found = 0;
    for (const auto& their : theirs.points) {
        num_found += std::any_of(ours.begin(), ours.end(),
                                 [&](const auto& our) { return is_same(their, our); });
    }
    std::size_t num_shared = 0;
    for (const NarfKeypoint& our : ours) {
        num_shared += std::any_of(theirs.points.begin(), theirs.points.end(),
                                  [&](const auto& their) { return is_same(their, our); });
    }
    EXPECT_GT(ours.size(), 10U);
    return {share(num_found, theirs.size()), share(num_shared, ours.size())};
}

TEST(NarfKeypointsAgainstPcl, MostAreTheSame) {
    for (const Rivals& rival : rivals()) {
        const KeypointAgreement mended = compare_keypoints(rival, true);
        // Directions fall into 10 degree bins; PCL sees them from the pixel where it began to look
        // around, we from where they are.
        EXPECT_GT(mended.found, 0.8);
        EXPECT_GT(mended.shared, 0.8);
        const KeypointAgreement as_it_is = compare_keypoints(rival, false);
        EXPECT_GT(as_it_is.found, 0.5);
        EXPECT_GT(as_it_is.shared, 0.5);
    }
}

/// Their descriptor of a pixel; of several, the first. Empty if it has none.
std::vector<float> describe_with_pcl(const pcl::RangeImage& image, int x, int y,
                                     bool rotation_invariant, float& orientation) {
    std::vector<pcl::Narf*> narfs;
    pcl::Narf::extractFromRangeImageAndAddToList(image, static_cast<float>(x),
                                                 static_cast<float>(y), narf_size, support_size,
                                                 rotation_invariant, narfs);
    std::vector<float> values;
    if (!narfs.empty()) {
        values.assign(narfs.front()->getDescriptor(), narfs.front()->getDescriptor() + narf_size);
        orientation = narfs.front()->getSurfacePatchRotation();
    }
    for (pcl::Narf* narf : narfs)
        delete narf;
    return values;
}

/// Shares of the keypoints' descriptors that differ by less than 0.01 per value.
double compare_descriptors(const Rivals& rival, bool rotation_invariant) {
    const RangeImage image = rival.same_image();
    std::vector<std::uint32_t> pixels;
    for (const auto& keypoint : detect_narf_keypoints(image, {.support_size = support_size})) {
        pixels.push_back(keypoint.pixel);
    }
    const NarfDescriptors ours = compute_narf(
        image, pixels, {.support_size = support_size, .rotation_invariant = rotation_invariant});
    std::size_t num_same = 0;
    std::size_t num_compared = 0;
    for (std::size_t column = 0; column < ours.keypoints.size(); ++column) {
        // Of the further orientations PCL loses those below the first one: it compares a signed
        // difference of angles with 70 degrees. The unit tests hold ours against a pillar.
        if (column > 0 && ours.keypoints[column] == ours.keypoints[column - 1]) continue;
        ++num_compared;
        const std::uint32_t pixel = pixels[ours.keypoints[column]];
        float orientation = 0.0F;
        const std::vector<float> theirs = describe_with_pcl(
            rival.theirs, image.column(pixel), image.row(pixel), rotation_invariant, orientation);
        if (theirs.empty()) continue;
        const double turn =
            std::remainder(orientation - ours.orientations[column], 2.0 * std::numbers::pi);
        const float difference = (ours.values.col(static_cast<Eigen::Index>(column)) -
                                  Eigen::Map<const Eigen::VectorXf>(theirs.data(), narf_size))
                                     .lpNorm<1>();
        if (std::abs(turn) < 1e-3 && difference < 0.01F * narf_size) ++num_same;
    }
    EXPECT_GT(num_compared, 10U);
    return share(num_same, num_compared);
}

TEST(NarfDescriptorsAgainstPcl, ValuesAgree) {
    for (const Rivals& rival : rivals()) {
        // PCL's closed-form eigenvectors in float32 lose a normal now and then.
        EXPECT_GT(compare_descriptors(rival, false), 0.9);
        EXPECT_GT(compare_descriptors(rival, true), 0.9);
    }
}

}  // namespace
}  // namespace roomscribe
