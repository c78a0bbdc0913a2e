// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/component_support.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/geometry/plane.hpp"

namespace roomscribe {
namespace {

/// Points of one instance.
struct Support {
    std::uint64_t points = 0;
    std::vector<std::size_t> scans;  ///< ascending
    PlaneMoments moments;            ///< of flat things alone
};
using SupportByInstance = std::map<std::int32_t, Support>;

void add_scan(std::vector<std::size_t>& scans, std::size_t scan) {
    const auto place = std::lower_bound(scans.begin(), scans.end(), scan);
    if (place == scans.end() || *place != scan) scans.insert(place, scan);
}

void add(Support& sum, const Support& other) {
    sum.points += other.points;
    for (const std::size_t scan : other.scans)
        add_scan(sum.scans, scan);
    sum.moments += other.moments;
}

bool is_flat(Label label) {
    return label == Label::door || label == Label::furniture;
}

/// Support by instance of a run of points that one scan saw.
SupportByInstance count_points(const ScanMap& map, const PointLabels& labels, std::size_t scan,
                               std::size_t begin, std::size_t end) {
    SupportByInstance counted;
    for (std::size_t i = begin; i < end; ++i) {
        if (labels.instances[i] < 0) continue;
        Support& support = counted[labels.instances[i]];
        ++support.points;
        if (support.scans.empty()) support.scans.push_back(scan);
        if (is_flat(labels.labels[i])) support.moments.add(map.cloud.positions[i].cast<double>());
    }
    return counted;
}

SupportByInstance count_points(const ScanMap& map, const PointLabels& labels,
                               const Context& context) {
    constexpr std::size_t chunk_size = 65536;
    SupportByInstance sum;
    for (std::size_t scan = 0; scan < map.sections.size(); ++scan) {
        const MapSection& section = map.sections[scan];
        const auto map_chunk = [&](std::size_t begin, std::size_t end) {
            return count_points(map, labels, scan, section.first + begin, section.first + end);
        };
        const auto combine = [](SupportByInstance a, SupportByInstance b) {
            for (const auto& [instance, support] : b)
                add(a[instance], support);
            return a;
        };
        sum = combine(std::move(sum), parallel_reduce(context, section.count, chunk_size,
                                                      SupportByInstance{}, map_chunk, combine));
    }
    return sum;
}

/// The component itself and the pieces of furniture that it is part of, by their numbers.
std::vector<std::size_t> owners_of(
    std::span<const Component> components,
    const std::unordered_map<std::string_view, std::size_t>& furniture, std::size_t part) {
    std::vector<std::size_t> owners{part};
    for (auto parent = furniture.find(components[part].parent); parent != furniture.end();
         parent = furniture.find(components[parent->second].parent)) {
        // A chain that bites its own tail ends there.
        if (std::find(owners.begin(), owners.end(), parent->second) != owners.end()) break;
        owners.push_back(parent->second);
    }
    return owners;
}

}  // namespace

void measure_support(const ScanMap& map, const PointLabels& labels, std::span<Component> components,
                     const Context& context) {
    const SupportByInstance by_instance = count_points(map, labels, context);
    std::unordered_map<std::string_view, std::size_t> furniture;
    for (std::size_t i = 0; i < components.size(); ++i) {
        if (components[i].label == Label::furniture) furniture.emplace(components[i].id, i);
    }
    std::vector<Support> supports(components.size());
    for (std::size_t i = 0; i < components.size(); ++i) {
        const auto own = by_instance.find(components[i].instance);
        if (own == by_instance.end()) continue;
        for (const std::size_t owner : owners_of(components, furniture, i))
            add(supports[owner], own->second);
    }
    for (std::size_t i = 0; i < components.size(); ++i) {
        Component& component = components[i];
        component.evidence.points = supports[i].points;
        component.evidence.scans = supports[i].scans.size();
        const bool is_face = is_flat(component.label) && !component.polygon.empty();
        if (!is_face || component.evidence.rms) continue;
        if (const auto fit = supports[i].moments.fit()) component.evidence.rms = fit->rms;
    }
}

}  // namespace roomscribe
