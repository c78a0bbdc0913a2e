// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/pose_support.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "roomscribe/core/parallel.hpp"

namespace roomscribe {
namespace {

/// Wrong poses were chosen because they bring large planes together, so these say little for a
/// pose; rays that passed speak alike against either. docs/registration.md
constexpr double usual_weight_of_shell = 0.02;

double share(double part, std::size_t whole) {
    return whole == 0 ? 0.0 : part / static_cast<double>(whole);
}

enum class Outcome : std::uint8_t { unseen, confirmed, displaced, contradicted };

void count(Outcome outcome, WitnessTally& tally) {
    ++tally.total;
    tally.confirmed += outcome == Outcome::confirmed ? 1 : 0;
    tally.displaced += outcome == Outcome::displaced ? 1 : 0;
    tally.contradicted += outcome == Outcome::contradicted ? 1 : 0;
}

/// What becomes of one witness in the frame of the scan that judges it. `deviation`: of its own
/// surroundings about their plane.
Outcome hear(const PreparedScan& judge, const Eigen::Vector3d& place, const Eigen::Vector3d& normal,
             float deviation, const SupportTolerance& tolerance) {
    const auto [index, squared_distance] =
        judge.fine.tree.nearest_two(place.cast<float>(), static_cast<float>(tolerance.reach))[0];
    if (!std::isfinite(squared_distance)) {
        const bool is_contradicted =
            judge.free_space_is_valid &&
            judge.free_space.look_at(place, tolerance.margin) == Visibility::free;
        return is_contradicted ? Outcome::contradicted : Outcome::unseen;
    }
    const Eigen::Vector3d judge_normal = judge.fine.normals[index].cast<double>();
    if (!(normal.dot(judge_normal) >= same_surface_cosine)) return Outcome::unseen;
    const double off_plane = judge_normal.dot(place - judge.fine.positions[index].cast<double>());
    // Far from a depth camera the surface itself is rough.
    const double roughness = std::hypot(static_cast<double>(deviation),
                                        static_cast<double>(judge.fine.deviations[index]));
    const double allowed =
        std::clamp(2.0 * roughness, tolerance.off_plane, tolerance.max_off_plane);
    return std::abs(off_plane) <= allowed ? Outcome::confirmed : Outcome::displaced;
}

/// What most of a piece's witnesses are.
Outcome outcome_of(const WitnessTally& piece) {
    if (piece.judged() < 2) return Outcome::unseen;
    if (2 * piece.confirmed > piece.judged()) return Outcome::confirmed;
    if (2 * piece.contradicted > piece.judged()) return Outcome::contradicted;
    return Outcome::displaced;
}

using Body = std::vector<std::uint32_t>;

/// Bodies of pieces whose cubes touch each other, by a corner at least.
std::vector<Body> part_into_bodies(Body pieces, const WitnessSet& witnesses) {
    std::vector<Body> bodies;
    while (!pieces.empty()) {
        Body body{pieces.back()};
        pieces.pop_back();
        for (std::size_t i = 0; i < body.size(); ++i) {
            const Eigen::Vector3i at = witnesses.cubes[body[i]];
            const auto touching =
                std::stable_partition(pieces.begin(), pieces.end(), [&](std::uint32_t other) {
                    return (witnesses.cubes[other] - at).cwiseAbs().maxCoeff() > 1;
                });
            body.insert(body.end(), touching, pieces.end());
            pieces.erase(touching, pieces.end());
        }
        bodies.push_back(std::move(body));
    }
    return bodies;
}

/// Between the middles of its cubes.
double length_of(const Body& body, const WitnessSet& witnesses) {
    int squared_length = 0;
    for (const std::uint32_t a : body) {
        for (const std::uint32_t b : body) {
            squared_length =
                std::max(squared_length, (witnesses.cubes[a] - witnesses.cubes[b]).squaredNorm());
        }
    }
    return witnesses.cube_size * std::sqrt(static_cast<double>(squared_length));
}

std::size_t count_contradictions(Body contradicted, const WitnessSet& witnesses) {
    constexpr double height_of_person = 2.0;  // m
    std::size_t contradictions = 0;
    for (const Body& body : part_into_bodies(std::move(contradicted), witnesses))
        contradictions += length_of(body, witnesses) <= height_of_person ? 1 : body.size();
    return contradictions;
}

/// One way: every `stride`-th of one scan's witnesses, as `judge` judges them.
WitnessCount hear_all(const WitnessSet& witnesses, std::size_t stride, const PreparedScan& judge,
                      const Transform& judge_from_seen, const SupportTolerance& tolerance,
                      const Context& context) {
    if (judge.fine.positions.empty()) return {};
    const OrientedPoints& points = witnesses.points;
    std::vector<Outcome> outcomes((points.positions.size() + stride - 1) / stride);
    parallel_for(context, outcomes.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t witness = i * stride;
            outcomes[i] = hear(judge, judge_from_seen * points.positions[witness].cast<double>(),
                               judge_from_seen.linear() * points.normals[witness].cast<double>(),
                               points.deviations[witness], tolerance);
        }
    });
    WitnessCount result;
    std::vector<WitnessTally> pieces(witnesses.cubes.size());
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        count(outcomes[i], result.points);
        count(outcomes[i], pieces[witnesses.pieces[i * stride]]);
    }
    Body contradicted;
    for (std::uint32_t i = 0; i < pieces.size(); ++i) {
        const Outcome outcome = outcome_of(pieces[i]);
        count(outcome, result.pieces);
        if (outcome == Outcome::contradicted) contradicted.push_back(i);
    }
    result.contradictions = count_contradictions(std::move(contradicted), witnesses);
    return result;
}

}  // namespace

