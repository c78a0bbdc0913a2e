// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "roomscribe/evaluation/protocol.hpp"
#include "roomscribe/model/ground_truth.hpp"

namespace roomscribe {

/// What a class of a foreign data set is in ours.
struct ForeignClass {
    std::string_view name;
    Label label = Label::unknown;
    /// The labels that are right for its points. Every label: the class holds things of several
    /// labels, and its points are left out.
    LabelSet acceptable = label_bit(Label::unknown);
};

struct LabelConvention {
    std::string_view name;
    std::span<const ForeignClass> classes;  ///< by number, from 0
    /// Labels all components of which the data set tells: the others' detections are not scored.
    LabelSet detected_labels = 0;
};

/// "s3dis" (Armeni et al. 2016), the 13 classes in their usual order; "nyu40" (Gupta et al. 2013),
/// the 40 classes that ScanNet's labels use, 0 unlabelled. Empty for an unknown name.
std::optional<LabelConvention> find_label_convention(std::string_view name);

/// Truth of a labelled cloud: a component per instance of a class of detected_labels, without
/// geometry (those labels are compared by points), no poses, z up, x and y as they are. Numbers of
/// classes that the convention does not have are left out like mixed classes. `instances` may be
/// empty; then there are no components. Throws InvalidArgument if an array is not as long as the
/// cloud.
GroundTruth truth_from_labelled_cloud(ScanMap map, std::span<const std::int32_t> classes,
                                      std::span<const std::int32_t> instances,
                                      const LabelConvention& convention);

}  // namespace roomscribe
