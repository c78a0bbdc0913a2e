// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/scanning/beam.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "roomscribe/geometry/plane.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

constexpr std::size_t num_sub_rays = 8;
/// Depths closer than this in one beam are one surface, to anyone who looks at the points.
constexpr double same_depth = 0.03;

struct SubRay {
    Echo echo;
    double light = 0.0;  ///< that returns along it
};

LabelSet acceptable_labels(const SimulatedWorld& world, const Echo& echo) {
    return echo.is_ghost ? label_bit(Label::unknown) : world.parts[echo.part].acceptable;
}

/// The part that most light comes from.
const SubRay& largest_share(std::span<const SubRay> group) {
    const SubRay* best = nullptr;
    double most = -1.0;
    for (const SubRay& candidate : group) {
        double light = 0.0;
        for (const SubRay& other : group) {
            if (other.echo.part == candidate.echo.part) light += other.light;
        }
        if (light > most) {
            most = light;
            best = &candidate;
        }
    }
    return *best;
}

/// One range for sub-rays in the order of their ranges.
BeamReturn melt(const SimulatedWorld& world, std::span<const SubRay> group,
                double pulse_resolution) {
    const auto nearest = static_cast<double>(group.front().echo.range);
    double light = 0.0;
    double weights = 0.0;
    double range = 0.0;
    double cosine = 0.0;
    double strength = 0.0;
    BeamReturn result;
    bool is_one_component = true;
    for (const SubRay& ray : group) {
        const auto distance = static_cast<double>(ray.echo.range);
        // The leading edge of the pulse decides: what comes later moves it less.
        const double weight = ray.light * std::exp((nearest - distance) / pulse_resolution);
        light += ray.light;
        weights += weight;
        range += weight * distance;
        cosine += ray.light * static_cast<double>(ray.echo.cosine);
        strength += static_cast<double>(ray.echo.strength);
        result.acceptable |= acceptable_labels(world, ray.echo);
        is_one_component = is_one_component && world.parts[ray.echo.part].component ==
                                                   world.parts[group.front().echo.part].component;
    }
    result.echo = largest_share(group).echo;
    result.echo.range = static_cast<float>(range / weights);
    result.echo.cosine = static_cast<float>(cosine / light);
    result.echo.strength = static_cast<float>(strength / num_sub_rays);
    const double spread = static_cast<double>(group.back().echo.range - group.front().echo.range);
    if (!is_one_component || spread > same_depth) result.acceptable |= label_bit(Label::unknown);
    return result;
}

/// The sub-rays of one beam.
class Beam {
  public:
    Beam(const RayCaster& caster, const ScannerModel& model, const Vector3d& origin,
         const Vector3d& direction, double range, const Random& luck)
        : caster_(caster),
          origin_(origin),
          direction_(direction),
          axes_(plane_axes(direction)),
          luck_(luck),
          radius_(0.5 * (model.divergence + model.beam_exit / range)),
          phase_(Random(luck).uniform(0.0, 2.0 * std::numbers::pi)) {}

    /// The sub-rays from number `first` on, in a sunflower pattern of equal areas (Vogel 1979), the
    /// last at the rim.
    void trace(std::size_t first, std::size_t end) {
        for (std::size_t i = first; i < end; ++i) {
            const double angle = phase_ + 2.399963 * static_cast<double>(i);
            const double offset =
                radius_ * std::sqrt((static_cast<double>(i) + 0.5) / num_sub_rays);
            const Vector3d ray =
                direction_ + offset * (std::cos(angle) * axes_.u + std::sin(angle) * axes_.v);
            Random own_luck = luck_;
            const Echo echo = trace_ray(caster_, origin_, ray.normalized(), own_luck);
            if (!echo || echo.strength <= 0.0F) continue;
            const auto range = static_cast<double>(echo.range);
            rays_[count_++] = {echo, static_cast<double>(echo.strength) / (range * range)};
        }
    }

    double radius() const { return radius_; }  ///< angle
    std::span<SubRay> found() { return {rays_.data(), count_}; }

  private:
    const RayCaster& caster_;
    const Vector3d& origin_;
    const Vector3d& direction_;
    PlaneAxes axes_;
    const Random& luck_;
    double radius_;
    double phase_;
    std::array<SubRay, num_sub_rays> rays_;
    std::size_t count_ = 0;
};

/// The group of sub-rays that most light comes from, as one range. Groups are apart by more than a
/// pulse resolves.
BeamReturn strongest_group(const SimulatedWorld& world, std::span<SubRay> rays,
                           double pulse_resolution) {
    std::sort(rays.begin(), rays.end(),
              [](const SubRay& a, const SubRay& b) { return a.echo.range < b.echo.range; });
    std::span<const SubRay> strongest;
    double most_light = 0.0;
    std::size_t begin = 0;
    for (std::size_t end = 1; end <= rays.size(); ++end) {
        const bool is_gap =
            end == rays.size() ||
            static_cast<double>(rays[end].echo.range - rays[end - 1].echo.range) > pulse_resolution;
        if (!is_gap) continue;
        double light = 0.0;
        for (std::size_t i = begin; i < end; ++i)
            light += rays[i].light;
        if (light > most_light) {
            most_light = light;
            strongest = rays.subspan(begin, end - begin);
        }
        begin = end;
    }
    return strongest.empty() ? BeamReturn{} : melt(world, strongest, pulse_resolution);
}

/// True if the rim of a beam, of so many sub-rays and this radius in metres, meets what its middle
/// does: nothing, or one plane.
bool is_all_one(std::span<const SubRay> rim, std::size_t num_sent, const Echo& center,
                double radius) {
    if (!center) return rim.empty();
    const double cosine = std::max(0.1, static_cast<double>(center.cosine));
    const double slope = std::sqrt(1.0 - std::min(1.0, cosine * cosine)) / cosine;
    const double tolerance = 0.5 * same_depth + radius * slope;
    return rim.size() == num_sent && std::all_of(rim.begin(), rim.end(), [&](const SubRay& ray) {
               return ray.echo.part == center.part &&
                      static_cast<double>(std::abs(ray.echo.range - center.range)) < tolerance;
           });
}

}  // namespace

BeamReturn thin_beam(const SimulatedWorld& world, const Echo& echo) {
    if (!echo) return {};
    return {echo, acceptable_labels(world, echo)};
}

BeamReturn spread_beam(const RayCaster& caster, const ScannerModel& model, const Vector3d& origin,
                       const Vector3d& direction, const Echo& center, double range,
                       const Random& luck) {
    constexpr std::size_t num_inner = num_sub_rays - 4;
    Beam beam(caster, model, origin, direction, range, luck);
    beam.trace(num_inner, num_sub_rays);
    if (is_all_one(beam.found(), num_sub_rays - num_inner, center, beam.radius() * range))
        return thin_beam(caster.world(), center);
    beam.trace(0, num_inner);
    return strongest_group(caster.world(), beam.found(), model.pulse_resolution);
}

}  // namespace roomscribe
