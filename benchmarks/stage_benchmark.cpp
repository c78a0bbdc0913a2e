// SPDX-License-Identifier: MIT
// stage_benchmark TARGET SOURCE [REPETITIONS]: times every stage beside PCL's on the same input.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <functional>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "pcl_stages.hpp"
#include "roomscribe/core/random.hpp"
#include "roomscribe/core/units.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "roomscribe/preprocessing/normal_estimation.hpp"
#include "roomscribe/preprocessing/scan_statistics.hpp"
#include "roomscribe/preprocessing/voxel_grid.hpp"
#include "roomscribe/registration/alignment/icp.hpp"
#include "roomscribe/registration/features/correspondence_rejection.hpp"
#include "roomscribe/registration/features/correspondences.hpp"
#include "roomscribe/registration/features/narf_descriptor.hpp"
#include "roomscribe/registration/features/narf_keypoints.hpp"
#include "roomscribe/registration/scan_registration.hpp"
#include "roomscribe/structure/plane_growing.hpp"
#include "roomscribe/structure/surface_sample.hpp"

namespace roomscribe::benchmark {
namespace {

constexpr double voxel_size = 0.1;
constexpr double fine_voxel_size = 0.05;
constexpr double fpfh_radius = 0.5;
constexpr double inlier_distance = 0.15;
constexpr double icp_reach = 0.3;
constexpr double plane_tolerance = 0.03;

Context two_threads() {
    Context context;
    context.num_threads = 2;
    return context;
}

using Stage = std::function<void()>;

double milliseconds(const Stage& stage) {
    const auto start = std::chrono::steady_clock::now();
    stage();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
        .count();
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

/// The two take turns, so that a busy machine slows both.
void compare(std::string_view name, std::string_view input, int repetitions, const Stage& ours,
             const Stage& theirs) {
    std::vector<double> our_times;
    std::vector<double> their_times;
    for (int i = 0; i < repetitions; ++i) {
        our_times.push_back(milliseconds(ours));
        their_times.push_back(milliseconds(theirs));
    }
    fmt::print("{:<28} {:<26} {:>9.1f} {:>9.1f} {:>7.1f}x\n", name, input, median(our_times),
               median(their_times), median(their_times) / median(our_times));
    std::fflush(stdout);
}

/// One scan on its way through our stages.
struct Ours {
    Scan scan;
    std::vector<Eigen::Vector3f> points;
    SearchTree tree{{}};
    std::vector<Eigen::Vector3f> normals;
    FpfhDescriptors descriptors;

    void thin(double size) {
        points = downsample_voxel_grid(scan.cloud, {.voxel_size = size}).cloud.positions;
    }
    void find_normals() {
        tree = SearchTree(points);
        normals = estimate_normals(points, tree, scan.sensor_position(), {.num_neighbors = 20},
                                   two_threads())
                      .normals;
    }
    void describe() {
        std::vector<std::uint32_t> all(points.size());
        std::iota(all.begin(), all.end(), 0U);
        // The tree is made anew, as PCL does.
        descriptors = compute_fpfh(points, normals, SearchTree(points), all,
                                   {.radius = fpfh_radius}, two_threads());
    }
};

std::vector<PointMatch> point_matches(const Ours& source, const Ours& target,
                                      const std::vector<Correspondence>& pairs) {
    std::vector<PointMatch> matches;
    for (const Correspondence& pair : pairs) {
        matches.push_back({source.points[pair.source].cast<double>(),
                           target.points[pair.target].cast<double>(),
                           source.normals[pair.source].cast<double>(),
                           target.normals[pair.target].cast<double>()});
    }
    return matches;
}

void print_difference(std::string_view what, const Transform& a, const Transform& b) {
    const Transform difference = a.inverse() * b;
    fmt::print("    {}: {:.3f} m and {:.2f} degrees apart\n", what, difference.translation().norm(),
               degrees(rotation_angle(difference.linear())));
}

Transform compare_registration_stages(Ours& target, Ours& source, PclScan& pcl_target,
                                      PclScan& pcl_source, int repetitions) {
    const std::string raw_size = fmt::format("{} points", source.scan.cloud.size());
    compare(
        "voxel grid 0.1 m", raw_size, repetitions, [&] { source.thin(voxel_size); },
        [&] { PclStages::downsample(pcl_source, voxel_size); });
    compare(
        "voxel grid 0.05 m", raw_size, repetitions, [&] { source.thin(fine_voxel_size); },
        [&] { PclStages::downsample(pcl_source, fine_voxel_size); });
    PclStages::set_points(pcl_source, source.points, {});
    compare(
        "normals, k = 20", fmt::format("{} points", source.points.size()), repetitions,
        [&] { source.find_normals(); }, [&] { PclStages::estimate_normals(pcl_source, 20); });

    for (Ours* scan : {&target, &source}) {
        scan->thin(voxel_size);
        scan->find_normals();
    }
    PclStages::set_points(pcl_target, target.points, target.normals);
    PclStages::set_points(pcl_source, source.points, source.normals);
    target.describe();
    compare(
        "FPFH, radius 0.5 m", fmt::format("{} points", source.points.size()), repetitions,
        [&] { source.describe(); }, [&] { PclStages::describe(pcl_source, fpfh_radius); });
    PclStages::set_descriptors(pcl_target, target.descriptors);
    PclStages::set_descriptors(pcl_source, source.descriptors);

    std::vector<Correspondence> pairs;
    compare(
        "matching, both ways", fmt::format("{} x {}", source.points.size(), target.points.size()),
        repetitions,
        [&] {
            pairs = match_descriptors(source.descriptors, target.descriptors, {}, two_threads());
        },
        [&] { PclStages::match(pcl_source, pcl_target); });

    const std::vector<PointMatch> matches = point_matches(source, target, pairs);
    RejectionResult rejection;
    Transform theirs = Transform::Identity();
    compare(
        "sample-consensus pose", fmt::format("{} matches", matches.size()), repetitions,
        [&] {
            rejection =
                reject_by_sample_consensus(matches, 1, {.inlier_distance = inlier_distance});
        },
        [&] { theirs = PclStages::reject(pcl_source, pcl_target, inlier_distance); });
    const Transform guess = rejection.target_from_source.value_or(Transform::Identity());
    print_difference("poses found by consensus", guess, theirs);
    return guess;
}

void compare_icp(Ours& target, Ours& source, PclScan& pcl_target, PclScan& pcl_source,
                 const Transform& guess, int repetitions) {
    for (Ours* scan : {&target, &source}) {
        scan->thin(fine_voxel_size);
        scan->find_normals();
    }
    PclStages::set_points(pcl_target, target.points, target.normals);
    PclStages::set_points(pcl_source, source.points, source.normals);
    Transform theirs = Transform::Identity();
    const std::array<std::pair<IcpMethod, std::string_view>, 3> methods{{
        {IcpMethod::point_to_point, "ICP, both point-to-point"},
        {IcpMethod::point_to_plane, "ICP, ours point-to-plane"},
        {IcpMethod::generalized, "ICP, ours generalized"},
    }};
    for (const auto& [method, name] : methods) {
        IcpResult result;
        const IcpSettings settings{.method = method,
                                   .max_correspondence_distance = icp_reach,
                                   .kernel = method == IcpMethod::point_to_point
                                                 ? RobustKernel::none
                                                 : RobustKernel::tukey};
        compare(
            name, fmt::format("{} points", source.points.size()), repetitions,
            [&] {
                result = align_icp({source.points, source.normals},
                                   {target.points, target.normals, target.tree}, guess, settings,
                                   two_threads());
            },
            [&] { theirs = PclStages::align(pcl_source, pcl_target, guess, icp_reach); });
        print_difference("aligned poses", result.target_from_source, theirs);
    }
}

void compare_narf(const Ours& scan, const PclScan& pcl_scan, int repetitions) {
    constexpr double angular_resolution = radians(0.5);
    for (const double support_size : {0.2, 0.5}) {
        std::size_t num_ours = 0;
        std::size_t num_theirs = 0;
        compare(
            fmt::format("NARF, all, support {} m", support_size),
            fmt::format("{} points", scan.scan.cloud.size()), repetitions,
            [&] {
                const Context context = two_threads();
                const RangeImage image = make_range_image(
                    scan.scan, {.angular_resolution = angular_resolution}, context);
                std::vector<std::uint32_t> pixels;
                for (const NarfKeypoint& keypoint :
                     detect_narf_keypoints(image, {.support_size = support_size}, context)) {
                    pixels.push_back(keypoint.pixel);
                }
                compute_narf(image, pixels, {.support_size = support_size}, context);
                num_ours = pixels.size();
            },
            [&] { num_theirs = PclStages::find_narf(pcl_scan, angular_resolution, support_size); });
        fmt::print("    keypoints: ours {}, PCL {}\n", num_ours, num_theirs);
    }
}

void compare_planes(const Ours& scan, const PclScan& pcl_scan, int repetitions) {
    std::size_t num_ours = 0;
    std::size_t num_theirs = 0;
    const ScanMap map = map_of_cloud(scan.scan);
    compare(
        "planes", fmt::format("{} points", scan.scan.cloud.size()), repetitions,
        [&] {
            const Context context = two_threads();
            const ScanStatistics statistics = estimate_scan_statistics(map.cloud, context);
            PointCloud sample = sample_surface(map, statistics, {}, context).cloud;
            std::vector<std::uint32_t> with_normal;
            for (std::uint32_t i = 0; i < sample.size(); ++i) {
                if (sample.normals[i].allFinite()) with_normal.push_back(i);
            }
            sample = select_points(sample, with_normal);
            num_ours = grow_planar_patches(sample, {.distance_tolerance = plane_tolerance}, context)
                           .size();
        },
        [&] { num_theirs = PclStages::detect_planes(pcl_scan, plane_tolerance, 2500); });
    fmt::print("    ours: connected patches, {}; PCL: RANSAC planes, {}\n", num_ours, num_theirs);
}

void compare_whole(const std::filesystem::path& target_path,
                   const std::filesystem::path& source_path, int repetitions) {
    RegistrationLink link;
    Transform theirs = Transform::Identity();
    compare(
        "files to pose", "2 scans", repetitions,
        [&] {
            const std::vector<Scan> scans = {read_scan(target_path), read_scan(source_path)};
            link = register_scans(scans, 1, {}, two_threads()).registration.links.front();
        },
        [&] {
            PclScan target;
            PclScan source;
            const auto prepare = [](PclScan& scan, const std::filesystem::path& path) {
                PclStages::read(scan, path);
                PclStages::downsample(scan, voxel_size);
                PclStages::estimate_normals(scan, 20);
                PclStages::describe(scan, fpfh_radius);
            };
            prepare(target, target_path);
            prepare(source, source_path);
            PclStages::match(source, target);
            const Transform guess = PclStages::reject(source, target, inlier_distance);
            PclStages::downsample(target, fine_voxel_size);
            PclStages::downsample(source, fine_voxel_size);
            theirs = PclStages::align(source, target, guess, icp_reach);
        });
    fmt::print("    ours: {}; PCL gives no verdict\n", link_verdict_name(link.verdict));
    print_difference("poses", link.target_from_source, theirs);
}

/// Reading of every format that we write, from files that lie in memory already; PCL has readers of
/// PCD and PLY. Ours on one thread and with all.
void compare_readers(int repetitions) {
    constexpr std::size_t num_points = 4'000'000;
    PointCloud cloud;
    Random random(1);
    for (std::size_t i = 0; i < num_points; ++i) {
        cloud.positions.emplace_back(Eigen::Vector3d(random.uniform(-5.0, 5.0),
                                                     random.uniform(-5.0, 5.0),
                                                     random.uniform(0.0, 3.0))
                                         .cast<float>());
    }
    fmt::print("\n{:<28} {:>16} {:>16} {:>16}\n", "reading, M points/s", "ours, 1 thread",
               "ours, all", "PCL");
    const auto compare_file = [&](const char* extension, Encoding encoding) {
        const std::filesystem::path path =
            std::filesystem::temp_directory_path() / fmt::format("stage_benchmark.{}", extension);
        write_point_cloud(path, cloud, {.encoding = encoding});
        const std::string_view kind(extension);
        const bool pcl_reads = kind == "pcd" || kind == "ply";
        std::array<std::vector<double>, 3> times;
        for (int i = 0; i < repetitions; ++i) {
            Context one_thread;
            one_thread.num_threads = 1;
            times[0].push_back(milliseconds([&] { read_scan(path, one_thread); }));
            times[1].push_back(milliseconds([&] { read_scan(path); }));
            PclScan theirs;
            if (pcl_reads) times[2].push_back(milliseconds([&] { PclStages::read(theirs, path); }));
        }
        std::filesystem::remove(path);
        fmt::print("{:<28}",
                   fmt::format("{}{}", extension, encoding == Encoding::ascii ? ", ascii" : ""));
        for (const std::vector<double>& column : times) {
            const std::string rate =
                column.empty() ? "-" : fmt::format("{:.1f}", num_points / median(column) / 1e3);
            fmt::print(" {:>16}", rate);
        }
        fmt::print("\n");
    };
    for (const char* const extension : {"ply", "pcd", "las", "e57"})
        compare_file(extension, Encoding::automatic);
    for (const char* const extension : {"ply", "pcd", "xyz"})
        compare_file(extension, Encoding::ascii);
}

void run(const std::filesystem::path& target_path, const std::filesystem::path& source_path,
         int repetitions) {
    fmt::print("{:<28} {:<26} {:>9} {:>9} {:>8}\n", "stage", "input", "ours, ms", "PCL, ms",
               "faster");
    Ours target;
    Ours source;
    PclScan pcl_target;
    PclScan pcl_source;
    target.scan = read_scan(target_path);
    PclStages::read(pcl_target, target_path);
    compare(
        "read", source_path.filename().string(), repetitions,
        [&] { source.scan = read_scan(source_path); },
        [&] { PclStages::read(pcl_source, source_path); });
    const Transform guess =
        compare_registration_stages(target, source, pcl_target, pcl_source, repetitions);
    compare_icp(target, source, pcl_target, pcl_source, guess, repetitions);
    compare_narf(target, pcl_target, std::min(repetitions, 3));
    compare_planes(target, pcl_target, std::min(repetitions, 3));
    compare_whole(target_path, source_path, std::min(repetitions, 3));
    compare_readers(std::min(repetitions, 3));
}

}  // namespace
}  // namespace roomscribe::benchmark

int main(int argc, char** argv) {
    if (argc < 3 || argc > 4) {
        fmt::print(stderr, "usage: stage_benchmark TARGET SOURCE [REPETITIONS]\n");
        return 2;
    }
    try {
        roomscribe::benchmark::run(argv[1], argv[2],
                                   argc > 3 ? std::max(1, std::atoi(argv[3])) : 5);
    } catch (const std::exception& error) {
        fmt::print(stderr, "stage_benchmark: {}\n", error.what());
        return 3;
    }
    return 0;
}
