// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "io_test_clouds.hpp"
#include "roomscribe/core/error.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "roomscribe/io/poses_io.hpp"
#include "support/test_data.hpp"

namespace roomscribe {
namespace {

using testing::HasSubstr;
using testing::Not;

/// The message of the IoError that reading gives; a failure if it gives none.
std::string error_of(const std::filesystem::path& path) {
    try {
        read_scan(path);
    } catch (const IoError& error) {
        EXPECT_EQ(error.path(), path.string());
        return error.what();
    }
    ADD_FAILURE() << path << " was read";
    return {};
}

std::string error_of_bytes(const std::string& name, const std::string& bytes) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / name, bytes);
    return error_of(folder / name);
}

std::string pcd(const std::string& fields, const std::string& rest) {
    return "VERSION 0.7\n" + fields + rest;
}
const std::string xyz = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
const std::string ply_xyz = "property float x\nproperty float y\nproperty float z\n";

struct Sample {
    std::string name;
    std::string bytes;
};

struct BadFile {
    const char* what;
    std::string name;
    std::string bytes;
    std::string place;   ///< that the message must name
    std::string reason;  ///< likewise
};

std::vector<BadFile> bad_files() {
    const std::string compressed =
        pcd(xyz, "WIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA binary_compressed\n");
    const auto sizes = [](std::uint32_t packed, std::uint32_t opened) {
        std::string bytes(8, '\0');
        std::memcpy(bytes.data(), &packed, 4);
        std::memcpy(bytes.data() + 4, &opened, 4);
        return bytes;
    };
    const std::string le = "ply\nformat binary_little_endian 1.0\n";
    const std::string text = "ply\nformat ascii 1.0\n";
    return {
        {"pcd that is ply", "a.pcd", "ply\nformat ascii 1.0\n", "line 1", "'ply'"},
        {"pcd of rubbish", "a.pcd", std::string("\x7f\0\x80\xff rubbish", 12), "line 1", "no line"},
        {"pcd cut off in the header", "a.pcd", "VERSION 0.7\nFIELDS x", "line 2", "header"},
        {"pcd with negative count", "a.pcd", pcd(xyz, "WIDTH -5\n"), "line 6", "'-5'"},
        {"pcd with absurd count", "a.pcd",
         pcd(xyz, "WIDTH 1000000000000\nHEIGHT 1\nPOINTS 1000000000000\nDATA binary\n"), "line 6",
         "1000000000000"},
        {"pcd with more points than bytes", "a.pcd",
         pcd(xyz, "WIDTH 4000000000\nHEIGHT 1\nDATA binary\n0123456789ab"), "line 8", "do not fit"},
        {"pcd text with more points than bytes", "a.pcd",
         pcd(xyz, "WIDTH 4000000000\nHEIGHT 1\nDATA ascii\n1 2 3\n"), "line 8", "do not fit"},
        {"pcd whose WIDTH * HEIGHT overflows 32 bits", "a.pcd",
         pcd(xyz, "WIDTH 65536\nHEIGHT 65536\nPOINTS 0\nDATA binary\n"), "line 9", "WIDTH 65536"},
        {"pcd whose WIDTH * HEIGHT is too many", "a.pcd",
         pcd(xyz, "WIDTH 4294967295\nHEIGHT 4294967295\nDATA binary\n"), "line 8", "4294967295"},
        {"pcd with SIZE 0", "a.pcd", pcd("FIELDS x y z\nSIZE 4 0 4\n", ""), "line 3", "'0'"},
        {"pcd with COUNT 0", "a.pcd",
         pcd("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 0 1 1\n", ""), "line 5", "'0'"},
        {"pcd with huge COUNT", "a.pcd",
         pcd("FIELDS x y z f\nSIZE 4 4 4 8\nTYPE F F F F\nCOUNT 1 1 1 4294967295\n",
             "WIDTH 3\nDATA binary\n0123456789"),
         "line 7", "do not fit"},
        {"pcd text with huge COUNT", "a.pcd",
         pcd("FIELDS x y z f\nSIZE 4 4 4 8\nTYPE F F F F\nCOUNT 1 1 1 4294967295\n",
             "WIDTH 3\nDATA ascii\n1 2 3 4"),
         "line 7", "do not fit"},
        {"pcd with huge padding", "a.pcd",
         pcd("FIELDS x y z _\nSIZE 4 4 4 4294967295\nTYPE F F F U\nCOUNT 1 1 1 4294967295\n",
             "WIDTH 3\nDATA binary\n1"),
         "line 7", "too wide"},
        {"pcd with a type that is none", "a.pcd",
         pcd("FIELDS x y z\nSIZE 4 4 3\nTYPE F F F\n", "WIDTH 1\nDATA ascii\n"), "line 6", "'z'"},
        {"pcd with lists of other lengths", "a.pcd",
         pcd("FIELDS x y z\nSIZE 4 4\nTYPE F F F\n", "WIDTH 1\nDATA ascii\n"), "line 6", "differ"},
        {"pcd without z", "a.pcd",
         pcd("FIELDS x y w\nSIZE 4 4 4\nTYPE F F F\n", "WIDTH 1\nDATA ascii\n"), "line 6", "x, y"},
        {"pcd without a count", "a.pcd", pcd(xyz, "DATA ascii\n1 2 3\n"), "line 6", "POINTS"},
        {"pcd with unknown DATA", "a.pcd", pcd(xyz, "WIDTH 1\nDATA zip\n1 2 3\n"), "line 7",
         "'zip'"},
        {"pcd with a wrong VIEWPOINT", "a.pcd", pcd(xyz, "VIEWPOINT 0 0 nan 1 0 0 0\n"), "line 6",
         "VIEWPOINT"},
        {"pcd with too few values", "a.pcd", pcd(xyz, "WIDTH 2\nDATA ascii\n1 2 3\n4 5\n1 1 1"),
         "line 9", "too few"},
        {"pcd with too many values", "a.pcd", pcd(xyz, "WIDTH 2\nDATA ascii\n1 2 3\n4 5 6 7\n"),
         "line 9", "too many"},
        {"pcd with a word for a number", "a.pcd", pcd(xyz, "WIDTH 1\nDATA ascii\n1 2 three\n"),
         "line 8", "'three'"},
        {"pcd text cut off", "a.pcd", pcd(xyz, "WIDTH 2\nDATA ascii\n1.25 2.25 3.25"), "line 8",
         "ends before"},
        {"pcd integer out of range", "a.pcd",
         pcd("FIELDS x y z\nSIZE 4 4 1\nTYPE F F U\n", "WIDTH 1\nDATA ascii\n1 2 256\n"), "line 7",
         "'256' is no uint8"},
        {"compressed pcd cut off", "a.pcd", compressed + sizes(100, 24) + "abc", "byte",
         "too early"},
        {"compressed pcd without sizes", "a.pcd", compressed + "abc", "byte", "too early"},
        {"compressed pcd that claims too much", "a.pcd", compressed + sizes(3, 4000000000U) + "abc",
         "byte", "claims 4000000000"},
        {"compressed pcd that claims what it cannot hold", "a.pcd",
         pcd(xyz, "WIDTH 100000000\nDATA binary_compressed\n") + sizes(3, 1200000000U) + "abc",
         "byte", "cannot hold"},
        {"compressed pcd of rubbish", "a.pcd", compressed + sizes(3, 24) + "\xff\xff\xff", "byte",
         "damaged"},
        {"ply without magic", "a.ply", "plyx\n", "line 1", "'ply'"},
        {"ply with unknown format", "a.ply", "ply\nformat binary 1.0\n", "line 2", "'binary'"},
        {"ply without format", "a.ply", "ply\nelement vertex 0\n" + ply_xyz + "end_header\n",
         "line 6", "format"},
        {"ply with negative count", "a.ply", text + "element vertex -1\n", "line 3", "count"},
        {"ply with absurd count", "a.ply",
         le + "element vertex 1000000000000\n" + ply_xyz + "end_header\n0123456789ab", "line 7",
         "1000000000000"},
        {"ply with more points than bytes", "a.ply",
         le + "element vertex 2\n" + ply_xyz + "end_header\n0123456789ab", "line 7", "do not fit"},
        {"ply text with more points than bytes", "a.ply",
         text + "element vertex 2\n" + ply_xyz + "end_header\n1 2 3\n", "line 7", "do not fit"},
        {"ply whose first element is absurd", "a.ply",
         le + "element face 4000000000\nproperty list uchar int i\nelement vertex 1\n" + ply_xyz +
             "end_header\n0123456789ab",
         "line 9", "do not fit"},
        {"ply with a list longer than the file", "a.ply",
         le + "element face 1\nproperty list uint double i\nelement vertex 1\n" + ply_xyz +
             "end_header\n\xff\xff\xff\xff 0123456789ab",
         "byte", "4294967295 values"},
        {"ply with a list of negative length", "a.ply",
         le + "element face 1\nproperty list char int i\nelement vertex 1\n" + ply_xyz +
             "end_header\n\xff 0123456789ab",
         "byte", "negative"},
        {"ply with a list of fractional length", "a.ply",
         le + "element face 1\nproperty list float int i\n", "line 4", "integer"},
        {"ply with unknown type", "a.ply", text + "element vertex 1\nproperty quad x\n", "line 4",
         "'quad'"},
        {"ply with early property", "a.ply", text + "property float x\n", "line 3", "before"},
        {"ply without vertices", "a.ply", text + "element face 0\nend_header\n", "line 4",
         "'vertex'"},
        {"ply without positions", "a.ply",
         text + "element vertex 1\nproperty float x\nend_header\n1\n", "line 5", "x, y and z"},
        {"ply with an unknown line", "a.ply", text + "elemental\n", "line 3", "'elemental'"},
        {"vtk without magic", "a.vtk", "vtk\n", "line 1", "begin"},
        {"vtk of another data set", "a.vtk",
         "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\n", "line 4", "POLYDATA"},
        {"vtk that promises too much", "a.vtk",
         "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET POLYDATA\nPOINTS 4000000000 double\n1",
         "line 5", "do not fit"},
        {"vtk of unknown type", "a.vtk",
         "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 1 bit\n1", "line 5",
         "'bit'"},
        {"vtk cut off", "a.vtk",
         "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 1 float\n1.111 22.22",
         "line 6", "ends before"},
        {"uos of two columns", "a.3d", "1 2\n", "line 1", "2 columns"},
        {"uos with a word", "a.3d", "1 2 3\n1 2 x\n", "line 2", "'x'"},
        {"uos with a short line", "a.3d", "1 2 3 4\n\n1 2 3\n", "line 3", "too few"},
        {"uos of blank lines", "a.3d", "\n\n", "line", "0 columns"},
    };
}

