// SPDX-License-Identifier: MIT
// libFuzzer's door to one target. `fuzz_<target> --write-seeds FOLDER` leaves its first inputs.
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "fuzz/targets.hpp"

namespace {

const roomscribe::fuzz::Target& target() {
    static const roomscribe::fuzz::Target& chosen = roomscribe::fuzz::ROOMSCRIBE_FUZZ_TARGET;
    return chosen;
}

void write_seeds(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    int number = 0;
    const auto write = [&](const std::string& bytes) {
        std::ofstream(folder / ("seed-" + std::to_string(number++)), std::ios::binary) << bytes;
    };
    for (const std::string& bytes : target().make_seeds())
        write(bytes);
    for (const std::string& bytes : roomscribe::fuzz::kept_inputs(target().name))
        write(bytes);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    if (*argc == 3 && std::string_view((*argv)[1]) == "--write-seeds") {
        write_seeds((*argv)[2]);
        std::exit(0);
    }
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    target().read(std::as_bytes(std::span(data, size)));
    return 0;
}
