// SPDX-License-Identifier: MIT
#include "roomscribe/io/ros_message.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/number_text.hpp"
#include "roomscribe/io/point_decoder.hpp"

namespace roomscribe {
namespace {

/// Deeper nests no type of ROS.
constexpr int max_depth = 16;

struct Builtin {
    std::string_view name;
    ScalarType type;
    std::size_t count;
};

constexpr std::array<Builtin, 15> builtins{{{"bool", ScalarType::uint8, 1},
                                            {"byte", ScalarType::int8, 1},
                                            {"char", ScalarType::uint8, 1},
                                            {"int8", ScalarType::int8, 1},
                                            {"uint8", ScalarType::uint8, 1},
                                            {"int16", ScalarType::int16, 1},
                                            {"uint16", ScalarType::uint16, 1},
                                            {"int32", ScalarType::int32, 1},
                                            {"uint32", ScalarType::uint32, 1},
                                            {"int64", ScalarType::int64, 1},
                                            {"uint64", ScalarType::uint64, 1},
                                            {"float32", ScalarType::float32, 1},
                                            {"float64", ScalarType::float64, 1},
                                            {"time", ScalarType::uint32, 2},
                                            {"duration", ScalarType::int32, 2}}};

const Builtin* find_builtin(std::string_view name) {
    const auto* const found = std::find_if(builtins.begin(), builtins.end(),
                                           [&](const Builtin& b) { return b.name == name; });
    return found == builtins.end() ? nullptr : found;
}

/// "float32[] ranges", "float64[9] R", "Header header".
RosMember parse_member(std::string_view type, std::string_view name) {
    RosMember member{std::string(type), std::string(name), false, std::nullopt};
    const std::size_t bracket = type.find('[');
    if (bracket == std::string_view::npos) return member;
    member.is_array = true;
    member.type = type.substr(0, bracket);
    const std::string_view length = type.substr(bracket + 1, type.size() - bracket - 2);
    if (!type.ends_with(']')) throw Error(quote_text(type) + " is no type");
    if (length.empty()) return member;
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(length.data(), length.data() + length.size(), value);
    if (error != std::errc() || end != length.data() + length.size()) {
        throw Error(quote_text(type) + " is no type");
    }
    member.length = value;
    return member;
}

class MessageReader {
  public:
    MessageReader(const RosDefinition& types, std::span<const std::byte> bytes,
                  std::vector<RosField>& fields)
        : types_(types), bytes_(bytes), fields_(fields) {}

    void read() {
        const auto own = types_.find("");
        if (own != types_.end()) read_type(own->second, "", 0);
    }

  private:
    std::span<const std::byte> take(std::size_t size) {
        if (size > bytes_.size()) throw Error("a message is shorter than its definition says");
        const auto taken = bytes_.first(size);
        bytes_ = bytes_.subspan(size);
        return taken;
    }
    std::size_t take_count() {
        std::uint32_t count = 0;
        std::memcpy(&count, take(sizeof(count)).data(), sizeof(count));
        return std::endian::native == std::endian::little ? count : swap_bytes(count);
    }
    void add(std::string path, ScalarType type, std::size_t count) {
        if (count > bytes_.size() / size_of(type)) {
            throw Error("a message is shorter than its definition says");
        }
        fields_.push_back({std::move(path), type, count, take(count * size_of(type))});
    }

    const std::vector<RosMember>& type_of(const std::string& name) const {
        const auto exact = types_.find(name);
        if (exact != types_.end() && !name.empty()) return exact->second;
        // Types of the same package, and std_msgs/Header, go by their last name.
        for (const auto& [full, type] : types_) {
            if (full.ends_with("/" + name)) return type;
        }
        throw Error(fmt::format("the definition of {} is missing", quote_text(name)));
    }

    void read_type(const std::vector<RosMember>& type, const std::string& prefix, int depth) {
        if (depth > max_depth) throw Error("a message definition holds itself");
        for (const RosMember& member : type)
            read_member(member, prefix + member.name, depth);
    }

