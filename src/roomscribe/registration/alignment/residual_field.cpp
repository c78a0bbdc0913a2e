// SPDX-License-Identifier: MIT
#include "roomscribe/registration/alignment/residual_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace roomscribe {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Residuals of one piece of surface.
struct Patch {
    double count = 0.0;
    double weight = 0.0;
    double sum = 0.0;      ///< weighted, of the residuals
    double squares = 0.0;  ///< weighted, of their squares
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
    Vector6d pull = Vector6d::Zero();  ///< sum of weight * jacobian

    double mean() const { return sum / weight; }
};

/// Axes that turn with the rows: principal ones, each towards its longer tail.
Eigen::Matrix3d own_axes(std::span<const ResidualRow> rows, const Eigen::Vector3d& center) {
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const ResidualRow& row : rows) {
        const Eigen::Vector3d offset = row.position - center;
        covariance.noalias() += offset * offset.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
    Eigen::Matrix3d axes = solver.eigenvectors();
    Eigen::Array3d skewness = Eigen::Array3d::Zero();
    for (const ResidualRow& row : rows) {
        skewness += (axes.transpose() * (row.position - center)).array().cube();
    }
    for (Eigen::Index i = 0; i < 3; ++i) {
        if (skewness[i] < 0.0) axes.col(i) *= -1.0;
    }
    return axes;
}

/// Rows in one cube that face about the same way.
std::vector<Patch> cut_patches(std::span<const ResidualRow> rows, double size) {
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    for (const ResidualRow& row : rows)
        center += row.position;
    center /= static_cast<double>(rows.size());
    const Eigen::Matrix3d axes = own_axes(rows, center);
    std::map<std::array<int, 4>, Patch> patches;
    for (const ResidualRow& row : rows) {
        const Eigen::Array3d place = (axes.transpose() * (row.position - center)).array() / size;
        const Eigen::Vector3d facing = axes.transpose() * row.direction;
        Eigen::Index axis = 0;
        facing.cwiseAbs().maxCoeff(&axis);
        const int side = static_cast<int>(axis) + (facing[axis] < 0.0 ? 3 : 0);
        Patch& patch = patches[{static_cast<int>(std::floor(place.x())),
                                static_cast<int>(std::floor(place.y())),
                                static_cast<int>(std::floor(place.z())), side}];
        patch.count += 1.0;
        patch.weight += row.weight;
        patch.sum += row.weight * row.residual;
        patch.squares += row.weight * row.residual * row.residual;
        patch.position += row.weight * row.position;
        patch.direction += row.weight * row.direction;
        patch.pull += row.weight * row.jacobian;
    }
    std::vector<Patch> result;
    result.reserve(patches.size());
    for (auto& [key, patch] : patches) {
        patch.position /= patch.weight;
        patch.direction.normalize();
        result.push_back(patch);
    }
    return result;
}

/// Variance of the residuals within patches: the part that neighbours do not share.
double variance_within(std::span<const Patch> patches) {
    double squares = 0.0;
    double weight = 0.0;
    for (const Patch& patch : patches) {
        if (patch.count < 2.0) continue;
        squares += patch.squares - patch.sum * patch.mean();
        weight += patch.weight * (1.0 - 1.0 / patch.count);
    }
    return weight > 0.0 ? std::max(0.0, squares / weight) : 0.0;
}

/// Variance of the patches' means beyond what independent errors leave in them.
double variance_between(std::span<const Patch> patches, double within) {
    double sum = 0.0;
    double weight = 0.0;
    for (const Patch& patch : patches) {
        sum += patch.weight * (patch.mean() * patch.mean() - within / patch.count);
        weight += patch.weight;
    }
    return weight > 0.0 ? std::max(0.0, sum / weight) : 0.0;
}

/// What the means of patches at one distance say of their correlation.
struct Lag {
    double covariance = 0.0;
    double weight = 0.0;
    double distance = 0.0;
};

