// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "roomscribe/model/byte_archive.hpp"

namespace roomscribe {

/// What a stage cost.
struct StageCost {
    std::string stage;
    double seconds = 0.0;
    std::size_t peak_memory = 0;  ///< bytes that the process had held at most when the stage ended
};

template <typename Archive, Either<StageCost> Value>
void exchange(Archive& archive, Value& cost) {
    archive(cost.stage, cost.seconds, cost.peak_memory);
}

/// Bytes of memory that the process has held at most so far; 0 where the system does not tell.
std::size_t peak_memory();

/// Notes the cost of one stage after the other.
class StageTimer {
  public:
    explicit StageTimer(std::vector<StageCost>& costs) : costs_(costs) {}

    /// Books the time since the last call (or since construction) under this name.
    void finish(std::string stage) {
        const auto now = std::chrono::steady_clock::now();
        costs_.push_back(
            {std::move(stage), std::chrono::duration<double>(now - start_).count(), peak_memory()});
        start_ = now;
    }

  private:
    std::vector<StageCost>& costs_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace roomscribe
