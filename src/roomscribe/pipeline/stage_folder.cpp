// SPDX-License-Identifier: MIT
#include "roomscribe/pipeline/stage_folder.hpp"

#include <cstring>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/io/atomic_file.hpp"
#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/pipeline/file_hash.hpp"

namespace roomscribe {
namespace {

constexpr std::string_view format_name = "stage result";
/// A stage file begins with this and the job's hash; it ends with the XXH64 of all before.
constexpr std::string_view magic = "rs-stage";
constexpr std::size_t head_size = magic.size() + sizeof(std::uint64_t);
constexpr std::size_t tail_size = sizeof(std::uint64_t);

std::string head_of(std::uint64_t job) {
    std::string head(magic);
    head.append(reinterpret_cast<const char*>(&job), sizeof(job));
    return head;
}

/// What a stage file holds; empty if it is of another job, or damaged.
std::span<const std::byte> payload_of(const MappedFile& file, std::uint64_t job) {
    const std::span<const std::byte> bytes = file.bytes();
    if (bytes.size() < head_size + tail_size) return {};
    if (file.text().substr(0, head_size) != head_of(job)) return {};
    std::uint64_t checksum = 0;
    std::memcpy(&checksum, bytes.last(tail_size).data(), tail_size);
    if (hash_bytes(bytes.first(bytes.size() - tail_size)) != checksum) return {};
    return bytes.subspan(head_size, bytes.size() - head_size - tail_size);
}

/// Of the running program's own bytes: another build may compute something else. 0 where the system
/// does not show them; then the version must do.
std::uint64_t hash_of_program() {
    try {
        return hash_file("/proc/self/exe");
    } catch (const IoError&) {
        return 0;
    }
}

}  // namespace

std::uint64_t hash_of_job(const RunRecord& record, std::string_view unit) {
    std::string text =
        fmt::format("{} {:x} {} {}\n", record.version, hash_of_program(), record.command, unit);
    for (const SettingEntry& setting : record.settings)
        text += fmt::format("{}={}\n", setting.name, setting.value);
    for (const FileRecord& input : record.inputs) {
        // The name is part of results, the folder is not.
        text += fmt::format("{:x} {} {}\n", input.xxh64, input.size,
                            std::filesystem::path(input.path).filename().string());
    }
    return hash_bytes(std::as_bytes(std::span(text.data(), text.size())));
}

StageFolder::StageFolder(const std::filesystem::path& output, std::uint64_t job, RunStart start,
                         Tell tell)
    : folder_(output / ".stages"), job_(job), tell_(std::move(tell)) {
    if (start == RunStart::resumed) {
        check_files();
    } else {
        remove();
    }
}

void StageFolder::check_files() const {
    std::size_t num_good = 0;
    std::vector<std::filesystem::path> bad;
    std::error_code error;
    remove_abandoned_files(folder_);
    for (const auto& entry : std::filesystem::directory_iterator(folder_, error)) {
        try {
            const MappedFile file(entry.path(), format_name);
            if (payload_of(file, job_).data() != nullptr) {
                ++num_good;
                continue;
            }
        } catch (const IoError&) {  // what cannot be read is no good either
        }
        bad.push_back(entry.path());
    }
    for (const std::filesystem::path& path : bad)
        std::filesystem::remove_all(path, error);
    tell_(num_good == 0 ? "--resume: there is nothing to go on from"
                        : fmt::format("--resume: {} results of the run before are used", num_good));
    if (!bad.empty()) {
        tell_(
            fmt::format("--resume: {} results are damaged, or of other scans, settings or another "
                        "program, and are computed again",
                        bad.size()));
    }
}

void StageFolder::keep(std::string_view name, const std::function<void(const Write&)>& give) {
    try {
        std::filesystem::create_directories(folder_);
        AtomicFile file(folder_ / name, format_name);
        Xxh64 hash;
        const Write write = [&](std::span<const std::byte> bytes) {
            hash.add(bytes);
            file.write(bytes);
        };
        const std::string head = head_of(job_);
        write(std::as_bytes(std::span(head.data(), head.size())));
        give(write);
        const std::uint64_t checksum = hash.finish();
        file.write(std::as_bytes(std::span(&checksum, 1)));
        file.commit();
    } catch (const IoError& error) {
        tell_(fmt::format("a stage cannot be kept for --resume: {}", error.what()));
    } catch (const std::filesystem::filesystem_error& error) {
        tell_(fmt::format("a stage cannot be kept for --resume: {}", error.what()));
    }
}

bool StageFolder::recall(std::string_view name,
                         const std::function<void(std::span<const std::byte>)>& take) {
    const std::filesystem::path path = folder_ / name;
    std::error_code error;
    if (!std::filesystem::exists(path, error)) return false;
    try {
        const MappedFile file(path, format_name);
        const std::span<const std::byte> payload = payload_of(file, job_);
        if (payload.data() == nullptr) return false;
        take(payload);
        return true;
    } catch (const Error&) {
        return false;
    }
}

void StageFolder::remove() const {
    std::error_code error;
    std::filesystem::remove_all(folder_, error);
}

}  // namespace roomscribe
