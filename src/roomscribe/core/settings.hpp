// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace roomscribe {

/// What is said about a setting, once, beside its field. The default is the field's initialiser.
struct SettingInfo {
    std::string_view name;
    /// "m", "rad", "s", ... or empty for a pure number.
    std::string_view unit;
    double min = -std::numeric_limits<double>::infinity();
    double max = std::numeric_limits<double>::infinity();
    std::string_view doc;
};

/// Walks the fields of a settings aggregate. An aggregate takes part by having
///
///     void visit(SettingVisitor& visitor) {
///         visitor(max_iterations, {.name = "max_iterations", .min = 1, .doc = "..."});
///         visitor.group("icp", icp);   // nested aggregate
///     }
///
/// From that one declaration come validation, the command line, the config file, the documentation
/// and run.json. An empty std::optional<double> means: derived from the data ("auto").
/// An enumeration takes part through a free function `std::span<const std::string_view>
/// enumerator_names(Enum)` that lists its enumerators from value 0 on.
class SettingVisitor {
  public:
    virtual ~SettingVisitor() = default;

    void operator()(bool& value, const SettingInfo& info) { visit_bool(value, info); }
    void operator()(int& value, const SettingInfo& info) { visit_int(value, info); }
    void operator()(double& value, const SettingInfo& info) { visit_real(value, info); }
    void operator()(std::optional<double>& value, const SettingInfo& info) {
        visit_optional(value, info);
    }
    template <typename Enum>
    requires std::is_enum_v<Enum>
    void operator()(Enum& value, const SettingInfo& info) {
        auto index = static_cast<std::size_t>(value);
        visit_choice(index, enumerator_names(value), info);
        value = static_cast<Enum>(index);
    }

    template <typename Settings>
    void group(std::string_view name, Settings& settings) {
        enter_group(name);
        settings.visit(*this);
        leave_group();
    }

  protected:
    virtual void visit_bool(bool& value, const SettingInfo& info) = 0;
    virtual void visit_int(int& value, const SettingInfo& info) = 0;
    virtual void visit_real(double& value, const SettingInfo& info) = 0;
    virtual void visit_optional(std::optional<double>& value, const SettingInfo& info) = 0;
    virtual void visit_choice(std::size_t& index, std::span<const std::string_view> names,
                              const SettingInfo& info) = 0;
    virtual void enter_group(std::string_view name) = 0;
    virtual void leave_group() = 0;
};

/// One setting as text: what `--help`, `run.json` and the docs print.
struct SettingEntry {
    std::string name;  ///< full, with its groups: "registration.icp.max_iterations"
    std::string unit;
    std::string range;  ///< "1 to 10000", "point_to_point | point_to_plane", ...
    std::string value;
    std::string doc;
    bool is_text = false;  ///< the value is a word, not a number or a truth value
};

namespace internal {
using VisitSettings = void (*)(void* settings, SettingVisitor& visitor);
std::vector<SettingEntry> list_settings(void* settings, VisitSettings visit);
void set_setting(void* settings, VisitSettings visit, std::string_view name,
                 std::string_view value);
void check_settings(void* settings, VisitSettings visit);

template <typename Settings>
void visit_settings(void* settings, SettingVisitor& visitor) {
    static_cast<Settings*>(settings)->visit(visitor);
}
}  // namespace internal

/// Every setting with its present value, in declaration order.
template <typename Settings>
std::vector<SettingEntry> list_settings(Settings settings) {
    return internal::list_settings(&settings, &internal::visit_settings<Settings>);
}

/// Sets one setting from text; "auto" empties an optional one. Throws InvalidArgument for an
/// unknown name (with the nearest known one), a value that does not parse, or one out of range.
template <typename Settings>
void set_setting(Settings& settings, std::string_view name, std::string_view value) {
    internal::set_setting(&settings, &internal::visit_settings<Settings>, name, value);
}

/// Throws InvalidArgument if a value is out of its declared range. Every algorithm calls this
/// first.
template <typename Settings>
void check_settings(Settings settings) {
    internal::check_settings(&settings, &internal::visit_settings<Settings>);
}

}  // namespace roomscribe