double WitnessTally::contradicted_share() const {
    return share(static_cast<double>(contradicted), confirmed + contradicted);
}

WitnessTally& WitnessTally::operator+=(const WitnessTally& other) {
    total += other.total;
    confirmed += other.confirmed;
    displaced += other.displaced;
    contradicted += other.contradicted;
    return *this;
}

WitnessCount& WitnessCount::operator+=(const WitnessCount& other) {
    points += other.points;
    pieces += other.pieces;
    contradictions += other.contradictions;
    return *this;
}

WitnessTally PoseSupport::all() const {
    WitnessTally sum = shell.points;
    return sum += detail.points;
}

double PoseSupport::overlap() const {
    const WitnessTally sum = all();
    return share(static_cast<double>(sum.confirmed + sum.displaced), sum.total);
}

double PoseSupport::agreement() const {
    const WitnessTally sum = all();
    return share(static_cast<double>(sum.confirmed), sum.judged());
}

double PoseSupport::evidence() const {
    return weigh(usual_weight_of_shell);
}

double PoseSupport::evidence_with_shell() const {
    constexpr double weight_of_clean_shell = 0.1;
    constexpr double max_share = 0.01;
    WitnessTally pieces = shell.pieces;
    pieces += detail.pieces;
    const double cleanness = std::max(0.0, 1.0 - pieces.contradicted_share() / max_share);
    return weigh(std::lerp(usual_weight_of_shell, weight_of_clean_shell, cleanness));
}

bool PoseSupport::shell_agrees() const {
    constexpr double max_shell_contradiction = 0.01;
    constexpr std::size_t enough_shell = 200;
    return shell.pieces.confirmed >= enough_shell &&
           shell.pieces.contradicted_share() <= max_shell_contradiction;
}

double PoseSupport::weigh(double weight_of_shell) const {
    // What is displaced says nothing: blurred surfaces are displaced at the right pose, too.
    const std::size_t shell_confirmed = shell.pieces.confirmed;
    const std::size_t detail_confirmed = detail.pieces.confirmed;
    const double confirmed = static_cast<double>(detail_confirmed) +
                             weight_of_shell * static_cast<double>(shell_confirmed);
    const auto contradicted_share = [](std::size_t contradicted, std::size_t confirmed_pieces) {
        return share(static_cast<double>(contradicted), contradicted + confirmed_pieces);
    };
    const std::size_t detail_contradicted =
        shell_agrees() ? detail.contradictions : detail.pieces.contradicted;
    // A corridor turned about fits all its shell: its details are not to be outvoted.
    const double contradicted =
        std::max(contradicted_share(detail_contradicted, detail_confirmed),
                 contradicted_share(shell.pieces.contradicted + detail_contradicted,
                                    shell_confirmed + detail_confirmed));
    return 0.5 * confirmed * (1.0 - contradicted / max_contradiction);
}

SupportTolerance coarse_tolerance(const RegistrationScale& scale) {
    return {.off_plane = 0.5 * scale.coarse_voxel,
            .max_off_plane = 0.5 * scale.coarse_voxel,
            .reach = scale.coarse_voxel,
            .margin = scale.coarse_voxel,
            .num_witnesses = 2000};
}

SupportTolerance fine_tolerance(const RegistrationScale& scale) {
    // The sides of small things, 6 cm apart, are not to contradict each other.
    constexpr double small_thing = 0.06;
    const double off_plane = std::max(3.0 * scale.noise, 0.5 * scale.fine_voxel);
    return {.off_plane = off_plane,
            .max_off_plane = std::max(off_plane, 0.5 * scale.coarse_voxel),
            .reach = 2.0 * scale.fine_voxel,
            .margin = std::max(4.0 * scale.noise, small_thing),
            .num_witnesses = 4000};
}

PoseSupport measure_support(const PreparedScan& source, const PreparedScan& target,
                            const Transform& target_from_source, const SupportTolerance& tolerance,
                            const Context& context) {
    PoseSupport support{{}, {}, source.free_space_is_valid && target.free_space_is_valid};
    const auto add = [&](const PreparedScan& seen, const PreparedScan& judge,
                         const Transform& judge_from_seen) {
        const std::size_t num_witnesses = seen.witnesses.shell.points.positions.size() +
                                          seen.witnesses.detail.points.positions.size();
        const std::size_t stride =
            std::max<std::size_t>(1, num_witnesses / tolerance.num_witnesses);
        support.shell +=
            hear_all(seen.witnesses.shell, stride, judge, judge_from_seen, tolerance, context);
        support.detail +=
            hear_all(seen.witnesses.detail, stride, judge, judge_from_seen, tolerance, context);
    };
    add(source, target, target_from_source);
    add(target, source, target_from_source.inverse());
    return support;
}

}  // namespace roomscribe
