// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/pose_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include <Eigen/Dense>

#include "roomscribe/core/units.hpp"

namespace roomscribe {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A rotation that takes directions of the source to directions of the target.
struct RotationCandidate {
    Matrix3d rotation = Matrix3d::Identity();
    double shared = 0.0;  ///< share of surface whose directions meet
};

/// Brings the pair (a, b) onto (c, d) as well as two different angles allow.
Matrix3d rotation_between(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                          const Vector3d& d) {
    const auto frame = [](const Vector3d& first, const Vector3d& second) {
        Matrix3d axes;
        axes.col(0) = (first + second).normalized();
        axes.col(2) = first.cross(second).normalized();
        axes.col(1) = axes.col(2).cross(axes.col(0));
        return axes;
    };
    return frame(c, d) * frame(a, b).transpose();
}

/// Refits the rotation to all directions that it brings together.
RotationCandidate settle_rotation(Matrix3d rotation, std::span<const SurfaceDirection> source,
                                  std::span<const SurfaceDirection> target) {
    const double min_cosine = std::cos(same_direction_angle);
    RotationCandidate candidate;
    for (int i = 0; i < 2; ++i) {
        Matrix3d products = Matrix3d::Zero();
        candidate.shared = 0.0;
        for (const SurfaceDirection& from : source) {
            const Vector3d turned = rotation * from.direction;
            for (const SurfaceDirection& to : target) {
                if (turned.dot(to.direction) < min_cosine) continue;
                const double weight = std::min(from.share, to.share);
                candidate.shared += weight;
                products += weight * to.direction * from.direction.transpose();
            }
        }
        if (!(candidate.shared > 0.0)) break;
        // Directions in one plane leave the third singular value 0, which does not matter.
        rotation = nearest_rotation(products + 1e-6 * candidate.shared * rotation);
    }
    candidate.rotation = rotation;
    return candidate;
}

std::vector<RotationCandidate> list_rotations(std::span<const SurfaceDirection> source,
                                              std::span<const SurfaceDirection> target) {
    // Two clusters of normals are each known to a few degrees.
    const double max_difference = radians(6.0);
    const double same_rotation = radians(8.0);
    // All right angles give 24; walls in two frames that meet at a slant four times as many.
    constexpr std::size_t max_rotations = 48;
    const auto angle = [](const Vector3d& a, const Vector3d& b) {
        return std::acos(std::clamp(a.dot(b), -1.0, 1.0));
    };
    std::vector<RotationCandidate> all;
    for (std::size_t a = 0; a < source.size(); ++a) {
        for (std::size_t b = a + 1; b < source.size(); ++b) {
            const double source_angle = angle(source[a].direction, source[b].direction);
            if (source_angle < radians(30.0) || source_angle > radians(150.0)) continue;
            for (std::size_t c = 0; c < target.size(); ++c) {
                for (std::size_t d = 0; d < target.size(); ++d) {
                    if (c == d) continue;
                    const double target_angle = angle(target[c].direction, target[d].direction);
                    if (std::abs(source_angle - target_angle) > max_difference) continue;
                    const RotationCandidate candidate =
                        settle_rotation(rotation_between(source[a].direction, source[b].direction,
                                                         target[c].direction, target[d].direction),
                                        source, target);
                    const bool is_known =
                        std::any_of(all.begin(), all.end(), [&](const RotationCandidate& other) {
                            return rotation_angle(other.rotation.transpose() * candidate.rotation) <
                                   same_rotation;
                        });
                    if (!is_known) all.push_back(candidate);
                }
            }
        }
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const auto& a, const auto& b) { return a.shared > b.shared; });
    all.resize(std::min(all.size(), max_rotations));
    return all;
}

/// How much surface that looks along an axis lies how far along it, one histogram for either way.
class AxisHistogram {
  public:
    AxisHistogram(std::span<const Eigen::Vector3f> positions,
                  std::span<const Eigen::Vector3f> normals, const Matrix3d& rotation,
                  const Vector3d& axis, double bin) {
        const Eigen::Vector3f along = (rotation.transpose() * axis).cast<float>();
        const auto min_cosine = static_cast<float>(std::cos(radians(25.0)));
        low_ = std::numeric_limits<int>::max();
        int high = std::numeric_limits<int>::min();
        std::vector<std::pair<int, int>> entries;  // (bin, 0 or 1)
        entries.reserve(positions.size());
        for (std::size_t i = 0; i < positions.size(); ++i) {
            const float cosine = normals[i].dot(along);
            if (!(std::abs(cosine) >= min_cosine)) continue;
            const int place =
                static_cast<int>(std::floor(static_cast<double>(positions[i].dot(along)) / bin));
            entries.emplace_back(place, cosine > 0.0F ? 0 : 1);
            low_ = std::min(low_, place);
            high = std::max(high, place);
        }
        if (entries.empty()) {
            low_ = 0;
            return;
        }
        for (auto& counts : counts_)
            counts.assign(static_cast<std::size_t>(high - low_) + 1, 0.0F);
        for (const auto& [place, way] : entries)
            counts_[static_cast<std::size_t>(way)][static_cast<std::size_t>(place - low_)] += 1.0F;
    }

