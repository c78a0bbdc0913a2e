// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/scanning/lidar.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/simulation/scanning/beam.hpp"
#include "roomscribe/simulation/scanning/surface_response.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

// Streams of random numbers: two a ray (where it goes, what is read off it), one a row.
std::uint64_t path_stream(std::size_t ray) {
    return 2 * ray;
}
std::uint64_t reading_stream(std::size_t ray) {
    return 2 * ray + 1;
}
std::uint64_t row_stream(std::size_t row) {
    return (1ULL << 62U) + row;
}
/// What is the same in every scan of a device: the calibration of its beams.
constexpr std::uint64_t device_seed = 64;

/// Directions of a scanner whose rows and columns are angles, from tables of their sines.
class BeamDirections {
  public:
    BeamDirections(const ScannerModel& model, const std::vector<double>& row_errors)
        : is_tilting_(model.pattern == ScanPattern::tilting_plane) {
        for (std::size_t row = 0; row < model.num_rows(); ++row) {
            rows_.push_back(turn_by(model.row_angles[row]));
            true_rows_.push_back(turn_by(model.row_angles[row] + row_errors[row]));
        }
        for (std::size_t column = 0; column < model.num_columns; ++column) {
            columns_.push_back(
                turn_by(model.first_column + model.column_step * static_cast<double>(column)));
        }
    }

    /// Where the scanner believes that the ray goes.
    Vector3d nominal(std::size_t row, std::size_t column) const {
        return direction(rows_[row], columns_[column]);
    }

    /// With the error of the row, and a small one of the column in radians.
    Vector3d with_errors(std::size_t row, std::size_t column, double column_error) const {
        const Turn& v = columns_[column];
        const Turn beside{v.cosine - column_error * v.sine, v.sine + column_error * v.cosine};
        return direction(true_rows_[row], beside);
    }

  private:
    struct Turn {
        double cosine;
        double sine;
    };
    static Turn turn_by(double angle) { return {std::cos(angle), std::sin(angle)}; }

    Vector3d direction(const Turn& u, const Turn& v) const {
        if (is_tilting_) return {u.cosine * v.cosine, v.sine, -u.sine * v.cosine};
        return {u.cosine * v.cosine, u.cosine * v.sine, u.sine};
    }

    bool is_tilting_;
    std::vector<Turn> rows_;
    std::vector<Turn> true_rows_;
    std::vector<Turn> columns_;
};

class BeamScanner {
  public:
    BeamScanner(const RayCaster& caster, const ScannerModel& model,
                const Transform& world_from_scan, std::uint64_t seed)
        : caster_(caster),
          model_(model),
          world_from_scan_(world_from_scan),
          seed_(seed),
          directions_(model, draw_row_errors(model, seed)) {
        for (std::size_t row = 0; row < model.num_rows(); ++row) {
            row_biases_.push_back(model.row_bias * Random(device_seed, row_stream(row)).normal());
        }
        echoes_.resize(model.num_rows() * model.num_columns);
    }

    /// Where the ray truly goes, as opposed to where the scanner believes that it does.
    Vector3d true_direction(std::size_t row, std::size_t column, Random& random) const {
        return world_from_scan_.linear() *
               directions_.with_errors(row, column, model_.ray_jitter * random.normal());
    }

    void trace(std::size_t row) {
        for (std::size_t column = 0; column < model_.num_columns; ++column) {
            const std::size_t ray = row * model_.num_columns + column;
            Random random(seed_, path_stream(ray));
            const Vector3d direction = true_direction(row, column, random);
            echoes_[ray] = trace_ray(caster_, world_from_scan_.translation(), direction, random);
        }
    }

    void record(std::size_t row, SimulatedScan& scan) const {
        for (std::size_t column = 0; column < model_.num_columns; ++column)
            record_ray(row, column, scan);
    }

  private:
    static std::vector<double> draw_row_errors(const ScannerModel& model, std::uint64_t seed) {
        std::vector<double> errors;
        for (std::size_t row = 0; row < model.num_rows(); ++row)
            errors.push_back(model.row_jitter * Random(seed, row_stream(row)).normal());
        return errors;
    }

