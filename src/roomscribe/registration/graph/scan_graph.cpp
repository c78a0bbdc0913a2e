// SPDX-License-Identifier: MIT
#include "roomscribe/registration/graph/scan_graph.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "roomscribe/model/kept_result.hpp"
#include "roomscribe/model/result_bytes.hpp"
#include "roomscribe/registration/graph/link_consistency.hpp"
#include "roomscribe/registration/graph/link_forest.hpp"
#include "roomscribe/registration/graph/pair_proposal.hpp"
#include "roomscribe/registration/graph/pose_graph.hpp"
#include "roomscribe/registration/graph/scan_placement.hpp"
#include "roomscribe/registration/graph/scanner_mounting.hpp"
#include "roomscribe/registration/graph/set_contradiction.hpp"
#include "roomscribe/registration/graph/set_joining.hpp"
#include "roomscribe/registration/pair/pair_registration.hpp"
#include "roomscribe/registration/pair/pose_support.hpp"

namespace roomscribe {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;

ChainedPose known_chain(const KnownPose& known) {
    Vector6d variances;
    variances.head<3>().setConstant(known.rotation_deviation * known.rotation_deviation);
    variances.tail<3>().setConstant(known.translation_deviation * known.translation_deviation);
    Transform to_scan = Transform::Identity();
    to_scan.translation() = known.world_from_scan.translation();
    const auto carry = adjoint(to_scan);
    return {known.world_from_scan, carry * variances.asDiagonal() * carry.transpose(), {}};
}

/// Two scans as a guess puts them.
struct NearbyPair {
    std::size_t source = 0;
    std::size_t target = 0;
    Transform target_from_source = Transform::Identity();
    double distance = 0.0;  ///< m, between the middles of the scans
};

class LinkFinder {
  public:
    LinkFinder(std::span<const PreparedScan> scans, std::span<const std::optional<KnownPose>> known,
               const RegistrationScale& scale, std::uint64_t seed,
               const PairRegistrationSettings& pair, const ScanGraphSettings& settings,
               const Context& context)
        : scans_(scans),
          known_(known),
          scale_(scale),
          seed_(seed),
          pair_(pair),
          settings_(settings),
          context_(context),
          tolerance_(link_tolerance(scale)) {}

    std::vector<RegistrationLink> run() && {
        link_known_neighbors();
        link_promising_pairs();
        if (drop_tilted_poses(links_, usual_ups())) link_promising_pairs();
        while (reject_what_sets_contradict(links_, scans_, min_probability_to_place, context_))
            link_promising_pairs();
        settle_by_known_poses();
        join_sets(links_, scans_, pair_, context_);
        reject_what_sets_contradict(links_, scans_, min_probability_to_place, context_);
        close_loops();
        check_loops(links_, tolerance_);
        reject_what_sets_contradict(links_, scans_, min_probability_to_place, context_);
        std::sort(links_.begin(), links_.end(), [](const auto& a, const auto& b) {
            return std::pair(a.source, a.target) < std::pair(b.source, b.target);
        });
        context_.report_progress("register", 1.0);
        return std::move(links_);
    }

  private:
    /// The link of a pair, source > target; nullptr if it was not tried.
    RegistrationLink* find_link(std::size_t source, std::size_t target) {
        const auto found = std::find_if(links_.begin(), links_.end(), [&](const auto& link) {
            return link.source == source && link.target == target;
        });
        return found == links_.end() ? nullptr : &*found;
    }

    std::vector<UsualUp> usual_ups() const {
        std::vector<UsualUp> ups;
        for (const PreparedScan& scan : scans_)
            ups.push_back(scan.usual_up);
        return ups;
    }

    void register_without_guess(std::size_t source, std::size_t target) {
        context_.throw_if_cancelled();
        RegistrationLink link = kept(context_, fmt::format("pair-{}-{}", source, target), [&] {
            return register_pair(scans_[source], scans_[target], seed_, pair_, context_);
        });
        link.source = source;
        link.target = target;
        links_.push_back(std::move(link));
    }

    /// Empty if the scans do not bear the guess out.
    std::optional<RegistrationLink> register_with_guess(const NearbyPair& pair) {
        context_.throw_if_cancelled();
        // Known poses and loops may each have their guess.
        const std::string name =
            fmt::format("guess-{}-{}-{}", pair.source, pair.target, num_guesses_++);
        RegistrationLink link = kept(context_, name, [&] {
            return register_pair_from(scans_[pair.source], scans_[pair.target],
                                      pair.target_from_source, pair_, context_);
        });
        link.source = pair.source;
        link.target = pair.target;
        if (link.verdict != LinkVerdict::accepted) return std::nullopt;
        return link;
    }

    bool should_overlap(const NearbyPair& pair) const {
        return measure_support(scans_[pair.source], scans_[pair.target], pair.target_from_source,
                               coarse_tolerance(scale_), context_)
                   .overlap() >= pair_.min_overlap;
    }

    NearbyPair nearby_pair(std::size_t a, std::size_t b, const Transform& frame_from_a,
                           const Transform& frame_from_b) const {
        const std::size_t source = std::max(a, b);
        const std::size_t target = std::min(a, b);
        const Transform& from_source = a > b ? frame_from_a : frame_from_b;
        const Transform& from_target = a > b ? frame_from_b : frame_from_a;
        return {
            source, target, from_target.inverse() * from_source,
            (from_source * scans_[source].spread.mean - from_target * scans_[target].spread.mean)
                .norm()};
    }

