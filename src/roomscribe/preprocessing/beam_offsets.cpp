// SPDX-License-Identifier: MIT
#include "roomscribe/preprocessing/beam_offsets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <Eigen/Dense>

#include "roomscribe/core/units.hpp"
#include "roomscribe/geometry/plane.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;
/// 1, x, y, xx, xy, yy at a place on a cell's plane: a surface that bends, and two that meet at a
/// small step, are not taken for offsets.
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr std::size_t min_beams = 8;
constexpr std::size_t max_beams = 128;
/// m. Several rings of a lidar with 16 beams cross a cell (2 degrees are 10 cm at 3 m), and a wall
/// is about even within it.
constexpr double cell_size = 1.0;
/// m, the standard deviation of offsets (data sheets), and of what one beam shows of a surface:
/// walls are uneven, and there is noise.
constexpr double usual_offset = 0.02;
constexpr double usual_unevenness = 0.006;

/// A point on a ring, in axes parallel to the cloud's.
struct RingPoint {
    Vector3d direction;
    double range = 0.0;
    std::size_t beam = 0;
};
using Cell = std::vector<RingPoint>;

/// The rays of a scan, with the sine of their elevation; NaN for what is no return.
class Rays {
  public:
    Rays(std::span<const Eigen::Vector3f> positions, const Vector3d& origin, const Vector3d& axis)
        : positions_(positions), origin_(origin), axis_(axis) {}
    std::size_t size() const { return positions_.size(); }
    Vector3d operator[](std::size_t i) const { return positions_[i].cast<double>() - origin_; }
    double elevation_sine(std::size_t i) const {
        const Vector3d ray = (*this)[i];
        return axis_.dot(ray) / ray.norm();
    }

  private:
    std::span<const Eigen::Vector3f> positions_;
    Vector3d origin_;
    Vector3d axis_;
};

/// Which ring a ray belongs to. Rings are narrow runs of bins between gaps; the rays of other
/// scanners lie at all elevations and make one wide run. Bins are even in the sine of the
/// elevation, which takes no arc function for each point of a large cloud.
class RingBins {
  public:
    explicit RingBins(const Rays& rays) : ring_of_bin_(bin_of(1.0) + max_width + 2, -1) {
        std::vector<std::size_t> counts(ring_of_bin_.size(), 0);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const double sine = rays.elevation_sine(i);
            if (!std::isfinite(sine)) continue;
            ++counts[bin_of(sine)];
            ++num_rays_;
        }
        number(counts);
    }

    std::size_t num_rings() const { return sines_.size(); }
    const std::vector<double>& elevation_sines() const { return sines_; }
    /// Strays and rounding may leave the rings.
    bool hold_most() const { return 20 * num_on_rings_ >= 19 * num_rays_; }
    std::int32_t ring_of(double sine) const {
        return std::isfinite(sine) ? ring_of_bin_[bin_of(sine)] : -1;
    }

  private:
    // The densest rings, of 128 beams, are 0.35 degrees apart.
    static constexpr double bin_size = radians(0.02);
    static constexpr std::size_t max_width = 5;

    static std::size_t bin_of(double sine) {
        return static_cast<std::size_t>((std::clamp(sine, -1.0, 1.0) + 1.0) / bin_size);
    }

    void number(const std::vector<std::size_t>& counts) {
        const std::size_t min_rays = std::max<std::size_t>(20, num_rays_ / 1000);
        std::size_t first = 0;
        std::size_t last = 0;
        std::size_t count = 0;
        for (std::size_t bin = 0; bin < counts.size(); ++bin) {
            if (count > 0 && bin - last > max_width) {
                if (count >= min_rays && last - first < max_width) {
                    for (std::size_t k = first; k <= last; ++k)
                        ring_of_bin_[k] = static_cast<std::int32_t>(sines_.size());
                    sines_.push_back(0.5 * bin_size * static_cast<double>(first + last + 1) - 1.0);
                    num_on_rings_ += count;
                }
                count = 0;
            }
            if (counts[bin] == 0) continue;
            if (count == 0) first = bin;
            last = bin;
            count += counts[bin];
        }
    }

    std::vector<std::int32_t> ring_of_bin_;
    std::vector<double> sines_;  ///< of the rings' middles
    std::size_t num_rays_ = 0;
    std::size_t num_on_rings_ = 0;
};

