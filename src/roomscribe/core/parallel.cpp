// SPDX-License-Identifier: MIT
#include "roomscribe/core/parallel.hpp"

#include <algorithm>

#ifdef ROOMSCRIBE_OWN_THREADS
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#else
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

namespace roomscribe {
namespace {

#ifdef ROOMSCRIBE_OWN_THREADS
/// ThreadSanitizer cannot look into TBB and would take all that it does for races: threads of our
/// own.
void for_each_chunk(int num_threads, std::size_t num_chunks,
                    const std::function<void(std::size_t)>& run_chunk) {
    std::atomic<std::size_t> next = 0;
    std::mutex mutex;
    std::exception_ptr thrown;
    const auto work = [&] {
        try {
            for (std::size_t chunk = next++; chunk < num_chunks; chunk = next++)
                run_chunk(chunk);
        } catch (...) {
            next = num_chunks;
            const std::lock_guard lock(mutex);
            if (!thrown) thrown = std::current_exception();
        }
    };
    std::vector<std::thread> others;
    for (int i = 1; i < (num_threads > 0 ? num_threads : 2); ++i)
        others.emplace_back(work);
    work();
    for (std::thread& thread : others)
        thread.join();
    if (thrown) std::rethrow_exception(thrown);
}
#else
void for_each_chunk(int num_threads, std::size_t num_chunks,
                    const std::function<void(std::size_t)>& run_chunk) {
    const auto run_all = [&] { tbb::parallel_for(std::size_t{0}, num_chunks, run_chunk); };
    // An arena for each of many short loops costs more than the loops on a busy machine.
    if (num_threads <= 0) {
        run_all();
    } else {
        tbb::task_arena(num_threads).execute(run_all);
    }
}
#endif

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
    for_each_chunk(context.num_threads, num_chunks, run_chunk);
}

}  // namespace roomscribe
