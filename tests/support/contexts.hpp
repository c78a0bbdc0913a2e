// SPDX-License-Identifier: MIT
#pragma once

#include "roomscribe/core/context.hpp"

namespace roomscribe::test {

inline Context with_threads(int num_threads) {
    Context context;
    context.num_threads = num_threads;
    return context;
}

}  // namespace roomscribe::test