/// One beam's points in a cell: the mean of their places, their mean height over the cell's plane
/// and how much of a longer range is height.
struct BeamMean {
    std::size_t beam = 0;
    double count = 0.0;
    Vector6d place = Vector6d::Zero();
    double height = 0.0;
    double cosine = 0.0;
};

/// Points farther off than so many standard deviations lie on something else.
constexpr double max_deviations = 2.5;

/// The plane of most of a cell; nothing if it is not flat, or a strip that fits any plane.
std::optional<PlaneFit> fit_flat(const Cell& cell, const std::vector<double>& offsets) {
    constexpr int num_trims = 3;
    constexpr double min_share = 0.7;
    constexpr double max_rms = 0.045;  // m, noise and offsets of 3 cm each (data sheets)
    constexpr double min_width = 0.15;
    std::optional<PlaneFit> fit;
    for (int trim = 0; trim <= num_trims; ++trim) {
        PlaneMoments moments;
        moments.reference = cell[0].range * cell[0].direction;
        for (const RingPoint& point : cell) {
            const Vector3d place = (point.range - offsets[point.beam]) * point.direction;
            if (!fit || std::abs(fit->plane.signed_distance(place)) < max_deviations * fit->rms)
                moments.add(place);
        }
        if (static_cast<double>(moments.count) < min_share * static_cast<double>(cell.size()))
            return std::nullopt;
        fit = moments.fit();
        if (!fit) return std::nullopt;
    }
    if (fit->rms > max_rms || fit->variances[1] < min_width * min_width) return std::nullopt;
    return fit;
}

/// Empty if the cell is not flat or few beams cross it.
std::vector<BeamMean> average_beams(const Cell& cell, const std::vector<double>& offsets) {
    constexpr double min_cosine = 0.2;  // at grazing rays a longer range hardly leaves the plane
    constexpr double min_points = 5.0;
    constexpr std::size_t min_beams_in_cell = 8;  // two more than a surface has coefficients
    const std::optional<PlaneFit> fit = fit_flat(cell, offsets);
    if (!fit) return {};
    const PlaneAxes axes = plane_axes(fit->plane.normal);
    std::map<std::size_t, BeamMean> means;
    for (const RingPoint& point : cell) {
        const double cosine = fit->plane.normal.dot(point.direction);
        const Vector3d place = (point.range - offsets[point.beam]) * point.direction;
        const double height = fit->plane.signed_distance(place);
        if (std::abs(cosine) < min_cosine || std::abs(height) > max_deviations * fit->rms) continue;
        const double x = axes.u.dot(place - fit->centroid);
        const double y = axes.v.dot(place - fit->centroid);
        BeamMean& mean = means[point.beam];
        mean.beam = point.beam;
        mean.count += 1.0;
        mean.place += (Vector6d() << 1.0, x, y, x * x, x * y, y * y).finished();
        mean.height += height;
        mean.cosine += cosine;
    }
    std::vector<BeamMean> result;
    for (auto& [beam, mean] : means) {
        if (mean.count < min_points) continue;
        mean.place /= mean.count;
        mean.height /= mean.count;
        mean.cosine /= mean.count;
        result.push_back(mean);
    }
    if (result.size() < min_beams_in_cell) result.clear();
    return result;
}

/// A bent surface through the means of a cell, those off it counting less (Cauchy's weights).
struct CellSurface {
    std::vector<double> weights;
    Matrix6d inverse;  ///< of the weighted squares of the places
    Vector6d heights;  ///< weighted sum of places times heights

    CellSurface(const std::vector<BeamMean>& means, double scale) : weights(means.size(), 1.0) {
        constexpr int num_passes = 5;
        for (int pass = 0;; ++pass) {
            Matrix6d squares = 1e-6 * Matrix6d::Identity();
            heights.setZero();
            for (std::size_t i = 0; i < means.size(); ++i) {
                squares += weights[i] * means[i].place * means[i].place.transpose();
                heights += weights[i] * means[i].height * means[i].place;
            }
            inverse = squares.inverse();
            if (pass == num_passes) return;
            const Vector6d surface = inverse * heights;
            for (std::size_t i = 0; i < means.size(); ++i) {
                const double off = (means[i].height - surface.dot(means[i].place)) / scale;
                weights[i] = 1.0 / (1.0 + off * off);
            }
        }
    }
};

/// Least squares over all cells for the beams' offsets; the cells' surfaces are eliminated.
class OffsetEquations {
  public:
    explicit OffsetEquations(std::size_t num_beams) {
        const auto size = static_cast<Eigen::Index>(num_beams);
        matrix_.setZero(size, size);
        right_.setZero(size);
    }

