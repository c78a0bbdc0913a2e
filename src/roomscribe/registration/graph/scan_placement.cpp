// SPDX-License-Identifier: MIT
#include "roomscribe/registration/graph/scan_placement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "roomscribe/registration/graph/link_consistency.hpp"
#include "roomscribe/registration/graph/link_forest.hpp"

namespace roomscribe {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

Matrix6d diagonal(double rotation_value, double translation_value) {
    Vector6d values;
    values.head<3>().setConstant(rotation_value);
    values.tail<3>().setConstant(translation_value);
    return values.asDiagonal();
}

PoseConstraint constraint_of(const RegistrationLink& link, double noise) {
    // So good is no scanner's calibration; and a covariance of zero has no inverse.
    const double deviation = std::max(0.1 * noise, 1e-4);
    constexpr double distance = 3.0;  // m, at which surfaces lie, about
    const ChainedPose pose = chain_of(link, {deviation / distance, deviation});
    return {link.source, link.target, link.target_from_source,
            information_of(pose.covariance, pose.unobservable)};
}

/// The known pose as a measurement of the scan in the frame of the known poses, which is a node of
/// its own: nobody knows where it lies in the map.
PoseConstraint constraint_of(const KnownPose& known, std::size_t scan, std::size_t world) {
    Transform to_scan = Transform::Identity();
    to_scan.translation() = known.world_from_scan.translation();
    const Matrix6d back = adjoint(to_scan.inverse());
    const Matrix6d information =
        diagonal(std::pow(known.rotation_deviation, -2), std::pow(known.translation_deviation, -2));
    return {scan, world, known.world_from_scan, back.transpose() * information * back};
}

class Placer {
  public:
    Placer(std::vector<RegistrationLink> links, std::size_t num_scans,
           std::span<const std::optional<KnownPose>> known, KnownPoseUse use, double noise,
           double min_ambiguous)
        : num_scans_(num_scans),
          known_(known),
          use_(use),
          noise_(noise),
          min_ambiguous_(min_ambiguous) {
        result_.links = std::move(links);
        for (std::size_t scan = 0; scan < known.size(); ++scan) {
            if (known[scan]) known_scans_.push_back(scan);
        }
    }

    Registration run(const PoseGraphSettings& settings, const Context& context) && {
        forest_ = grow_forest(links_and_bonds(), num_scans_, min_ambiguous_);
        map_set_ = choose_map_set();
        if (keeps_known()) move_to_known();
        find_components();
        place(optimize_pose_graph(make_graph(), settings, context));
        add_residuals();
        return std::move(result_);
    }

  private:
    bool keeps_known() const { return use_ == KnownPoseUse::fixed && !known_scans_.empty(); }

    /// The links; and where known poses are kept, these hold their scans together too.
    std::vector<RegistrationLink> links_and_bonds() const {
        std::vector<RegistrationLink> links = result_.links;
        if (!keeps_known()) return links;
        const std::size_t first = known_scans_.front();
        for (const std::size_t scan : known_scans_) {
            if (scan == first) continue;
            RegistrationLink bond;
            bond.source = scan;
            bond.target = first;
            bond.target_from_source =
                known_[first]->world_from_scan.inverse() * known_[scan]->world_from_scan;
            bond.verdict = LinkVerdict::accepted;
            bond.probability = std::numeric_limits<double>::infinity();
            links.push_back(bond);
        }
        return links;
    }

    /// The set that becomes the map: the one of known poses that are kept, else the largest, and of
    /// equally large ones that of the lowest scan.
    std::size_t choose_map_set() const {
        if (keeps_known()) return forest_.set_of[known_scans_.front()];
        std::vector<std::size_t> sizes(num_scans_, 0);
        for (const std::size_t set : forest_.set_of)
            ++sizes[set];
        return static_cast<std::size_t>(std::max_element(sizes.begin(), sizes.end()) -
                                        sizes.begin());
    }
    bool is_placed(std::size_t scan) const { return forest_.set_of[scan] == map_set_; }

    void move_to_known() {
        const std::size_t first = known_scans_.front();
        const Transform world_from_set =
            known_[first]->world_from_scan * forest_.set_from_scan[first].inverse();
        for (std::size_t scan = 0; scan < num_scans_; ++scan) {
            if (is_placed(scan)) {
                forest_.set_from_scan[scan] = world_from_set * forest_.set_from_scan[scan];
            }
        }
    }

