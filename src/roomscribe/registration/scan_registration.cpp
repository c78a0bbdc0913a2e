// SPDX-License-Identifier: MIT
#include "roomscribe/registration/scan_registration.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/quantile.hpp"
#include "roomscribe/model/kept_result.hpp"
#include "roomscribe/model/result_bytes.hpp"
#include "roomscribe/preprocessing/beam_offsets.hpp"
#include "roomscribe/preprocessing/false_returns.hpp"
#include "roomscribe/preprocessing/scan_statistics.hpp"
#include "roomscribe/registration/graph/link_consistency.hpp"

namespace roomscribe {
namespace {

/// The scans without what is no return and without their beams' offsets; those that have neither
/// are not copied.
class CleanScans {
  public:
    CleanScans(std::span<const Scan> scans, const Context& context) : as_given_(scans) {
        for (const Scan& scan : scans)
            cleaned_.push_back(without_false_returns(scan, context));
        remove_offsets();
    }
    const Scan& operator[](std::size_t i) const {
        return cleaned_[i] ? *cleaned_[i] : as_given_[i];
    }
    std::size_t size() const { return cleaned_.size(); }

  private:
    void remove_offsets() {
        std::vector<ScannedPoints> points;
        for (std::size_t i = 0; i < size(); ++i) {
            const Scan& scan = (*this)[i];
            points.push_back({scan.cloud.positions, scan.sensor_position(), scan.sensor_axes()});
        }
        const std::vector<std::optional<BeamOffsets>> found = find_beam_offsets(points);
        for (std::size_t i = 0; i < size(); ++i) {
            if (!found[i]) continue;
            if (!cleaned_[i]) cleaned_[i] = as_given_[i];
            remove_beam_offsets(cleaned_[i]->cloud.positions, points[i].sensor_position, *found[i]);
        }
    }

    std::span<const Scan> as_given_;
    std::vector<std::optional<Scan>> cleaned_;
};

std::vector<ScanStatistics> measure_scans(const CleanScans& scans, const Context& context) {
    std::vector<ScanStatistics> statistics;
    statistics.reserve(scans.size());
    for (std::size_t i = 0; i < scans.size(); ++i)
        statistics.push_back(estimate_scan_statistics(scans[i].cloud, context));
    return statistics;
}

double derive_fine_voxel(double coarse_voxel, double spacing, double noise) {
    return std::min(coarse_voxel, std::max({spacing, 2.0 * noise, coarse_voxel / 4.0}));
}

/// The sizes of a scan: what all share, and its own noise and spacing. A depth camera sees what is
/// far with ten times the noise of what is near.
RegistrationScale scale_of_scan(const RegistrationScale& typical, const ScanStatistics& statistics,
                                const ScanRegistrationSettings& settings) {
    if (!(statistics.extent > 0.0)) return typical;
    RegistrationScale scale = typical;
    scale.noise = statistics.noise;
    scale.fine_voxel = settings.fine_voxel.value_or(
        derive_fine_voxel(typical.coarse_voxel, statistics.point_spacing, statistics.noise));
    return scale;
}

/// The sizes that follow from the scans: each with its reason.
RegistrationScale derive_scale(std::span<const ScanStatistics> scans,
                               const ScanRegistrationSettings& settings,
                               std::vector<DerivedValue>& derived) {
    std::vector<double> spacings;
    std::vector<double> noises;
    std::vector<double> extents;
    for (const ScanStatistics& statistics : scans) {
        if (!(statistics.extent > 0.0)) continue;  // no returns, no sizes
        spacings.push_back(statistics.point_spacing);
        noises.push_back(statistics.noise);
        extents.push_back(statistics.extent);
    }
    if (extents.empty()) return {};
    const double spacing = median(spacings);
    const double noise = median(noises);
    const double extent = median(extents);
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
        derive_fine_voxel(scale.coarse_voxel, spacing, noise),
        "largest of the spacing, twice the noise, a quarter of the coarse voxel; each scan's own");
    scale.fpfh_radius = derive("registration.fpfh_radius", settings.fpfh_radius,
                               5.0 * scale.coarse_voxel, "five coarse voxels");
    if (uses_narf_keypoints(settings.pair.features)) {
        scale.narf_support = derive("registration.narf_support", settings.narf_support,
                                    5.0 * scale.coarse_voxel, "five coarse voxels");
    }
    return scale;
}

/// Every scan to the one before (the paper's iterative registration).
std::vector<RegistrationLink> link_in_sequence(std::span<const PreparedScan> prepared,
                                               std::uint64_t seed,
                                               const ScanRegistrationSettings& settings,
                                               const Context& context) {
    std::vector<RegistrationLink> links;
    for (std::size_t scan = 1; scan < prepared.size(); ++scan) {
        context.throw_if_cancelled();
        RegistrationLink& link =
            links.emplace_back(kept(context, fmt::format("pair-{}-{}", scan, scan - 1), [&] {
                return register_pair(prepared[scan], prepared[scan - 1], seed, settings.pair,
                                     context);
            }));
        link.source = scan;
        link.target = scan - 1;
        context.report_progress(
            "register", static_cast<double>(scan + 1) / static_cast<double>(prepared.size()));
    }
    return links;
}

/// An order of the scans that neither the order in which they were given nor the frames in which
/// their points lie decide: by the number of returns, then by size.
std::vector<std::size_t> canonical_order(std::span<const Scan> scans) {
    struct Key {
        std::size_t num_points;
        double size;
    };
    std::vector<Key> keys;
    keys.reserve(scans.size());
    for (const Scan& scan : scans) {
        const std::vector<std::uint32_t> finite = finite_points(scan.cloud);
        std::vector<Eigen::Vector3f> some;
        for (std::size_t i = 0; i < finite.size(); i += 1 + finite.size() / 1000) {
            some.push_back(scan.cloud.positions[finite[i]]);
        }
        keys.push_back({finite.size(), measure_spread(some).covariance.trace()});
    }
    std::vector<std::size_t> order(scans.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&keys](std::size_t a, std::size_t b) {
        return std::tuple(keys[a].num_points, keys[a].size) <
               std::tuple(keys[b].num_points, keys[b].size);
    });
    return order;
}

