// SPDX-License-Identifier: MIT
#include "support/run_program.hpp"

#include <csignal>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "support/test_data.hpp"

namespace roomscribe::test {
namespace {

pid_t start_program(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                    const std::filesystem::path& out, const std::filesystem::path& err) {
    std::vector<std::string> words{program.string()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words)
        argv.push_back(word.data());
    argv.push_back(nullptr);

    constexpr int flags = O_WRONLY | O_CREAT | O_TRUNC;
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, out.c_str(), flags, 0600);
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, err.c_str(), flags, 0600);
    pid_t pid = 0;
    const int error =
        posix_spawn(&pid, words.front().c_str(), &files, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    if (error != 0) throw std::runtime_error("cannot start " + program.string());
    return pid;
}

}  // namespace

ProgramResult run_program(const std::filesystem::path& program,
                          const std::vector<std::string>& arguments,
                          const ProgramOptions& options) {
    using Clock = std::chrono::steady_clock;
    const TemporaryFolder folder;
    const std::filesystem::path out = folder / "stdout";
    const std::filesystem::path err = folder / "stderr";
    const Clock::time_point start = Clock::now();
    const Clock::time_point deadline = start + options.timeout;
    const pid_t pid = start_program(program, arguments, out, err);

    ProgramResult result;
    bool to_interrupt = options.interrupt_at_first_message;
    int status = 0;
    struct rusage usage = {};
    while (wait4(pid, &status, WNOHANG, &usage) == 0) {
        if (Clock::now() > deadline && !result.timed_out) {
            result.timed_out = true;
            kill(pid, SIGKILL);
        }
        std::error_code not_there_yet;
        if (to_interrupt && std::filesystem::file_size(err, not_there_yet) > 0 && !not_there_yet) {
            to_interrupt = false;
            kill(pid, SIGINT);
        }
        const bool is_time = options.kill_after && Clock::now() - start >= *options.kill_after;
        const bool is_there = !options.kill_at_file.empty() &&
                              std::filesystem::exists(options.kill_at_file, not_there_yet);
        if (is_time || is_there) kill(pid, SIGKILL);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    result.peak_memory = static_cast<std::size_t>(usage.ru_maxrss) * 1024;
    result.out = read_bytes(out);
    result.err = read_bytes(err);
    return result;
}

std::string read_bytes(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace roomscribe::test
