// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

#include "roomscribe/core/context.hpp"
#include "roomscribe/pipeline/reconstruct.hpp"

namespace roomscribe {

/// From above with the ceiling taken off, coloured by label, components drawn over it.
std::string plan_figure(const Reconstruction& reconstruction, std::size_t width,
                        const Context& context);

/// A vertical section through the middle, coloured by label.
std::string section_figure(const Reconstruction& reconstruction, std::size_t width,
                           const Context& context);

/// From above as an X-ray, coloured by scan, with the scanners' places.
std::string scans_figure(const Reconstruction& reconstruction, std::size_t width,
                         const Context& context);

/// The largest pieces of furniture that have faces or fixtures, each seen from its front, like the
/// paper's figures 5 and 6. Empty if there are none.
std::string furniture_figures(const Reconstruction& reconstruction, const Context& context);

/// What the label colours of plan and section mean, with points and components per label.
std::string label_legend(const Reconstruction& reconstruction);

}  // namespace roomscribe
