// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace roomscribe::cli {

enum class ProgressMode {
    automatic,  ///< a bar if stderr is a terminal, else nothing
    none,
    json  ///< one JSON object a line
};

/// Shows how far a job is, on stderr.
class ProgressDisplay {
  public:
    explicit ProgressDisplay(ProgressMode mode);
    /// Takes the bar away.
    ~ProgressDisplay();
    ProgressDisplay(const ProgressDisplay&) = delete;
    ProgressDisplay& operator=(const ProgressDisplay&) = delete;

    void show(std::string_view stage, double fraction);
    void show_message(std::string_view message);

  private:
    using Clock = std::chrono::steady_clock;

    void draw_bar(double fraction) const;
    void erase_bar() const;

    bool as_bar_ = false;
    bool as_json_ = false;
    Clock::time_point start_ = Clock::now();
    Clock::time_point stage_start_ = start_;
    Clock::time_point last_shown_;
    std::string stage_;
};

}  // namespace roomscribe::cli
