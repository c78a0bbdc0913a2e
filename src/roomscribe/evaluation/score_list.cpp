// SPDX-License-Identifier: MIT
#include "roomscribe/evaluation/score_list.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "roomscribe/core/units.hpp"

namespace roomscribe {
namespace {

/// Collects the scores of one group.
class ScoreGroup {
  public:
    explicit ScoreGroup(std::string_view group) : group_(group) {}

    void start_row(std::string item) { item_ = std::move(item); }

    void count(std::string_view measure, std::uint64_t value) {
        add(measure, ScoreUnit::count, static_cast<double>(value));
    }
    void share(std::string_view measure, std::optional<double> value) {
        add(measure, ScoreUnit::share, value);
    }
    void add(std::string_view measure, ScoreUnit unit, std::optional<double> value) {
        scores_.push_back({group_, item_, measure, unit, value});
    }

    /// A group of zeros and gaps says nothing.
    void append_to(std::vector<Score>& scores) const {
        const bool says_something =
            std::any_of(scores_.begin(), scores_.end(),
                        [](const Score& score) { return score.value.value_or(0.0) != 0.0; });
        if (says_something) scores.insert(scores.end(), scores_.begin(), scores_.end());
    }

  private:
    std::string_view group_;
    std::string item_;
    std::vector<Score> scores_;
};

void add_counts(ScoreGroup& group, const DetectionCounts& counts) {
    group.count("ground_truth", counts.ground_truth);
    group.count("correct", counts.correct);
    group.share("accuracy", counts.accuracy());
    group.count("false_positives", counts.false_positives);
    group.share("precision", counts.precision());
    group.share("f1", counts.f1());
    group.count("scenes", counts.scenes);
}

void add_errors(ScoreGroup& group, std::string item, const std::vector<double>& sorted,
                ScoreUnit unit) {
    const auto value_at = [&](double share) -> std::optional<double> {
        const std::optional<double> value = percentile(sorted, share);
        if (!value || unit != ScoreUnit::degree) return value;
        return degrees(*value);
    };
    group.start_row(std::move(item));
    group.count("count", sorted.size());
    group.add("median", unit, value_at(0.5));
    group.add("p90", unit, value_at(0.9));
    group.add("max", unit, value_at(1.0));
}

ScoreGroup detection_scores(const EvaluationSummary& summary) {
    ScoreGroup group("detection");
    DetectionCounts all;
    for (std::size_t id = 1; id < num_labels; ++id) {
        group.start_row(std::string(label_name(static_cast<Label>(id))));
        add_counts(group, summary.detections[id]);
        all += summary.detections[id];
    }
    // In how many scenes the most common label is: all of them, in practice.
    all.scenes = 0;
    for (const DetectionCounts& counts : summary.detections)
        all.scenes = std::max(all.scenes, counts.scenes);
    group.start_row("all");
    add_counts(group, all);
    return group;
}

ScoreGroup point_scores(const EvaluationSummary& summary) {
    ScoreGroup group("points");
    std::uint64_t num_points = 0;
    for (std::size_t id = 1; id < num_labels; ++id) {
        group.start_row(std::string(label_name(static_cast<Label>(id))));
        group.count("points", summary.points.true_points[id]);
        group.share("iou", summary.points.iou(static_cast<Label>(id)));
        num_points += summary.points.true_points[id];
    }
    group.start_row("mean");
    group.count("points", num_points);
    group.share("iou", summary.points.mean_iou());
    return group;
}

ScoreGroup decoy_scores(const EvaluationSummary& summary) {
    ScoreGroup group("decoys");
    DecoyCounts all;
    const auto add_row = [&](std::string_view item, const DecoyCounts& counts) {
        group.start_row(std::string(item));
        group.count("there", counts.there);
        group.count("taken", counts.taken);
        group.share("share", counts.share());
    };
    for (std::size_t kind = 0; kind < summary.decoys.size(); ++kind) {
        add_row(decoy_kind_names[kind], summary.decoys[kind]);
        all += summary.decoys[kind];
    }
    add_row("all", all);
    return group;
}

ScoreGroup opening_scores(const EvaluationSummary& summary) {
    ScoreGroup group("openings");
    std::uint64_t all = 0;
    for (const std::uint64_t detections : summary.opening_grounds)
        all += detections;
    for (std::size_t ground = 0; ground < summary.opening_grounds.size(); ++ground) {
        const std::uint64_t detections = summary.opening_grounds[ground];
        group.start_row(std::string(opening_ground_names[ground]));
        group.count("detections", detections);
        group.share("share", all == 0 ? std::nullopt
                                      : std::optional(static_cast<double>(detections) /
                                                      static_cast<double>(all)));
    }
    return group;
}

ScoreGroup room_scores(const EvaluationSummary& summary) {
    ScoreGroup group("rooms");
    group.start_row("room");
    add_counts(group, summary.rooms);
    group.start_row("neighbours");
    add_counts(group, summary.neighbors);
    return group;
}

ScoreGroup room_size_scores(const EvaluationSummary& summary) {
    ScoreGroup group("room_sizes");
    add_errors(group, "area", summary.area_errors, ScoreUnit::share);
    add_errors(group, "height", summary.height_errors, ScoreUnit::metre);
    add_errors(group, "volume", summary.volume_errors, ScoreUnit::share);
    return group;
}

ScoreGroup axes_scores(const EvaluationSummary& summary) {
    ScoreGroup group("axes");
    add_errors(group, "up", summary.up_errors, ScoreUnit::degree);
    add_errors(group, "horizontal", summary.horizontal_errors, ScoreUnit::degree);
    return group;
}

ScoreGroup registration_scores(const EvaluationSummary& summary) {
    ScoreGroup group("registration");
    add_errors(group, "translation", summary.translation_errors, ScoreUnit::metre);
    group.add("rmse", ScoreUnit::metre, translation_rmse(summary.scans));
    add_errors(group, "rotation", summary.rotation_errors, ScoreUnit::degree);
    return group;
}

ScoreGroup recall_scores(const EvaluationSummary& summary) {
    ScoreGroup group("recall");
    for (const protocol::PoseTolerance& tolerance : {protocol::strict_pose, protocol::loose_pose}) {
        group.start_row(
            fmt::format("{:g} m, {:g} deg", tolerance.translation, degrees(tolerance.rotation)));
        group.count("scans", summary.scans.size());
        group.share("recall", registration_recall(summary.scans, tolerance));
    }
    return group;
}

ScoreGroup link_scores(const EvaluationSummary& summary) {
    ScoreGroup group("links");
    for (const LinkVerdict verdict :
         {LinkVerdict::accepted, LinkVerdict::ambiguous, LinkVerdict::rejected}) {
        group.start_row(std::string(link_verdict_name(verdict)));
        for (std::size_t truth = 0; truth < link_truth_names.size(); ++truth) {
            group.count(link_truth_names[truth],
                        summary.links[static_cast<std::size_t>(verdict)][truth]);
        }
    }
    return group;
}

void add_bin(ScoreGroup& group, std::string item, const CalibrationBin& bin) {
    group.start_row(std::move(item));
    group.count("detections", bin.detections);
    group.count("correct", bin.correct);
    group.share("correct_share", bin.correct_share());
    group.share("mean_confidence", bin.mean_confidence());
}

ScoreGroup confidence_scores(const EvaluationSummary& summary) {
    ScoreGroup group("confidence");
    const Calibration& calibration = summary.calibration;
    CalibrationBin all;
    for (std::size_t i = 0; i < Calibration::num_bins; ++i) {
        const CalibrationBin& bin = calibration.bins[i];
        if (bin.detections == 0) continue;
        add_bin(group, fmt::format("0.{} to {}.{}", i, (i + 1) / 10, (i + 1) % 10), bin);
        all.detections += bin.detections;
        all.correct += bin.correct;
        all.confidence_sum += bin.confidence_sum;
    }
    add_bin(group, "accepted", calibration.accepted);
    add_bin(group, "doubtful", calibration.doubtful);
    add_bin(group, "all", all);
    group.share("calibration_error", calibration.expected_error());
    return group;
}

}  // namespace

std::vector<Score> list_scores(const EvaluationSummary& summary) {
    std::vector<Score> scores;
    detection_scores(summary).append_to(scores);
    decoy_scores(summary).append_to(scores);
    opening_scores(summary).append_to(scores);
    room_scores(summary).append_to(scores);
    room_size_scores(summary).append_to(scores);
    point_scores(summary).append_to(scores);
    axes_scores(summary).append_to(scores);
    registration_scores(summary).append_to(scores);
    recall_scores(summary).append_to(scores);
    link_scores(summary).append_to(scores);
    confidence_scores(summary).append_to(scores);
    return scores;
}

}  // namespace roomscribe
