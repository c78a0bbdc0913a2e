// SPDX-License-Identifier: MIT
#include "roomscribe/io/byte_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io_test_clouds.hpp"
#include "roomscribe/core/error.hpp"
#include "support/test_data.hpp"

namespace roomscribe {
namespace {

class ByteReaderTest : public testing::Test {
  protected:
    const MappedFile& map(std::string_view bytes) {
        test::write_bytes(folder_ / "a.bin", bytes);
        file_.emplace(folder_ / "a.bin", "BIN");
        return *file_;
    }

  private:
    test::TemporaryFolder folder_;
    std::optional<MappedFile> file_;
};

TEST_F(ByteReaderTest, ReadsBothByteOrders) {
    ByteReader reader(map(std::string("\x01\x02\x03\x04\x01\x02\x03\x04\x3f\x80\x00\x00", 12)),
                      "BIN");
    EXPECT_EQ(reader.read<std::uint32_t>(std::endian::little), 0x04030201U);
    EXPECT_EQ(reader.read<std::uint32_t>(std::endian::big), 0x01020304U);
    EXPECT_EQ(reader.read<float>(std::endian::big), 1.0F);
    EXPECT_TRUE(reader.at_end());
    EXPECT_THROW(reader.read<std::uint8_t>(), IoError);
}

TEST_F(ByteReaderTest, TakesNothingBeyondTheEnd) {
    ByteReader reader(map("12345"), "BIN");
    reader.take(2);
    EXPECT_THROW(reader.take(4), IoError);
    EXPECT_THROW(reader.take(static_cast<std::size_t>(-1)), IoError);
    EXPECT_EQ(reader.position(), 2U);
    EXPECT_EQ(reader.take(3).size(), 3U);
}

TEST_F(ByteReaderTest, ReadsLinesWithAnyEnd) {
    ByteReader reader(map("one\r\ntwo\n\nlast"), "BIN");
    EXPECT_EQ(reader.read_line(), "one");
    EXPECT_EQ(reader.read_line(), "two");
    EXPECT_EQ(reader.read_line(), "");
    EXPECT_EQ(reader.read_line(), "last");
    EXPECT_THROW(reader.read_line(), IoError);
}

TEST_F(ByteReaderTest, CountsLinesForMessages) {
    ByteReader reader(map("one\ntwo\nthree\n"), "BIN");
    reader.read_line();
    reader.read_line();
    try {
        reader.fail_at_line("reason", "cure");
    } catch (const IoError& error) {
        EXPECT_THAT(error.what(), testing::EndsWith("a.bin (BIN), line 2: reason; cure"));
    }
    try {
        reader.fail_at_byte("reason", "cure");
    } catch (const IoError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("byte 8"));
    }
}

TEST_F(ByteReaderTest, RefusesCountsThatTheFileCannotBack) {
    const ByteReader reader(map("0123456789"), "BIN");
    EXPECT_NO_THROW(reader.require_backed(10, 1, "things"));
    EXPECT_NO_THROW(reader.require_backed(0, 1000, "things"));
    EXPECT_THROW(reader.require_backed(11, 1, "things"), IoError);
    EXPECT_THROW(reader.require_backed(1, 11, "things"), IoError);
    EXPECT_THROW(reader.require_backed(2, std::uint64_t{1} << 63U, "things"), IoError);
    EXPECT_THROW(reader.require_backed(std::uint64_t{1} << 32U, 0, "things"), IoError);
}

TEST(SwapBytes, TurnsRoundAndBack) {
    EXPECT_EQ(swap_bytes(std::uint16_t{0x1234}), 0x3412);
    EXPECT_EQ(swap_bytes(std::uint64_t{0x0102030405060708}), 0x0807060504030201U);
    EXPECT_EQ(swap_bytes(swap_bytes(-1.5)), -1.5);
}

}  // namespace
}  // namespace roomscribe
