// SPDX-License-Identifier: MIT
#include "roomscribe/registration/graph/link_consistency.hpp"

#include <algorithm>
#include <tuple>

#include "roomscribe/registration/graph/pose_graph.hpp"

namespace roomscribe {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

std::vector<Vector6d> carried(const std::vector<Vector6d>& twists, const Matrix6d& carry) {
    std::vector<Vector6d> result;
    result.reserve(twists.size());
    for (const Vector6d& twist : twists)
        result.emplace_back((carry * twist).normalized());
    return result;
}

/// How many independent chains say the same as a link, and how many do not.
struct LoopVotes {
    int agree = 0;
    int disagree = 0;
};

LoopVotes count_votes(std::span<const RegistrationLink> links, std::size_t number,
                      const LinkTolerance& tolerance) {
    // Further chains are longer, and tell little.
    constexpr int max_chains = 4;
    const RegistrationLink& link = links[number];
    const ChainedPose direct = chain_of(link, tolerance);
    std::vector<bool> left_out(links.size(), false);
    left_out[number] = true;
    LoopVotes votes;
    while (votes.agree + votes.disagree < max_chains) {
        const auto chain = take_chain(links, link.source, link.target, left_out, tolerance);
        if (!chain) break;
        ++(are_consistent(direct, *chain) ? votes.agree : votes.disagree);
    }
    return votes;
}

/// The accepted link that loops contradict most; empty if none is contradicted enough.
std::optional<std::size_t> find_worst(std::span<const RegistrationLink> links,
                                      std::span<const LoopVotes> votes) {
    std::optional<std::size_t> worst;
    const auto trust = [&](std::size_t i) {
        return std::tuple(votes[i].agree - votes[i].disagree, links[i].probability,
                          links[i].agreement);
    };
    for (std::size_t i = 0; i < links.size(); ++i) {
        const bool is_contradicted = votes[i].disagree >= 2 && votes[i].disagree > votes[i].agree;
        if (is_contradicted && (!worst || trust(i) < trust(*worst))) worst = i;
    }
    return worst;
}

void reject_contradicted(std::vector<RegistrationLink>& links, const LinkTolerance& tolerance) {
    while (true) {
        std::vector<LoopVotes> votes(links.size());
        for (std::size_t i = 0; i < links.size(); ++i) {
            if (links[i].verdict != LinkVerdict::accepted) continue;
            votes[i] = count_votes(links, i, tolerance);
            if (links[i].loops == LoopCheck::resolved) continue;
            links[i].loops = votes[i].agree > 0 ? LoopCheck::agrees : LoopCheck::none;
        }
        const std::optional<std::size_t> worst = find_worst(links, votes);
        if (!worst) return;
        links[*worst].verdict = LinkVerdict::rejected;
        links[*worst].loops = LoopCheck::disagrees;
    }
}

/// Gives an ambiguous link the one of its poses that accepted links lead to.
void resolve_ambiguous(std::vector<RegistrationLink>& links, const LinkTolerance& tolerance) {
    for (RegistrationLink& link : links) {
        // A link that slides freely agrees with too much.
        if (link.verdict != LinkVerdict::ambiguous || !link.unobservable.empty()) continue;
        std::vector<bool> left_out(links.size(), false);
        const auto chain = take_chain(links, link.source, link.target, left_out, tolerance);
        if (!chain || !chain->unobservable.empty()) continue;
        if (const auto pose = only_consistent_pose(link, *chain, tolerance))
            settle_link(link, *pose);
    }
}

}  // namespace

ChainedPose chain_of(const RegistrationLink& link, const LinkTolerance& tolerance) {
    Vector6d floor;
    floor.head<3>().setConstant(tolerance.rotation * tolerance.rotation);
    floor.tail<3>().setConstant(tolerance.translation * tolerance.translation);
    // What a wrong angle does grows with the distance from where the scans meet; about the middle
    // between the scanners it does least.
    Transform to_middle = Transform::Identity();
    to_middle.translation() = 0.5 * link.target_from_source.translation();
    const Matrix6d carry = adjoint(to_middle);
    return {link.target_from_source,
            link.covariance + carry * floor.asDiagonal() * carry.transpose(), link.unobservable};
}

