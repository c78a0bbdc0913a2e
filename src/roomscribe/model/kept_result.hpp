// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>

#include "roomscribe/core/context.hpp"
#include "roomscribe/core/error.hpp"
#include "roomscribe/core/result_store.hpp"
#include "roomscribe/model/byte_archive.hpp"

namespace roomscribe {

/// Keeps values under a name that is unique within the job, where the context has a store.
template <typename... Values>
void keep(const Context& context, std::string_view name, const Values&... values) {
    if (context.results == nullptr) return;
    context.results->keep(name, [&](const ResultStore::Write& write) {
        ByteSink sink(write);
        sink(values...);
    });
}

/// Fills the values with what was kept under that name; false, and nothing in them is changed, if
/// there is nothing.
template <typename... Values>
bool recall(const Context& context, std::string_view name, Values&... values) {
    if (context.results == nullptr) return false;
    std::tuple<Values...> recalled;
    const bool is_known = context.results->recall(name, [&](std::span<const std::byte> bytes) {
        ByteSource source(bytes);
        std::apply([&source](Values&... all) { source(all...); }, recalled);
        if (!source.at_end()) throw Error("a kept result ends too late");
    });
    if (is_known) std::tie(values...) = std::move(recalled);
    return is_known;
}

/// What was kept under that name, or else what `compute` returns, which is kept.
template <typename Compute>
auto kept(const Context& context, std::string_view name, Compute&& compute) {
    decltype(compute()) result{};
    if (recall(context, name, result)) return result;
    result = std::forward<Compute>(compute)();
    keep(context, name, result);
    return result;
}

}  // namespace roomscribe
