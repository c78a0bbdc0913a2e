// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/pose_support.hpp"

#include <algorithm>
#include <cmath>

#include "roomscribe/core/parallel.hpp"

namespace roomscribe {
namespace {

/// Normals of one surface, each estimated from another scan's points.
constexpr double min_normal_cosine = 0.707;

double share(double part, std::size_t whole) {
    return whole == 0 ? 0.0 : part / static_cast<double>(whole);
}

struct Tallies {
    WitnessTally shell;
    WitnessTally detail;
};

/// What becomes of one witness in the frame of the scan that judges it. `deviation`: of its own
/// surroundings about their plane.
void hear(const PreparedScan& judge, const Eigen::Vector3d& place, const Eigen::Vector3d& normal,
          float deviation, const SupportTolerance& tolerance, WitnessTally& tally) {
    ++tally.total;
    const auto [index, squared_distance] =
        judge.fine.tree.nearest_two(place.cast<float>(), static_cast<float>(tolerance.reach))[0];
    if (std::isfinite(squared_distance)) {
        const Eigen::Vector3d judge_normal = judge.fine.normals[index].cast<double>();
        if (!(normal.dot(judge_normal) >= min_normal_cosine)) return;
        const double off_plane =
            judge_normal.dot(place - judge.fine.positions[index].cast<double>());
        // Far from a depth camera the surface itself is rough.
        const double roughness = std::hypot(static_cast<double>(deviation),
                                            static_cast<double>(judge.fine.deviations[index]));
        const double allowed =
            std::clamp(2.0 * roughness, tolerance.off_plane, tolerance.max_off_plane);
        ++(std::abs(off_plane) <= allowed ? tally.confirmed : tally.displaced);
    } else if (judge.free_space_is_valid &&
               judge.free_space.look_at(place, tolerance.margin) == Visibility::free) {
        ++tally.contradicted;
    }
}

/// One way: the witnesses of `seen` as `judge` judges them.
Tallies hear_all(const PreparedScan& seen, const PreparedScan& judge,
                 const Transform& judge_from_seen, const SupportTolerance& tolerance,
                 const Context& context) {
    if (judge.fine.positions.empty()) return {};
    const OrientedPoints& witnesses = seen.witnesses.points;
    const std::size_t stride =
        std::max<std::size_t>(1, witnesses.positions.size() / tolerance.num_witnesses);
    const auto hear_some = [&](std::size_t begin, std::size_t end) {
        Tallies tallies;
        for (std::size_t i = begin * stride; i < end * stride; i += stride) {
            hear(judge, judge_from_seen * witnesses.positions[i].cast<double>(),
                 judge_from_seen.linear() * witnesses.normals[i].cast<double>(),
                 witnesses.deviations[i], tolerance,
                 seen.witnesses.is_detail[i] != 0 ? tallies.detail : tallies.shell);
        }
        return tallies;
    };
    return parallel_reduce(context, witnesses.positions.size() / stride, 256, Tallies{}, hear_some,
                           [](Tallies sum, const Tallies& part) {
                               sum.shell += part.shell;
                               sum.detail += part.detail;
                               return sum;
                           });
}

/// The sum over some witnesses of 1 for each that is confirmed and -1 for each contradicted one.
double screen_one_way(const PreparedScan& seen, const PreparedScan& judge,
                      const Transform& judge_from_seen, std::size_t num_witnesses,
                      bool asks_free_space, const RegistrationScale& scale) {
    const OrientedPoints& witnesses = seen.witnesses.points;
    const Eigen::Isometry3f motion = judge_from_seen.cast<float>();
    const std::size_t stride = std::max<std::size_t>(1, witnesses.positions.size() / num_witnesses);
    const auto max_off_plane = static_cast<float>(0.5 * scale.coarse_voxel);
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < witnesses.positions.size(); i += stride) {
        const Eigen::Vector3f place = motion * witnesses.positions[i];
        ++count;
        if (const auto near = judge.coarse_grid.near(place)) {
            const Eigen::Vector3f& normal = judge.coarse.normals[*near];
            const bool agrees =
                (motion.linear() * witnesses.normals[i]).dot(normal) >= min_normal_cosine &&
                std::abs(normal.dot(place - judge.coarse.positions[*near])) <= max_off_plane;
            sum += agrees ? 1.0 : 0.0;
        } else if (asks_free_space && judge.free_space_is_valid &&
                   judge.free_space.look_at(place.cast<double>(), scale.coarse_voxel) ==
                       Visibility::free) {
            sum -= 1.0;
        }
    }
    return share(sum, count);
}

}  // namespace

WitnessTally& WitnessTally::operator+=(const WitnessTally& other) {
    total += other.total;
    confirmed += other.confirmed;
    displaced += other.displaced;
    contradicted += other.contradicted;
    return *this;
}

WitnessTally PoseSupport::all() const {
    WitnessTally sum = shell;
    return sum += detail;
}

double PoseSupport::overlap() const {
    const WitnessTally sum = all();
    return share(static_cast<double>(sum.confirmed + sum.displaced), sum.total);
}

double PoseSupport::agreement() const {
    const WitnessTally sum = all();
    return share(static_cast<double>(sum.confirmed), sum.judged());
}

std::optional<double> PoseSupport::detail_agreement() const {
    constexpr std::size_t min_judged = 30;
    if (detail.judged() < min_judged) return std::nullopt;
    return share(static_cast<double>(detail.confirmed), detail.judged());
}

double PoseSupport::detail_share() const {
    return share(static_cast<double>(detail.judged()), all().judged());
}

double PoseSupport::contradiction() const {
    const WitnessTally sum = all();
    if (sum.contradicted == 0) return 0.0;
    return static_cast<double>(sum.contradicted) /
           static_cast<double>(std::max<std::size_t>(sum.confirmed, 1));
}

double PoseSupport::score() const {
    // At the right pose hardly anything is contradicted, some of the surface is displaced by what
    // is curved or blurred: so the one weighs more than a confirmation, the other less.
    const WitnessTally sum = all();
    return share(static_cast<double>(sum.confirmed) - 2.0 * static_cast<double>(sum.contradicted) -
                     0.5 * static_cast<double>(sum.displaced),
                 sum.total);
}

SupportTolerance coarse_tolerance(const RegistrationScale& scale) {
    return {.off_plane = 0.5 * scale.coarse_voxel,
            .max_off_plane = 0.5 * scale.coarse_voxel,
            .reach = scale.coarse_voxel,
            .margin = scale.coarse_voxel,
            .num_witnesses = 1000};
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
    Tallies there = hear_all(source, target, target_from_source, tolerance, context);
    const Tallies back = hear_all(target, source, target_from_source.inverse(), tolerance, context);
    there.shell += back.shell;
    there.detail += back.detail;
    return {there.shell, there.detail, source.free_space_is_valid && target.free_space_is_valid};
}

std::vector<double> screen_poses(const PreparedScan& source, const PreparedScan& target,
                                 std::span<const Transform> poses, const RegistrationScale& scale,
                                 Screening screening, const Context& context) {
    std::vector<double> scores(poses.size());
    const auto screen = [&](const Transform& pose) {
        if (screening == Screening::glance)
            return screen_one_way(source, target, pose, 40, false, scale);
        return 0.5 * (screen_one_way(source, target, pose, 300, true, scale) +
                      screen_one_way(target, source, pose.inverse(), 300, true, scale));
    };
    parallel_for(context, poses.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            scores[i] = screen(poses[i]);
    });
    return scores;
}

}  // namespace roomscribe