/// By distance in patch sizes, doubling every second lag; the pairs beyond are left out.
std::vector<Lag> measure_lags(std::span<const Patch> patches, double size) {
    constexpr std::size_t num_lags = 9;
    constexpr double min_cosine = 0.5;
    std::vector<Lag> lags(num_lags);
    for (std::size_t a = 0; a < patches.size(); ++a) {
        for (std::size_t b = 0; b < a; ++b) {
            const double cosine = patches[a].direction.dot(patches[b].direction);
            if (cosine < min_cosine) continue;
            const double distance = (patches[a].position - patches[b].position).norm();
            const double lag = std::max(0.0, 2.0 * std::log2(distance / size) + 1.0);
            if (!(lag < static_cast<double>(num_lags))) continue;
            const double weight = patches[a].weight * patches[b].weight * cosine;
            Lag& sum = lags[static_cast<std::size_t>(lag)];
            sum.covariance += weight * patches[a].mean() * patches[b].mean();
            sum.weight += weight * cosine;
            sum.distance += weight * cosine * distance;
        }
    }
    std::erase_if(lags, [](const Lag& lag) { return !(lag.weight > 0.0); });
    for (Lag& lag : lags) {
        lag.covariance /= lag.weight;
        lag.distance /= lag.weight;
        lag.weight = std::sqrt(lag.weight);
    }
    return lags;
}

/// variance * exp(-distance / range).
struct Correlation {
    double variance = 0.0;
    double range = 1.0;  ///< m

    double at(double distance) const { return variance * std::exp(-distance / range); }
};

/// The exponential that fits the lags and the variance at no distance best, by least squares.
Correlation fit_correlation(std::vector<Lag> lags, double variance, double size) {
    Correlation best{0.0, size};
    if (lags.empty()) return {variance, size};
    lags.push_back({variance, lags.front().weight, 0.0});
    double least_error = std::numeric_limits<double>::infinity();
    for (int step = 0; step < 12; ++step) {
        Correlation candidate{1.0, 0.5 * size * std::pow(1.3, step)};
        double products = 0.0;
        double squares = 0.0;
        for (const Lag& lag : lags) {
            const double shape = candidate.at(lag.distance);
            products += lag.weight * shape * lag.covariance;
            squares += lag.weight * shape * shape;
        }
        candidate.variance = std::max(0.0, products / squares);
        double error = 0.0;
        for (const Lag& lag : lags) {
            const double miss = lag.covariance - candidate.at(lag.distance);
            error += lag.weight * miss * miss;
        }
        if (error < least_error) {
            least_error = error;
            best = candidate;
        }
    }
    return best;
}

}  // namespace

Matrix6d gradient_covariance(std::span<const ResidualRow> rows, double extent,
                             double shared_deviation) {
    Matrix6d sum = Matrix6d::Zero();
    if (rows.empty()) return sum;
    // Some hundred patches on the surfaces of a room.
    const double size = extent / 6.0;
    const std::vector<Patch> patches = cut_patches(rows, size);
    const double within = variance_within(patches);
    const double between = variance_between(patches, within);
    const Correlation field = fit_correlation(measure_lags(patches, size), between, size);
    const Correlation shared{shared_deviation * shared_deviation, extent};
    const double rest = std::max(0.0, between - field.variance);

    for (const ResidualRow& row : rows) {
        const Vector6d pull = row.weight * row.jacobian;
        sum.noalias() += (within * pull) * pull.transpose();
    }
    for (const Patch& a : patches) {
        Vector6d partners = rest * a.pull;
        for (const Patch& b : patches) {
            const double distance = (a.position - b.position).norm();
            partners +=
                a.direction.dot(b.direction) * (field.at(distance) + shared.at(distance)) * b.pull;
        }
        sum.noalias() += a.pull * partners.transpose();
    }
    return 0.5 * (sum + sum.transpose());
}

}  // namespace roomscribe
