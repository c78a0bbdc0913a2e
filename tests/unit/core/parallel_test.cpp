// SPDX-License-Identifier: MIT
#include "roomscribe/core/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/random.hpp"
#include "support/contexts.hpp"

namespace roomscribe {
namespace {

using Chunk = std::pair<std::size_t, std::size_t>;

std::vector<Chunk> chunks_of(std::size_t count, std::size_t chunk_size, int num_threads) {
    std::mutex mutex;
    std::vector<Chunk> chunks;
    parallel_for(test::with_threads(num_threads), count, chunk_size,
                 [&](std::size_t begin, std::size_t end) {
                     const std::scoped_lock lock(mutex);
                     chunks.emplace_back(begin, end);
                 });
    std::sort(chunks.begin(), chunks.end());
    return chunks;
}

TEST(ParallelFor, CutsIntoChunksWhateverTheThreads) {
    for (const int num_threads : {0, 1, 2, 7}) {
        EXPECT_EQ(chunks_of(10, 4, num_threads), (std::vector<Chunk>{{0, 4}, {4, 8}, {8, 10}}));
        EXPECT_EQ(chunks_of(8, 4, num_threads), (std::vector<Chunk>{{0, 4}, {4, 8}}));
        EXPECT_EQ(chunks_of(3, 4, num_threads), (std::vector<Chunk>{{0, 3}}));
        EXPECT_TRUE(chunks_of(0, 4, num_threads).empty());
        EXPECT_EQ(chunks_of(1000, 1, num_threads).size(), 1000U);
    }
}

TEST(ParallelFor, ThrowsWhatABodyThrows) {
    for (const int num_threads : {1, 3}) {
        const auto body = [](std::size_t begin, std::size_t) {
            if (begin == 40) throw std::out_of_range("chunk 40");
        };
        EXPECT_THROW(parallel_for(test::with_threads(num_threads), 100, 4, body),
                     std::out_of_range);
    }
}

TEST(ParallelFor, StopsWhenCancelled) {
    for (const int num_threads : {1, 2}) {
        std::atomic<bool> cancel = false;
        std::atomic<int> num_done = 0;
        Context context = test::with_threads(num_threads);
        context.cancel = &cancel;
        const auto body = [&](std::size_t, std::size_t) {
            ++num_done;
            cancel = true;
        };
        EXPECT_THROW(parallel_for(context, 10'000, 1, body), Cancelled);
        EXPECT_GE(num_done, 1);
        EXPECT_LE(num_done, 2 * num_threads);
    }
}

TEST(ParallelReduce, SumsInChunkOrder) {
    // Terms of such different size that a sum in any other order has other bits.
    Random random(1);
    std::vector<double> terms(20'000);
    for (double& term : terms)
        term = random.uniform(-1.0, 1.0) * std::pow(10.0, random.below(16));
    const auto sum_range = [&](std::size_t begin, std::size_t end) {
        return std::accumulate(terms.begin() + static_cast<std::ptrdiff_t>(begin),
                               terms.begin() + static_cast<std::ptrdiff_t>(end), 0.0);
    };
    double expected = 0.0;
    for (std::size_t begin = 0; begin < terms.size(); begin += 64) {
        expected += sum_range(begin, std::min(begin + 64, terms.size()));
    }
    ASSERT_NE(expected, sum_range(0, terms.size()));
    for (const int num_threads : {1, 2, 7}) {
        EXPECT_EQ(parallel_reduce(test::with_threads(num_threads), terms.size(), 64, 0.0, sum_range,
                                  std::plus<>()),
                  expected);
    }
}

TEST(ParallelReduce, OfNothingIsTheIdentity) {
    const auto never = [](std::size_t, std::size_t) -> std::string { throw std::logic_error(""); };
    EXPECT_EQ(parallel_reduce({}, 0, 8, std::string("identity"), never, std::plus<>()), "identity");
}

}  // namespace
}  // namespace roomscribe