    int size() const { return static_cast<int>(counts_[0].size()); }
    int low() const { return low_; }

    /// Surface that falls together if this one is shifted by so many bins, and up to a bin more or
    /// less.
    double shared(const AxisHistogram& other, int shift) const {
        double sum = 0.0;
        for (std::size_t way = 0; way < 2; ++way) {
            for (int i = 0; i < size(); ++i) {
                const int j = i + low_ + shift - other.low_;
                if (counts_[way][static_cast<std::size_t>(i)] == 0.0F) continue;
                if (j < 0 || j >= other.size()) continue;
                sum +=
                    static_cast<double>(std::min(counts_[way][static_cast<std::size_t>(i)],
                                                 other.counts_[way][static_cast<std::size_t>(j)]));
            }
        }
        return sum;
    }

  private:
    int low_ = 0;
    std::array<std::vector<float>, 2> counts_;
};

struct ShiftCandidate {
    double shift = 0.0;  ///< m
    double shared = 0.0;
};

/// The shifts along an axis that bring most surface together: peaks, best first.
std::vector<ShiftCandidate> list_shifts(const AxisHistogram& source, const AxisHistogram& target,
                                        double bin, std::size_t max_count) {
    std::vector<ShiftCandidate> peaks;
    if (source.size() == 0 || target.size() == 0) return peaks;
    const int first = target.low() - source.low() - source.size();
    const int last = target.low() + target.size() - source.low();
    std::vector<double> raw(static_cast<std::size_t>(last - first) + 1);
    for (int shift = first; shift <= last; ++shift)
        raw[static_cast<std::size_t>(shift - first)] = source.shared(target, shift);
    // A plane may fall into two bins of one scan and into one of the other.
    const auto smooth = [&](std::size_t i) {
        return 0.5 * (i > 0 ? raw[i - 1] : 0.0) + raw[i] +
               0.5 * (i + 1 < raw.size() ? raw[i + 1] : 0.0);
    };
    std::vector<double> smoothed(raw.size());
    for (std::size_t i = 0; i < raw.size(); ++i)
        smoothed[i] = smooth(i);
    for (std::size_t i = 1; i + 1 < smoothed.size(); ++i) {
        if (smoothed[i] <= 0.0 || smoothed[i] < smoothed[i - 1] || smoothed[i] <= smoothed[i + 1])
            continue;
        const double weight = smoothed[i - 1] + smoothed[i] + smoothed[i + 1];
        const double offset = (smoothed[i + 1] - smoothed[i - 1]) / weight;
        peaks.push_back({(first + static_cast<double>(i) + offset) * bin, smoothed[i]});
    }
    std::stable_sort(peaks.begin(), peaks.end(),
                     [](const auto& a, const auto& b) { return a.shared > b.shared; });
    peaks.resize(std::min(peaks.size(), max_count));
    return peaks;
}

/// Shifts along an axis from one end of the overlap to the other: where little surface faces that
/// way, as along a corridor or from one wall, no histogram knows the right one.
std::vector<double> list_slides(const PreparedScan& source, const PreparedScan& target,
                                const Matrix3d& rotation, const Vector3d& axis, double step) {
    constexpr int max_slides = 120;
    const auto extent = [](std::span<const Eigen::Vector3f> positions, const Vector3d& along) {
        std::pair<double, double> ends{std::numeric_limits<double>::max(),
                                       std::numeric_limits<double>::lowest()};
        for (const Eigen::Vector3f& position : positions) {
            const auto place = static_cast<double>(position.dot(along.cast<float>()));
            ends = {std::min(ends.first, place), std::max(ends.second, place)};
        }
        return ends;
    };
    const auto [source_low, source_high] =
        extent(source.coarse_sample.positions, rotation.transpose() * axis);
    const auto [target_low, target_high] = extent(target.coarse_sample.positions, axis);
    const double first = target_low - source_high;
    const double range = target_high - source_low - first;
    if (!(range > 0.0)) return {};
    step = std::max(step, range / max_slides);
    std::vector<double> slides;
    for (int i = 1; i * step < range; ++i)
        slides.push_back(first + i * step);
    return slides;
}

/// The pairs of shifts along two axes that bring most surface together.
std::vector<std::pair<double, double>> best_pairs(std::span<const ShiftCandidate> first,
                                                  std::span<const ShiftCandidate> second) {
    constexpr std::size_t max_pairs = 6;
    std::vector<std::pair<ShiftCandidate, ShiftCandidate>> all;
    for (const ShiftCandidate& a : first) {
        for (const ShiftCandidate& b : second)
            all.emplace_back(a, b);
    }
    std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
        return a.first.shared + a.second.shared > b.first.shared + b.second.shared;
    });
    all.resize(std::min(all.size(), max_pairs));
    std::vector<std::pair<double, double>> pairs;
    pairs.reserve(all.size());
    for (const auto& [a, b] : all)
        pairs.emplace_back(a.shift, b.shift);
    return pairs;
}