    void add(const std::vector<BeamMean>& means, const CellSurface& surface) {
        for (std::size_t i = 0; i < means.size(); ++i) {
            const auto row = static_cast<Eigen::Index>(means[i].beam);
            const double factor = surface.weights[i] * means[i].cosine;
            const Vector6d of_surface = surface.inverse * means[i].place;
            right_[row] += factor * (means[i].height - of_surface.dot(surface.heights));
            matrix_(row, row) += factor * means[i].cosine;
            for (std::size_t j = 0; j < means.size(); ++j) {
                matrix_(row, static_cast<Eigen::Index>(means[j].beam)) -=
                    factor * of_surface.dot(means[j].place) * surface.weights[j] * means[j].cosine;
            }
        }
    }

    /// Adds what is still missing to the offsets, which a priori are of the usual size.
    void improve(std::vector<double>& offsets) const {
        constexpr double prior =
            usual_unevenness * usual_unevenness / (usual_offset * usual_offset);
        Eigen::Map<Eigen::VectorXd> known(offsets.data(), right_.size());
        const Eigen::MatrixXd with_prior =
            matrix_ + prior * Eigen::MatrixXd::Identity(right_.size(), right_.size());
        known += with_prior.ldlt().solve(right_ - prior * known);
    }

  private:
    Eigen::MatrixXd matrix_;
    Eigen::VectorXd right_;
};

std::vector<Cell> cut_into_cells(const std::vector<RingPoint>& points) {
    // Askew, so that no surface lies between two cells, each of which would see the nearer or the
    // farther of its points.
    const Eigen::Matrix3d askew =
        Eigen::AngleAxisd(0.5, Vector3d(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
    std::map<std::array<int, 3>, Cell> cells;
    for (const RingPoint& point : points) {
        // Rounded, so that no wall of cells parts the beams above the horizon from those below.
        const Eigen::Vector3i cell =
            (point.range / cell_size * (askew * point.direction)).array().round().cast<int>();
        cells[{cell.x(), cell.y(), cell.z()}].push_back(point);
    }
    std::vector<Cell> result;
    result.reserve(cells.size());
    for (auto& [place, members] : cells)
        result.push_back(std::move(members));
    return result;
}

/// From every `stride`-th cell. The more the beams agree, the smaller a `scale` (m) tells what is
/// off a surface.
void improve_offsets(std::vector<double>& offsets, std::span<const Cell> cells, std::size_t stride,
                     int num_rounds, double scale) {
    for (int round = 0; round < num_rounds; ++round) {
        OffsetEquations equations(offsets.size());
        for (std::size_t i = 0; i < cells.size(); i += stride) {
            const std::vector<BeamMean> means = average_beams(cells[i], offsets);
            if (!means.empty()) equations.add(means, CellSurface(means, scale));
        }
        equations.improve(offsets);
    }
}

/// Empty where the two halves of the cells tell differently.
std::vector<double> solve_offsets(const std::vector<Cell>& cells, std::size_t num_beams) {
    // Of clutter alone, without any offsets, halves correlate by up to 0.5.
    constexpr double min_correlation = 0.6;
    constexpr double min_offset = 0.005;  // m: less may be the walls', and does no harm
    if (cells.size() < 2) return {};
    std::array<std::vector<double>, 2> halves;
    for (std::size_t half = 0; half < 2; ++half) {
        halves[half].assign(num_beams, 0.0);
        improve_offsets(halves[half], std::span(cells).subspan(half), 2, 3, usual_offset);
    }
    const auto size = static_cast<Eigen::Index>(num_beams);
    const Eigen::Map<const Eigen::VectorXd> a(halves[0].data(), size);
    const Eigen::Map<const Eigen::VectorXd> b(halves[1].data(), size);
    if (!(a.dot(b) > min_correlation * a.norm() * b.norm())) return {};
    std::vector<double> offsets(num_beams, 0.0);
    Eigen::Map<Eigen::VectorXd> all(offsets.data(), size);
    all = 0.5 * (a + b);
    improve_offsets(offsets, cells, 1, 2, usual_unevenness);
    if (all.norm() < min_offset * std::sqrt(static_cast<double>(num_beams))) return {};
    return offsets;
}

/// Nothing if there are no rings; without offsets if these are not told.
std::optional<BeamOffsets> find_beams(const ScannedPoints& scan) {
    const Rays rays(scan.positions, scan.sensor_position, scan.sensor_axes.col(2));
    const RingBins bins(rays);
    if (bins.num_rings() < min_beams || bins.num_rings() > max_beams || !bins.hold_most())
        return std::nullopt;
    BeamOffsets beams;
    beams.elevation_sines = bins.elevation_sines();
    beams.beam_of_point.reserve(rays.size());
    std::vector<RingPoint> points;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const std::int32_t beam = bins.ring_of(rays.elevation_sine(i));
        beams.beam_of_point.push_back(beam);
        if (beam < 0) continue;
        points.push_back({rays[i].normalized(), rays[i].norm(), static_cast<std::size_t>(beam)});
    }
    beams.offsets = solve_offsets(cut_into_cells(points), bins.num_rings());
    return beams;
}

bool have_like_rings(const BeamOffsets& a, const BeamOffsets& b) {
    constexpr double max_difference = 0.001;  // of sines, as files round; rings are 0.006 apart
    return std::equal(a.elevation_sines.begin(), a.elevation_sines.end(), b.elevation_sines.begin(),
                      b.elevation_sines.end(),
                      [](double x, double y) { return std::abs(x - y) <= max_difference; });
}

/// The mean of what scans with like rings told; empty if fewer than two did.
std::vector<double> offsets_of_others(const BeamOffsets& scan,
                                      std::span<const std::optional<BeamOffsets>> all,
                                      std::span<const std::size_t> telling) {
    std::vector<double> mean(scan.elevation_sines.size(), 0.0);
    double count = 0.0;
    for (const std::size_t other : telling) {
        if (!have_like_rings(scan, *all[other])) continue;
        count += 1.0;
        for (std::size_t beam = 0; beam < mean.size(); ++beam)
            mean[beam] += all[other]->offsets[beam];
    }
    if (count < 2.0) return {};
    for (double& offset : mean)
        offset /= count;
    return mean;
}

}  // namespace

