// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "roomscribe/core/context.hpp"

namespace roomscribe {

/// Calls `body(begin, end)` for consecutive chunks that cover [0, count), each of `chunk_size`
/// items but for the last (at least 1). The cut into chunks depends on the arguments alone and
/// never on the number of threads, so a body that writes only to its own items gives the same bits
/// on any machine. Throws Cancelled between chunks, and what a body throws.
void parallel_for(const Context& context, std::size_t count, std::size_t chunk_size,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Folds `map(begin, end)` over the chunks of parallel_for, in chunk order: a floating-point sum is
/// the same on 1 or N threads. Returns `identity` when count is 0.
template <typename Value, typename Map, typename Combine>
Value parallel_reduce(const Context& context, std::size_t count, std::size_t chunk_size,
                      Value identity, Map&& map, Combine&& combine) {
    const std::size_t num_chunks = (count + chunk_size - 1) / chunk_size;
    std::vector<Value> partial(num_chunks, identity);
    parallel_for(context, count, chunk_size, [&](std::size_t begin, std::size_t end) {
        partial[begin / chunk_size] = map(begin, end);
    });
    Value total = std::move(identity);
    for (Value& value : partial)
        total = combine(std::move(total), std::move(value));
    return total;
}

}  // namespace roomscribe