    /// The nearest pairs, some more than can be linked: not all of them will overlap.
    static void keep_nearest(std::vector<NearbyPair>& pairs, int count) {
        std::stable_sort(pairs.begin(), pairs.end(),
                         [](const auto& a, const auto& b) { return a.distance < b.distance; });
        pairs.resize(std::min(pairs.size(), 2 * static_cast<std::size_t>(count)));
    }

    /// The scans that known poses put next to each other.
    void link_known_neighbors() {
        for (std::size_t scan = 0; scan < known_.size(); ++scan) {
            if (!known_[scan]) continue;
            std::vector<NearbyPair> pairs;
            for (std::size_t other = 0; other < known_.size(); ++other) {
                if (other == scan || !known_[other]) continue;
                pairs.push_back(nearby_pair(scan, other, known_[scan]->world_from_scan,
                                            known_[other]->world_from_scan));
            }
            const int max_links = 2 * settings_.max_closures;
            keep_nearest(pairs, max_links);
            int num_links = 0;
            for (const NearbyPair& pair : pairs) {
                if (num_links == max_links) break;
                if (find_link(pair.source, pair.target) != nullptr) {
                    ++num_links;
                } else if (should_overlap(pair)) {
                    ++num_links;
                    if (auto link = register_with_guess(pair)) {
                        links_.push_back(std::move(*link));
                    } else {
                        register_without_guess(pair.source, pair.target);
                    }
                }
            }
        }
    }

    void link_promising_pairs() {
        const std::vector<ProposedPair> pairs = propose_pairs(
            scans_, static_cast<std::size_t>(settings_.max_partners), scale_, context_);
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const auto [target, source, promise] = pairs[i];
            context_.report_progress(
                "register", 0.7 * static_cast<double>(i) / static_cast<double>(pairs.size()));
            const LinkForest forest = grow_forest(links_, scans_.size());
            if (forest.set_of[source] == forest.set_of[target]) continue;
            if (find_link(source, target) == nullptr) register_without_guess(source, target);
        }
    }

    /// Links between scans that are in one set and lie near each other.
    void close_loops() {
        const LinkForest forest = grow_forest(links_, scans_.size());
        for (std::size_t scan = 0; scan < scans_.size(); ++scan) {
            context_.report_progress("register", 0.7 + 0.2 * static_cast<double>(scan) /
                                                           static_cast<double>(scans_.size()));
            std::vector<NearbyPair> pairs;
            for (std::size_t other = 0; other < scans_.size(); ++other) {
                if (other == scan || forest.set_of[other] != forest.set_of[scan]) continue;
                pairs.push_back(nearby_pair(scan, other, forest.set_from_scan[scan],
                                            forest.set_from_scan[other]));
            }
            keep_nearest(pairs, settings_.max_closures);
            close_loops_of(scan, pairs);
        }
    }

    void close_loops_of(std::size_t scan, std::span<const NearbyPair> pairs) {
        auto num_links = std::count_if(links_.begin(), links_.end(), [scan](const auto& link) {
            return link.verdict == LinkVerdict::accepted &&
                   (link.source == scan || link.target == scan);
        });
        bool may_search = true;
        for (const NearbyPair& pair : pairs) {
            if (num_links >= settings_.max_closures) break;
            if (find_link(pair.source, pair.target) != nullptr || !should_overlap(pair)) continue;
            if (auto link = register_with_guess(pair)) {
                links_.push_back(std::move(*link));
                ++num_links;
            } else if (may_search) {
                // Scans that should overlap and do not as they should: one of the links that put
                // them there may be wrong. Once per scan their true pose is worth a search.
                may_search = false;
                register_without_guess(pair.source, pair.target);
            }
        }
    }

    /// Of the poses of an ambiguous link, known poses may allow one alone.
    void settle_by_known_poses() {
        if (known_.empty()) return;
        for (RegistrationLink& link : links_) {
            if (link.verdict != LinkVerdict::ambiguous) continue;
            if (!known_[link.source] || !known_[link.target]) continue;
            const ChainedPose expected =
                reversed(known_chain(*known_[link.target])) * known_chain(*known_[link.source]);
            if (const auto pose = only_consistent_pose(link, expected, tolerance_))
                settle_link(link, *pose);
        }
    }

    std::span<const PreparedScan> scans_;
    std::span<const std::optional<KnownPose>> known_;
    RegistrationScale scale_;
    std::uint64_t seed_;
    const PairRegistrationSettings& pair_;
    const ScanGraphSettings& settings_;
    const Context& context_;
    LinkTolerance tolerance_;
    std::vector<RegistrationLink> links_;
    std::size_t num_guesses_ = 0;  ///< that were tried so far
};

}  // namespace

LinkTolerance link_tolerance(const RegistrationScale& scale) {
    // Poses that are off by more than a quarter of a voxel at some metres are not merely inexact.
    constexpr double distance = 3.0;
    const double deviation = 0.25 * scale.coarse_voxel;
    return {deviation / distance, deviation};
}

std::vector<RegistrationLink> link_scans(std::span<const PreparedScan> scans,
                                         std::span<const std::optional<KnownPose>> known,
                                         const RegistrationScale& scale, std::uint64_t seed,
                                         const PairRegistrationSettings& pair,
                                         const ScanGraphSettings& settings,
                                         const Context& context) {
    return LinkFinder(scans, known, scale, seed, pair, settings, context).run();
}

}  // namespace roomscribe
