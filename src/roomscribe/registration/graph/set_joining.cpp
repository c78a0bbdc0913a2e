// SPDX-License-Identifier: MIT
#include "roomscribe/registration/graph/set_joining.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "roomscribe/registration/graph/link_consistency.hpp"
#include "roomscribe/registration/graph/link_forest.hpp"
#include "roomscribe/registration/graph/pairs_across.hpp"
#include "roomscribe/registration/pair/pose_probability.hpp"
#include "roomscribe/registration/pair/pose_support.hpp"
#include "roomscribe/registration/pair/pose_verification.hpp"

namespace roomscribe {
namespace {

/// One way to put two sets of scans together.
struct Junction {
    std::size_t link = 0;
    Transform target_from_source = Transform::Identity();  ///< of the link's scans
    Transform target_set_from_source_set = Transform::Identity();
    double evidence = 0.0;
    std::size_t num_pairs = 0;  ///< of scans that say something
    double probability = 0.0;
};

/// Two sets, that of the link's source first.
using SetPair = std::pair<std::size_t, std::size_t>;

class SetJoiner {
  public:
    SetJoiner(std::vector<RegistrationLink>& links, std::span<const PreparedScan> scans,
              const PairRegistrationSettings& settings, const Context& context)
        : links_(links), scans_(scans), settings_(settings), context_(context) {}

    void run() {
        forest_ = grow_forest(links_, scans_.size());
        find_junctions();
        while (const std::optional<Junction> best = likeliest_junction()) {
            settle_link(links_[best->link], best->target_from_source);
            links_[best->link].probability = best->probability;
            forest_ = grow_forest(links_, scans_.size());
            find_junctions();
        }
    }

  private:
    /// All ways to put sets together.
    void find_junctions() {
        junctions_.clear();
        for (std::size_t i = 0; i < links_.size(); ++i) {
            const RegistrationLink& link = links_[i];
            if (link.verdict != LinkVerdict::ambiguous) continue;
            const SetPair sets{forest_.set_of[link.source], forest_.set_of[link.target]};
            if (sets.first == sets.second) continue;
            add_junction(i, link.target_from_source, sets);
            for (const Transform& rival : link.rivals)
                add_junction(i, rival, sets);
        }
    }

    void add_junction(std::size_t link, const Transform& target_from_source, SetPair sets) {
        context_.throw_if_cancelled();
        Junction junction{.link = link, .target_from_source = target_from_source};
        junction.target_set_from_source_set = forest_.set_from_scan[links_[link].target] *
                                              target_from_source *
                                              forest_.set_from_scan[links_[link].source].inverse();
        if (sets.first < sets.second) {  // the same two sets, linked the other way round
            std::swap(sets.first, sets.second);
            junction.target_set_from_source_set = junction.target_set_from_source_set.inverse();
        }
        std::vector<Junction>& others = junctions_[sets];
        for (const Junction& other : others) {
            if (!differ(sets.first, junction, other)) return;
        }
        others.push_back(hear_both_sets(junction, sets));
    }

    static bool joins(const RegistrationLink& link, std::size_t a, std::size_t b) {
        return std::pair(link.source, link.target) == std::pair(std::max(a, b), std::min(a, b));
    }

    bool differ(std::size_t source_set, const Junction& a, const Junction& b) const {
        return are_different(scans_[source_set], a.target_set_from_source_set,
                             b.target_set_from_source_set, scans_[source_set].scale);
    }

    /// What the scans of both sets say that come nearest each other. The link's own two proposed
    /// the pose because it suits them best: they are not asked again.
    Junction hear_both_sets(Junction junction, const SetPair& sets) const {
        constexpr std::size_t max_pairs = 8;
        std::vector<PairAcross> pairs =
            nearest_across(scans_, forest_, sets.first, sets.second,
                           junction.target_set_from_source_set, max_pairs + 1);
        std::erase_if(pairs, [&](const PairAcross& pair) {
            return joins(links_[junction.link], pair.source, pair.target);
        });
        pairs.resize(std::min(pairs.size(), max_pairs));
        double sum = 0.0;
        for (const PairAcross& pair : pairs) {
            const PreparedScan& source = scans_[pair.source];
            const PreparedScan& target = scans_[pair.target];
            const PoseSupport support =
                measure_support(source, target, pair.target_from_source,
                                fine_tolerance(joint_scale(source, target)), context_);
            if (support.all().judged() == 0) continue;
            sum += support.evidence();
            ++junction.num_pairs;
        }
        // Scans of one set see much of the same things: they are not so many witnesses.
        if (junction.num_pairs > 0)
            junction.evidence = sum / std::sqrt(static_cast<double>(junction.num_pairs));
        return junction;
    }

    /// All poses of the links between two sets were looked at.
    PoseSearch search_of(const Junction& junction) const {
        const RegistrationLink& link = links_[junction.link];
        return are_cameras(scans_[link.source], scans_[link.target]) ? PoseSearch::narrow
                                                                     : PoseSearch::exhaustive;
    }

    /// Empty if none is likely enough.
    std::optional<Junction> likeliest_junction() const {
        std::optional<Junction> likeliest;
        double highest = settings_.min_probability;
        for (const auto& [sets, junctions] : junctions_) {
            for (const Junction& junction : junctions) {
                double rival = 0.0;
                for (const Junction& other : junctions) {
                    if (&other != &junction) rival = std::max(rival, other.evidence);
                }
                const double probability =
                    probability_of({junction.evidence, rival, search_of(junction)});
                if (probability < highest) continue;
                highest = probability;
                likeliest = junction;
                likeliest->probability = probability;
            }
        }
        return likeliest;
    }

    std::vector<RegistrationLink>& links_;
    std::span<const PreparedScan> scans_;
    const PairRegistrationSettings& settings_;
    const Context& context_;
    LinkForest forest_;
    std::map<SetPair, std::vector<Junction>> junctions_;
};

}  // namespace

void join_sets(std::vector<RegistrationLink>& links, std::span<const PreparedScan> scans,
               const PairRegistrationSettings& settings, const Context& context) {
    SetJoiner(links, scans, settings, context).run();
}

}  // namespace roomscribe
