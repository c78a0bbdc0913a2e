// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/scanning/light_path.hpp"

#include "roomscribe/simulation/scanning/line_of_sight.hpp"
#include "roomscribe/simulation/scanning/surface_response.hpp"

namespace roomscribe {
namespace {

constexpr int max_bounces = 4;
constexpr double mirror_reflectance = 0.9;

}  // namespace

Echo trace_ray(const RayCaster& caster, const Eigen::Vector3d& origin,
               const Eigen::Vector3d& direction, Random& random) {
    Eigen::Vector3d from = origin;
    Eigen::Vector3d along = direction;
    double length = 0.0;
    double kept = 1.0;  // of the light, there and back
    bool is_ghost = false;
    for (int bounce = 0; bounce <= max_bounces; ++bounce) {
        const std::optional<RayHit> hit = caster.cast(from, along);
        if (!hit) return {};
        length += hit->distance;
        const WorldPart& part = caster.world().parts[hit->part];

        if (part.material == Material::mirror) {
            const Eigen::Vector3d normal = hit->normal.cast<double>();
            from += hit->distance * along;
            along = (along - 2.0 * along.dot(normal) * normal).normalized();
            kept *= mirror_reflectance * mirror_reflectance;
            is_ghost = true;
            continue;
        }
        if (is_pane(part)) {
            const PaneShares shares = pane_shares(part.transparency, hit->cosine);
            const double fate = random.uniform();
            if (fate < shares.passed) {
                from += hit->distance * along;
                kept *= part.transparency * part.transparency;
                continue;
            }
            if (fate > shares.passed + shares.returned) return {};
        }

        const SurfaceResponse& surface = surface_response(part.material);
        const double loss = glare_loss(surface, hit->cosine);
        if (loss > 0.0 && random.uniform() < loss) return {};
        return {.range = static_cast<float>(length),
                .cosine = static_cast<float>(hit->cosine),
                .strength = static_cast<float>(kept * echo_strength(surface, hit->cosine)),
                .part = hit->part,
                .is_ghost = is_ghost};
    }
    return {};
}

}  // namespace roomscribe