    void record_ray(std::size_t row, std::size_t column, SimulatedScan& scan) const {
        const std::size_t ray = row * model_.num_columns + column;
        Random random(seed_, reading_stream(ray));
        const double near = range_to_spread_at(row, column);
        BeamReturn found;
        if (near > 0.0) {
            Random path(seed_, path_stream(ray));
            const Vector3d direction = true_direction(row, column, path);
            found = spread_beam(caster_, model_, world_from_scan_.translation(), direction,
                                echoes_[ray], near, path);
        } else {
            found = thin_beam(caster_.world(), echoes_[ray]);
        }
        if (!is_detected(found.echo, random)) return;

        double range = read_range(found.echo, random) + row_biases_[row];
        const bool is_outlier = random.uniform() < model_.outlier_rate;
        if (is_outlier) range = random.uniform(model_.min_range, range);
        range = model_.range_step * std::round(range / model_.range_step);
        if (range < model_.min_range || range > model_.max_range) return;

        const WorldPart& part = caster_.world().parts[found.echo.part];
        scan.scan.cloud.positions[ray] = (range * directions_.nominal(row, column)).cast<float>();
        scan.scan.cloud.intensities[ray] =
            found.echo.strength * static_cast<float>(1.0 + 0.05 * random.normal());
        if (is_outlier || found.echo.is_ghost) return;
        scan.labels[ray] = part.label;
        scan.acceptable[ray] = static_cast<LabelSet>(found.acceptable | label_bit(part.label));
        if (part.component >= 0) {
            const auto index = static_cast<std::size_t>(part.component);
            scan.instances[ray] = caster_.world().scene.components[index].instance;
        }
    }

    /// The smallest range about a ray where surfaces end or change; 0 where there is no edge.
    double range_to_spread_at(std::size_t row, std::size_t column) const {
        const std::size_t columns = model_.num_columns;
        const bool closed = model_.is_closed();
        const std::size_t ray = row * columns + column;
        const std::size_t left = column > 0 ? ray - 1 : closed ? ray + columns - 1 : ray;
        const std::size_t right = column + 1 < columns ? ray + 1 : closed ? ray + 1 - columns : ray;
        const std::size_t up = row > 0 ? ray - columns : ray;
        const std::size_t down = row + 1 < model_.num_rows() ? ray + columns : ray;
        if (!is_edge(ray, left, right) && !is_edge(ray, up, down)) return 0.0;
        double nearest = 0.0;
        for (const std::size_t i : {ray, left, right, up, down}) {
            const double range = static_cast<double>(echoes_[i].range);
            if (range > 0.0 && (nearest == 0.0 || range < nearest)) nearest = range;
        }
        return nearest;
    }

    bool is_edge(std::size_t ray, std::size_t before, std::size_t after) const {
        const Echo& a = echoes_[before];
        const Echo& b = echoes_[ray];
        const Echo& c = echoes_[after];
        if (!a && !b && !c) return false;
        if (!a || !b || !c || a.part != b.part || c.part != b.part) return true;
        // Second difference: a plane, however oblique, has little of it.
        return before != ray && after != ray &&
               std::abs(2.0F * b.range - a.range - c.range) > 0.02F;
    }

    /// Light that returns in units of the least that is detected half the time.
    double signal(const Echo& echo) const {
        const double fall_off = model_.dark_range / static_cast<double>(echo.range);
        return static_cast<double>(echo.strength) / 0.1 * fall_off * fall_off;
    }

    bool is_detected(const Echo& echo, Random& random) const {
        if (!echo || random.uniform() < model_.dropout_rate) return false;
        const double light = signal(echo);
        // Speckle and roughness make light fluctuate by about half, which only matters when dim.
        return light > 20.0 || light * std::exp(0.5 * random.normal()) > 1.0;
    }

    double read_range(const Echo& echo, Random& random) const {
        const double range = static_cast<double>(echo.range);
        const double cosine = std::max(0.05, static_cast<double>(echo.cosine));
        const double slope = std::sqrt(1.0 - std::min(1.0, cosine * cosine)) / cosine;
        // An oblique beam meets a stretch of surface, and its centre is read less sharply.
        const double smear = 0.05 * (model_.beam_exit + model_.divergence * range) * slope;
        const double noise = model_.range_noise * std::sqrt(1.0 + 2.0 / signal(echo));
        const double bias =
            model_.darkness_bias *
            std::clamp(std::log10(0.5 / static_cast<double>(echo.strength)), 0.0, 1.5);
        return range + bias + std::hypot(noise, smear) * random.normal();
    }

    const RayCaster& caster_;
    const ScannerModel& model_;
    Transform world_from_scan_;
    std::uint64_t seed_;
    BeamDirections directions_;
    std::vector<double> row_biases_;
    std::vector<Echo> echoes_;
};

}  // namespace

void scan_by_beams(SimulatedScan& scan, const RayCaster& caster, const ScannerModel& model,
                   std::uint64_t seed, const Context& context) {
    BeamScanner scanner(caster, model, scan.world_from_scan, seed);
    const auto for_rows = [&](auto&& body) {
        parallel_for(context, model.num_rows(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t row = begin; row < end; ++row)
                body(row);
        });
    };
    for_rows([&](std::size_t row) { scanner.trace(row); });
    // An edge is seen from both its sides, so all rays are traced before any is read.
    for_rows([&](std::size_t row) { scanner.record(row, scan); });
}

}  // namespace roomscribe
