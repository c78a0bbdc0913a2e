// SPDX-License-Identifier: MIT
#include "roomscribe/registration/pair/pair_settings.hpp"

namespace roomscribe {

void PairRegistrationSettings::visit(SettingVisitor& visitor) {
    visitor(
        initial_alignment,
        {.name = "initial_alignment",
         .unit = "",
         .doc =
             "How poses are found: from descriptor matches by the paper's sample consensus or as "
             "several candidates from the compatibility graph, or from the scans' surfaces, "
             "and from the graph where these hold none."});
    visitor(features,
            {.name = "features",
             .unit = "",
             .doc = "What points are matched by: FPFH at distinctive points or at NARF keypoints, "
                    "NARF, or the matches of fpfh and narf combined (the paper's)."});
    visitor(match_method,
            {.name = "match_method",
             .unit = "",
             .doc = "Every descriptor to its nearest, or only those that are nearest both ways."});
    visitor(match_tolerance,
            {.name = "match_tolerance",
             .unit = "m",
             .min = 1e-6,
             .max = 1e6,
             .doc = "How far a motion may leave the points of its matches apart; auto: 1.5 coarse "
                    "voxels."});
    visitor(icp_method, {.name = "icp_method", .unit = "", .doc = "What ICP minimises."});
    visitor(icp_max_iterations,
            {.name = "icp_max_iterations",
             .unit = "",
             .min = 1,
             .max = 100'000,
             .doc = "Most iterations of the fine alignment (the paper's 100)."});
    visitor(icp_kernel, {.name = "icp_kernel",
                         .unit = "",
                         .doc = "How much a pair of points counts in the fine alignment by its "
                                "residual."});
    visitor.group("covariance", covariance);
    visitor(max_candidates, {.name = "max_candidates",
                             .unit = "",
                             .min = 1,
                             .max = 1000,
                             .doc = "Most candidate poses that are held against the scans."});
    visitor(min_overlap,
            {.name = "min_overlap",
             .unit = "",
             .min = 0.0,
             .max = 1.0,
             .doc = "A link is rejected if a smaller share of the points has a counterpart; three "
                    "tenths of it are enough between scans that see around themselves."});
    visitor(
        min_agreement,
        {.name = "min_agreement",
         .unit = "",
         .min = 0.0,
         .max = 1.0,
         .doc = "... or if, of the points on which the other scan has a say, a smaller share is "
                "confirmed."});
    visitor(min_agreement_alone,
            {.name = "min_agreement_alone",
             .unit = "",
             .min = 0.0,
             .max = 1.0,
             .doc = "The same where it is not known what the scanners' rays passed through."});
    visitor(min_probability,
            {.name = "min_probability",
             .unit = "",
             .min = 0.0,
             .max = 1.0,
             .doc = "A link is ambiguous, or rejected, if its pose is less likely to be right."});
}

}  // namespace roomscribe