TEST(BadFiles, EachGivesOneLineWithPathFormatPlaceAndReason) {
    for (const BadFile& bad : bad_files()) {
        SCOPED_TRACE(bad.what);
        const std::string message = error_of_bytes(bad.name, bad.bytes);
        EXPECT_THAT(message, HasSubstr(bad.name));
        EXPECT_THAT(message, HasSubstr(bad.place));
        EXPECT_THAT(message, HasSubstr(bad.reason));
        EXPECT_THAT(message, HasSubstr("; "));
        EXPECT_THAT(message, Not(HasSubstr("\n")));
        EXPECT_LT(message.size(), 400U);
    }
}

TEST(BadFiles, MissingEmptyFolderDeviceAndUnknown) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directory(folder / "folder.ply");
    std::filesystem::create_symlink("/dev/zero", folder / "zero.ply");
    test::write_bytes(folder / "a.xyzzy", "1 2 3\n");
    for (const std::string name : {"a.pcd", "a.ply", "a.3d", "a.vtk"}) {
        EXPECT_THAT(error_of(folder / name), HasSubstr("No such file"));
        test::write_bytes(folder / name, "");
        EXPECT_THAT(error_of(folder / name), HasSubstr("empty"));
        EXPECT_THROW(summarize_file(folder / name), IoError);
    }
    EXPECT_THAT(error_of(folder / "folder.ply"), HasSubstr("folder"));
    EXPECT_THAT(error_of(folder / "zero.ply"), HasSubstr("no regular file"));
    EXPECT_THAT(error_of(folder / "a.xyzzy"), HasSubstr("'.xyzzy'"));
    EXPECT_THAT(error_of(folder.path()), HasSubstr("folder"));
}

