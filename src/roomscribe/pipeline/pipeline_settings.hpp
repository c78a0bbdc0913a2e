// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "roomscribe/core/settings.hpp"
#include "roomscribe/interpretation/fixtures/find_fixtures.hpp"
#include "roomscribe/interpretation/furniture/furniture_settings.hpp"
#include "roomscribe/interpretation/paper_rules/paper_rules_settings.hpp"
#include "roomscribe/interpretation/point_labels.hpp"
#include "roomscribe/interpretation/rooms/room_surfaces.hpp"
#include "roomscribe/interpretation/upright/upright.hpp"
#include "roomscribe/registration/scan_registration.hpp"
#include "roomscribe/structure/principal_axes.hpp"
#include "roomscribe/structure/surface_sample.hpp"

namespace roomscribe {

/// How the planes of a map are found.
enum class PlaneMethod : std::uint8_t {
    growing,  ///< all connected patches, big and small
    ransac,   ///< the paper's: one plane after the other, the largest first
    hough,    ///< the same without drawing lots
};

inline std::span<const std::string_view> enumerator_names(PlaneMethod) {
    static constexpr std::array<std::string_view, 3> names{"growing", "ransac", "hough"};
    return names;
}

/// How the principal axes are found.
enum class AxesMethod : std::uint8_t {
    consensus,    ///< all patches vote with their area
    algorithm_2,  ///< the paper's: the first three perpendicular planes
};

inline std::span<const std::string_view> enumerator_names(AxesMethod) {
    static constexpr std::array<std::string_view, 2> names{"consensus", "algorithm_2"};
    return names;
}

/// How a map is interpreted.
enum class InterpretationMethod : std::uint8_t {
    standard,  ///< what works best ("default")
    paper      ///< the paper's section 4, from its planes to its rules
};

inline std::span<const std::string_view> enumerator_names(InterpretationMethod) {
    static constexpr std::array<std::string_view, 2> names{"default", "paper"};
    return names;
}

struct StructureSettings {
    PlaneMethod plane_method = PlaneMethod::growing;
    AxesMethod axes_method = AxesMethod::consensus;
    std::optional<double> plane_tolerance;
    int min_plane_inliers = 2500;
    SurfaceSampleSettings sample;
    PrincipalAxesSettings axes;

    void visit(SettingVisitor& visitor) {
        visitor(plane_method,
                {.name = "plane_method",
                 .unit = "",
                 .doc = "All connected patches, the paper's RANSAC loop, or the same by the "
                        "Hough transform."});
        visitor(axes_method, {.name = "axes_method",
                              .unit = "",
                              .doc = "A vote of all patches, or the paper's Algorithm 2."});
        visitor(plane_tolerance,
                {.name = "plane_tolerance",
                 .unit = "m",
                 .min = 1e-9,
                 .max = 1e6,
                 .doc = "How far a point of a plane may lie from it; auto: from noise "
                        "and the evenness of finished walls."});
        visitor(min_plane_inliers,
                {.name = "min_plane_inliers",
                 .unit = "",
                 .min = 3,
                 .max = 1e9,
                 .doc = "Fewest inliers of a plane, in the paper's methods only (its 2,500)."});
        visitor.group("sample", sample);
        visitor.group("axes", axes);
    }
};

struct InterpretationSettings {
    InterpretationMethod method = InterpretationMethod::standard;
    UprightSettings upright;
    RoomSurfacesSettings surfaces;
    PointLabelSettings labels;
    PaperRulesSettings paper;  ///< of the method `paper`
    FurnitureSettings furniture;
    FixtureSettings fixtures;

    void visit(SettingVisitor& visitor) {
        visitor(method,
                {.name = "method",
                 .unit = "",
                 .doc = "What works best, or the paper's section 4 whole: its planes, axes, "
                        "quadrilaterals and rules, by the settings under paper."});
        visitor.group("upright", upright);
        visitor.group("surfaces", surfaces);
        visitor.group("labels", labels);
        visitor.group("paper", paper);
        visitor.group("furniture", furniture);
        visitor.group("fixtures", fixtures);
    }
};

/// Everything that changes a result, in one tree.
struct PipelineSettings {
    int seed = 1;
    ScanRegistrationSettings registration;
    StructureSettings structure;
    InterpretationSettings interpretation;

    void visit(SettingVisitor& visitor) {
        visitor(seed, {.name = "seed",
                       .unit = "",
                       .min = 0,
                       .max = 2147483647,
                       .doc = "Of all random draws. The same seed gives the same bits."});
        visitor.group("registration", registration);
        visitor.group("structure", structure);
        visitor.group("interpretation", interpretation);
    }
};

}  // namespace roomscribe
