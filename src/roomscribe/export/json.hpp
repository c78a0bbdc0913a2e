// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/model/correction.hpp"
#include "roomscribe/model/registration_result.hpp"
#include "roomscribe/model/scene.hpp"

namespace roomscribe {

/// scene.json (docs/formats.md): accepted and doubtful components; rejected ones are left out. A
/// key whose value would be empty is left out too. Lengths are rounded to 1e-6 m, directions to
/// 1e-9. The same scene gives the same text. Throws InvalidArgument if a number is not finite.
std::string scene_to_json(const Scene& scene);

/// Reads what scene_to_json writes; unknown keys are ignored, what is absent or null keeps its
/// default. Throws IoError, which names `path`, for text that is not JSON or not a scene of version
/// 1: with the byte, or with the place as in components[3].polygon[0].
Scene scene_from_json(std::string_view text, const std::string& path = "scene.json");

/// registration.json: every link, and per scan its name, whether it has a place, and its residual.
/// Covariances are of (rotation vector, translation) of target_from_source, rad2 / rad m / m2.
/// Poses are between the scans' own coordinates less their global shifts. A residual that is not
/// finite is null. Precondition: one name per scan.
std::string registration_to_json(const Registration& registration,
                                 std::span<const std::string> scan_names);

/// What registration.json says of one scan.
struct ScanRecord {
    std::string name;
    bool is_placed = false;
    bool is_doubtful = false;
    std::optional<double> residual;  ///< m
    std::optional<double> overlap;   ///< the largest share of it that another scan has as well
    std::optional<Eigen::Matrix<double, 6, 6>> covariance;  ///< of its pose in the map
};

struct RegistrationRecord {
    std::vector<ScanRecord> scans;
    std::vector<std::vector<std::size_t>> components;  ///< as Registration has them
    std::vector<RegistrationLink> links;               ///< without the stop reasons
};

/// Reads what registration_to_json wrote; unknown keys are ignored. Throws IoError, which names
/// `path`, as scene_from_json does, also for a link or component of a scan that is not listed.
RegistrationRecord registration_from_json(std::string_view text,
                                          const std::string& path = "registration.json");

/// Reads corrections.json (docs/formats.md), with coordinates as the file has them. Throws IoError,
/// which names `path`, as scene_from_json does: also for an element without a shape, a size that
/// does not fit it, and an action that is none.
std::vector<Correction> corrections_from_json(std::string_view text,
                                              const std::string& path = "corrections.json");

/// Any JSON text, laid out to be read: an array without objects or nested arrays stays on one line,
/// all else is indented by two blanks. Keys keep their order. Throws InvalidArgument if the text is
/// not JSON.
std::string lay_out_json(std::string_view text);

}  // namespace roomscribe
