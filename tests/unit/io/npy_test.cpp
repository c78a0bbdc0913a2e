// SPDX-License-Identifier: MIT
#include "roomscribe/io/npy.hpp"

#include <cstdint>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io_test_clouds.hpp"
#include "roomscribe/core/error.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "support/test_data.hpp"

namespace roomscribe {
namespace {

using testing::HasSubstr;

/// The bytes that numpy.save wrote for np.array([1, -2, 3], dtype=np.int32).
std::string numpy_bytes(const std::string& type = "<i4", const std::string& shape = "(3,)") {
    std::string header =
        "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
    header.resize(117, ' ');
    header += '\n';
    const std::string values("\1\0\0\0\xfe\xff\xff\xff\3\0\0\0", 12);
    return std::string("\x93NUMPY\1\0v\0", 10) + header + values;
}

template <typename Value>
void expect_round_trip(const std::vector<Value>& values) {
    const test::TemporaryFolder folder;
    write_npy(folder / "a.npy", std::span<const Value>(values));
    EXPECT_EQ(read_npy<Value>(folder / "a.npy"), values);
    EXPECT_EQ((std::filesystem::file_size(folder / "a.npy") - sizeof(Value) * values.size()) % 64,
              0U);
}

TEST(Npy, RoundTripOfEveryType) {
    expect_round_trip<std::uint8_t>({0, 9, 255});
    expect_round_trip<std::uint16_t>({0, 1023, 65535});
    expect_round_trip<std::int32_t>({-1, 0, std::numeric_limits<std::int32_t>::min()});
    expect_round_trip<std::int32_t>({});
    // Longer counts make the header longer.
    for (const std::size_t size : {9UL, 10UL, 99'999UL, 1'000'000UL})
        expect_round_trip(std::vector<std::uint8_t>(size, 7));
}

TEST(Npy, WritesWhatNumpyWrites) {
    const test::TemporaryFolder folder;
    const std::vector<std::int32_t> values{1, -2, 3};
    write_npy(folder / "a.npy", std::span<const std::int32_t>(values));
    EXPECT_EQ(test::read_bytes(folder / "a.npy"), numpy_bytes());
}

TEST(Npy, ReadsOtherSpellingsAndFormat2) {
    const test::TemporaryFolder folder;
    const std::string header = "{\"shape\" : ( 3 , ), 'fortran_order':True,'descr':'<i4'}   \n";
    test::write_bytes(folder / "a.npy", std::string("\x93NUMPY\2\0", 8) +
                                            static_cast<char>(header.size()) +
                                            std::string("\0\0\0", 3) + header +
                                            std::string("\1\0\0\0\xfe\xff\xff\xff\3\0\0\0", 12));
    EXPECT_EQ(read_npy<std::int32_t>(folder / "a.npy"), (std::vector<std::int32_t>{1, -2, 3}));
}

template <typename Value = std::int32_t>
std::string error_of(const std::string& bytes) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "a.npy", bytes);
    try {
        read_npy<Value>(folder / "a.npy");
    } catch (const IoError& error) {
        EXPECT_THAT(error.what(), HasSubstr("a.npy"));
        return error.what();
    }
    return "was read";
}

TEST(Npy, SaysWhatIsWrong) {
    EXPECT_EQ(error_of(numpy_bytes()), "was read");
    EXPECT_THAT(error_of<std::uint8_t>(numpy_bytes()), HasSubstr("'<i4' instead of '|u1'"));
    EXPECT_THAT(error_of(numpy_bytes(">i4")), HasSubstr("'>i4' instead of '<i4'"));
    EXPECT_THAT(error_of(numpy_bytes("<i8")), HasSubstr("'<i8'"));
    for (const char* shape : {"(3, 1)", "()", "(3)", "(3,", "(-3,)", "(x,)", "3"})
        EXPECT_THAT(error_of(numpy_bytes("<i4", shape)), HasSubstr("one dimension")) << shape;
    EXPECT_THAT(error_of(numpy_bytes("<i4", "(4,)")), HasSubstr("do not fit"));
    EXPECT_THAT(error_of(numpy_bytes("<i4", "(4000000000,)")), HasSubstr("do not fit"));
    EXPECT_THAT(error_of(numpy_bytes("<i4", "(99999999999999999,)")), HasSubstr("more than"));
    EXPECT_THAT(error_of(""), HasSubstr("empty"));
    EXPECT_THAT(error_of("PK\3\4 a zipped .npz"), HasSubstr("does not begin"));
    EXPECT_THAT(error_of(std::string("\x93NUMPY\3\0", 8)), HasSubstr("format 3"));
    for (std::size_t size = 1; size < 127; ++size)
        EXPECT_NE(error_of(numpy_bytes().substr(0, size)), "was read");
    EXPECT_THROW(read_npy<std::uint8_t>("absent.npy"), IoError);
}

std::string npy_file(const std::string& dictionary, const std::string& elements) {
    std::string bytes("\x93NUMPY\x01\x00", 8);
    bytes += static_cast<char>(dictionary.size());
    bytes += '\0';
    return bytes + dictionary + elements;
}

TEST(NpyPoints, ReadsBothOrdersAndTypes) {
    const test::TemporaryFolder folder;
    const float rows[] = {1, 2, 3, 10, 20, 30, 4, 5, 6, 11, 21, 31};
    const double columns[] = {1, 4, 2, 5, 3, 6, 10, 11, 20, 21, 30, 31};
    const auto text = [](const auto& list) {
        return std::string(reinterpret_cast<const char*>(list), sizeof(list));
    };
    for (const std::string& bytes :
         {npy_file("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 6), }\n", text(rows)),
          npy_file("{'descr': '<f8', 'fortran_order': True, 'shape': (2, 6), }\n",
                   text(columns))}) {
        test::write_bytes(folder / "a.npy", bytes);
        const PointCloud cloud = read_scan(folder / "a.npy").cloud;
        ASSERT_EQ(cloud.size(), 2U);
        EXPECT_EQ(cloud.positions[1], Eigen::Vector3f(4, 5, 6));
        EXPECT_EQ(cloud.colors[1], (std::array<std::uint8_t, 3>{11, 21, 31}));
        for (std::size_t size = 1; size < bytes.size(); ++size) {
            test::write_bytes(folder / "a.npy", bytes.substr(0, size));
            EXPECT_THROW(read_scan(folder / "a.npy"), IoError);
        }
    }
}

TEST(NpyPoints, RefusesOtherShapesAndTypes) {
    const test::TemporaryFolder folder;
    for (const char* dictionary :
         {"{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2), }\n",
          "{'descr': '<f4', 'fortran_order': False, 'shape': (2,), }\n",
          "{'descr': '<f4', 'fortran_order': False, 'shape': (4000000000, 3), }\n",
          "{'descr': '<f4', 'fortran_order': False, 'shape': (18446744073709551615, 3), }\n",
          "{'descr': '<i4', 'fortran_order': False, 'shape': (2, 3), }\n"}) {
        test::write_bytes(folder / "a.npy", npy_file(dictionary, std::string(24, '\0')));
        EXPECT_THROW(read_scan(folder / "a.npy"), IoError) << dictionary;
    }
}

}  // namespace
}  // namespace roomscribe
