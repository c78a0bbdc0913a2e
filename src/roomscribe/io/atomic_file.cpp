// SPDX-License-Identifier: MIT
#include "roomscribe/io/atomic_file.hpp"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "roomscribe/core/error.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t buffer_size = 1U << 20U;

/// A name that no other writer in this folder has, in this process or another.
std::filesystem::path temporary_name(const std::filesystem::path& path) {
    static std::atomic<unsigned> counter = 0;
    return path.parent_path() / fmt::format(".roomscribe-{}-{}.tmp", ::getpid(), counter++);
}

/// The process that wrote a file of that name; 0 if it is no temporary name.
pid_t writer_of(const std::string& name) {
    int pid = 0;
    unsigned count = 0;
    if (std::sscanf(name.c_str(), ".roomscribe-%d-%u.tmp", &pid, &count) != 2) return 0;
    return fmt::format(".roomscribe-{}-{}.tmp", pid, count) == name && pid > 0 ? pid : 0;
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path path, std::string_view format)
    : path_(std::move(path)), format_(format) {
    std::error_code none;
    if (std::filesystem::is_symlink(path_, none)) {
        path_ = std::filesystem::weakly_canonical(path_, none);
    }
    const auto status = std::filesystem::status(path_, none);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
        throw IoError(path_.string(), format_, {}, "it is a folder or a device, not a file",
                      "name a file");
    }
    temporary_ = temporary_name(path_);
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail("cannot be created");
    buffer_.reserve(buffer_size);
}

AtomicFile::~AtomicFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::write(std::span<const std::byte> bytes) {
    if (buffer_.size() + bytes.size() > buffer_size) flush();
    if (bytes.size() >= buffer_size) {
        write_through(bytes.data(), bytes.size());
    } else {
        buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    }
}

void AtomicFile::write(std::string_view text) {
    write(std::as_bytes(std::span(text.data(), text.size())));
}

void AtomicFile::commit() {
    flush();
    // Some file systems report a full disk or a broken link only when the file is closed.
    const bool closed = ::close(std::exchange(descriptor_, -1)) == 0;
    if (!closed) fail("cannot be written");
    if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail("cannot be put in place");
    temporary_.clear();
}

void AtomicFile::write_through(const std::byte* bytes, std::size_t size) {
    while (size > 0) {
        const ssize_t written = ::write(descriptor_, bytes, size);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail("cannot be written");
        bytes += written;
        size -= static_cast<std::size_t>(written);
    }
}

void AtomicFile::flush() {
    write_through(buffer_.data(), buffer_.size());
    buffer_.clear();
}

void AtomicFile::fail(std::string_view action) const {
    const int reason = errno;
    throw IoError(path_.string(), format_, {}, fmt::format("{}: {}", action, std::strerror(reason)),
                  "check that the folder is there, may be written to and has room");
}

void write_file(const std::filesystem::path& path, std::string_view format,
                std::string_view content) {
    AtomicFile file(path, format);
    file.write(content);
    file.commit();
}

void remove_abandoned_files(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> abandoned;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        const pid_t writer = writer_of(entry.path().filename().string());
        if (writer > 0 && ::kill(writer, 0) != 0 && errno == ESRCH)
            abandoned.push_back(entry.path());
    }
    for (const std::filesystem::path& path : abandoned)
        std::filesystem::remove(path, error);
}

}  // namespace roomscribe
