// SPDX-License-Identifier: MIT
#include "roomscribe/registration/graph/pair_proposal.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "roomscribe/core/parallel.hpp"

namespace roomscribe {
namespace {

/// Mutually nearest places of two signatures.
std::vector<std::pair<Eigen::Index, Eigen::Index>> match_mutually(const ScanSignature& a,
                                                                  const ScanSignature& b) {
    std::vector<std::pair<Eigen::Index, Eigen::Index>> matches;
    if (a.positions.empty() || b.positions.empty()) return matches;
    Eigen::MatrixXf distances = -2.0F * (a.descriptors.transpose() * b.descriptors);
    distances.colwise() += a.squared_norms;
    distances.rowwise() += b.squared_norms.transpose();
    std::vector<Eigen::Index> nearest_in_a(b.positions.size());
    for (Eigen::Index j = 0; j < distances.cols(); ++j) {
        distances.col(j).minCoeff(&nearest_in_a[static_cast<std::size_t>(j)]);
    }
    for (Eigen::Index i = 0; i < distances.rows(); ++i) {
        Eigen::Index j = 0;
        distances.row(i).minCoeff(&j);
        if (nearest_in_a[static_cast<std::size_t>(j)] == i) matches.emplace_back(i, j);
    }
    return matches;
}

/// Whether two matches can belong to one rigid motion.
bool are_compatible(const ScanSignature& a, const ScanSignature& b,
                    const std::pair<Eigen::Index, Eigen::Index>& first,
                    const std::pair<Eigen::Index, Eigen::Index>& second, float length_tolerance) {
    const auto edge = [](const ScanSignature& scan, Eigen::Index from, Eigen::Index to) {
        return Eigen::Vector3f(scan.positions[static_cast<std::size_t>(to)] -
                               scan.positions[static_cast<std::size_t>(from)]);
    };
    const Eigen::Vector3f edge_a = edge(a, first.first, second.first);
    const Eigen::Vector3f edge_b = edge(b, first.second, second.second);
    const float length = edge_a.norm();
    // Places side by side match side by side wherever they are.
    if (length < 4.0F * length_tolerance || std::abs(length - edge_b.norm()) > length_tolerance) {
        return false;
    }
    constexpr float max_difference = 0.35F;
    const auto normal = [](const ScanSignature& scan, Eigen::Index at) -> const Eigen::Vector3f& {
        return scan.normals[static_cast<std::size_t>(at)];
    };
    const Eigen::Vector3f& first_a = normal(a, first.first);
    const Eigen::Vector3f& first_b = normal(b, first.second);
    const Eigen::Vector3f& second_a = normal(a, second.first);
    const Eigen::Vector3f& second_b = normal(b, second.second);
    const auto differs = [](float x, float y) { return std::abs(x - y) > max_difference; };
    return !differs(first_a.dot(second_a), first_b.dot(second_b)) &&
           !differs(first_a.dot(edge_a) / length, first_b.dot(edge_b) / length) &&
           !differs(second_a.dot(edge_a) / length, second_b.dot(edge_b) / length);
}

/// The numbers of the scans whose summaries are likest, nearest first.
std::vector<std::size_t> find_likest(std::span<const ScanSignature> signatures, std::size_t scan,
                                     std::size_t count) {
    std::vector<std::size_t> others;
    std::vector<float> distances(signatures.size());
    for (std::size_t other = 0; other < signatures.size(); ++other) {
        distances[other] = (signatures[other].summary - signatures[scan].summary).lpNorm<1>();
        if (other != scan) others.push_back(other);
    }
    if (others.size() <= count) return others;
    std::stable_sort(others.begin(), others.end(), [&distances](std::size_t a, std::size_t b) {
        return distances[a] < distances[b];
    });
    others.resize(count);
    return others;
}

}  // namespace

ScanSignature make_signature(const PreparedScan& scan) {
    constexpr std::size_t max_places = 600;
    ScanSignature signature;
    signature.summary = Eigen::VectorXf::Zero(2 * fpfh_size);
    if (scan.fpfh.positions.empty()) {
        signature.descriptors.resize(fpfh_size, 0);
        return signature;
    }
    const Eigen::Matrix<float, fpfh_size, 1> mean = scan.fpfh.descriptors.rowwise().mean();
    const FpfhDescriptors offsets = scan.fpfh.descriptors.colwise() - mean;
    signature.summary << mean,
        offsets.rowwise().squaredNorm().cwiseSqrt() / std::sqrt(static_cast<float>(offsets.cols()));
    const Eigen::VectorXf distinctness = offsets.colwise().squaredNorm();
    std::vector<std::size_t> order(scan.fpfh.positions.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return distinctness[static_cast<Eigen::Index>(a)] >
               distinctness[static_cast<Eigen::Index>(b)];
    });
    std::erase_if(order, [&scan](std::size_t i) { return !scan.fpfh.normals[i].allFinite(); });
    order.resize(std::min(order.size(), max_places));
    signature.descriptors.resize(fpfh_size, static_cast<Eigen::Index>(order.size()));
    for (std::size_t i = 0; i < order.size(); ++i) {
        signature.positions.push_back(scan.fpfh.positions[order[i]]);
        signature.normals.push_back(scan.fpfh.normals[order[i]]);
        signature.descriptors.col(static_cast<Eigen::Index>(i)) =
            scan.fpfh.descriptors.col(static_cast<Eigen::Index>(order[i]));
    }
    signature.squared_norms = signature.descriptors.colwise().squaredNorm();
    return signature;
}

