// SPDX-License-Identifier: MIT
#include "roomscribe/io/byte_reader.hpp"

#include <algorithm>
#include <cerrno>
#include <limits>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "roomscribe/core/error.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t max_line_length = 65536;
constexpr std::string_view unbacked_cure =
    "the file is cut off or its header is wrong: copy it again, or split it if it is too large";

}  // namespace

MappedFile::MappedFile(const std::filesystem::path& path, std::string_view format)
    : path_(path.string()) {
    const auto fail = [&](std::string_view reason, std::string_view cure) {
        throw IoError(path_, format, {}, reason, cure);
    };
    // Without O_NONBLOCK the opening of a pipe would wait for a writer.
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0) {
        fail(fmt::format("cannot be opened: {}", std::strerror(errno)),
             "check the name and the permission to read");
    }
    struct stat status = {};
    const bool known = ::fstat(descriptor, &status) == 0;
    const bool regular = known && S_ISREG(status.st_mode);
    const std::size_t size = regular ? static_cast<std::size_t>(status.st_size) : 0;
    void* data = MAP_FAILED;
    if (size > 0) data = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
    const int map_error = errno;
    ::close(descriptor);

    if (known && S_ISDIR(status.st_mode)) fail("it is a folder", "name a file in it");
    if (!regular) fail("it is no regular file", "copy its content into a file first");
    if (size == 0) fail("the file is empty", "write or copy it again");
    if (data == MAP_FAILED) {
        fail(fmt::format("cannot be mapped: {}", std::strerror(map_error)),
             "copy it to a local disk");
    }
    ::madvise(data, size, MADV_SEQUENTIAL);
    data_ = static_cast<const std::byte*>(data);
    size_ = size;
}

MappedFile::~MappedFile() {
    ::munmap(const_cast<std::byte*>(data_), size_);
}

void let_go(std::span<const std::byte> mapped) {
    // Whole pages alone: the others may be in use by who reads what lies beside.
    static const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
    const auto begin = reinterpret_cast<std::uintptr_t>(mapped.data());
    const std::uintptr_t first = (begin + page - 1) / page * page;
    const std::uintptr_t end = (begin + mapped.size()) / page * page;
    if (first >= end) return;
    ::madvise(reinterpret_cast<void*>(first), end - first, MADV_DONTNEED);
}

std::span<const std::byte> ByteReader::take(std::size_t size) {
    if (size > remaining()) {
        fail_at_byte(fmt::format("the file ends {} bytes too early", size - remaining()),
                     "the file is cut off: copy it again");
    }
    const std::span<const std::byte> taken = bytes_.subspan(position_, size);
    pass(size);
    return taken;
}

void ByteReader::pass(std::size_t size) {
    if (position_ - held_ >= bytes_let_go_at_once) {
        let_go(bytes_.subspan(held_, position_ - held_));
        held_ = position_;
    }
    position_ += size;
}

std::string_view ByteReader::read_line() {
    last_line_ = position_;
    if (at_end()) fail_at_line("the file ends in its header", "the file is cut off: copy it again");
    const std::string_view text = remaining_text();
    const std::size_t end = text.substr(0, max_line_length).find('\n');
    if (end == std::string_view::npos && text.size() >= max_line_length) {
        fail_at_line(fmt::format("a header line is longer than {} bytes", max_line_length),
                     "this is no file of that format, or a damaged one");
    }
    std::string_view line = text.substr(0, end);
    pass(std::min(line.size() + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
}

std::string_view ByteReader::remaining_text() const {
    return {reinterpret_cast<const char*>(bytes_.data()) + position_, remaining()};
}

void ByteReader::fail_at_byte(std::string_view reason, std::string_view cure) const {
    throw IoError(path_, format_, {.byte = position_, .line = {}}, reason, cure);
}

void ByteReader::fail_at_line(std::string_view reason, std::string_view cure) const {
    fail_at_line_of(last_line_, reason, cure);
}

void ByteReader::fail_at_line_of(std::size_t position, std::string_view reason,
                                 std::string_view cure) const {
    const auto before = bytes_.first(std::min(position, bytes_.size()));
    const auto line = std::count(before.begin(), before.end(), std::byte{'\n'}) + 1;
    throw IoError(path_, format_, {.byte = {}, .line = static_cast<std::uint64_t>(line)}, reason,
                  cure);
}

std::string ByteReader::unbacked(std::uint64_t count, std::uint64_t min_bytes,
                                 std::string_view what) const {
    if (count > std::numeric_limits<std::uint32_t>::max()) {
        return fmt::format("{} {} are more than 4294967295", count, what);
    }
    if (count > 0 && min_bytes > remaining() / count) {
        return fmt::format("{} {} of at least {} bytes do not fit into the {} bytes left", count,
                           what, min_bytes, remaining());
    }
    return {};
}

void ByteReader::require_backed(std::uint64_t count, std::uint64_t min_bytes,
                                std::string_view what) const {
    const std::string reason = unbacked(count, min_bytes, what);
    if (!reason.empty()) fail_at_line(reason, unbacked_cure);
}

void ByteReader::require_backed_at_byte(std::uint64_t count, std::uint64_t min_bytes,
                                        std::string_view what) const {
    const std::string reason = unbacked(count, min_bytes, what);
    if (!reason.empty()) fail_at_byte(reason, unbacked_cure);
}

}  // namespace roomscribe
