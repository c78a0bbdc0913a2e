// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>

namespace roomscribe::cli {

/// From now on Ctrl-C sets the returned flag; a second Ctrl-C ends the program at once.
const std::atomic<bool>& catch_interrupt();

}  // namespace roomscribe::cli
