// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>

namespace roomscribe::cli {

/// What the server of a report gives away.
struct ServedReport {
    std::string page;        ///< at /
    std::string nodes_json;  ///< at /points/nodes.json
    std::size_t num_nodes = 0;
    /// At /points/NUMBER; called from many threads.
    std::function<std::string(std::size_t node)> points_of_node;
};

/// Serves the report on 127.0.0.1 until `cancel` is true: these addresses and no others, for
/// reading; no file is opened. `on_start` is told the port, which is any free one for port 0.
/// Throws UsageError if the port cannot be had.
void serve_report(const ServedReport& report, int port, const std::atomic<bool>& cancel,
                  const std::function<void(int port)>& on_start);

}  // namespace roomscribe::cli
