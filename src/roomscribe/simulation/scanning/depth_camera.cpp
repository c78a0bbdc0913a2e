// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/scanning/depth_camera.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/simulation/scanning/light_path.hpp"
#include "roomscribe/simulation/scanning/line_of_sight.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

/// Normally distributed noise that is alike over some pixels. The camera matches whole windows, so
/// nothing that happens to a pixel happens to it alone.
class SmoothNoise {
  public:
    SmoothNoise(std::size_t rows, std::size_t columns, double size, std::uint64_t seed,
                std::uint64_t stream)
        : size_(size),
          cells_per_row_(static_cast<std::size_t>(static_cast<double>(columns) / size) + 2) {
        const auto cell_rows = static_cast<std::size_t>(static_cast<double>(rows) / size) + 2;
        Random random(seed, stream);
        for (std::size_t cell = 0; cell < cell_rows * cells_per_row_; ++cell)
            values_.push_back(random.normal());
    }

    /// Unit variance everywhere.
    double at(std::size_t row, std::size_t column) const {
        const double y = static_cast<double>(row) / size_;
        const double x = static_cast<double>(column) / size_;
        const double fy = y - std::floor(y);
        const double fx = x - std::floor(x);
        const std::size_t cell =
            static_cast<std::size_t>(y) * cells_per_row_ + static_cast<std::size_t>(x);
        const std::array weights{(1 - fy) * (1 - fx), (1 - fy) * fx, fy * (1 - fx), fy * fx};
        const std::array cells{cell, cell + 1, cell + cells_per_row_, cell + cells_per_row_ + 1};
        double sum = 0.0;
        double variance = 0.0;
        for (std::size_t i = 0; i < weights.size(); ++i) {
            sum += weights[i] * values_[cells[i]];
            variance += weights[i] * weights[i];
        }
        return sum / std::sqrt(variance);
    }

  private:
    double size_;
    std::size_t cells_per_row_;
    std::vector<double> values_;
};

class DepthCamera {
  public:
    DepthCamera(const RayCaster& caster, const ScannerModel& model,
                const Transform& world_from_scan, std::uint64_t seed)
        : caster_(caster),
          model_(model),
          world_from_scan_(world_from_scan),
          projector_(world_from_scan * Vector3d(model.baseline, 0.0, 0.0)),
          seed_(seed),
          disparity_noise_(model.num_rows(), model.num_columns, model.noise_size, seed, 0),
          row_jitter_(model.num_rows(), model.num_columns, model.noise_size, seed, 1),
          column_jitter_(model.num_rows(), model.num_columns, model.noise_size, seed, 2),
          light_noise_(model.num_rows(), model.num_columns, 2.0 * model.noise_size, seed, 3),
          pixels_(model.num_rows() * model.num_columns) {}

    void trace(std::size_t row) {
        const Vector3d origin = world_from_scan_.translation();
        for (std::size_t column = 0; column + model_.blind_columns < model_.num_columns; ++column) {
            const Vector3d in_scan = ray_direction(
                model_, row, column, model_.pixel_jitter * row_jitter_.at(row, column),
                model_.pixel_jitter * column_jitter_.at(row, column));
            const Vector3d direction = world_from_scan_.linear() * in_scan;
            Random luck = patch_luck(row, column);
            const Echo echo = trace_ray(caster_, origin, direction, luck);
            if (!echo) continue;
            const double range = static_cast<double>(echo.range);
            if (!echo.is_ghost && !is_lit(origin + range * direction)) continue;
            pixels_[row * model_.num_columns + column] = {echo, range * in_scan.z()};
        }
    }

    void record(std::size_t row, SimulatedScan& scan) const {
        for (std::size_t column = 0; column < model_.num_columns; ++column)
            record_pixel(row, column, scan);
    }

  private:
    struct Pixel {
        Echo echo;
        double depth = 0.0;
    };

    /// The same for all pixels of a ragged patch, whichever way chance goes there.
    Random patch_luck(std::size_t row, std::size_t column) const {
        const auto patch = [&](std::size_t pixel, double jitter) {
            const double place = static_cast<double>(pixel) / model_.noise_size + 0.5 * jitter;
            return static_cast<std::uint64_t>(std::max(0.0, place + 3.0));
        };
        const std::uint64_t patch_row = patch(row, row_jitter_.at(row, column));
        const std::uint64_t patch_column = patch(column, column_jitter_.at(row, column));
        return Random(seed_, (1ULL << 62U) + (patch_row << 31U) + patch_column);
    }

