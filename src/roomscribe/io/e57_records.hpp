// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace roomscribe {

/// How the values of one property of the points stand in an E57 file.
struct E57Element {
    enum class Kind { integer, scaled_integer, float32, float64 };

    std::string name;  ///< as in the file: "cartesianX"
    Kind kind = Kind::float64;
    std::int64_t minimum = 0;  ///< of integers
    std::int64_t maximum = 0;
    double scale = 1.0;
    double offset = 0.0;

    /// Bits of one value: of integers, as many as the range needs, which may be none.
    unsigned bits() const;
};

/// The values of one property, which arrive in pieces: each may end within a value, even within a
/// byte.
class E57Stream {
  public:
    explicit E57Stream(E57Element element) : element_(std::move(element)) {}

    const E57Element& element() const { return element_; }
    void append(std::span<const std::byte> bytes);
    /// Decodes as many values as have arrived, but no more than `max_count`, behind `values`.
    void decode(std::vector<double>& values, std::size_t max_count);

  private:
    void decode_floats(std::vector<double>& values, std::size_t count);
    void decode_integers(std::vector<double>& values, std::size_t count);

    E57Element element_;
    std::vector<std::byte> bytes_;  ///< with 8 bytes of zeros at the end
    std::size_t position_ = 0;      ///< in bits
};

}  // namespace roomscribe
