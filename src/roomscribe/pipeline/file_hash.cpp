// SPDX-License-Identifier: MIT
#include "roomscribe/pipeline/file_hash.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <vector>

#include "roomscribe/core/error.hpp"

namespace roomscribe {
namespace {

static_assert(std::endian::native == std::endian::little, "words are read in little-endian order");

constexpr std::uint64_t prime_1 = 0x9E3779B185EBCA87ULL;
constexpr std::uint64_t prime_2 = 0xC2B2AE3D27D4EB4FULL;
constexpr std::uint64_t prime_3 = 0x165667B19E3779F9ULL;
constexpr std::uint64_t prime_4 = 0x85EBCA77C2B2AE63ULL;
constexpr std::uint64_t prime_5 = 0x27D4EB2F165667C5ULL;

template <typename Word>
std::uint64_t read_word(const std::byte* bytes) {
    Word word = 0;
    std::memcpy(&word, bytes, sizeof(word));
    return word;
}

std::uint64_t round_of(std::uint64_t accumulator, std::uint64_t lane) {
    return std::rotl(accumulator + lane * prime_2, 31) * prime_1;
}

}  // namespace

Xxh64::Xxh64() : accumulators_{prime_1 + prime_2, prime_2, 0, 0 - prime_1} {}

void Xxh64::add(std::span<const std::byte> bytes) {
    total_ += bytes.size();
    if (num_pending_ > 0) {
        const std::size_t taken = std::min(stripe - num_pending_, bytes.size());
        std::copy_n(bytes.begin(), taken, pending_.begin() + num_pending_);
        num_pending_ += taken;
        bytes = bytes.subspan(taken);
        if (num_pending_ < stripe) return;
        add_stripe(pending_.data());
        num_pending_ = 0;
    }
    for (; bytes.size() >= stripe; bytes = bytes.subspan(stripe))
        add_stripe(bytes.data());
    std::copy(bytes.begin(), bytes.end(), pending_.begin());
    num_pending_ = bytes.size();
}

std::uint64_t Xxh64::finish() const {
    std::uint64_t hash = total_ >= stripe ? converged() : prime_5;  // steps 1 and 3
    hash += total_;                                                 // step 4
    const std::byte* next = pending_.data();                        // step 5
    std::size_t left = num_pending_;
    for (; left >= 8; left -= 8, next += 8) {
        hash ^= round_of(0, read_word<std::uint64_t>(next));
        hash = std::rotl(hash, 27) * prime_1 + prime_4;
    }
    if (left >= 4) {
        hash ^= read_word<std::uint32_t>(next) * prime_1;
        hash = std::rotl(hash, 23) * prime_2 + prime_3;
        left -= 4;
        next += 4;
    }
    for (; left > 0; --left, ++next) {
        hash = std::rotl(hash ^ read_word<std::uint8_t>(next) * prime_5, 11) * prime_1;
    }
    hash = (hash ^ (hash >> 33U)) * prime_2;  // step 6
    hash = (hash ^ (hash >> 29U)) * prime_3;
    return hash ^ (hash >> 32U);
}

void Xxh64::add_stripe(const std::byte* bytes) {  // step 2
    for (std::size_t i = 0; i < 4; ++i) {
        accumulators_[i] = round_of(accumulators_[i], read_word<std::uint64_t>(bytes + 8 * i));
    }
}

std::uint64_t Xxh64::converged() const {
    std::uint64_t hash = std::rotl(accumulators_[0], 1) + std::rotl(accumulators_[1], 7) +
                         std::rotl(accumulators_[2], 12) + std::rotl(accumulators_[3], 18);
    for (const std::uint64_t accumulator : accumulators_) {
        hash = (hash ^ round_of(0, accumulator)) * prime_1 + prime_4;
    }
    return hash;
}

std::uint64_t hash_bytes(std::span<const std::byte> bytes) {
    Xxh64 hash;
    hash.add(bytes);
    return hash.finish();
}

std::uint64_t hash_file(const std::filesystem::path& path) {
    constexpr std::size_t piece_size = 1U << 20U;
    std::ifstream file(path, std::ios::binary);
    std::vector<char> piece(piece_size);
    Xxh64 hash;
    while (file) {
        file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
        hash.add(std::as_bytes(std::span(piece).first(static_cast<std::size_t>(file.gcount()))));
    }
    if (!file.eof()) {
        throw IoError(path.string(), "", {}, "cannot be read",
                      "check the path and its permissions");
    }
    return hash.finish();
}

}  // namespace roomscribe
