// SPDX-License-Identifier: MIT
#include "cli/progress_display.hpp"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace roomscribe::cli {
namespace {

constexpr double min_seconds_between = 0.1;

double seconds_between(std::chrono::steady_clock::time_point begin,
                       std::chrono::steady_clock::time_point end) {
    return std::chrono::duration<double>(end - begin).count();
}

void print_json_line(const nlohmann::json& object) {
    using Dump = nlohmann::json;
    fmt::print(stderr, "{}\n", object.dump(-1, ' ', false, Dump::error_handler_t::replace));
}

}  // namespace

ProgressDisplay::ProgressDisplay(ProgressMode mode)
    : as_bar_(mode == ProgressMode::automatic && isatty(STDERR_FILENO) == 1),
      as_json_(mode == ProgressMode::json) {}

ProgressDisplay::~ProgressDisplay() {
    erase_bar();
}

void ProgressDisplay::show(std::string_view stage, double fraction) {
    if (!as_bar_ && !as_json_) return;
    const Clock::time_point now = Clock::now();
    const bool stage_changed = stage != stage_;
    if (stage_changed) {
        stage_ = stage;
        stage_start_ = now;
    }
    const bool due = seconds_between(last_shown_, now) >= min_seconds_between;
    if (!stage_changed && !due && fraction < 1.0) return;
    last_shown_ = now;
    if (as_bar_) {
        draw_bar(std::clamp(fraction, 0.0, 1.0));
    } else {
        print_json_line(
            {{"stage", stage_}, {"fraction", fraction}, {"seconds", seconds_between(start_, now)}});
    }
}

void ProgressDisplay::show_message(std::string_view message) {
    if (as_bar_) {
        erase_bar();
        fmt::print(stderr, "{}\n", message);
    } else if (as_json_) {
        print_json_line({{"message", std::string(message)}});
    }
}

void ProgressDisplay::draw_bar(double fraction) const {
    constexpr int width = 24;
    const double spent = seconds_between(stage_start_, last_shown_);
    std::string left;
    // Too early a guess would only jump about.
    if (fraction > 0.05 && spent > 0.5) {
        const double rate = 100.0 * fraction / spent;
        left = fmt::format(", {:.{}f} %/s, {:.0f} s left", rate, rate < 10.0 ? 1 : 0,
                           spent * (1.0 - fraction) / fraction);
    }
    const int filled = static_cast<int>(fraction * width);
    fmt::print(stderr, "\r\033[K[{:#<{}}{:.<{}}] {} {:.0f} %{}", "", filled, "", width - filled,
               stage_, 100.0 * fraction, left);
    std::fflush(stderr);
}

void ProgressDisplay::erase_bar() const {
    if (as_bar_ && !stage_.empty()) fmt::print(stderr, "\r\033[K");
}

}  // namespace roomscribe::cli
