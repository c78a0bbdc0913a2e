// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string_view>

namespace roomscribe {

/// Keeps results of costly steps, so that a run that was stopped can go on where it was
/// (Context::results). What a step computes depends on the job alone, so a name that is unique
/// within the job is all that it takes. Called from the thread that runs the job.
class ResultStore {
  public:
    /// Takes the bytes of a result, piece by piece.
    using Write = std::function<void(std::span<const std::byte>)>;

    virtual ~ResultStore() = default;

    /// Keeps what `give` writes. `name` is a word of letters, digits and hyphens. A result that
    /// cannot be kept is no error: it will be computed again.
    virtual void keep(std::string_view name, const std::function<void(const Write&)>& give) = 0;

    /// Hands the bytes of that name to `take`, which throws Error if it can do nothing with them.
    /// False if there are none that `take` could use.
    virtual bool recall(std::string_view name,
                        const std::function<void(std::span<const std::byte>)>& take) = 0;
};

}  // namespace roomscribe