ChainedPose reversed(const ChainedPose& pose) {
    const Transform back = pose.target_from_source.inverse();
    const Matrix6d carry = adjoint(back);
    return {back, carry * pose.covariance * carry.transpose(), carried(pose.unobservable, carry)};
}

ChainedPose operator*(const ChainedPose& outer, const ChainedPose& inner) {
    const Matrix6d carry = adjoint(outer.target_from_source);
    ChainedPose chain = {outer.target_from_source * inner.target_from_source,
                         outer.covariance + carry * inner.covariance * carry.transpose(),
                         outer.unobservable};
    for (const Vector6d& twist : carried(inner.unobservable, carry))
        chain.unobservable.push_back(twist);
    return chain;
}

RegistrationLink reversed(const RegistrationLink& link) {
    RegistrationLink back = link;
    std::swap(back.source, back.target);
    back.target_from_source = link.target_from_source.inverse();
    const Matrix6d carry = adjoint(back.target_from_source);
    back.covariance = carry * link.covariance * carry.transpose();
    back.unobservable = carried(link.unobservable, carry);
    for (Transform& rival : back.rivals)
        rival = rival.inverse();
    return back;
}

void settle_link(RegistrationLink& link, const Transform& pose) {
    link.target_from_source = pose;
    link.rivals.clear();
    link.verdict = LinkVerdict::accepted;
    link.loops = LoopCheck::resolved;
}

std::optional<Transform> only_consistent_pose(const RegistrationLink& link,
                                              const ChainedPose& expected,
                                              const LinkTolerance& tolerance) {
    std::optional<Transform> found;
    RegistrationLink reading = link;
    for (std::size_t i = 0; i <= link.rivals.size(); ++i) {
        if (i > 0) reading.target_from_source = link.rivals[i - 1];
        if (!are_consistent(chain_of(reading, tolerance), expected)) continue;
        if (found) return std::nullopt;
        found = reading.target_from_source;
    }
    return found;
}

bool are_consistent(const ChainedPose& a, const ChainedPose& b) {
    constexpr double chi_square_6_quantile_0_999 = 22.458;
    const Vector6d difference = twist_between(a.target_from_source, b.target_from_source);
    std::vector<Vector6d> free = a.unobservable;
    free.insert(free.end(), b.unobservable.begin(), b.unobservable.end());
    const Matrix6d information = information_of(a.covariance + b.covariance, free);
    return difference.dot(information * difference) <= chi_square_6_quantile_0_999;
}

std::optional<ChainedPose> take_chain(std::span<const RegistrationLink> links, std::size_t source,
                                      std::size_t target, std::vector<bool>& left_out,
                                      const LinkTolerance& tolerance) {
    struct Step {
        std::size_t scan;
        std::size_t link;
        std::size_t previous;  ///< number of a step
    };
    // Breadth first from the source: the first way found to a scan is a shortest one.
    std::vector<Step> steps = {{source, 0, 0}};
    const auto was_reached = [&steps](std::size_t scan) {
        return std::any_of(steps.begin(), steps.end(),
                           [scan](const Step& step) { return step.scan == scan; });
    };
    for (std::size_t at = 0; at < steps.size() && steps.back().scan != target; ++at) {
        for (std::size_t i = 0; i < links.size() && steps.back().scan != target; ++i) {
            const RegistrationLink& link = links[i];
            if (left_out[i] || link.verdict != LinkVerdict::accepted) continue;
            const std::size_t scan = steps[at].scan;
            if (link.source != scan && link.target != scan) continue;
            const std::size_t next = link.source == scan ? link.target : link.source;
            if (!was_reached(next)) steps.push_back({next, i, at});
        }
    }
    if (steps.back().scan != target || target == source) return std::nullopt;
    ChainedPose chain;
    for (std::size_t at = steps.size() - 1; at != 0; at = steps[at].previous) {
        const RegistrationLink& link = links[steps[at].link];
        const ChainedPose step = chain_of(link, tolerance);
        chain = chain * (link.target == steps[at].scan ? step : reversed(step));
        left_out[steps[at].link] = true;
    }
    return chain;
}

void check_loops(std::vector<RegistrationLink>& links, const LinkTolerance& tolerance) {
    reject_contradicted(links, tolerance);
    resolve_ambiguous(links, tolerance);
}

}  // namespace roomscribe
