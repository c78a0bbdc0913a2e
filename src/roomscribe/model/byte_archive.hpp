// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/result_store.hpp"
#include "roomscribe/geometry/transform.hpp"

namespace roomscribe {

/// True for `Type` and `const Type`: the parameter of an exchange function, below.
template <typename Value, typename Type>
concept Either = std::same_as<std::remove_const_t<Value>, Type>;

namespace internal {

template <typename Value>
inline constexpr bool is_fixed_matrix = false;
template <typename Scalar, int rows, int columns>
inline constexpr bool is_fixed_matrix<Eigen::Matrix<Scalar, rows, columns>> =
    rows != Eigen::Dynamic&& columns != Eigen::Dynamic;
template <>
inline constexpr bool is_fixed_matrix<Transform> = true;

/// Values whose bytes are all that they are.
template <typename Value>
inline constexpr bool is_flat =
    std::is_arithmetic_v<Value> || std::is_enum_v<Value> || is_fixed_matrix<Value>;

}  // namespace internal

/// Values as bytes that the same build of the program reads again: native byte order, no names, no
/// version. A type takes part through a function that lists its fields, once for both ways:
///
///     template <typename Archive, Either<Room> Value>
///     void exchange(Archive& archive, Value& room) { archive(room.id, room.polygon); }
class ByteSink {
  public:
    explicit ByteSink(const ResultStore::Write& write) : write_(write) {}

    template <typename... Values>
    void operator()(const Values&... values) {
        (put(values), ...);
    }

  private:
    void put_bytes(const void* bytes, std::size_t size) {
        write_({static_cast<const std::byte*>(bytes), size});
    }
    template <typename Value>
    void put(const Value& value) {
        if constexpr (internal::is_flat<Value>) {
            put_bytes(&value, sizeof(Value));
        } else {
            exchange(*this, value);
        }
    }
    void put(const std::string& text) {
        put(std::uint64_t{text.size()});
        put_bytes(text.data(), text.size());
    }
    template <typename Value>
    void put(const std::optional<Value>& value) {
        put(value.has_value());
        if (value) put(*value);
    }
    template <typename Value, std::size_t size>
    void put(const std::array<Value, size>& values) {
        for (const Value& value : values)
            put(value);
    }
    template <typename Value>
    void put(const std::vector<Value>& values) {
        put(std::uint64_t{values.size()});
        if constexpr (std::same_as<Value, bool>) {
            for (const bool value : values)
                put(value);
        } else if constexpr (internal::is_flat<Value>) {
            put_bytes(values.data(), values.size() * sizeof(Value));
        } else {
            for (const Value& value : values)
                put(value);
        }
    }

    const ResultStore::Write& write_;
};

/// The way back. Throws Error where the bytes end too early.
class ByteSource {
  public:
    explicit ByteSource(std::span<const std::byte> bytes) : bytes_(bytes) {}

    template <typename... Values>
    void operator()(Values&... values) {
        (get(values), ...);
    }
    bool at_end() const { return bytes_.empty(); }

  private:
    void get_bytes(void* target, std::size_t size) {
        require(size);
        if (size > 0) std::memcpy(target, bytes_.data(), size);
        bytes_ = bytes_.subspan(size);
    }
    void require(std::size_t size) const {
        if (size > bytes_.size()) throw Error("a kept result ends too early");
    }
    /// Of items that take `min_bytes` each: no more than there are bytes for.
    std::size_t get_count(std::size_t min_bytes) {
        std::uint64_t count = 0;
        get(count);
        require(count > bytes_.size() / min_bytes ? bytes_.size() + 1 : 0);
        return count;
    }
    template <typename Value>
    void get(Value& value) {
        if constexpr (internal::is_flat<Value>) {
            get_bytes(&value, sizeof(Value));
        } else {
            exchange(*this, value);
        }
    }
    void get(std::string& text) {
        text.resize(get_count(1));
        get_bytes(text.data(), text.size());
    }
    template <typename Value>
    void get(std::optional<Value>& value) {
        bool has_value = false;
        get(has_value);
        value.reset();
        if (has_value) get(value.emplace());
    }
    template <typename Value, std::size_t size>
    void get(std::array<Value, size>& values) {
        for (Value& value : values)
            get(value);
    }
    template <typename Value>
    void get(std::vector<Value>& values) {
        if constexpr (internal::is_flat<Value> && !std::same_as<Value, bool>) {
            values.resize(get_count(sizeof(Value)));
            get_bytes(values.data(), values.size() * sizeof(Value));
        } else {
            const std::size_t count = get_count(1);
            values.clear();
            for (std::size_t i = 0; i < count; ++i) {
                Value value{};
                get(value);
                values.push_back(std::move(value));
            }
        }
    }

    std::span<const std::byte> bytes_;
};

}  // namespace roomscribe
