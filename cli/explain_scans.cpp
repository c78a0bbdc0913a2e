// SPDX-License-Identifier: MIT
#include "cli/explain_scans.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "cli/text_table.hpp"
#include "roomscribe/core/units.hpp"

namespace roomscribe::cli {
namespace {

using Json = nlohmann::ordered_json;

std::vector<const RegistrationLink*> links_of(const RegistrationRecord& registration,
                                              std::size_t scan) {
    std::vector<const RegistrationLink*> links;
    for (const RegistrationLink& link : registration.links) {
        if (link.source == scan || link.target == scan) links.push_back(&link);
    }
    std::stable_sort(links.begin(), links.end(), [](const auto* a, const auto* b) {
        if (a->verdict != b->verdict) return a->verdict < b->verdict;
        return a->probability > b->probability;
    });
    return links;
}

std::size_t other_end(const RegistrationLink& link, std::size_t scan) {
    return link.source == scan ? link.target : link.source;
}

/// The scans at the other ends of the links with a verdict.
std::vector<std::string> partners(const RegistrationRecord& registration, std::size_t scan,
                                  LinkVerdict verdict) {
    std::vector<std::string> names;
    for (const RegistrationLink* link : links_of(registration, scan)) {
        if (link->verdict == verdict)
            names.push_back(registration.scans[other_end(*link, scan)].name);
    }
    return names;
}

/// Empty for a scan in no set: a file without `components`.
std::optional<std::size_t> set_of(const RegistrationRecord& registration, std::size_t scan) {
    for (std::size_t i = 0; i < registration.components.size(); ++i) {
        const std::vector<std::size_t>& set = registration.components[i];
        if (std::find(set.begin(), set.end(), scan) != set.end()) return i;
    }
    return std::nullopt;
}

std::string reason_without_place(const RegistrationRecord& registration, std::size_t scan) {
    const std::optional<std::size_t> set = set_of(registration, scan);
    std::vector<std::string> others;
    if (set) {
        for (const std::size_t other : registration.components[*set]) {
            if (other != scan) others.push_back(registration.scans[other].name);
        }
    }
    if (!others.empty()) {
        return fmt::format(
            "joined to {} alone, and no accepted or ambiguous link leads from there "
            "to the map",
            joined(others));
    }
    const std::size_t num_links = links_of(registration, scan).size();
    if (num_links == 0) return "no other scan looked enough like it for a link to be tried";
    return fmt::format("no pose with any of {} other scan{} was borne out", num_links,
                       num_links == 1 ? "" : "s");
}

std::string place_text(const RegistrationRecord& registration, std::size_t scan) {
    const ScanRecord& record = registration.scans[scan];
    if (!record.is_placed) return "none: " + reason_without_place(registration, scan);
    const std::vector<std::string> accepted = partners(registration, scan, LinkVerdict::accepted);
    const std::vector<std::string> ambiguous = partners(registration, scan, LinkVerdict::ambiguous);
    if (record.is_doubtful) {
        return ambiguous.empty()
                   ? "in doubt: what joins it to the map goes by way of an ambiguous link"
                   : fmt::format("in doubt: ambiguous links to {}", joined(ambiguous));
    }
    if (!accepted.empty()) return fmt::format("by accepted links to {}", joined(accepted));
    if (!ambiguous.empty()) return fmt::format("by ambiguous links to {}", joined(ambiguous));
    return registration.scans.size() == 1 ? "it is the map"
                                          : "known beforehand: no link leads to it";
}

/// Angle and distance between two poses.
std::string difference_text(const Transform& a, const Transform& b) {
    const Transform between = a.inverse() * b;
    return fmt::format("{} and {:.1f} deg away",
                       length_text((b.translation() - a.translation()).norm()),
                       degrees(Eigen::AngleAxisd(between.linear()).angle()));
}

std::string link_reason(const RegistrationLink& link) {
    std::vector<std::string> reasons;
    switch (link.loops) {
        case LoopCheck::none:
            break;
        case LoopCheck::agrees:
            reasons.emplace_back("other ways between them agree");
            break;
        case LoopCheck::disagrees:
            reasons.emplace_back("other ways between them lead elsewhere");
            break;
        case LoopCheck::resolved:
            reasons.emplace_back("what lies around decided between its poses");
            break;
    }
    if (!link.rivals.empty()) {
        reasons.push_back("another pose fits as well, " +
                          difference_text(link.target_from_source, link.rivals.front()));
    }
    if (!link.unobservable.empty() && link.verdict != LinkVerdict::rejected) {
        reasons.push_back(fmt::format("free to slide along {} direction{}",
                                      link.unobservable.size(),
                                      link.unobservable.size() == 1 ? "" : "s"));
    }
    if (link.verdict == LinkVerdict::rejected && link.loops != LoopCheck::disagrees)
        reasons.emplace_back("the best pose is not borne out");
    return fmt::format("{}", fmt::join(reasons, "; "));
}

std::string link_text(const RegistrationRecord& registration, const RegistrationLink& link,
                      std::size_t scan) {
    const std::string reason = link_reason(link);
    return fmt::format("{} with {}: {} overlap, {} of it agrees, RMSE {}, probability {}{}{}",
                       link_verdict_name(link.verdict),
                       registration.scans[other_end(link, scan)].name, share_text(link.overlap),
                       share_text(link.agreement), length_text(link.rmse),
                       share_text(link.probability), reason.empty() ? "" : "; ", reason);
}

/// Standard deviations of place and direction; what no link holds has none.
std::optional<std::array<double, 2>> deviations(const ScanRecord& record) {
    if (!record.covariance) return std::nullopt;
    const double rotation = record.covariance->diagonal().head<3>().sum();
    const double translation = record.covariance->diagonal().tail<3>().sum();
    // A scan that defines the frame; and directions that no link holds (Registration::covariances).
    constexpr double unknown = 1e5;
    if (rotation + translation <= 0.0 || rotation + translation > unknown) return std::nullopt;
    return std::array{std::sqrt(translation), std::sqrt(rotation)};
}

Json link_json(const RegistrationRecord& registration, const RegistrationLink& link,
               std::size_t scan) {
    return {{"with", registration.scans[other_end(link, scan)].name},
            {"verdict", link_verdict_name(link.verdict)},
            {"probability", link.probability},
            {"loops", loop_check_name(link.loops)},
            {"overlap", link.overlap},
            {"agreement", link.agreement},
            {"rmse", link.rmse},
            {"inliers", link.inliers},
            {"has_rival", !link.rivals.empty()},
            {"unobservable_directions", link.unobservable.size()},
            {"reason", link_reason(link)}};
}

}  // namespace

Explanation explain_scan(const RegistrationRecord& registration, std::size_t scan) {
    const ScanRecord& record = registration.scans[scan];
    Explanation explanation;
    const char* state = !record.is_placed    ? "without a place"
                        : record.is_doubtful ? "placed in doubt"
                                             : "placed";
    explanation.title = fmt::format("{}: scan, {}", record.name, state);
    const std::string place = place_text(registration, scan);
    explanation.facts = {{"id", record.name},
                         {"label", "scan"},
                         {"placed", record.is_placed},
                         {"doubtful", record.is_doubtful},
                         {"place", place}};
    auto& lines = explanation.lines;
    lines.push_back({"place", place});
    if (record.residual) {
        lines.push_back({"residual", length_text(*record.residual) + " over its links"});
        explanation.facts["residual"] = *record.residual;
    }
    if (record.overlap) {
        lines.push_back(
            {"overlap", share_text(*record.overlap) + " with the scan that has most of it"});
        explanation.facts["overlap"] = *record.overlap;
    }
    if (const auto deviation = deviations(record)) {
        lines.push_back(
            {"uncertainty", fmt::format("{} and {:.3f} deg (one standard deviation)",
                                        length_text((*deviation)[0]), degrees((*deviation)[1]))});
        explanation.facts["deviation"] = {{"translation", (*deviation)[0]},
                                          {"rotation", (*deviation)[1]}};
    }
    Json links = Json::array();
    for (const RegistrationLink* link : links_of(registration, scan)) {
        lines.push_back({links.empty() ? "links" : "", link_text(registration, *link, scan)});
        links.push_back(link_json(registration, *link, scan));
    }
    explanation.facts["links"] = std::move(links);
    return explanation;
}

std::string registration_table(const RegistrationRecord& registration) {
    TextTable table("llrl");
    table.add_row({"scan", "placed", "residual", "why"});
    for (std::size_t i = 0; i < registration.scans.size(); ++i) {
        const ScanRecord& record = registration.scans[i];
        table.add_row({record.name,
                       !record.is_placed    ? "no"
                       : record.is_doubtful ? "in doubt"
                                            : "yes",
                       record.residual ? length_text(*record.residual) : "-",
                       place_text(registration, i)});
    }
    return table.to_text();
}

}  // namespace roomscribe::cli
