// SPDX-License-Identifier: MIT
#include "cli/memory_limit.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <sys/resource.h>

#include "cli/command.hpp"
#include "roomscribe/pipeline/memory_need.hpp"

namespace roomscribe::cli {
namespace {

constexpr std::size_t mega = std::size_t{1} << 20U;
constexpr std::size_t giga = std::size_t{1} << 30U;
/// Less than a small room takes.
constexpr std::size_t least = 512 * mega;
/// What counts as memory in use and is not the data that RLIMIT_DATA bounds: the program itself,
/// its libraries, and what of open files was just read.
constexpr std::size_t not_data = 128 * mega;

std::string size_text(std::size_t bytes) {
    const double gigabytes = static_cast<double>(bytes) / static_cast<double>(giga);
    // Upwards: who gives what is asked for must have enough.
    return gigabytes >= 1.0 ? fmt::format("{:.1f}G", std::ceil(10.0 * gigabytes) / 10.0)
                            : fmt::format("{:.0f}M", std::ceil(1024.0 * gigabytes));
}

}  // namespace

std::size_t parse_memory_size(std::string_view text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
    const bool is_giga = unit == "G" || unit == "GB" || unit == "GiB";
    const bool is_mega = unit == "M" || unit == "MB" || unit == "MiB";
    const double bytes = value * static_cast<double>(is_giga ? giga : mega);
    if (error != std::errc() || !(is_giga || is_mega) || !(bytes >= static_cast<double>(least)) ||
        !(bytes < 1e15)) {
        throw UsageError(fmt::format("--memory {}: give a size like 8G or 800M, of at least {}",
                                     text, size_text(least)));
    }
    return static_cast<std::size_t>(bytes);
}

MemoryLimit::MemoryLimit(std::optional<std::size_t> size) : size_(size) {
    if (!size_) return;
    rlimit limit{};
    if (getrlimit(RLIMIT_DATA, &limit) != 0) return;
    before_ = limit.rlim_cur;
    limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, *size_ - not_data);
    setrlimit(RLIMIT_DATA, &limit);
}

MemoryLimit::~MemoryLimit() {
    if (!size_) return;
    rlimit limit{};
    if (getrlimit(RLIMIT_DATA, &limit) != 0) return;
    limit.rlim_cur = before_;
    setrlimit(RLIMIT_DATA, &limit);
}

void MemoryLimit::require_room(std::span<const Scan> scans) const {
    if (!size_) return;
    const std::size_t need = memory_need(scans);
    if (need <= *size_) return;
    std::size_t num_points = 0;
    for (const Scan& scan : scans)
        num_points += scan.cloud.size();
    throw UsageError(fmt::format(
        "--memory {} is not enough: the first {} scans, {:.1f} million points, need {}; give more "
        "memory, fewer scans, or thinned ones",
        size_text(*size_), scans.size(), static_cast<double>(num_points) / 1e6, size_text(need)));
}

std::string MemoryLimit::exceeded_message() const {
    return fmt::format(
        "--memory {} was not enough: give more; run and register go on where they were with "
        "--resume",
        size_text(*size_));
}

}  // namespace roomscribe::cli
