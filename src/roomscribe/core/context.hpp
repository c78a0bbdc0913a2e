// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <functional>
#include <string_view>

namespace roomscribe {

class ResultStore;

/// How a computation runs, as opposed to what it computes: nothing in here changes a result.
struct Context {
    /// Threads to use; 0 means as many as the machine has.
    int num_threads = 0;
    /// Told at every step of a stage, from the calling thread; `fraction` is in [0, 1].
    std::function<void(std::string_view stage, double fraction)> on_progress = {};
    /// Told what a user may want to know (a derived value, a doubtful input). Never an error.
    std::function<void(std::string_view message)> on_message = {};
    /// When it becomes true, the computation throws Cancelled at its next check.
    const std::atomic<bool>* cancel = nullptr;
    /// Where costly steps keep their results and find them again; none are kept without.
    ResultStore* results = nullptr;

    void report_progress(std::string_view stage, double fraction) const {
        if (on_progress) on_progress(stage, fraction);
    }
    void report_message(std::string_view message) const {
        if (on_message) on_message(message);
    }
    /// Throws Cancelled if the caller asked to stop.
    void throw_if_cancelled() const;
};

}  // namespace roomscribe
