// SPDX-License-Identifier: MIT
#include "roomscribe/io/number_text.hpp"

#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include "io_test_clouds.hpp"
#include "roomscribe/core/error.hpp"
#include "support/test_data.hpp"

namespace roomscribe {
namespace {

template <typename Value>
std::vector<Value> read_column(const std::string& text, ScalarType type, std::size_t count) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "a.txt", text);
    const MappedFile file(folder / "a.txt", "text");
    ByteReader reader(file, "text");
    const std::vector<TextColumn> columns = {{type, false}};
    TextTable table(reader, columns);
    std::vector<Value> values(count);
    for (Value& value : values)
        table.read_row(reinterpret_cast<std::byte*>(&value));
    return values;
}

TEST(TextTable, ReadsTheForms) {
    const auto values = read_column<float>("1\n -2.5e1\t\r\n\n+.5\n1e-50\n-1e50\nNaN\n-inf\n1e-42",
                                           ScalarType::float32, 8);
    EXPECT_EQ(values[0], 1.0F);
    EXPECT_EQ(values[1], -25.0F);
    EXPECT_EQ(values[2], 0.5F);
    EXPECT_EQ(values[3], 0.0F);
    EXPECT_EQ(values[4], -INFINITY);
    EXPECT_TRUE(std::isnan(values[5]));
    EXPECT_EQ(values[6], -INFINITY);
    EXPECT_EQ(values[7], 1e-42F);
}

TEST(TextTable, ReadsIntegersInAnyDress) {
    const auto values = read_column<std::int8_t>("-128\n127\n+7\n7.0\n1e2\n", ScalarType::int8, 5);
    EXPECT_EQ(values, (std::vector<std::int8_t>{-128, 127, 7, 7, 100}));
    for (const char* text : {"128", "-129", "7.5", "1e3", "nan", "x", "7x", "--7", "+"}) {
        EXPECT_THROW(read_column<std::int8_t>(text, ScalarType::int8, 1), IoError) << text;
    }
    EXPECT_EQ(read_column<std::uint64_t>("18446744073709551615", ScalarType::uint64, 1)[0],
              18446744073709551615U);
    EXPECT_THROW(read_column<std::uint64_t>("18446744073709551616", ScalarType::uint64, 1),
                 IoError);
    EXPECT_THROW(read_column<std::int64_t>("9223372036854775808.0", ScalarType::int64, 1), IoError);
}

/// The C library's correctly rounded conversion is the oracle, with texts of 1 to 20 digits.
TEST(TextTable, RoundsAsTheCLibraryDoes) {
    Random random(5);
    std::string text;
    std::vector<float> expected;
    for (int i = 0; i < 20000; ++i) {
        char line[64];
        const double value = random.uniform(-100.0, 100.0) * std::pow(10.0, random.uniform(-8, 8));
        std::snprintf(line, sizeof(line), "%.*g", static_cast<int>(1 + random.below(20)), value);
        text += line;
        text += '\n';
        expected.push_back(std::strtof(line, nullptr));
    }
    EXPECT_EQ(read_column<float>(text, ScalarType::float32, expected.size()), expected);
}

TEST(AppendNumber, ReadsBackToTheSameBits) {
    Random random(6);
    std::string text;
    std::vector<double> doubles;
    for (int i = 0; i < 5000; ++i) {
        const std::uint64_t bits = random.next();
        double value = 0.0;
        std::memcpy(&value, &bits, sizeof(value));
        if (!std::isfinite(value)) continue;
        doubles.push_back(value);
        append_number(text, ScalarType::float64, reinterpret_cast<const std::byte*>(&value));
        text += '\n';
    }
    EXPECT_TRUE(
        test::same_bits(read_column<double>(text, ScalarType::float64, doubles.size()), doubles));
    const float nan = -NAN;
    text.clear();
    append_number(text, ScalarType::float32, reinterpret_cast<const std::byte*>(&nan));
    EXPECT_EQ(text, "nan");
}

TEST(Words, SplitParseAndQuote) {
    EXPECT_EQ(split_words("  a\tbc  d \r"), (std::vector<std::string_view>{"a", "bc", "d"}));
    EXPECT_TRUE(split_words(" \t").empty());
    EXPECT_EQ(parse_count("12"), 12U);
    for (const char* word : {"", "-1", "1.5", "12x", "99999999999999999999"}) {
        EXPECT_EQ(parse_count(word), std::nullopt) << word;
    }
    EXPECT_EQ(parse_real("-1e3"), -1000.0);
    EXPECT_EQ(quote_text("a\nb\x80"), "'a?b?'");
    EXPECT_LT(quote_text(std::string(1000, 'x')).size(), 50U);
}

}  // namespace
}  // namespace roomscribe
