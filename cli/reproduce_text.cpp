// SPDX-License-Identifier: MIT
#include "cli/reproduce_text.hpp"

#include <cmath>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/text_table.hpp"

namespace roomscribe::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view table_1_notes =
    "T: NARF or FPFH descriptors of one scan at its NARF keypoints, mean of ten runs on one "
    "thread;\n"
    "range image, normals and search tree, which either may need, are not counted.\n"
    "S: mean squared distance of all points of the second scan to the nearest point of the first\n"
    "after the initial alignment (PCL's fitness score, as which we take the paper's), median of "
    "ten\n"
    "seeds; \"aligned\" is how many of them end within 0.3 m and 5 degrees, and S true is that of "
    "the\n"
    "true pose: points that only one scan saw leave it above 0.\n";

constexpr std::string_view table_2_notes =
    "Error of the second scan's origin along the first one's axes (x forward, y left, z up): mean\n"
    "and standard deviation of its absolute value over the pairs that come within 0.3 m and 5\n"
    "degrees. sigma: mean standard deviation by equation (2) with 1 cm of noise. The paper does "
    "not\n"
    "say how many pairs it has, nor what became of those that failed.\n";

constexpr std::string_view table_4_notes =
    "The paper's 13 scenes are not public; ours are simulated alike: 4 rooms and 9 single scans, 8 "
    "by\n"
    "a Hokuyo UTM-30LX and 5 by a SICK LMS200. Correct: as docs/evaluation.md says. False: found "
    "where\n"
    "there is none, which the paper does not count. Furniture and handles are not found by either "
    "way yet.\n";

std::string number(double value, const char* pattern) {
    return std::isfinite(value) ? fmt::format(fmt::runtime(pattern), value) : "-";
}

std::string out_of_ten(const std::optional<int>& count) {
    return count ? fmt::format("{}/10", *count) : "-";
}

std::string centimetres(double mean, double deviation) {
    return fmt::format("{:.2f} +- {:.2f}", 100.0 * mean, 100.0 * deviation);
}

Json finite_or_null(double value) {
    return std::isfinite(value) ? Json(value) : Json();
}

Json figures_json(const DescriptorFigures& figures) {
    return {{"t_narf", figures.seconds[0]},
            {"t_fpfh", figures.seconds[1]},
            {"s_narf", finite_or_null(figures.fitness[0])},
            {"s_fpfh", finite_or_null(figures.fitness[1])}};
}

Json counts_json(const DetectionCounts& counts) {
    const auto accuracy = counts.accuracy();
    return {{"ground_truth", counts.ground_truth},
            {"correct", counts.correct},
            {"accuracy", accuracy ? Json(*accuracy) : Json()},
            {"false_positives", counts.false_positives},
            {"scenes", counts.scenes}};
}

Json count_json(const std::optional<int>& count) {
    return count ? Json(*count) : Json();
}

Json errors_json(const AxisErrors& errors) {
    const auto list = [](const Eigen::Vector3d& v) { return Json{v.x(), v.y(), v.z()}; };
    return {{"mean", list(errors.mean)}, {"deviation", list(errors.deviation)}};
}

std::string dump(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string table_1_text(const TableOne& rows, const RowSources& sources) {
    TextTable table("lrrrrrrrrrrrrr");
    table.add_row({"", "T NARF, s", "", "T FPFH, s", "", "S NARF, m2", "", "", "S FPFH, m2", "", "",
                   "S true", "", ""});
    table.add_row({"data set", "paper", "ours", "paper", "ours", "paper", "ours", "aligned",
                   "paper", "ours", "aligned", "m2", "points", "keypoints"});
    std::string notes;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const DescriptorFigures& paper = table_1_of_paper[i];
        const DescriptorComparison& row = rows[i];
        const DescriptorFigures& ours = row.ours;
        table.add_row({std::string(table_1_rows[i]), number(paper.seconds[0], "{:.2f}"),
                       number(ours.seconds[0], "{:.4f}"), number(paper.seconds[1], "{:.0f}"),
                       number(ours.seconds[1], "{:.4f}"), number(paper.fitness[0], "{:.3f}"),
                       number(ours.fitness[0], "{:.3f}"), out_of_ten(row.num_aligned[0]),
                       number(paper.fitness[1], "{:.3f}"), number(ours.fitness[1], "{:.3f}"),
                       out_of_ten(row.num_aligned[1]),
                       row.true_fitness ? number(*row.true_fitness, "{:.3f}") : "-",
                       number(row.num_points, "{:.0f}"), number(row.num_keypoints, "{:.0f}")});
        notes += fmt::format("{}: {}\n", table_1_rows[i], sources[i]);
    }
    return fmt::format("Table 1: descriptors\n\n{}\n{}{}", table.to_text(), notes, table_1_notes);
}

