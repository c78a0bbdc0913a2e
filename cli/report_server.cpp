// SPDX-License-Identifier: MIT
#include "cli/report_server.hpp"

#include <charconv>
#include <chrono>
#include <thread>

#include <fmt/format.h>
#include <httplib.h>

#include "cli/command.hpp"

namespace roomscribe::cli {
namespace {

constexpr const char* this_machine = "127.0.0.1";

/// Who may ask, and for what. Pages of others that were led to this address (DNS rebinding) name
/// another host.
httplib::Server::HandlerResponse screen(const httplib::Request& request,
                                        httplib::Response& answer) {
    const std::string host = request.get_header_value("Host");
    const std::string name = host.substr(0, host.find(':'));
    answer.set_header("Content-Security-Policy",
                      "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
                      "img-src data:; connect-src 'self'");
    answer.set_header("Cache-Control", "no-store");
    answer.set_header("X-Content-Type-Options", "nosniff");
    const bool is_ours = name == this_machine || name == "localhost";
    const bool is_reading = request.method == "GET" || request.method == "HEAD";
    if (is_ours && is_reading) return httplib::Server::HandlerResponse::Unhandled;
    answer.status = is_ours ? 405 : 403;
    return httplib::Server::HandlerResponse::Handled;
}

void declare_pages(httplib::Server& server, const ServedReport& report) {
    server.set_pre_routing_handler(screen);
    server.Get("/", [&report](const httplib::Request&, httplib::Response& answer) {
        answer.set_content(report.page, "text/html; charset=utf-8");
    });
    server.Get("/points/nodes.json", [&report](const httplib::Request&, httplib::Response& answer) {
        answer.set_content(report.nodes_json, "application/json");
    });
    server.Get("/points/([0-9]{1,9})",
               [&report](const httplib::Request& request, httplib::Response& answer) {
                   const std::string digits = request.matches[1];
                   std::size_t number = 0;
                   std::from_chars(digits.data(), digits.data() + digits.size(), number);
                   if (number >= report.num_nodes) {
                       answer.status = 404;
                       return;
                   }
                   answer.set_content(report.points_of_node(number), "application/octet-stream");
               });
    // A browser asks for it unasked.
    server.Get("/favicon.ico",
               [](const httplib::Request&, httplib::Response& answer) { answer.status = 204; });
}

}  // namespace

void serve_report(const ServedReport& report, int port, const std::atomic<bool>& cancel,
                  const std::function<void(int port)>& on_start) {
    httplib::Server server;
    declare_pages(server, report);
    if (port == 0) {
        port = server.bind_to_any_port(this_machine);
    } else if (!server.bind_to_port(this_machine, port)) {
        throw UsageError(
            fmt::format("port {} is taken or not allowed: leave --port out for a free one", port));
    }
    on_start(port);
    std::atomic<bool> has_ended = false;
    std::thread watch([&] {
        while (!cancel && !has_ended)
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        server.stop();
    });
    server.listen_after_bind();
    has_ended = true;
    watch.join();
}

}  // namespace roomscribe::cli
