// SPDX-License-Identifier: MIT
#include "roomscribe/core/settings.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "roomscribe/core/edit_distance.hpp"
#include "roomscribe/core/error.hpp"

namespace roomscribe::internal {
namespace {

std::string describe_range(const SettingInfo& info) {
    const bool has_min = std::isfinite(info.min);
    const bool has_max = std::isfinite(info.max);
    if (has_min && has_max) return fmt::format("{} to {}", info.min, info.max);
    if (has_min) return fmt::format("at least {}", info.min);
    if (has_max) return fmt::format("at most {}", info.max);
    return "any number";
}

std::string describe_choices(std::span<const std::string_view> names) {
    return fmt::format("{}", fmt::join(names, " | "));
}

/// Keeps the full name of the setting that is being visited.
class NamedVisitor : public SettingVisitor {
  protected:
    void check_range(double value, const SettingInfo& info) const {
        if (std::isfinite(value) && value >= info.min && value <= info.max) return;
        throw InvalidArgument(full_name(info), fmt::format("{}", value), describe_range(info));
    }
    void enter_group(std::string_view name) override {
        prefix_lengths_.push_back(prefix_.size());
        prefix_ += std::string(name) + ".";
    }
    void leave_group() override {
        prefix_.resize(prefix_lengths_.back());
        prefix_lengths_.pop_back();
    }
    std::string full_name(const SettingInfo& info) const {
        return prefix_ + std::string(info.name);
    }

  private:
    std::string prefix_;
    std::vector<std::size_t> prefix_lengths_;
};

class Lister : public NamedVisitor {
  public:
    std::vector<SettingEntry> entries;

  private:
    void add(const SettingInfo& info, std::string range, std::string value, bool is_text) {
        entries.push_back({full_name(info), std::string(info.unit), std::move(range),
                           std::move(value), std::string(info.doc), is_text});
    }
    void visit_bool(bool& value, const SettingInfo& info) override {
        add(info, "true | false", value ? "true" : "false", false);
    }
    void visit_int(int& value, const SettingInfo& info) override {
        add(info, describe_range(info), fmt::format("{}", value), false);
    }
    void visit_real(double& value, const SettingInfo& info) override {
        add(info, describe_range(info), fmt::format("{}", value), false);
    }
    void visit_optional(std::optional<double>& value, const SettingInfo& info) override {
        add(info, "auto | " + describe_range(info), value ? fmt::format("{}", *value) : "auto",
            !value);
    }
    void visit_choice(std::size_t& index, std::span<const std::string_view> names,
                      const SettingInfo& info) override {
        add(info, describe_choices(names), std::string(names[index]), true);
    }
};

class Checker : public NamedVisitor {
  private:
    void visit_bool(bool&, const SettingInfo&) override {}
    void visit_int(int& value, const SettingInfo& info) override { check_range(value, info); }
    void visit_real(double& value, const SettingInfo& info) override { check_range(value, info); }
    void visit_optional(std::optional<double>& value, const SettingInfo& info) override {
        if (value) check_range(*value, info);
    }
    void visit_choice(std::size_t& index, std::span<const std::string_view> names,
                      const SettingInfo& info) override {
        if (index >= names.size()) {
            throw InvalidArgument(full_name(info), fmt::format("{}", index),
                                  describe_choices(names));
        }
    }
};

template <typename Number>
bool parse_number(std::string_view text, Number& number) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc{} && end == text.data() + text.size();
}

class Setter : public NamedVisitor {
  public:
    Setter(std::string_view name, std::string_view value) : name_(name), text_(value) {}
    bool found() const { return found_; }

  private:
    bool matches(const SettingInfo& info) {
        if (full_name(info) != name_) return false;
        found_ = true;
        return true;
    }
    [[noreturn]] void refuse(std::string_view allowed) const {
        throw InvalidArgument(name_, text_, allowed);
    }
    /// A number that parses and is in range: the setting takes no other.
    template <typename Number>
    Number parse(const SettingInfo& info, std::string_view allowed) const {
        Number number{};
        if (!parse_number(text_, number)) refuse(allowed);
        check_range(number, info);
        return number;
    }
    void visit_bool(bool& value, const SettingInfo& info) override {
        if (!matches(info)) return;
        if (text_ != "true" && text_ != "false") refuse("true or false");
        value = text_ == "true";
    }
    void visit_int(int& value, const SettingInfo& info) override {
        if (matches(info)) value = parse<int>(info, "a whole number");
    }
    void visit_real(double& value, const SettingInfo& info) override {
        if (matches(info)) value = parse<double>(info, "a number");
    }
    void visit_optional(std::optional<double>& value, const SettingInfo& info) override {
        if (!matches(info)) return;
        value =
            text_ == "auto" ? std::nullopt : std::optional(parse<double>(info, "a number or auto"));
    }
    void visit_choice(std::size_t& index, std::span<const std::string_view> names,
                      const SettingInfo& info) override {
        if (!matches(info)) return;
        const auto found = std::find(names.begin(), names.end(), text_);
        if (found == names.end()) refuse("one of " + describe_choices(names));
        index = static_cast<std::size_t>(found - names.begin());
    }

    std::string_view name_;
    std::string_view text_;
    bool found_ = false;
};

/// People leave out the groups: the last part of a name may stand for the whole.
std::size_t name_distance(std::string_view known, std::string_view name) {
    return std::min(edit_distance(known, name),
                    edit_distance(known.substr(known.rfind('.') + 1), name));
}

}  // namespace

std::vector<SettingEntry> list_settings(void* settings, VisitSettings visit) {
    Lister lister;
    visit(settings, lister);
    return std::move(lister.entries);
}

void set_setting(void* settings, VisitSettings visit, std::string_view name,
                 std::string_view value) {
    Setter setter(name, value);
    visit(settings, setter);
    if (!setter.found()) {
        const std::vector<SettingEntry> known = list_settings(settings, visit);
        const auto nearest = std::min_element(
            known.begin(), known.end(), [&](const SettingEntry& a, const SettingEntry& b) {
                return name_distance(a.name, name) < name_distance(b.name, name);
            });
        throw InvalidArgument(
            "setting", name,
            nearest == known.end()
                ? "a known setting"
                : fmt::format("a known setting (did you mean {}?)", nearest->name));
    }
}

void check_settings(void* settings, VisitSettings visit) {
    Checker checker;
    visit(settings, checker);
}

}  // namespace roomscribe::internal