/// Three directions of the target that span space, those with most shared surface first; what is
/// missing is filled by their cross product.
Matrix3d choose_axes(const RotationCandidate& candidate, std::span<const SurfaceDirection> source,
                     std::span<const SurfaceDirection> target) {
    std::vector<SurfaceDirection> shared;
    const double min_cosine = std::cos(same_direction_angle);
    for (const SurfaceDirection& to : target) {
        double weight = 0.0;
        for (const SurfaceDirection& from : source) {
            if ((candidate.rotation * from.direction).dot(to.direction) >= min_cosine)
                weight += std::min(from.share, to.share);
        }
        if (weight > 0.0) shared.push_back({to.direction, weight});
    }
    std::stable_sort(shared.begin(), shared.end(),
                     [](const auto& a, const auto& b) { return a.share > b.share; });
    std::vector<Vector3d> axes;
    for (const SurfaceDirection& surface : shared) {
        const Vector3d& direction = surface.direction;
        const bool adds = std::all_of(axes.begin(), axes.end(), [&](const Vector3d& axis) {
            return std::abs(axis.dot(direction)) < std::cos(radians(50.0));
        });
        const bool spans =
            axes.size() < 2 || std::abs(axes[0].cross(axes[1]).normalized().dot(direction)) > 0.5;
        if (adds && spans) axes.push_back(direction);
        if (axes.size() == 3) break;
    }
    if (axes.size() == 2) axes.push_back(axes[0].cross(axes[1]).normalized());
    Matrix3d result = Matrix3d::Zero();
    for (std::size_t i = 0; i < axes.size(); ++i)
        result.col(static_cast<Eigen::Index>(i)) = axes[i];
    return result;
}

}  // namespace

bool faces_three_ways(std::span<const SurfaceDirection> directions) {
    constexpr double min_share = 0.05;
    // Walls that look at each other fix the same shift.
    const auto share_of_axis = [directions](const SurfaceDirection& axis) {
        const double cosine = std::cos(same_direction_angle);
        double share = 0.0;
        for (const SurfaceDirection& surface : directions) {
            if (std::abs(surface.direction.dot(axis.direction)) >= cosine) share += surface.share;
        }
        return share;
    };
    Matrix3d spread = Matrix3d::Zero();
    for (const SurfaceDirection& surface : directions) {
        if (share_of_axis(surface) >= min_share)
            spread += surface.direction * surface.direction.transpose();
    }
    // Three at right angles give three times 1; a third that leans out of the plane of two by 30
    // degrees still gives a quarter.
    return Eigen::SelfAdjointEigenSolver<Matrix3d>(spread).eigenvalues()[0] > 0.25;
}

std::vector<Transform> search_poses(const PreparedScan& source, const PreparedScan& target,
                                    const RegistrationScale& scale, const Context& context) {
    constexpr std::size_t shifts_per_axis = 6;
    const double bin = 0.5 * scale.coarse_voxel;
    std::vector<Transform> poses;
    for (const RotationCandidate& candidate :
         list_rotations(source.directions, target.directions)) {
        context.throw_if_cancelled();
        const Matrix3d axes = choose_axes(candidate, source.directions, target.directions);
        if (std::abs(axes.determinant()) < 0.1) continue;
        std::array<std::vector<ShiftCandidate>, 3> shifts;
        for (Eigen::Index i = 0; i < 3; ++i) {
            const AxisHistogram moved(source.coarse.positions, source.coarse.normals,
                                      candidate.rotation, axes.col(i), bin);
            const AxisHistogram fixed(target.coarse.positions, target.coarse.normals,
                                      Matrix3d::Identity(), axes.col(i), bin);
            shifts[static_cast<std::size_t>(i)] = list_shifts(moved, fixed, bin, shifts_per_axis);
        }
        const Matrix3d translation_from_shifts = axes.transpose().inverse();
        const auto add = [&](double a, double b, double c) {
            Transform pose = Transform::Identity();
            pose.linear() = candidate.rotation;
            pose.translation() = translation_from_shifts * Vector3d(a, b, c);
            poses.push_back(pose);
        };
        const std::vector<double> slides =
            list_slides(source, target, candidate.rotation, axes.col(2), 2.0 * scale.coarse_voxel);
        for (const auto& [a, b] : best_pairs(shifts[0], shifts[1])) {
            for (const double slide : slides)
                add(a, b, slide);
        }
        for (const ShiftCandidate& a : shifts[0]) {
            for (const ShiftCandidate& b : shifts[1]) {
                for (const ShiftCandidate& c : shifts[2])
                    add(a.shift, b.shift, c.shift);
            }
        }
    }
    return poses;
}

}  // namespace roomscribe