    void read_member(const RosMember& member, const std::string& path, int depth) {
        const std::size_t count = !member.is_array ? 1
                                  : member.length  ? *member.length
                                                   : take_count();
        if (const Builtin* const builtin = find_builtin(member.type)) {
            if (count > bytes_.size()) throw Error("a message is shorter than its definition says");
            add(path, builtin->type, count * builtin->count);
            return;
        }
        for (std::size_t i = 0; i < count; ++i) {
            const std::string element = member.is_array ? fmt::format("{}[{}]", path, i) : path;
            const std::size_t before = bytes_.size();
            if (member.type == "string") {
                const std::size_t length = take_count();
                add(element, ScalarType::uint8, length);
            } else {
                read_type(type_of(member.type), element + ".", depth + 1);
            }
            // Elements of nothing could be any number.
            if (member.is_array && bytes_.size() == before) {
                throw Error("an array holds elements without fields");
            }
        }
    }

    const RosDefinition& types_;
    std::span<const std::byte> bytes_;
    std::vector<RosField>& fields_;
};

}  // namespace

RosDefinition parse_ros_definition(std::string_view text) {
    RosDefinition types;
    std::string name;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        std::string_view line = text.substr(0, end);
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        if (line.starts_with("===")) continue;
        line = line.substr(0, line.find('#'));
        const std::vector<std::string_view> words = split_words(line);
        if (words.size() == 2 && words[0] == "MSG:") {
            name = words[1];
            types[name];
            continue;
        }
        // A constant is no field.
        if (words.size() < 2 || line.find('=') != std::string_view::npos) continue;
        types[name].push_back(parse_member(words[0], words[1]));
    }
    return types;
}

RosMessage::RosMessage(const RosDefinition& definition, std::span<const std::byte> bytes) {
    MessageReader(definition, bytes, fields_).read();
    by_path_.resize(fields_.size());
    std::iota(by_path_.begin(), by_path_.end(), std::size_t{0});
    std::stable_sort(by_path_.begin(), by_path_.end(), [this](std::size_t a, std::size_t b) {
        return fields_[a].path < fields_[b].path;
    });
}

const RosField* RosMessage::find(std::string_view path) const {
    const auto found = std::lower_bound(
        by_path_.begin(), by_path_.end(), path,
        [this](std::size_t i, std::string_view wanted) { return fields_[i].path < wanted; });
    return found == by_path_.end() || fields_[*found].path != path ? nullptr : &fields_[*found];
}

std::optional<double> RosMessage::number(std::string_view path) const {
    const RosField* const field = find(path);
    if (field == nullptr || field->count != 1) return std::nullopt;
    return load_as_double(field->bytes.data(), field->type,
                          std::endian::native == std::endian::big);
}

std::optional<std::string> RosMessage::text(std::string_view path) const {
    const RosField* const field = find(path);
    if (field == nullptr || field->type != ScalarType::uint8) return std::nullopt;
    return std::string(reinterpret_cast<const char*>(field->bytes.data()), field->bytes.size());
}

std::vector<double> RosMessage::numbers(std::string_view path) const {
    std::vector<double> numbers;
    const RosField* const field = find(path);
    if (field == nullptr) return numbers;
    numbers.reserve(field->count);
    for (std::size_t i = 0; i < field->count; ++i) {
        numbers.push_back(load_as_double(field->bytes.data() + i * size_of(field->type),
                                         field->type, std::endian::native == std::endian::big));
    }
    return numbers;
}

double RosMessage::time(std::string_view path) const {
    const std::vector<double> stamp = numbers(path);
    return stamp.size() == 2 ? stamp[0] + 1e-9 * stamp[1] : 0.0;
}

std::string RosMessage::frame(std::string_view path) const {
    std::string frame = text(path).value_or("");
    if (frame.starts_with('/')) frame.erase(0, 1);
    return frame;
}

}  // namespace roomscribe
