// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace roomscribe {

/// A symmetric 3x3 matrix whose extreme eigenvalues are wanted for every pixel of an image, where a
/// general solver would take most of the time.
struct SymmetricMatrix {
    float xx = 0.0F, xy = 0.0F, xz = 0.0F, yy = 0.0F, yz = 0.0F, zz = 0.0F;

    float trace() const { return xx + yy + zz; }
    void add_square(const Eigen::Vector3f& v, float weight = 1.0F) {
        xx += weight * v.x() * v.x();
        xy += weight * v.x() * v.y();
        xz += weight * v.x() * v.z();
        yy += weight * v.y() * v.y();
        yz += weight * v.y() * v.z();
        zz += weight * v.z() * v.z();
    }
    void scale(float factor) {
        for (float* value : {&xx, &xy, &xz, &yy, &yz, &zz})
            *value *= factor;
    }

    /// Precondition for both: positive semi-definite. Accurate to about 1e-6 of the trace.
    float smallest_eigenvalue() const { return eigenvalue_from(0.0F); }
    float largest_eigenvalue() const { return eigenvalue_from(trace()); }

    /// Unit eigenvector of a simple eigenvalue; any unit vector of its space for a multiple one.
    Eigen::Vector3f eigenvector(float eigenvalue) const {
        const Eigen::Vector3f rows[] = {
            {xx - eigenvalue, xy, xz}, {xy, yy - eigenvalue, yz}, {xz, yz, zz - eigenvalue}};
        Eigen::Vector3f best = rows[0].cross(rows[1]);
        for (const Eigen::Vector3f& other :
             {Eigen::Vector3f(rows[0].cross(rows[2])), Eigen::Vector3f(rows[1].cross(rows[2]))}) {
            if (other.squaredNorm() > best.squaredNorm()) best = other;
        }
        if (best.squaredNorm() > 0.0F) return best / best.norm();
        const auto* longest = std::max_element(
            std::begin(rows), std::end(rows),
            [](const auto& a, const auto& b) { return a.squaredNorm() < b.squaredNorm(); });
        return longest->squaredNorm() > 0.0F ? longest->unitOrthogonal() : Eigen::Vector3f::UnitX();
    }

  private:
    /// Newton's method on the characteristic polynomial, which comes down to the nearest root
    /// without passing it when it starts outside all roots.
    float eigenvalue_from(float start) const {
        const double a = trace();
        const double b = double{xx} * yy - double{xy} * xy + double{xx} * zz - double{xz} * xz +
                         double{yy} * zz - double{yz} * yz;
        const double c = double{xx} * (double{yy} * zz - double{yz} * yz) -
                         double{xy} * (double{xy} * zz - double{yz} * xz) +
                         double{xz} * (double{xy} * yz - double{yy} * xz);
        double root = start;
        for (int step = 0; step < 40; ++step) {
            const double value = ((root - a) * root + b) * root - c;
            const double slope = (3.0 * root - 2.0 * a) * root + b;
            if (slope <= 0.0) break;
            const double change = value / slope;
            root -= change;
            if (std::abs(change) <= 1e-7 * a) break;
        }
        return static_cast<float>(root);
    }
};

}  // namespace roomscribe
