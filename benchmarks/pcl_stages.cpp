// SPDX-License-Identifier: MIT
#include "pcl_stages.hpp"

#include <numbers>

#include <pcl/features/fpfh_omp.h>
#include <pcl/features/narf_descriptor.h>
#include <pcl/features/normal_3d_omp.h>
#include <pcl/features/range_image_border_extractor.h>
#include <pcl/filters/extract_indices.h>
#include <pcl/filters/filter.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/keypoints/narf_keypoint.h>
#include <pcl/point_types.h>
#include <pcl/range_image/range_image.h>
#include <pcl/registration/correspondence_estimation.h>
#include <pcl/registration/correspondence_rejection_sample_consensus.h>
#include <pcl/registration/icp.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/sac_segmentation.h>

namespace roomscribe::benchmark {
namespace {

using Points = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;
using Signatures = pcl::PointCloud<pcl::FPFHSignature33>;

constexpr int num_threads = 2;

}  // namespace

struct PclScan::Data {
    Points::Ptr raw = std::make_shared<Points>();
    Points::Ptr points = std::make_shared<Points>();
    Normals::Ptr normals = std::make_shared<Normals>();
    Signatures::Ptr signatures = std::make_shared<Signatures>();
    pcl::CorrespondencesPtr matches = std::make_shared<pcl::Correspondences>();
};

PclScan::PclScan() : data(std::make_unique<Data>()) {}
PclScan::~PclScan() = default;

void PclStages::read(PclScan& scan, const std::filesystem::path& path) {
    Points all;
    if (path.extension() == ".ply") {
        pcl::io::loadPLYFile(path.string(), all);
    } else {
        pcl::io::loadPCDFile(path.string(), all);
    }
    all.is_dense = false;
    std::vector<int> kept;
    pcl::removeNaNFromPointCloud(all, *scan.data->raw, kept);
}

void PclStages::set_points(PclScan& scan, std::span<const Eigen::Vector3f> positions,
                           std::span<const Eigen::Vector3f> normals) {
    scan.data->points = std::make_shared<Points>();
    for (const Eigen::Vector3f& point : positions) {
        scan.data->points->push_back(pcl::PointXYZ(point.x(), point.y(), point.z()));
    }
    scan.data->normals = std::make_shared<Normals>();
    for (const Eigen::Vector3f& normal : normals) {
        scan.data->normals->push_back(pcl::Normal(normal.x(), normal.y(), normal.z()));
    }
}

void PclStages::set_descriptors(PclScan& scan, const FpfhDescriptors& descriptors) {
    scan.data->signatures = std::make_shared<Signatures>();
    for (Eigen::Index i = 0; i < descriptors.cols(); ++i) {
        pcl::FPFHSignature33 signature;
        Eigen::Map<Eigen::VectorXf>(signature.histogram, fpfh_size) = descriptors.col(i);
        scan.data->signatures->push_back(signature);
    }
}

void PclStages::downsample(PclScan& scan, double voxel_size) {
    pcl::VoxelGrid<pcl::PointXYZ> filter;
    filter.setInputCloud(scan.data->raw);
    const auto size = static_cast<float>(voxel_size);
    filter.setLeafSize(size, size, size);
    scan.data->points = std::make_shared<Points>();
    filter.filter(*scan.data->points);
}

void PclStages::estimate_normals(PclScan& scan, int num_neighbors) {
    pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation(num_threads);
    estimation.setInputCloud(scan.data->points);
    estimation.setSearchMethod(std::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
    estimation.setKSearch(num_neighbors);
    scan.data->normals = std::make_shared<Normals>();
    estimation.compute(*scan.data->normals);
}

void PclStages::describe(PclScan& scan, double radius) {
    pcl::FPFHEstimationOMP<pcl::PointXYZ, pcl::Normal, pcl::FPFHSignature33> estimation(
        num_threads);
    estimation.setInputCloud(scan.data->points);
    estimation.setInputNormals(scan.data->normals);
    estimation.setSearchMethod(std::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
    estimation.setRadiusSearch(radius);
    scan.data->signatures = std::make_shared<Signatures>();
    estimation.compute(*scan.data->signatures);
}

std::size_t PclStages::find_narf(const PclScan& scan, double angular_resolution,
                                 double support_size) {
    pcl::RangeImage image;
    const auto angle = static_cast<float>(angular_resolution);
    constexpr float pi = std::numbers::pi_v<float>;
    image.createFromPointCloud(*scan.data->raw, angle, angle, 2.0F * pi, pi,
                               Eigen::Affine3f::Identity(), pcl::RangeImage::LASER_FRAME);
    pcl::RangeImageBorderExtractor extractor;
    extractor.getParameters().max_no_of_threads = num_threads;
    pcl::NarfKeypoint detector(&extractor, static_cast<float>(support_size));
    detector.getParameters().max_no_of_threads = num_threads;
    detector.setRangeImage(&image);
    pcl::PointCloud<int> keypoints;
    detector.compute(keypoints);
    const pcl::Indices pixels(keypoints.begin(), keypoints.end());
    pcl::NarfDescriptor descriptor(&image, &pixels);
    descriptor.getParameters().support_size = static_cast<float>(support_size);
    pcl::PointCloud<pcl::Narf36> narfs;
    descriptor.compute(narfs);
    return keypoints.size();
}

std::size_t PclStages::match(PclScan& source, const PclScan& target) {
    pcl::registration::CorrespondenceEstimation<pcl::FPFHSignature33, pcl::FPFHSignature33>
        estimation;
    estimation.setInputSource(source.data->signatures);
    estimation.setInputTarget(target.data->signatures);
    estimation.determineReciprocalCorrespondences(*source.data->matches);
    return source.data->matches->size();
}

Transform PclStages::reject(const PclScan& source, const PclScan& target, double inlier_distance) {
    pcl::registration::CorrespondenceRejectorSampleConsensus<pcl::PointXYZ> rejector;
    rejector.setInputSource(source.data->points);
    rejector.setInputTarget(target.data->points);
    rejector.setInlierThreshold(inlier_distance);
    rejector.setMaximumIterations(100'000);
    rejector.setInputCorrespondences(source.data->matches);
    pcl::Correspondences kept;
    rejector.getCorrespondences(kept);
    return Transform(rejector.getBestTransformation().cast<double>());
}

Transform PclStages::align(const PclScan& source, const PclScan& target, const Transform& guess,
                           double max_distance) {
    pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp;
    icp.setInputSource(source.data->points);
    icp.setInputTarget(target.data->points);
    icp.setMaxCorrespondenceDistance(max_distance);
    icp.setMaximumIterations(100);
    icp.setTransformationEpsilon(1e-9);
    Points aligned;
    icp.align(aligned, guess.matrix().cast<float>());
    return Transform(icp.getFinalTransformation().cast<double>());
}

std::size_t PclStages::detect_planes(const PclScan& scan, double tolerance, int min_inliers) {
    pcl::SACSegmentation<pcl::PointXYZ> segmentation;
    segmentation.setModelType(pcl::SACMODEL_PLANE);
    segmentation.setMethodType(pcl::SAC_RANSAC);
    segmentation.setOptimizeCoefficients(true);
    segmentation.setDistanceThreshold(tolerance);
    segmentation.setMaxIterations(1000);
    pcl::ExtractIndices<pcl::PointXYZ> extraction;
    Points::Ptr left = scan.data->raw;
    std::size_t num_planes = 0;
    while (left->size() >= static_cast<std::size_t>(min_inliers)) {
        auto inliers = std::make_shared<pcl::PointIndices>();
        pcl::ModelCoefficients coefficients;
        segmentation.setInputCloud(left);
        segmentation.segment(*inliers, coefficients);
        if (inliers->indices.size() < static_cast<std::size_t>(min_inliers)) break;
        ++num_planes;
        extraction.setInputCloud(left);
        extraction.setIndices(inliers);
        extraction.setNegative(true);
        auto rest = std::make_shared<Points>();
        extraction.filter(*rest);
        left = rest;
    }
    return num_planes;
}

}  // namespace roomscribe::benchmark
