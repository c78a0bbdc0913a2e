// SPDX-License-Identifier: MIT
#include "roomscribe/registration/scan_registration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/preprocessing/scan_statistics.hpp"

namespace roomscribe {
namespace {

double median_of(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// The sizes that follow from the scans: each with its reason.
RegistrationScale derive_scale(std::span<const Scan> scans,
                               const ScanRegistrationSettings& settings,
                               std::vector<DerivedValue>& derived, const Context& context) {
    std::vector<double> spacings;
    std::vector<double> noises;
    std::vector<double> extents;
    for (const Scan& scan : scans) {
        const ScanStatistics statistics = estimate_scan_statistics(scan.cloud, context);
        if (!(statistics.extent > 0.0)) continue;  // no returns, no sizes
        spacings.push_back(statistics.point_spacing);
        noises.push_back(statistics.noise);
        extents.push_back(statistics.extent);
    }
    if (extents.empty()) return {};
    const double spacing = median_of(spacings);
    const double noise = median_of(noises);
    const double extent = median_of(extents);
    const auto derive = [&derived](std::string name, const std::optional<double>& fixed,
                                   double value, std::string reason) {
        if (fixed) {
            value = *fixed;
            reason = "set by hand";
        }
        derived.push_back({std::move(name), value, "m", std::move(reason)});
        return value;
    };
    derive("registration.point_spacing", {}, spacing, "median of the scans, over their surface");
    derive("registration.noise", {}, noise, "residuals of smooth surface, median of the scans");

    // Door and window reveals, furniture and columns are some decimetres: with descriptors of five
    // voxels' radius a coarser voxel would not see them, however long the corridor.
    constexpr double max_structure = 0.15;
    RegistrationScale scale;
    scale.noise = noise;
    scale.coarse_voxel =
        derive("registration.coarse_voxel", settings.coarse_voxel,
               std::max({std::min(extent / 100.0, max_structure), 2.0 * spacing, 4.0 * noise}),
               fmt::format("largest of 1/100 of the extent ({:.1f} m, at most {} m), twice the "
                           "spacing, four times the noise",
                           extent, max_structure));
    scale.fine_voxel = derive(
        "registration.fine_voxel", settings.fine_voxel,
        std::min(scale.coarse_voxel, std::max({spacing, 2.0 * noise, scale.coarse_voxel / 4.0})),
        "largest of the spacing, twice the noise, a quarter of the coarse voxel");
    scale.fpfh_radius = derive("registration.fpfh_radius", settings.fpfh_radius,
                               5.0 * scale.coarse_voxel, "five coarse voxels");
    return scale;
}

/// Registers scan after scan to those that have a place.
class SequencePlacer {
  public:
    SequencePlacer(std::span<const PreparedScan> prepared, const RegistrationScale& scale,
                   std::uint64_t seed, const ScanRegistrationSettings& settings,
                   const Context& context)
        : prepared_(prepared), scale_(scale), seed_(seed), settings_(settings), context_(context) {
        registration_.map_from_scan.resize(prepared.size());
        registration_.map_from_scan.front() = Transform::Identity();
        placed_.push_back(0);
    }

    Registration run() && {
        std::vector<std::size_t> waiting;
        for (std::size_t scan = 1; scan < prepared_.size(); ++scan) {
            if (!place(scan, placed_)) waiting.push_back(scan);
            context_.report_progress(
                "register", static_cast<double>(scan + 1) / static_cast<double>(prepared_.size()));
        }
        place_waiting(std::move(waiting));
        add_residuals();
        return std::move(registration_);
    }

  private:
    /// Tries the partners, latest first, until a link is accepted; an ambiguous one will do if none
    /// is.
    bool place(std::size_t scan, std::span<const std::size_t> partners) {
        std::optional<RegistrationLink> ambiguous;
        const std::vector<std::size_t> latest_first(partners.rbegin(), partners.rend());
        for (const std::size_t partner : latest_first) {
            context_.throw_if_cancelled();
            RegistrationLink link = register_pair(prepared_[scan], prepared_[partner], scale_,
                                                  seed_, settings_.pair, context_);
            link.source = scan;
            link.target = partner;
            registration_.links.push_back(link);
            if (link.verdict == LinkVerdict::accepted) {
                settle(link);
                return true;
            }
            if (link.verdict == LinkVerdict::ambiguous && !ambiguous) ambiguous = link;
        }
        if (ambiguous) settle(*ambiguous);
        return ambiguous.has_value();
    }

    void settle(const RegistrationLink& link) {
        registration_.map_from_scan[link.source] =
            *registration_.map_from_scan[link.target] * link.target_from_source;
        placed_.push_back(link.source);
    }

    /// A scan may touch only scans that were placed after its turn.
    void place_waiting(std::vector<std::size_t> waiting) {
        std::size_t num_tried = 1;
        while (!waiting.empty() && num_tried < placed_.size()) {
            const std::vector<std::size_t> new_partners(
                placed_.begin() + static_cast<std::ptrdiff_t>(num_tried), placed_.end());
            num_tried = placed_.size();
            std::erase_if(waiting, [&](std::size_t scan) {
                std::vector<std::size_t> untried;
                for (const std::size_t partner : new_partners) {
                    if (!was_tried(scan, partner)) untried.push_back(partner);
                }
                return place(scan, untried);
            });
        }
    }

    bool was_tried(std::size_t source, std::size_t target) const {
        return std::any_of(registration_.links.begin(), registration_.links.end(),
                           [&](const RegistrationLink& link) {
                               return link.source == source && link.target == target;
                           });
    }

    void add_residuals() {
        std::vector<double> squares(prepared_.size(), 0.0);
        std::vector<double> counts(prepared_.size(), 0.0);
        for (const RegistrationLink& link : registration_.links) {
            if (link.verdict == LinkVerdict::rejected) continue;
            const auto inliers = static_cast<double>(link.inliers);
            for (const std::size_t scan : {link.source, link.target}) {
                squares[scan] += inliers * link.rmse * link.rmse;
                counts[scan] += inliers;
            }
        }
        for (std::size_t scan = 0; scan < prepared_.size(); ++scan) {
            registration_.residuals.push_back(counts[scan] > 0.0
                                                  ? std::sqrt(squares[scan] / counts[scan])
                                                  : std::numeric_limits<double>::quiet_NaN());
        }
    }

    std::span<const PreparedScan> prepared_;
    RegistrationScale scale_;
    std::uint64_t seed_;
    const ScanRegistrationSettings& settings_;
    const Context& context_;
    Registration registration_;
    std::vector<std::size_t> placed_;
};

}  // namespace

void ScanRegistrationSettings::visit(SettingVisitor& visitor) {
    visitor(coarse_voxel, {.name = "coarse_voxel",
                           .unit = "m",
                           .min = 1e-6,
                           .max = 1e6,
                           .doc = "Spacing of the points that are matched."});
    visitor(fine_voxel, {.name = "fine_voxel",
                         .unit = "m",
                         .min = 1e-6,
                         .max = 1e6,
                         .doc = "Spacing of the points that ICP aligns."});
    visitor(fpfh_radius, {.name = "fpfh_radius",
                          .unit = "m",
                          .min = 1e-6,
                          .max = 1e6,
                          .doc = "Radius of the FPFH descriptors."});
    visitor.group("pair", pair);
}

ScanRegistration register_scans(std::span<const Scan> scans, std::uint64_t seed,
                                const ScanRegistrationSettings& settings, const Context& context) {
    check_settings(settings);
    if (scans.empty()) throw InvalidArgument("scans", "0", "at least one scan");
    ScanRegistration result;
    const RegistrationScale scale = derive_scale(scans, settings, result.derived_values, context);
    std::vector<PreparedScan> prepared;
    prepared.reserve(scans.size());
    for (const Scan& scan : scans) {
        prepared.push_back(prepare_scan(scan, scale, context));
        context.report_progress(
            "prepare", static_cast<double>(prepared.size()) / static_cast<double>(scans.size()));
    }
    result.registration = SequencePlacer(prepared, scale, seed, settings, context).run();
    return result;
}

}  // namespace roomscribe
