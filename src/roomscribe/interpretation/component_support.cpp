// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/component_support.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <unordered_map>
#include <utility>
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
using SupportByInstance = std::vector<Support>;

void add(Support& sum, const Support& other) {
    sum.points += other.points;
    std::vector<std::size_t> scans;
    std::set_union(sum.scans.begin(), sum.scans.end(), other.scans.begin(), other.scans.end(),
                   std::back_inserter(scans));
    sum.scans = std::move(scans);
    sum.moments += other.moments;
}

bool is_flat(Label label) {
    return label == Label::door || label == Label::furniture;
}

/// Instances are numbered from 0 on.
std::size_t instance_count(std::span<const Component> components) {
    std::size_t count = 0;
    for (const Component& component : components) {
        if (component.instance >= 0)
            count = std::max(count, static_cast<std::size_t>(component.instance) + 1);
    }
    return count;
}

SupportByInstance count_points(const ScanMap& map, const PointLabels& labels,
                               std::size_t num_instances, const Context& context) {
    constexpr std::size_t chunk_size = 262144;
    const auto combine = [](SupportByInstance a, const SupportByInstance& b) {
        for (std::size_t i = 0; i < b.size(); ++i) {
            if (b[i].points > 0) add(a[i], b[i]);
        }
        return a;
    };
    SupportByInstance sum(num_instances);
    for (std::size_t scan = 0; scan < map.sections.size(); ++scan) {
        const MapSection& section = map.sections[scan];
        const auto count_chunk = [&](std::size_t begin, std::size_t end) {
            SupportByInstance counted(num_instances);
            for (std::size_t i = section.first + begin; i < section.first + end; ++i) {
                const std::int32_t instance = labels.instances[i];
                if (instance < 0 || static_cast<std::size_t>(instance) >= num_instances) continue;
                Support& support = counted[static_cast<std::size_t>(instance)];
                if (support.points++ == 0) support.scans.push_back(scan);
                if (is_flat(labels.labels[i]))
                    support.moments.add(map.cloud.positions[i].cast<double>());
            }
            return counted;
        };
        sum = combine(std::move(sum),
                      parallel_reduce(context, section.count, chunk_size,
                                      SupportByInstance(num_instances), count_chunk, combine));
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
    const SupportByInstance by_instance =
        count_points(map, labels, instance_count(components), context);
    std::unordered_map<std::string_view, std::size_t> furniture;
    for (std::size_t i = 0; i < components.size(); ++i) {
        if (components[i].label == Label::furniture) furniture.emplace(components[i].id, i);
    }
    std::vector<Support> supports(components.size());
    for (std::size_t i = 0; i < components.size(); ++i) {
        if (components[i].instance < 0) continue;
        const Support& own = by_instance[static_cast<std::size_t>(components[i].instance)];
        for (const std::size_t owner : owners_of(components, furniture, i))
            add(supports[owner], own);
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
