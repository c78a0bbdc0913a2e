// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/pose_support.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "roomscribe/core/parallel.hpp"

namespace roomscribe {
namespace {

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
    std::vector<WitnessTally> pieces(witnesses.num_pieces);
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        count(outcomes[i], result.points);
        count(outcomes[i], pieces[witnesses.pieces[i * stride]]);
    }
    for (const WitnessTally& piece : pieces)
        count(outcome_of(piece), result.pieces);
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
    // Wrong poses were chosen because they bring large planes together, so these say little for a
    // pose; rays that passed speak alike against either. What is displaced says nothing: blurred
    // surfaces are displaced at the right pose, too. docs/registration.md
    constexpr double confirmed_shell = 0.02;
    WitnessTally pieces = shell.pieces;
    pieces += detail.pieces;
    const double confirmed = static_cast<double>(detail.pieces.confirmed) +
                             confirmed_shell * static_cast<double>(shell.pieces.confirmed);
    // A corridor turned about fits all its shell: its details are not to be outvoted.
    const double contradicted =
        std::max(detail.pieces.contradicted_share(), pieces.contradicted_share());
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
