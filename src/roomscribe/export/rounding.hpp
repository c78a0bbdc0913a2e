// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

namespace roomscribe {

/// The nearest multiple of 1 / `steps`; never -0. Throws InvalidArgument if the value is not
/// finite, which JSON cannot say.
double rounded(double value, double steps);

/// The same of each coefficient.
template <typename Derived>
std::vector<double> rounded(const Eigen::MatrixBase<Derived>& vector, double steps) {
    std::vector<double> numbers;
    numbers.reserve(static_cast<std::size_t>(vector.size()));
    for (Eigen::Index i = 0; i < vector.size(); ++i)
        numbers.push_back(rounded(vector(i), steps));
    return numbers;
}

}  // namespace roomscribe
