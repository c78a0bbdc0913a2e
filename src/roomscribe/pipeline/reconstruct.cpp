// SPDX-License-Identifier: MIT
#include "roomscribe/pipeline/reconstruct.hpp"

#include <utility>

namespace roomscribe {

Reconstruction register_to_map(std::span<const Scan> scans, const PipelineSettings& settings,
                               const Context& context) {
    Reconstruction result;
    StageTimer timer(result.stage_costs);
    ScanRegistration registration =
        register_scans(scans, static_cast<std::uint64_t>(settings.seed), settings.registration,
                       context);
    timer.finish("register");
    result.map = merge_scans(scans, registration.registration.map_from_scan);
    timer.finish("merge");
    result.registration = std::move(registration.registration);
    result.derived_values = std::move(registration.derived_values);
    return result;
}

void interpret_map(Reconstruction& reconstruction, const PipelineSettings& settings,
                   const Context& context) {
    check_settings(settings);
    context.throw_if_cancelled();
    reconstruction.labels.labels.assign(reconstruction.map.cloud.size(), Label::unknown);
    reconstruction.labels.instances.assign(reconstruction.map.cloud.size(), -1);
    reconstruction.labels.confidences.assign(reconstruction.map.cloud.size(), 0.0F);
}

Reconstruction reconstruct(std::span<const Scan> scans, const PipelineSettings& settings,
                           const Context& context) {
    Reconstruction result = register_to_map(scans, settings, context);
    interpret_map(result, settings, context);
    return result;
}

}  // namespace roomscribe
