// SPDX-License-Identifier: MIT
#include "roomscribe/core/context.hpp"

#include "roomscribe/core/error.hpp"

namespace roomscribe {

void Context::throw_if_cancelled() const {
    if (cancel != nullptr && cancel->load(std::memory_order_relaxed)) throw Cancelled();
}

}  // namespace roomscribe
