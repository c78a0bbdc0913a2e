// SPDX-License-Identifier: MIT
#include "roomscribe/report/html_text.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace roomscribe {
namespace {

/// With more, cells stand closer together to fit on a page.
constexpr std::size_t many_columns = 10;

}  // namespace

std::string escape_html(std::string_view text) {
    std::string html;
    html.reserve(text.size());
    for (const char c : text) {
        switch (c) {
            case '&':
                html += "&amp;";
                break;
            case '<':
                html += "&lt;";
                break;
            case '>':
                html += "&gt;";
                break;
            case '"':
                html += "&quot;";
                break;
            case '\'':
                html += "&#39;";
                break;
            default:
                if (static_cast<unsigned char>(c) < 0x20) {
                    html += "\xEF\xBF\xBD";
                } else {
                    html += c;
                }
        }
    }
    return html;
}

std::string encode_base64(std::span<const std::byte> bytes) {
    constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t given = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            bits = (bits << 8U) | (k < given ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += k <= given ? digits[(bits >> (18U - 6U * k)) & 63U] : '=';
        }
    }
    return text;
}

std::string with_separators(std::uint64_t number) {
    std::string text = fmt::format("{}", number);
    for (std::size_t i = text.size(); i > 3; i -= 3)
        text.insert(i - 3, 1, ',');
    return text;
}

std::string in_words(std::string_view name) {
    std::string words(name);
    std::replace(words.begin(), words.end(), '_', ' ');
    return words;
}

std::string counted(std::size_t count, std::string_view one) {
    return fmt::format("{} {}{}", with_separators(count), one, count == 1 ? "" : "s");
}

std::string decimal(double value, int decimals) {
    std::string text = fmt::format("{:.{}f}", value, decimals);
    if (text.front() != '-') return text;
    const bool is_zero = text.find_first_of("123456789") == std::string::npos;
    return text.replace(0, 1, is_zero ? "" : "\u2212");
}

std::string verdict_mark(std::string_view verdict) {
    return fmt::format("<span class=\"verdict {0}\">{0}</span>", verdict);
}

HtmlTable::HtmlTable(std::string_view caption, std::vector<HtmlColumn> columns)
    : columns_(std::move(columns)) {
    head_ = fmt::format("<caption>{}</caption>\n<thead><tr>", escape_html(caption));
    for (const HtmlColumn& column : columns_) {
        head_ +=
            fmt::format("<th scope=\"col\"{}>{}</th>", column.is_number ? " class=\"number\"" : "",
                        escape_html(column.title));
    }
    head_ += "</tr></thead>\n";
}

void HtmlTable::begin_row(std::string_view css_class) {
    if (!body_.empty()) body_ += "</tr>\n";
    body_ += css_class.empty() ? "<tr>" : fmt::format("<tr class=\"{}\">", css_class);
    column_ = 0;
}

void HtmlTable::cell(std::string_view attributes, std::string_view html) {
    const std::string_view tag = column_ == 0 ? "th scope=\"row\"" : "td";
    const std::string_view css_class = columns_[column_].is_number ? " class=\"number\"" : "";
    body_ += fmt::format("<{}{}{}>{}</{}>", tag, css_class, attributes, html, tag.substr(0, 2));
    ++column_;
}

void HtmlTable::text(std::string_view text) {
    cell("", escape_html(text));
}

void HtmlTable::html(std::string_view html, std::string_view sort_by) {
    cell(sort_by.empty() ? "" : fmt::format(" data-sort=\"{}\"", escape_html(sort_by)), html);
}

void HtmlTable::number(std::optional<double> value, int decimals) {
    if (value && std::isfinite(*value)) {
        cell(fmt::format(" data-sort=\"{}\"", *value), decimal(*value, decimals));
    } else {
        cell("", "&#8211;");
    }
}

void HtmlTable::count(std::uint64_t value) {
    cell(fmt::format(" data-sort=\"{}\"", value), with_separators(value));
}

std::string HtmlTable::finish() const {
    if (body_.empty()) return {};
    return fmt::format(
        "<div class=\"scroll\" "
        "tabindex=\"0\" role=\"group\" aria-label=\"Table, scrolls "
        "sideways\"><table{}>\n{}<tbody>\n{}</tr>\n</tbody></table></div>\n",
        columns_.size() > many_columns ? " class=\"many\"" : "", head_, body_);
}

}  // namespace roomscribe
