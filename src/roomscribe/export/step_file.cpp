// SPDX-License-Identifier: MIT
#include "roomscribe/export/step_file.hpp"

#include <array>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

namespace roomscribe {
namespace {

/// FNV-1a, then the finaliser of SplitMix64: identifiers differ in few bits, ids are to differ in
/// all.
std::uint64_t hash(std::string_view text, std::uint64_t seed) {
    std::uint64_t value = 0xcbf29ce484222325ULL ^ seed;
    for (const char c : text) {
        value ^= static_cast<unsigned char>(c);
        value *= 0x100000001b3ULL;
    }
    value ^= value >> 30;
    value *= 0xbf58476d1ce4e5b9ULL;
    value ^= value >> 27;
    value *= 0x94d049bb133111ebULL;
    return value ^ (value >> 31);
}

/// The code point that starts at `position`, which moves behind it; '?' for what is no UTF-8.
char32_t next_code_point(std::string_view text, std::size_t& position) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char lead = byte(position++);
    if (lead < 0x80) return lead;
    const int count = lead >= 0xf0 ? 3 : lead >= 0xe0 ? 2 : lead >= 0xc0 ? 1 : 0;
    char32_t code = lead & (0x3fU >> count);
    for (int i = 0; i < count; ++i) {
        if (position >= text.size() || (byte(position) & 0xc0U) != 0x80U) return U'?';
        code = (code << 6U) | (byte(position++) & 0x3fU);
    }
    return count == 0 ? U'?' : code;
}

}  // namespace

std::string StepFile::add(std::string_view entity, std::initializer_list<std::string> arguments) {
    std::string id = fmt::format("#{}", ++num_entities_);
    data_ += fmt::format("{}={}({});\n", id, entity, fmt::join(arguments, ","));
    return id;
}

std::string StepFile::text(std::string_view header) const {
    return fmt::format("ISO-10303-21;\nHEADER;\n{}ENDSEC;\nDATA;\n{}ENDSEC;\nEND-ISO-10303-21;\n",
                       header, data_);
}

std::string step_text(std::string_view text) {
    std::string quoted = "'";
    for (std::size_t position = 0; position < text.size();) {
        const char32_t code = next_code_point(text, position);
        if (code == U'\'' || code == U'\\') {
            quoted.append(2, static_cast<char>(code));
        } else if (code >= 0x20 && code < 0x7f) {
            quoted += static_cast<char>(code);
        } else if (code <= 0xffff) {
            quoted += fmt::format("\\X2\\{:04X}\\X0\\", static_cast<std::uint32_t>(code));
        } else {
            quoted += fmt::format("\\X4\\{:08X}\\X0\\", static_cast<std::uint32_t>(code));
        }
    }
    return quoted + "'";
}

std::string step_real(double value) {
    std::string text = fmt::format("{:.9f}", value);
    text.erase(text.find_last_not_of('0') + 1);
    return text == "-0." ? "0." : text;
}

std::string step_list(std::span<const std::string> elements) {
    return fmt::format("({})", fmt::join(elements, ","));
}

std::string step_numbers(const Eigen::VectorXd& numbers) {
    std::vector<std::string> elements;
    for (const double number : numbers)
        elements.push_back(step_real(number));
    return step_list(elements);
}

std::string ifc_global_id(std::string_view text) {
    constexpr std::string_view digits =
        "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_$";
    std::array<std::uint64_t, 2> halves{hash(text, 0), hash(text, 0x9e3779b97f4a7c15ULL)};
    // 22 digits of 6 bits are 132 bits: the first digit has but two.
    std::string id(22, '0');
    for (std::size_t i = id.size(); i-- > 0;) {
        id[i] = digits[halves[1] & 63U];
        halves[1] = (halves[1] >> 6U) | (halves[0] << 58U);
        halves[0] >>= 6U;
    }
    return id;
}

}  // namespace roomscribe