std::vector<std::optional<KnownPose>> describe_known(
    std::span<const std::optional<Transform>> world_from_scan, std::span<const std::size_t> order,
    const ScanRegistrationSettings& settings) {
    std::vector<std::optional<KnownPose>> known;
    if (world_from_scan.empty()) return known;
    known.resize(world_from_scan.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (!world_from_scan[order[i]]) continue;
        known[i] = KnownPose{*world_from_scan[order[i]], settings.known_rotation,
                             settings.known_translation};
    }
    return known;
}

/// Numbers of scans in `order` become those of the scans as they were given.
void renumber(std::vector<RegistrationLink>& links, std::span<const std::size_t> order) {
    for (RegistrationLink& link : links) {
        link.source = order[link.source];
        link.target = order[link.target];
        if (link.source < link.target) link = reversed(link);
    }
    std::sort(links.begin(), links.end(), [](const auto& a, const auto& b) {
        return std::pair(a.source, a.target) < std::pair(b.source, b.target);
    });
}

}  // namespace

void ScanRegistrationSettings::visit(SettingVisitor& visitor) {
    visitor(sequence, {.name = "sequence",
                       .unit = "",
                       .doc = "Each scan to the one before (the paper's), or a graph of scans in "
                              "any order."});
    visitor(known_poses, {.name = "known_poses",
                          .unit = "",
                          .doc = "What becomes of poses that are given: they pull like links, or "
                                 "they are kept."});
    visitor(known_translation, {.name = "known_translation",
                                .unit = "m",
                                .min = 1e-6,
                                .max = 1e6,
                                .doc = "Standard deviation of given poses."});
    visitor(known_rotation, {.name = "known_rotation",
                             .unit = "rad",
                             .min = 1e-6,
                             .max = 10.0,
                             .doc = "The same of their rotation; 0.0873 is 5 degrees."});
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
    visitor(narf_support, {.name = "narf_support",
                           .unit = "m",
                           .min = 1e-3,
                           .max = 1e3,
                           .doc = "Support size of NARF keypoints and descriptors."});
    visitor.group("pair", pair);
    visitor.group("graph", graph);
    visitor.group("optimization", optimization);
}

ScanRegistration register_scans(std::span<const Scan> scans,
                                std::span<const std::optional<Transform>> known_world_from_scan,
                                std::uint64_t seed, const ScanRegistrationSettings& settings,
                                const Context& context) {
    check_settings(settings);
    if (scans.empty()) throw InvalidArgument("scans", "0", "at least one scan");
    if (!known_world_from_scan.empty() && known_world_from_scan.size() != scans.size()) {
        throw InvalidArgument("known_world_from_scan",
                              fmt::format("{} poses", known_world_from_scan.size()),
                              fmt::format("one per scan, {}, or none", scans.size()));
    }
    ScanRegistration result;
    const CleanScans clean(scans, context);
    const std::vector<ScanStatistics> statistics = measure_scans(clean, context);
    const RegistrationScale scale = derive_scale(statistics, settings, result.derived_values);
    const bool is_graph = settings.sequence == ScanSequence::graph;
    std::vector<std::size_t> as_given(scans.size());
    std::iota(as_given.begin(), as_given.end(), std::size_t{0});
    const std::vector<std::size_t> order = is_graph ? canonical_order(scans) : as_given;
    std::vector<PreparedScan> prepared;
    prepared.reserve(scans.size());
    for (const std::size_t scan : order) {
        prepared.push_back(prepare_scan(clean[scan],
                                        scale_of_scan(scale, statistics[scan], settings),
                                        settings.pair.features, context));
        context.report_progress(
            "prepare", static_cast<double>(prepared.size()) / static_cast<double>(scans.size()));
    }
    std::vector<RegistrationLink> links;
    if (is_graph) {
        links = link_scans(prepared, describe_known(known_world_from_scan, order, settings), scale,
                           seed, settings.pair, settings.graph, context);
        renumber(links, order);
    } else {
        links = link_in_sequence(prepared, seed, settings, context);
    }
    result.registration = place_scans(
        std::move(links), scans.size(), describe_known(known_world_from_scan, as_given, settings),
        settings.known_poses, scale.noise, is_graph ? min_probability_to_place : 0.0,
        settings.optimization, context);
    return result;
}

ScanRegistration register_scans(std::span<const Scan> scans, std::uint64_t seed,
                                const ScanRegistrationSettings& settings, const Context& context) {
    return register_scans(scans, {}, seed, settings, context);
}

}  // namespace roomscribe
