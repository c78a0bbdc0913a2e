// SPDX-License-Identifier: MIT
#include "roomscribe/pipeline/stage_costs.hpp"

#include <sys/resource.h>

namespace roomscribe {

std::size_t peak_memory() {
    rusage usage{};
    if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
    return static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

}  // namespace roomscribe
