// SPDX-License-Identifier: MIT
#include "roomscribe/core/parallel.hpp"

#include <algorithm>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace roomscribe {

void parallel_for(const Context& context, std::size_t count, std::size_t chunk_size,
                  const std::function<void(std::size_t begin, std::size_t end)>& body) {
    const std::size_t num_chunks = (count + chunk_size - 1) / chunk_size;
    const auto run_chunk = [&](std::size_t chunk) {
        context.throw_if_cancelled();
        const std::size_t begin = chunk * chunk_size;
        body(begin, std::min(begin + chunk_size, count));
    };
    if (num_chunks <= 1 || context.num_threads == 1) {
        for (std::size_t chunk = 0; chunk < num_chunks; ++chunk)
            run_chunk(chunk);
        return;
    }
    const auto run_all = [&] { tbb::parallel_for(std::size_t{0}, num_chunks, run_chunk); };
    // An arena for each of many short loops costs more than the loops on a busy machine.
    if (context.num_threads <= 0) {
        run_all();
    } else {
        tbb::task_arena(context.num_threads).execute(run_all);
    }
}

}  // namespace roomscribe