    bool is_lit(const Vector3d& point) const {
        const double tolerance = 0.005 + 0.005 * (point - projector_).norm();
        return is_in_sight(caster_, projector_, point, tolerance, [&](std::uint32_t part) {
            return is_pane(caster_.world().parts[part]);
        });
    }

    void record_pixel(std::size_t row, std::size_t column, SimulatedScan& scan) const {
        const std::size_t index = row * model_.num_columns + column;
        const Pixel& pixel = pixels_[index];
        if (!is_detected(row, column)) return;
        double disparity = disparity_of(pixel.depth);
        LabelSet acceptable = acceptable_labels(pixel);
        if (const Pixel* other = across_edge(row, column)) {
            // The window holds two depths: it matches one of them, now and then a blend or nothing.
            Random luck = patch_luck(row, column);
            const double fate = luck.uniform();
            if (fate < 0.15) return;
            if (fate < 0.17) {
                const double share = luck.uniform(0.5, 1.0);
                disparity = share * disparity + (1.0 - share) * disparity_of(other->depth);
                acceptable |= label_bit(Label::unknown);
            }
            acceptable |= acceptable_labels(*other);
        }
        disparity += model_.disparity_noise * disparity_noise_.at(row, column);
        disparity = model_.disparity_step * std::round(disparity / model_.disparity_step);
        if (disparity <= 0.0) return;
        const double depth = model_.focal_length * model_.baseline / disparity;
        if (depth < model_.min_range || depth > model_.max_range) return;

        const Vector3d direction = ray_direction(model_, row, column);
        scan.scan.cloud.positions[index] = (depth / direction.z() * direction).cast<float>();
        if (pixel.echo.is_ghost) return;
        const WorldPart& part = caster_.world().parts[pixel.echo.part];
        scan.labels[index] = part.label;
        scan.acceptable[index] = static_cast<LabelSet>(acceptable | label_bit(part.label));
        if (part.component >= 0) {
            const auto component = static_cast<std::size_t>(part.component);
            scan.instances[index] = caster_.world().scene.components[component].instance;
        }
    }

    double disparity_of(double depth) const {
        return model_.focal_length * model_.baseline / depth;
    }

    LabelSet acceptable_labels(const Pixel& pixel) const {
        if (pixel.echo.is_ghost) return label_bit(Label::unknown);
        return caster_.world().parts[pixel.echo.part].acceptable;
    }

    bool is_detected(std::size_t row, std::size_t column) const {
        const Pixel& pixel = pixels_[row * model_.num_columns + column];
        if (!pixel.echo || patch_luck(row, column).uniform() < model_.dropout_rate) return false;
        const double fall_off = model_.dark_range / static_cast<double>(pixel.echo.range);
        const double light = static_cast<double>(pixel.echo.strength) / 0.1 * fall_off * fall_off;
        return light * std::exp(0.5 * light_noise_.at(row, column)) > 1.0;
    }

    /// The neighbour whose depth differs most by more than its noise could, if any.
    const Pixel* across_edge(std::size_t row, std::size_t column) const {
        const std::size_t columns = model_.num_columns;
        const std::size_t index = row * columns + column;
        const double depth = pixels_[index].depth;
        const Pixel* other = nullptr;
        double largest = 0.03 * depth;
        const auto look = [&](std::size_t neighbour) {
            const Pixel& candidate = pixels_[neighbour];
            if (!candidate.echo || std::abs(candidate.depth - depth) <= largest) return;
            largest = std::abs(candidate.depth - depth);
            other = &candidate;
        };
        if (column > 0) look(index - 1);
        if (column + 1 < columns) look(index + 1);
        if (row > 0) look(index - columns);
        if (row + 1 < model_.num_rows()) look(index + columns);
        return other;
    }

    const RayCaster& caster_;
    const ScannerModel& model_;
    Transform world_from_scan_;
    Vector3d projector_;
    std::uint64_t seed_;
    SmoothNoise disparity_noise_;
    SmoothNoise row_jitter_;
    SmoothNoise column_jitter_;
    SmoothNoise light_noise_;
    std::vector<Pixel> pixels_;
};

}  // namespace

void scan_by_pattern(SimulatedScan& scan, const RayCaster& caster, const ScannerModel& model,
                     std::uint64_t seed, const Context& context) {
    DepthCamera camera(caster, model, scan.world_from_scan, seed);
    parallel_for(context, model.num_rows(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row)
            camera.trace(row);
    });
    parallel_for(context, model.num_rows(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row)
            camera.record(row, scan);
    });
}

}  // namespace roomscribe
