// SPDX-License-Identifier: MIT
#include "cli/interrupt.hpp"

#include <csignal>

namespace roomscribe::cli {
namespace {

// A signal handler can reach nothing but a static variable.
std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free, "must be safe in a signal handler");

void note_interrupt(int) {
    interrupted = true;
}

}  // namespace

const std::atomic<bool>& catch_interrupt() {
    struct sigaction action = {};
    action.sa_handler = note_interrupt;
    action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
    sigaction(SIGINT, &action, nullptr);
    return interrupted;
}

}  // namespace roomscribe::cli
