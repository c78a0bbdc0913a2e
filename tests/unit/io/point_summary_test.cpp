// SPDX-License-Identifier: MIT
#include "roomscribe/io/point_summary.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "support/contexts.hpp"
#include "support/test_data.hpp"

namespace roomscribe {
namespace {

PointCloud random_cloud(std::size_t num_points) {
    PointCloud cloud;
    Random random(7, 0);
    for (std::size_t i = 0; i < num_points; ++i) {
        const auto next = [&] { return static_cast<float>(random.uniform(-4.0, 4.0)); };
        cloud.positions.emplace_back(next(), next(), next());
        if (i % 100 == 7) cloud.positions.back().y() = std::nanf("");
    }
    return cloud;
}

/// What is said of a file whose points were not kept is what they say once they are read.
TEST(PointSummary, AgreesWithThePointsInEveryFormat) {
    const test::TemporaryFolder folder;
    PointCloud cloud = random_cloud(50001);
    for (const double shift : {0.0, 4500100.0}) {
        cloud.global_shift = {shift, -shift, 0.0};
        for (const char* name : {"a.pcd", "a.ply", "a.las", "a.e57", "a.xyz", "a.csv", "a.3d"}) {
            write_point_cloud(folder / name, cloud);
            const PointCloud read = read_scan(folder / name).cloud;
            const FileSummary summary = summarize_file(folder / name).front();
            Eigen::AlignedBox3d bounds;
            const std::vector<std::uint32_t> finite = finite_points(read);
            for (const std::uint32_t i : finite)
                bounds.extend(read.positions[i].cast<double>() + read.global_shift);
            EXPECT_EQ(summary.num_points, read.size()) << name;
            EXPECT_EQ(summary.num_non_finite, read.size() - finite.size()) << name;
            EXPECT_EQ(summary.bounds.min(), bounds.min()) << name;
            EXPECT_EQ(summary.bounds.max(), bounds.max()) << name;
        }
    }
}

TEST(PointSummary, IsTheSameInPieces) {
    const PointCloud cloud = random_cloud(45678);
    const std::span<const Eigen::Vector3f> all = cloud.positions;
    const PointSummary whole = summarize_points(all, 0, all.size());
    PointSummary pieces;
    constexpr std::size_t piece = 1001;
    for (std::size_t first = 0; first < all.size(); first += piece) {
        const auto part = all.subspan(first, std::min(piece, all.size() - first));
        pieces = joined(std::move(pieces), summarize_points(part, first, all.size()));
    }
    EXPECT_EQ(pieces.num_points, whole.num_points);
    EXPECT_EQ(pieces.num_finite, whole.num_finite);
    EXPECT_EQ(pieces.bounds.min(), whole.bounds.min());
    EXPECT_EQ(pieces.bounds.max(), whole.bounds.max());
    ASSERT_EQ(pieces.sample.size(), whole.sample.size());
    EXPECT_GE(whole.sample.size(), 10000U);
    EXPECT_EQ(median_distance(pieces.sample), median_distance(all));
}

}  // namespace
}  // namespace roomscribe
