// SPDX-License-Identifier: MIT
#include "roomscribe/core/parallel.hpp"

#include <algorithm>
#include <atomic>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace roomscribe {
namespace {

// ThreadSanitizer cannot look into TBB. These tell it what TBB guarantees: a chunk sees what was
// written before its loop, and what comes after the loop sees what the chunks wrote. They are
// global since a chunk may touch nothing of its loop before it has passed the first.
std::atomic<std::size_t> num_begun_loops;
std::atomic<std::size_t> num_ended_chunks;

}  // namespace

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
    const auto run_all = [&] {
        num_begun_loops.fetch_add(1, std::memory_order_release);
        tbb::parallel_for(std::size_t{0}, num_chunks, [&](std::size_t chunk) {
            num_begun_loops.load(std::memory_order_acquire);
            run_chunk(chunk);
            num_ended_chunks.fetch_add(1, std::memory_order_release);
        });
        num_ended_chunks.load(std::memory_order_acquire);
    };
    // An arena for each of many short loops costs more than the loops on a busy machine.
    if (context.num_threads <= 0) {
        run_all();
    } else {
        tbb::task_arena(context.num_threads).execute(run_all);
    }
}

}  // namespace roomscribe