    void find_components() {
        for (std::size_t first = 0; first < num_scans_; ++first) {
            if (forest_.set_of[first] != first) continue;
            std::vector<std::size_t>& component = result_.components.emplace_back();
            for (std::size_t scan = first; scan < num_scans_; ++scan) {
                if (forest_.set_of[scan] == first) component.push_back(scan);
            }
        }
        std::stable_partition(
            result_.components.begin(), result_.components.end(),
            [&](const std::vector<std::size_t>& scans) { return is_placed(scans.front()); });
    }

    PoseGraph make_graph() const {
        PoseGraph graph;
        graph.map_from_node = forest_.set_from_scan;
        for (std::size_t i = 0; i < result_.links.size(); ++i) {
            const RegistrationLink& link = result_.links[i];
            const bool is_needed =
                std::binary_search(forest_.used_links.begin(), forest_.used_links.end(), i);
            if (link.verdict == LinkVerdict::accepted || is_needed) {
                graph.constraints.push_back(constraint_of(link, noise_));
            }
        }
        if (keeps_known()) {
            graph.fixed = known_scans_;
        } else {
            graph.fixed = {map_set_};
            add_priors(graph);
        }
        for (const std::vector<std::size_t>& scans : result_.components) {
            if (!is_placed(scans.front())) graph.fixed.push_back(scans.front());
        }
        return graph;
    }

    void add_priors(PoseGraph& graph) const {
        const std::size_t world = graph.map_from_node.size();
        for (const std::size_t scan : known_scans_) {
            if (!is_placed(scan)) continue;
            if (graph.map_from_node.size() == world) {
                graph.map_from_node.push_back(graph.map_from_node[scan] *
                                              known_[scan]->world_from_scan.inverse());
            }
            graph.constraints.push_back(constraint_of(*known_[scan], scan, world));
        }
    }

    void place(const PoseGraphResult& optimized) {
        for (std::size_t scan = 0; scan < num_scans_; ++scan) {
            const Transform& pose = optimized.map_from_node[scan];
            const bool placed = is_placed(scan);
            result_.map_from_scan.push_back(placed ? std::optional(pose) : std::nullopt);
            result_.apart_from_scan.push_back(placed ? std::nullopt : std::optional(pose));
            result_.covariances.push_back(optimized.covariances[scan]);
            result_.is_doubtful.push_back(forest_.is_doubtful[scan]);
        }
    }

    void add_residuals() {
        std::vector<double> squares(num_scans_, 0.0);
        std::vector<double> counts(num_scans_, 0.0);
        result_.overlaps.assign(num_scans_, 0.0);
        for (const RegistrationLink& link : result_.links) {
            if (link.verdict == LinkVerdict::rejected) continue;
            const auto inliers = static_cast<double>(link.inliers);
            for (const std::size_t scan : {link.source, link.target}) {
                squares[scan] += inliers * link.rmse * link.rmse;
                counts[scan] += inliers;
                result_.overlaps[scan] = std::max(result_.overlaps[scan], link.overlap);
            }
        }
        for (std::size_t scan = 0; scan < num_scans_; ++scan) {
            result_.residuals.push_back(counts[scan] > 0.0
                                            ? std::sqrt(squares[scan] / counts[scan])
                                            : std::numeric_limits<double>::quiet_NaN());
        }
    }

    std::size_t num_scans_;
    std::span<const std::optional<KnownPose>> known_;
    KnownPoseUse use_;
    double noise_;
    double min_ambiguous_;
    std::vector<std::size_t> known_scans_;
    LinkForest forest_;
    std::size_t map_set_ = 0;  ///< lowest scan of the set that becomes the map
    Registration result_;
};

}  // namespace

Registration place_scans(std::vector<RegistrationLink> links, std::size_t num_scans,
                         std::span<const std::optional<KnownPose>> known, KnownPoseUse use,
                         double noise, double min_ambiguous, const PoseGraphSettings& settings,
                         const Context& context) {
    return Placer(std::move(links), num_scans, known, use, noise, min_ambiguous)
        .run(settings, context);
}

}  // namespace roomscribe