double measure_promise(const ScanSignature& a, const ScanSignature& b,
                       const RegistrationScale& scale) {
    const auto matches = match_mutually(a, b);
    const auto count = static_cast<Eigen::Index>(matches.size());
    if (count < 3) return 0.0;
    const auto tolerance = static_cast<float>(1.5 * scale.coarse_voxel);
    Eigen::MatrixXf compatible = Eigen::MatrixXf::Zero(count, count);
    for (Eigen::Index i = 0; i < count; ++i) {
        for (Eigen::Index j = i + 1; j < count; ++j) {
            if (!are_compatible(a, b, matches[static_cast<std::size_t>(i)],
                                matches[static_cast<std::size_t>(j)], tolerance)) {
                continue;
            }
            compatible(i, j) = compatible(j, i) = 1.0F;
        }
    }
    // Of k matches that all agree, each lies in (k - 1)(k - 2) ordered triangles.
    const Eigen::VectorXf triangles =
        (compatible * compatible).cwiseProduct(compatible).rowwise().sum();
    return std::sqrt(static_cast<double>(triangles.maxCoeff()));
}

std::vector<ProposedPair> propose_pairs(std::span<const PreparedScan> scans,
                                        std::size_t max_partners, const RegistrationScale& scale,
                                        const Context& context) {
    constexpr std::size_t max_measured = 30;
    std::vector<ScanSignature> signatures(scans.size());
    parallel_for(context, scans.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            signatures[i] = make_signature(scans[i]);
    });
    std::map<std::pair<std::size_t, std::size_t>, double> promises;
    std::vector<std::vector<std::size_t>> likest(scans.size());
    for (std::size_t scan = 0; scan < scans.size(); ++scan) {
        likest[scan] = find_likest(signatures, scan, max_measured);
        for (const std::size_t other : likest[scan])
            promises[std::minmax(scan, other)] = 0.0;
    }
    std::vector<ProposedPair> pairs;
    pairs.reserve(promises.size());
    for (const auto& [pair, promise] : promises)
        pairs.push_back({pair.first, pair.second, promise});
    parallel_for(context, pairs.size(), 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            pairs[i].promise =
                measure_promise(signatures[pairs[i].a], signatures[pairs[i].b], scale);
        }
    });
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const auto& x, const auto& y) { return x.promise > y.promise; });
    std::vector<std::size_t> num_partners(scans.size(), 0);
    std::erase_if(pairs, [&](const ProposedPair& pair) {
        const std::size_t fewer = std::min(num_partners[pair.a]++, num_partners[pair.b]++);
        return fewer >= max_partners;
    });
    return pairs;
}

}  // namespace roomscribe