std::optional<BeamOffsets> find_beam_offsets(const ScannedPoints& scan) {
    std::optional<BeamOffsets> beams = find_beams(scan);
    if (beams && beams->offsets.empty()) beams.reset();
    return beams;
}

std::vector<std::optional<BeamOffsets>> find_beam_offsets(std::span<const ScannedPoints> scans) {
    std::vector<std::optional<BeamOffsets>> found;
    std::vector<std::size_t> telling;
    for (const ScannedPoints& scan : scans) {
        found.push_back(find_beams(scan));
        if (found.back() && !found.back()->offsets.empty()) telling.push_back(found.size() - 1);
    }
    for (std::optional<BeamOffsets>& beams : found) {
        if (!beams || !beams->offsets.empty()) continue;
        beams->offsets = offsets_of_others(*beams, found, telling);
        if (beams->offsets.empty()) beams.reset();
    }
    return found;
}

void remove_beam_offsets(std::span<Eigen::Vector3f> positions, const Vector3d& sensor_position,
                         const BeamOffsets& beams) {
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const std::int32_t beam = beams.beam_of_point[i];
        if (beam < 0) continue;
        const Vector3d ray = positions[i].cast<double>() - sensor_position;
        const double offset = beams.offsets[static_cast<std::size_t>(beam)];
        positions[i] -= (offset * ray.normalized()).cast<float>();
    }
}

std::vector<HiddenPoint> remove_beam_offsets(ScanMap& map) {
    std::vector<ScannedPoints> scans;
    std::vector<std::uint32_t> first_points;
    for (const MapSection& section : map.sections) {
        if (!section.sensor_position || !section.sensor_axes) continue;
        scans.push_back({std::span(map.cloud.positions).subspan(section.first, section.count),
                         *section.sensor_position, *section.sensor_axes});
        first_points.push_back(section.first);
    }
    const std::vector<std::optional<BeamOffsets>> found = find_beam_offsets(scans);
    std::vector<HiddenPoint> moved;
    for (std::size_t scan = 0; scan < scans.size(); ++scan) {
        if (!found[scan]) continue;
        const auto positions = std::span(map.cloud.positions)
                                   .subspan(first_points[scan], scans[scan].positions.size());
        for (std::uint32_t i = 0; i < positions.size(); ++i) {
            if (found[scan]->beam_of_point[i] >= 0)
                moved.push_back({first_points[scan] + i, positions[i]});
        }
        remove_beam_offsets(positions, scans[scan].sensor_position, *found[scan]);
    }
    return moved;
}

}  // namespace roomscribe