TEST(BadFiles, HeaderLineWithoutEndIsRefusedAtOnce) {
    const test::TemporaryFolder folder;
    const std::vector<Sample> starts = {{"a.pcd", "VERSION 0.7 "},
                                        {"a.ply", "ply\ncomment "},
                                        {"a.vtk", "# vtk DataFile Version 3.0 "},
                                        {"a.3d", "1 2 3 "}};
    for (const Sample& start : starts) {
        const auto path = folder / start.name;
        test::write_bytes(path, start.bytes);
        // A hole: the file is 1 GB long and takes no room.
        std::filesystem::resize_file(path, std::uintmax_t{1} << 30U);
        EXPECT_THAT(error_of(path), HasSubstr("longer than"));
    }
}

/// Forbids the process more address space than it has and `bytes` beyond.
class MemoryLimit {
  public:
    explicit MemoryLimit(std::uint64_t bytes) {
        ::getrlimit(RLIMIT_AS, &old_);
        std::ifstream status("/proc/self/statm");
        std::uint64_t pages = 0;
        status >> pages;
        const rlimit limit{pages * 4096 + bytes, old_.rlim_max};
        ::setrlimit(RLIMIT_AS, &limit);
    }
    ~MemoryLimit() { ::setrlimit(RLIMIT_AS, &old_); }
    MemoryLimit(const MemoryLimit&) = delete;
    MemoryLimit& operator=(const MemoryLimit&) = delete;

  private:
    rlimit old_{};
};

