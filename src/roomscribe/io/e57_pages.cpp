// SPDX-License-Identifier: MIT
#include "roomscribe/io/e57_pages.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/parallel.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t pages_per_chunk = 256;
constexpr std::size_t damaged_pages_named = 8;
constexpr std::string_view cure = "the file is damaged: copy or export it again";

/// table[k][b]: what byte b does to the sum from k bytes further on.
using CrcTable = std::array<std::array<std::uint32_t, 256>, 8>;

CrcTable make_crc_table() {
    constexpr std::uint32_t reflected_polynomial = 0x82f63b78;
    CrcTable table{};
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
        std::uint32_t sum = byte;
        for (int bit = 0; bit < 8; ++bit)
            sum = (sum >> 1U) ^ ((sum & 1U) != 0 ? reflected_polynomial : 0U);
        table[0][byte] = sum;
    }
    for (std::size_t k = 1; k < table.size(); ++k) {
        for (std::size_t byte = 0; byte < 256; ++byte) {
            const std::uint32_t before = table[k - 1][byte];
            table[k][byte] = (before >> 8U) ^ table[0][before & 0xffU];
        }
    }
    return table;
}

/// The checksum stands in big-endian order, alone of all numbers in the file.
std::uint32_t stored_checksum(const std::byte* page) {
    std::uint32_t sum = 0;
    for (std::size_t i = e57_page_content; i < e57_page_bytes; ++i)
        sum = sum << 8U | std::to_integer<std::uint32_t>(page[i]);
    return sum;
}

std::vector<std::size_t> find_damaged_pages(std::span<const std::byte> bytes,
                                            const Context& context) {
    using Pages = std::vector<std::size_t>;
    const auto check = [&](std::size_t begin, std::size_t end) {
        Pages damaged;
        for (std::size_t page = begin; page < end; ++page) {
            const auto content = bytes.subspan(page * e57_page_bytes, e57_page_content);
            if (crc32c(content) != stored_checksum(content.data())) damaged.push_back(page);
        }
        let_go(bytes.subspan(begin * e57_page_bytes, (end - begin) * e57_page_bytes));
        return damaged;
    };
    const auto join = [](Pages a, const Pages& b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
    };
    return parallel_reduce(context, bytes.size() / e57_page_bytes, pages_per_chunk, Pages(), check,
                           join);
}

}  // namespace

std::uint32_t crc32c(std::span<const std::byte> bytes) {
    static const CrcTable table = make_crc_table();
    std::uint32_t sum = 0xffffffffU;
    const auto at = [&](std::size_t i) { return std::to_integer<std::uint32_t>(bytes[i]); };
    std::size_t i = 0;
    for (; i + 8 <= bytes.size(); i += 8) {
        sum ^= at(i) | at(i + 1) << 8U | at(i + 2) << 16U | at(i + 3) << 24U;
        sum = table[7][sum & 0xffU] ^ table[6][sum >> 8U & 0xffU] ^ table[5][sum >> 16U & 0xffU] ^
              table[4][sum >> 24U] ^ table[3][at(i + 4)] ^ table[2][at(i + 5)] ^
              table[1][at(i + 6)] ^ table[0][at(i + 7)];
    }
    for (; i < bytes.size(); ++i)
        sum = (sum >> 8U) ^ table[0][(sum ^ at(i)) & 0xffU];
    return ~sum;
}

std::uint64_t e57_physical(std::uint64_t logical) {
    return logical / e57_page_content * e57_page_bytes + logical % e57_page_content;
}

E57Pages::E57Pages(const MappedFile& file, const Context& context) : file_(file) {
    const std::span<const std::byte> bytes = file.bytes();
    const std::size_t num_pages = bytes.size() / e57_page_bytes;
    size_ = num_pages * e57_page_content;
    if (bytes.size() % e57_page_bytes != 0) {
        throw IoError(file.path(), "E57", {},
                      fmt::format("its {} bytes are no whole number of pages of {} bytes",
                                  bytes.size(), e57_page_bytes),
                      "the file is cut off: copy it again");
    }
    const std::vector<std::size_t> damaged = find_damaged_pages(bytes, context);
    if (damaged.empty()) return;
    const auto named = std::span(damaged).first(std::min(damaged.size(), damaged_pages_named));
    throw IoError(file.path(), "E57", {.byte = damaged.front() * e57_page_bytes, .line = {}},
                  fmt::format("{} of {} pages are damaged (their checksum is wrong): {}{}",
                              damaged.size(), num_pages, fmt::join(named, ", "),
                              named.size() < damaged.size() ? ", ..." : ""),
                  cure);
}

std::uint64_t E57Pages::logical(std::uint64_t physical) const {
    const std::uint64_t in_page = physical % e57_page_bytes;
    if (physical >= file_.bytes().size() || in_page >= e57_page_content) {
        throw IoError(file_.path(), "E57", {.byte = physical, .line = {}},
                      "something in the file is said to stand there, and cannot", cure);
    }
    return physical / e57_page_bytes * e57_page_content + in_page;
}

void E57Pages::read(std::uint64_t logical, std::span<std::byte> target) const {
    if (logical > size_ || target.size() > size_ - logical) {
        fail(std::min(logical, size_), fmt::format("{} bytes are missing there", target.size()));
    }
    while (!target.empty()) {
        const std::size_t in_page = logical % e57_page_content;
        const std::size_t count = std::min(target.size(), e57_page_content - in_page);
        std::memcpy(target.data(), file_.bytes().data() + e57_physical(logical), count);
        target = target.subspan(count);
        logical += count;
    }
}

void E57Pages::let_go(std::uint64_t first, std::uint64_t last) const {
    const std::uint64_t begin = e57_physical(first);
    roomscribe::let_go(file_.bytes().subspan(begin, e57_physical(last) - begin));
}

void E57Pages::fail(std::uint64_t logical, std::string_view reason) const {
    throw IoError(file_.path(), "E57", {.byte = e57_physical(logical), .line = {}}, reason, cure);
}

void E57PageWriter::write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const std::size_t count = std::min(bytes.size(), e57_page_content - page_.size());
        page_.insert(page_.end(), bytes.begin(),
                     bytes.begin() + static_cast<std::ptrdiff_t>(count));
        bytes = bytes.subspan(count);
        if (page_.size() == e57_page_content) write_page();
    }
}

void E57PageWriter::write(std::string_view text) {
    write(std::as_bytes(std::span(text.data(), text.size())));
}

void E57PageWriter::finish() {
    if (page_.empty()) return;
    page_.resize(e57_page_content);
    write_page();
}

void E57PageWriter::write_page() {
    const std::uint32_t sum = crc32c(page_);
    for (const unsigned shift : {24U, 16U, 8U, 0U})
        page_.push_back(static_cast<std::byte>(sum >> shift));
    file_.write(page_);
    page_.clear();
}

}  // namespace roomscribe