std::string table_1_json(const TableOne& rows, const RowSources& sources) {
    Json json{{"table", 1}, {"rows", Json::array()}};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const DescriptorComparison& row = rows[i];
        json["rows"].push_back({{"data_set", table_1_rows[i]},
                                {"scans", sources[i]},
                                {"paper", figures_json(table_1_of_paper[i])},
                                {"ours", figures_json(row.ours)},
                                {"aligned_narf", count_json(row.num_aligned[0])},
                                {"aligned_fpfh", count_json(row.num_aligned[1])},
                                {"s_true", row.true_fitness ? Json(*row.true_fitness) : Json()},
                                {"points", row.num_points},
                                {"keypoints", row.num_keypoints}});
    }
    return dump(json);
}

std::string table_2_text(const TableTwo& rows, const std::string& source) {
    TextTable table("lrrrrrrrrrr");
    std::vector<std::string> heading{"transform error, cm"};
    std::vector<std::string> subheading{""};
    for (const char* axis : {"tx", "ty", "tz"}) {
        heading.insert(heading.end(), {axis, "", ""});
        subheading.insert(subheading.end(), {"paper", "ours", "sigma"});
    }
    heading.emplace_back("aligned");
    subheading.emplace_back("");
    table.add_row(heading);
    table.add_row(subheading);
    const auto paper = table_2_of_paper();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        std::vector<std::string> cells{std::string(table_2_rows[i])};
        for (const int axis : {0, 1, 2}) {
            const AxisErrors& theirs = paper[i];
            cells.push_back(centimetres(theirs.mean[axis], theirs.deviation[axis]));
            const bool is_empty = rows[i].num_aligned == 0;
            cells.push_back(
                is_empty ? "-"
                         : centimetres(rows[i].errors.mean[axis], rows[i].errors.deviation[axis]));
            cells.push_back(is_empty ? "-"
                                     : fmt::format("{:.3f}", 100.0 * rows[i].predicted[axis]));
        }
        cells.push_back(fmt::format("{}/{}", rows[i].num_aligned, rows[i].num_pairs));
        table.add_row(cells);
    }
    return fmt::format("Table 2: registration\n\n{}\nPairs: {}\n{}", table.to_text(), source,
                       table_2_notes);
}

std::string table_2_json(const TableTwo& rows, const std::string& source) {
    Json json{{"table", 2}, {"scans", source}, {"rows", Json::array()}};
    const auto paper = table_2_of_paper();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Eigen::Vector3d& sigma = rows[i].predicted;
        json["rows"].push_back({{"method", table_2_rows[i]},
                                {"paper", errors_json(paper[i])},
                                {"ours", errors_json(rows[i].errors)},
                                {"sigma", {sigma.x(), sigma.y(), sigma.z()}},
                                {"pairs", rows[i].num_pairs},
                                {"aligned", rows[i].num_aligned}});
    }
    return dump(json);
}

std::string table_4_text(const TableFour& table) {
    TextTable text("lrrrrrrrrrrrrrr");
    text.add_row({"", "paper", "", "", "", "its rules", "", "", "", "", "default", "", "", "", ""});
    std::vector<std::string> heading{"label"};
    for (const char* column : {"truth", "correct", "accuracy", "scenes"})
        heading.emplace_back(column);
    for (int way = 0; way < 2; ++way) {
        for (const char* column : {"truth", "correct", "accuracy", "false", "scenes"})
            heading.emplace_back(column);
    }
    text.add_row(heading);
    const auto percent = [](std::optional<double> share) {
        return share ? fmt::format("{:.0f} %", 100.0 * *share) : "-";
    };
    for (const DetectionFigures& paper : table_4_of_paper) {
        std::vector<std::string> cells{
            std::string(label_name(paper.label)), fmt::format("{}", paper.ground_truth),
            fmt::format("{}", paper.correct),
            percent(static_cast<double>(paper.correct) / paper.ground_truth),
            fmt::format("{}", paper.scenes)};
        for (const auto* way : {&table.by_paper, &table.by_default}) {
            const DetectionCounts& ours = (*way)[static_cast<std::size_t>(paper.label)];
            cells.insert(cells.end(),
                         {fmt::format("{}", ours.ground_truth), fmt::format("{}", ours.correct),
                          percent(ours.accuracy()), fmt::format("{}", ours.false_positives),
                          fmt::format("{}", ours.scenes)});
        }
        text.add_row(cells);
    }
    return fmt::format("Table 4: labels, {} scenes\n\n{}\n{}", table.num_scenes, text.to_text(),
                       table_4_notes);
}

std::string table_4_json(const TableFour& table) {
    Json json{{"table", 4}, {"scenes", table.num_scenes}, {"rows", Json::array()}};
    for (const DetectionFigures& paper : table_4_of_paper) {
        const auto label = static_cast<std::size_t>(paper.label);
        json["rows"].push_back(
            {{"label", label_name(paper.label)},
             {"paper",
              {{"ground_truth", paper.ground_truth},
               {"correct", paper.correct},
               {"accuracy", static_cast<double>(paper.correct) / paper.ground_truth},
               {"scenes", paper.scenes}}},
             {"by_rules", counts_json(table.by_paper[label])},
             {"by_default", counts_json(table.by_default[label])}});
    }
    return dump(json);
}

}  // namespace roomscribe::cli