std::string mutate(std::string bytes, Random& random) {
    const auto size = static_cast<std::uint32_t>(bytes.size());
    if (random.below(4) == 0) bytes.resize(random.below(size + 1));
    const std::size_t num_flips = bytes.empty() ? 0 : random.below(6);
    for (std::size_t i = 0; i < num_flips; ++i) {
        // Most flips go into the header, where they hurt most.
        const auto end = static_cast<std::uint32_t>(bytes.size());
        const std::size_t place = random.below(random.below(3) == 0 ? end : std::min(end, 250U));
        if (random.below(3) == 0) {
            constexpr std::string_view likely = "0123456789-. \nnfe";
            bytes[place] = likely[random.below(static_cast<std::uint32_t>(likely.size()))];
        } else {
            bytes[place] = static_cast<char>(bytes[place] ^ (1 << random.below(8)));
        }
    }
    return bytes;
}

std::vector<Sample> valid_files(const test::TemporaryFolder& folder) {
    constexpr std::array<ScalarType, 4> types = {ScalarType::uint8, ScalarType::int16,
                                                 ScalarType::float64, ScalarType::uint32};
    std::vector<Sample> samples;
    const auto add = [&](const std::string& name, Encoding encoding) {
        for (const std::uint64_t seed : {11U, 12U, 13U}) {
            write_point_cloud(folder / name, test::random_cloud(seed, types), {encoding});
            samples.push_back({name, test::read_bytes(folder / name)});
        }
    };
    for (const Encoding encoding :
         {Encoding::ascii, Encoding::binary, Encoding::binary_compressed}) {
        add("a.pcd", encoding);
    }
    for (const Encoding encoding :
         {Encoding::ascii, Encoding::binary, Encoding::binary_big_endian}) {
        add("a.ply", encoding);
    }
    add("a.3d", Encoding::automatic);
    const std::string vertices = "element vertex 2\n" + ply_xyz;
    const std::string faces = "element face 2\nproperty list uchar int vertex_indices\n";
    samples.push_back({"a.ply", "ply\nformat ascii 1.0\n" + faces + vertices +
                                    "end_header\n3 0 1 1\n2 1 0\n1 2 3\n4 5 6\n"});
    samples.push_back({"a.ply", "ply\nformat binary_little_endian 1.0\n" + faces + vertices +
                                    "end_header\n" + std::string("\1\0\0\0\0\0", 6) +
                                    std::string(24, 'a')});
    const std::string vtk = "# vtk DataFile Version 3.0\ntitle\n";
    samples.push_back({"a.vtk", vtk + "ASCII\nDATASET POLYDATA\nPOINTS 2 float\n1 2 3 4\n5 6\n"});
    samples.push_back(
        {"a.vtk", vtk + "BINARY\nDATASET POLYDATA\nPOINTS 2 float\n" + std::string(24, 'a')});
    samples.push_back(
        {"poses.txt", "1 0 0 1 0 1 0 2 0 0 1 3\n" +
                          std::string("nan nan nan nan nan nan nan nan nan nan nan nan\n")});
    samples.push_back({"tum.txt", "0.5 1 2 3 0 0 0 1\n"});
    samples.push_back({"a.pose", "1 2 3\n4 5 6\n"});
    return samples;
}

/// Whatever stands in a file, it is read or refused, and never takes memory beyond its size.
TEST(BadFiles, ThousandsOfDamagedFilesAreReadOrRefused) {
    const test::TemporaryFolder folder;
    Context one_thread;
    one_thread.num_threads = 1;
    const std::vector<Sample> samples = valid_files(folder);
    const MemoryLimit limit(std::uint64_t{64} << 20U);
    std::size_t num_refused = 0;
    std::size_t num_read = 0;
    for (std::uint64_t round = 0; round < 250; ++round) {
        for (std::size_t i = 0; i < samples.size(); ++i) {
            Random random(round, i);
            const auto path = folder / samples[i].name;
            test::write_bytes(path, mutate(samples[i].bytes, random));
            const std::string extension = path.extension().string();
            try {
                if (extension == ".txt" || extension == ".pose") {
                    read_poses(path, one_thread);
                } else {
                    const FileSummary summary = summarize_file(path, one_thread).front();
                    EXPECT_LE(summary.num_points, 1000000U);
                    const Scan scan = read_scans(path, one_thread).front().scan;
                    EXPECT_EQ(scan.cloud.size(), summary.num_points);
                }
                ++num_read;
            } catch (const IoError& error) {
                EXPECT_THAT(error.what(), Not(HasSubstr("\n")));
                ++num_refused;
            }
        }
    }
    EXPECT_GT(num_refused, 1000U);
    EXPECT_GT(num_read, 1000U);
}

}  // namespace
}  // namespace roomscribe
