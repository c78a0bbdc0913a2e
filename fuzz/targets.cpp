// SPDX-License-Identifier: MIT
#include "fuzz/targets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <unistd.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/export/json.hpp"
#include "roomscribe/io/e57.hpp"
#include "roomscribe/io/e57_pages.hpp"
#include "roomscribe/io/npy.hpp"
#include "roomscribe/io/point_cloud_io.hpp"
#include "roomscribe/io/poses_io.hpp"
#include "tests/support/rosbag_bytes.hpp"

namespace roomscribe::fuzz {

namespace fs = std::filesystem;

fs::path scratch_file(std::string_view name) {
    const fs::path memory = "/dev/shm";
    static const fs::path folder = (fs::exists(memory) ? memory : fs::temp_directory_path()) /
                                   ("roomscribe-fuzz-" + std::to_string(getpid()));
    static const struct Cleaner {
        ~Cleaner() {
            std::error_code ignored;
            fs::remove_all(folder, ignored);
        }
    } cleaner;
    fs::create_directories(folder);
    return folder / name;
}

fs::path scratch_file(std::string_view name, std::span<const std::byte> bytes) {
    const fs::path path = scratch_file(name);
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    return path;
}

namespace {

using Bytes = std::span<const std::byte>;
using Seeds = std::vector<std::string>;

std::string read_file(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

Context one_thread() {
    Context context;
    context.num_threads = 1;
    return context;
}

void read_cloud(std::string_view extension, Bytes bytes) {
    const fs::path path = scratch_file("input." + std::string(extension), bytes);
    try {
        read_scans(path, one_thread());
        summarize_file(path, one_thread());
    } catch (const IoError&) {
    }
}

/// Checksums would stop every changed byte at the door: they are put right first.
void read_e57_of(Bytes bytes) {
    std::vector<std::byte> pages(bytes.begin(), bytes.end());
    for (std::size_t page = 0; page + e57_page_bytes <= pages.size(); page += e57_page_bytes) {
        const std::uint32_t sum = crc32c(std::span(pages).subspan(page, e57_page_content));
        for (std::size_t i = 0; i < sizeof(sum); ++i)
            pages[page + e57_page_content + i] = static_cast<std::byte>(sum >> (24U - 8U * i));
    }
    read_cloud("e57", pages);
}

/// Three rows of four points with all that a point can have; one has no coordinates.
PointCloud seed_cloud() {
    PointCloud cloud;
    for (int i = 0; i < 12; ++i) {
        const auto value = static_cast<float>(i);
        cloud.positions.emplace_back(0.5F * value, 1.0F - value, 0.25F);
        cloud.normals.emplace_back(0.0F, 0.0F, 1.0F);
        cloud.colors.push_back({static_cast<std::uint8_t>(20 * i), 7, 255});
        cloud.intensities.push_back(0.1F * value);
    }
    cloud.positions[5].setConstant(std::nanf(""));
    cloud.channels.push_back(
        {"ring", ScalarType::uint16, 1, std::vector<std::byte>(24, std::byte{3})});
    cloud.grid = ScanGrid{3, 4};
    return cloud;
}

std::string written(std::string_view extension, const PointCloud& cloud,
                    Encoding encoding = Encoding::automatic) {
    const fs::path path = scratch_file("seed." + std::string(extension));
    write_point_cloud(path, cloud, {.encoding = encoding});
    return read_file(path);
}

PointCloud far_cloud() {
    PointCloud cloud = seed_cloud();
    cloud.global_shift = Eigen::Vector3d(4.5e6, 5.4e6, 100.0);
    return cloud;
}

Seeds pcd_seeds() {
    using enum Encoding;
    return {written("pcd", seed_cloud(), ascii), written("pcd", seed_cloud(), binary),
            written("pcd", seed_cloud(), binary_compressed), written("pcd", far_cloud())};
}
Seeds ply_seeds() {
    using enum Encoding;
    return {written("ply", seed_cloud(), ascii), written("ply", seed_cloud(), binary),
            written("ply", seed_cloud(), binary_big_endian), written("ply", far_cloud())};
}
Seeds e57_seeds() {
    const fs::path path = scratch_file("seed.e57");
    const StoredScan scan{{"a", seed_cloud()}, Transform::Identity()};
    const std::array scans{scan, scan};
    write_e57(path, scans, {});
    return {written("e57", seed_cloud()), written("e57", far_cloud()), read_file(path)};
}
Seeds las_seeds() {
    return {written("las", seed_cloud()), written("las", far_cloud())};
}
Seeds text_seeds() {
    return {written("xyz", seed_cloud()), "1 2 3 255 0 0\n2 3 4 255 1 0\n", "// c\n1,2,3\n4,5,6\n"};
}
Seeds csv_seeds() {
    return {written("csv", seed_cloud()), "\"X\";\"Y\";\"Z\";\"R\"\n1;2;3;0.5\n"};
}
Seeds pts_seeds() {
    return {"2\n1 2 3 -100 255 0 0\n4 5 6 100 0 0 7\n", "3\n1 2 3\n1 2 3\n2\n1 2 3\n"};
}
Seeds ptx_seeds() {
    return {
        "2\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"
        "1 2 3 0.5\n0 0 0 0.5\n",
        "1\n2\n9 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n9 0 0 1\n"
        "1 2 3 0.5 1 2 3\n0 1 0 0.5 1 2 3\n"};
}
Seeds uos_seeds() {
    return {written("3d", seed_cloud()), "100 0 50\n100 10 50 0.5\n"};
}
Seeds npy_seeds() {
    const auto header = [](std::string text, std::size_t bytes) {
        text.insert(text.begin(),
                    {'\x93', 'N', 'U', 'M', 'P', 'Y', 1, 0, static_cast<char>(text.size()), 0});
        return text + std::string(bytes, '\x3f');
    };
    return {header("{'descr': '<f4', 'fortran_order': False, 'shape': (4, 3), }\n", 48),
            header("{'descr': '>f8', 'fortran_order': True, 'shape': (2, 6), }\n", 96)};
}
Seeds vtk_seeds() {
    return {"# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n1 2 3 4 5 6\n",
            "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET POLYDATA\nPOINTS 1 double\n" +
                std::string(24, '\x3f') + "\n"};
}

Seeds obj_seeds() {
    return {"v 1 2 3\nvn 0 0 1\nf 1 1 1\n", "v 1 2 3 1 0 0.5\nv 4 5 6 0 1 0\n"};
}
Seeds tilt_seeds() {
    return {
        "unit mm\nstart -90\nstep 90\noffset 0.1 0 0.2\nrange 0.1 80\nscan -1 1 2 3\nscan 1 4 5 "
        "6\n"};
}
/// 2 x 2 pixels, by any writer.
constexpr unsigned char small_png[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44,
    0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x10, 0x00, 0x00, 0x00, 0x00, 0x07,
    0x4d, 0x8e, 0xbb, 0x00, 0x00, 0x00, 0x12, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x60,
    0x7e, 0xc1, 0xc0, 0xc0, 0xc0, 0x7e, 0xe1, 0xff, 0x7f, 0x00, 0x0c, 0xee, 0x03, 0xc1, 0x20,
    0x68, 0xfe, 0x7d, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

/// CRC-32 of PNG and zlib.
std::uint32_t png_checksum(Bytes bytes) {
    std::uint32_t sum = 0xffffffffU;
    for (const std::byte byte : bytes) {
        sum ^= std::to_integer<std::uint32_t>(byte);
        for (int bit = 0; bit < 8; ++bit)
            sum = (sum >> 1U) ^ ((sum & 1U) != 0 ? 0xedb88320U : 0U);
    }
    return ~sum;
}

/// As with E57, checksums are put right first, of all chunks that are whole.
void read_png_of(Bytes bytes) {
    std::vector<std::byte> png(bytes.begin(), bytes.end());
    const auto at = [&](std::size_t i) { return std::to_integer<std::uint32_t>(png[i]); };
    for (std::size_t chunk = 8; chunk + 12 <= png.size();) {
        const std::uint64_t size =
            at(chunk) << 24U | at(chunk + 1) << 16U | at(chunk + 2) << 8U | at(chunk + 3);
        if (size > png.size() - chunk - 12) break;
        const std::uint32_t sum = png_checksum(std::span(png).subspan(chunk + 4, size + 4));
        for (std::size_t i = 0; i < 4; ++i)
            png[chunk + 8 + size + i] = static_cast<std::byte>(sum >> (24U - 8U * i));
        chunk += size + 12;
    }
    scratch_file("intrinsics.txt", std::as_bytes(std::span("525 525 1 1\n", 12)));
    read_cloud("png", png);
}
Seeds png_seeds() {
    return {std::string(reinterpret_cast<const char*>(small_png), sizeof(small_png))};
}

void read_poses_of(Bytes bytes, const char* name) {
    const fs::path path = scratch_file(name, bytes);
    try {
        read_poses(path);
    } catch (const IoError&) {
    }
}
Seeds pose_seeds() {
    return {"1 0 0 4 0 1 0 5 0 0 1 6\nnan nan nan nan nan nan nan nan nan nan nan nan\n",
            "# t\n0.5 1 2 3 0 0 0 1\n"};
}

template <typename Read>
void read_text(Bytes bytes, Read read) {
    try {
        read(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    } catch (const IoError&) {
    }
}

Seeds scene_seeds() {
    Scene scene;
    Component face;
    face.id = "wall-1";
    face.label = Label::wall;
    face.polygon = {{0, 0, 0}, {1, 0, 0}, {1, 0, 2}};
    face.evidence.rule = "r";
    face.evidence.coverage = 0.5;
    face.evidence.rms = 0.01;
    Component handle;
    handle.id = "handle-1";
    handle.label = Label::handle;
    handle.box = OrientedBox{};
    handle.grasp = Grasp{};
    handle.opens = OpeningMotion{};
    scene.components = {face, handle};
    Room room;
    room.id = "room-1";
    room.polygon = face.polygon;
    room.walls = {"wall-1"};
    room.neighbors = {{"room-2", "door-1"}};
    scene.rooms = {room};
    return {scene_to_json(scene)};
}

Seeds correction_seeds() {
    const std::string door = R"({"label":"door","polygon":[[0,0,0],[1,0,0],[1,0,2]]})";
    const std::string piece =
        R"({"label":"furniture","box":{"center":[0,0,1],"axes":[[1,0,0],[0,1,0],[0,0,1]],"size":[1,1,2]}})";
    return {R"({"format":"roomscribe-corrections","version":1,"corrections":[)"
            R"({"action":"pin","element":)" +
            door + R"(},{"action":"reject","element":)" + piece +
            R"(},{"action":"relabel","label":"window","kind":"french_window","element":)" + door +
            R"(},{"action":"set_size","size":[0.9,2.05],"element":)" + door + "}]}"};
}

Seeds bag_seeds() {
    const test::BagTopic laser =
        test::laser_topic({test::laser_message(1.0, "laser", {1.0F, 2.0F}),
                           test::laser_message(2.0, "laser", {1.0F, 2.0F})});
    const test::BagTopic tf = test::tf_topic({{1.0, "base", "laser", {0, 0, 0, 0, 0, 0, 1}},
                                              {2.0, "base", "laser", {0, 0, 1, 0, 1, 0, 0}}});
    return {test::bag_of({tf, laser}), test::bag_of({test::cloud_topic({test::cloud_message(2)})})};
}

Seeds registration_seeds() {
    Registration registration;
    registration.map_from_scan = {Transform::Identity(), std::nullopt};
    registration.apart_from_scan.resize(2);
    registration.covariances.resize(2);
    registration.residuals = {0.0, 0.1};
    registration.overlaps = {0.5, 0.0};
    registration.is_doubtful = {false, true};
    registration.components = {{0}, {1}};
    registration.links.resize(1);
    registration.links[0].source = 1;
    const std::array<std::string, 2> names{"a", "b"};
    return {registration_to_json(registration, names)};
}

constexpr Target all_targets[] = {
    {"pcd", [](Bytes bytes) { read_cloud("pcd", bytes); }, pcd_seeds},
    {"ply", [](Bytes bytes) { read_cloud("ply", bytes); }, ply_seeds},
    {"e57", read_e57_of, e57_seeds},
    {"las", [](Bytes bytes) { read_cloud("las", bytes); }, las_seeds},
    {"ptx", [](Bytes bytes) { read_cloud("ptx", bytes); }, ptx_seeds},
    {"pts", [](Bytes bytes) { read_cloud("pts", bytes); }, pts_seeds},
    {"xyz", [](Bytes bytes) { read_cloud("xyz", bytes); }, text_seeds},
    {"csv", [](Bytes bytes) { read_cloud("csv", bytes); }, csv_seeds},
    {"npy", [](Bytes bytes) { read_cloud("npy", bytes); }, npy_seeds},
    {"uos", [](Bytes bytes) { read_cloud("3d", bytes); }, uos_seeds},
    {"vtk", [](Bytes bytes) { read_cloud("vtk", bytes); }, vtk_seeds},
    {"obj", [](Bytes bytes) { read_cloud("obj", bytes); }, obj_seeds},
    {"tilt", [](Bytes bytes) { read_cloud("tilt", bytes); }, tilt_seeds},
    {"bag", [](Bytes bytes) { read_cloud("bag", bytes); }, bag_seeds},
    {"png", read_png_of, png_seeds},
    {"poses", [](Bytes bytes) { read_poses_of(bytes, "poses.txt"); }, pose_seeds},
    {"uos_pose", [](Bytes bytes) { read_poses_of(bytes, "scan.pose"); },
     [] { return Seeds{"1 2 3\n4 5 6\n"}; }},
    {"scene", [](Bytes bytes) { read_text(bytes, [](auto text) { scene_from_json(text); }); },
     scene_seeds},
    {"corrections",
     [](Bytes bytes) { read_text(bytes, [](auto text) { corrections_from_json(text); }); },
     correction_seeds},
    {"registration",
     [](Bytes bytes) { read_text(bytes, [](auto text) { registration_from_json(text); }); },
     registration_seeds},
};

}  // namespace

std::span<const Target> targets() {
    return all_targets;
}

const Target& target_of(std::string_view name) {
    const auto found = std::find_if(std::begin(all_targets), std::end(all_targets),
                                    [name](const Target& target) { return target.name == name; });
    if (found == std::end(all_targets)) throw std::out_of_range("no target " + std::string(name));
    return *found;
}

std::vector<std::string> kept_inputs(std::string_view name) {
    const fs::path folder = fs::path(ROOMSCRIBE_SOURCE_DIR) / "fuzz" / "corpus" / name;
    std::vector<fs::path> files;
    if (fs::exists(folder)) {
        for (const auto& entry : fs::directory_iterator(folder))
            files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    std::vector<std::string> inputs;
    for (const fs::path& path : files) {
        std::string digits = read_file(path);
        std::erase_if(digits, [](unsigned char c) { return std::isxdigit(c) == 0; });
        std::string& bytes = inputs.emplace_back();
        for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
            bytes += static_cast<char>(std::stoi(digits.substr(i, 2), nullptr, 16));
    }
    return inputs;
}

}  // namespace roomscribe::fuzz
