// SPDX-License-Identifier: MIT
#include "roomscribe/io/depth_images.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/io/byte_reader.hpp"
#include "roomscribe/io/number_text.hpp"
#include "roomscribe/io/png_depth.hpp"
#include "roomscribe/io/poses_io.hpp"

namespace roomscribe {
namespace {

namespace fs = std::filesystem;

/// Depth cameras run at 30 images a second: an image has a pose of its own time within half of
/// that.
constexpr double largest_time_difference = 0.02;
constexpr std::size_t max_images = 100;
/// What cameras write, beside 0, where they saw nothing: the end of 16 bits (7-Scenes).
constexpr std::uint16_t no_depth = 65535;
constexpr std::string_view list_cure = "write a time and a file name in each line";
constexpr std::string_view camera_cure =
    "write fx fy cx cy, and steps per metre if they are not 1000, into intrinsics.txt beside it";
constexpr std::string_view frames_cure = "name the images NAME.depth.png";

struct Camera {
    double fx = 525.0;
    double fy = 525.0;
    double cx = 319.5;
    double cy = 239.5;
    double steps_per_metre = 5000.0;
};

Camera read_camera(const fs::path& path) {
    const MappedFile file(path, "intrinsics");
    ByteReader reader(file, "intrinsics");
    std::vector<double> numbers;
    while (!reader.at_end()) {
        for (const std::string_view word : split_words(reader.read_line())) {
            if (word.starts_with('#')) break;
            const std::optional<double> number = parse_real(word);
            if (!number || !std::isfinite(*number)) {
                reader.fail_at_line(quote_text(word) + " is no number", camera_cure);
            }
            numbers.push_back(*number);
        }
    }
    if (numbers.size() == 9) {
        const std::vector<double>& m = numbers;  // row by row
        if (m[1] != 0.0 || m[3] != 0.0 || m[6] != 0.0 || m[7] != 0.0 || m[8] != 1.0)
            reader.fail_at_line("this is no camera's matrix", camera_cure);
        numbers = {m[0], m[4], m[2], m[5]};
    }
    if (numbers.size() == 4) numbers.push_back(1000.0);
    if (numbers.size() != 5 || numbers[0] <= 0.0 || numbers[1] <= 0.0 || numbers[4] <= 0.0) {
        reader.fail_at_line("these are no numbers of a camera", camera_cure);
    }
    return {numbers[0], numbers[1], numbers[2], numbers[3], numbers[4]};
}

FileContents place_pixels(const fs::path& path, const Camera& camera, PointsAs as) {
    const DepthPixels image = read_depth_png(path);
    FileContents contents{
        {}, "depth image", "PNG, 16 bits", {{"depth", ScalarType::uint16, 1}}, {}};
    PointCloud& cloud = contents.cloud;
    cloud.positions.reserve(image.depths.size());
    for (std::size_t row = 0; row < image.rows; ++row) {
        for (std::size_t column = 0; column < image.columns; ++column) {
            const std::uint16_t steps = image.depths[row * image.columns + column];
            const bool is_none = steps == 0 || steps == no_depth;
            const double z = is_none ? std::nan("") : steps / camera.steps_per_metre;
            const Eigen::Vector3d point((static_cast<double>(column) - camera.cx) / camera.fx * z,
                                        (static_cast<double>(row) - camera.cy) / camera.fy * z, z);
            cloud.positions.emplace_back(point.cast<float>());
        }
    }
    cloud.grid = ScanGrid{image.rows, image.columns};
    cloud.sensor_pose = Transform::Identity();
    keep_points(as, contents);
    return contents;
}

struct TimedFile {
    double time = 0.0;
    std::string name;
};

std::vector<TimedFile> read_list(const fs::path& path) {
    const MappedFile file(path, "TUM RGB-D");
    ByteReader reader(file, "TUM RGB-D");
    std::vector<TimedFile> list;
    while (!reader.at_end()) {
        const std::vector<std::string_view> words = split_words(reader.read_line());
        if (words.empty() || words[0].starts_with('#')) continue;
        const std::optional<double> time = parse_real(words[0]);
        if (words.size() != 2 || !time || !std::isfinite(*time)) {
            reader.fail_at_line("this is no time and file", list_cure);
        }
        const fs::path name(words[1]);
        const bool leaves =
            name.is_absolute() || std::find(name.begin(), name.end(), "..") != name.end();
        if (leaves) reader.fail_at_line(quote_text(words[1]) + " leaves the folder", list_cure);
        list.push_back({*time, name.string()});
    }
    if (list.empty()) reader.fail_at_line("there are no images in the list", list_cure);
    return list;
}

/// The times of the lines of a file of poses, in its order.
std::vector<double> read_times(const fs::path& path) {
    const MappedFile file(path, "poses");
    ByteReader reader(file, "poses");
    std::vector<double> times;
    while (!reader.at_end()) {
        const std::vector<std::string_view> words = split_words(reader.read_line());
        if (words.empty() || words[0].starts_with('#')) continue;
        times.push_back(parse_real(words[0]).value_or(0.0));
    }
    return times;
}

class Trajectory {
  public:
    explicit Trajectory(const fs::path& path, const Context& context)
        : poses_(read_poses(path, context)), times_(read_times(path)) {}

    std::optional<Transform> at(double time) const {
        std::size_t best = 0;
        for (std::size_t i = 1; i < times_.size(); ++i) {
            if (std::abs(times_[i] - time) < std::abs(times_[best] - time)) best = i;
        }
        if (!(std::abs(times_[best] - time) <= largest_time_difference)) return std::nullopt;
        return poses_[best];
    }

  private:
    std::vector<std::optional<Transform>> poses_;
    std::vector<double> times_;
};

/// Which of a folder's images are read: all, or so many evenly.
std::vector<std::size_t> taken_images(std::size_t num_images) {
    std::vector<std::size_t> taken(std::min(num_images, max_images));
    for (std::size_t i = 0; i < taken.size(); ++i)
        taken[i] = i * num_images / taken.size();
    return taken;
}

void warn_of_left_images(std::size_t num_images, FileContents& image) {
    if (num_images <= max_images) return;
    image.warnings.push_back(
        fmt::format("{} of {} images are taken, evenly", max_images, num_images));
}

constexpr std::string_view depth_suffix = ".depth.png";

void add_depth_images(const fs::path& folder, std::vector<fs::path>& images) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        if (entry.path().filename().string().ends_with(depth_suffix))
            images.push_back(entry.path());
    }
}

/// NAME.depth.png in a folder and in the folders right inside it, by their names.
std::vector<fs::path> depth_images_of(const fs::path& folder) {
    std::vector<fs::path> images;
    add_depth_images(folder, images);
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        if (entry.is_directory()) add_depth_images(entry.path(), images);
    }
    std::sort(images.begin(), images.end());
    return images;
}

}  // namespace

FileContents read_depth_image(const fs::path& path, PointsAs as, const Context& context) {
    context.throw_if_cancelled();
    fs::path own = path;
    own.replace_extension(".intrinsics.txt");
    const fs::path candidates[] = {own, path.parent_path() / "intrinsics.txt",
                                   path.parent_path() / frames_index};
    const auto* const camera =
        std::find_if(std::begin(candidates), std::end(candidates),
                     [](const fs::path& candidate) { return fs::exists(candidate); });
    if (camera == std::end(candidates)) {
        // A missing image is the better message.
        const MappedFile file(path, "depth image");
        throw IoError(path.string(), "depth image", {}, "the camera's numbers are not known",
                      std::string(camera_cure));
    }
    return place_pixels(path, read_camera(*camera), as);
}

std::vector<FileContents> read_tum_folder(const fs::path& folder, PointsAs as,
                                          const Context& context) {
    const std::vector<TimedFile> list = read_list(folder / tum_index);
    const fs::path intrinsics = folder / "intrinsics.txt";
    const bool camera_known = fs::exists(intrinsics);
    const Camera camera = camera_known ? read_camera(intrinsics) : Camera{};
    std::optional<Trajectory> trajectory;
    if (fs::exists(folder / "groundtruth.txt")) {
        trajectory.emplace(folder / "groundtruth.txt", context);
    }
    std::vector<FileContents> images;
    for (const std::size_t i : taken_images(list.size())) {
        context.throw_if_cancelled();
        const TimedFile& entry = list[i];
        FileContents image = place_pixels(folder / entry.name, camera, as);
        image.name = fs::path(entry.name).stem().string();
        if (trajectory) image.map_from_scan = trajectory->at(entry.time);
        if (!camera_known) {
            image.warnings.emplace_back(
                "the camera's numbers are guessed (525 525 319.5 239.5 5000): write "
                "intrinsics.txt");
        }
        warn_of_left_images(list.size(), image);
        images.push_back(std::move(image));
    }
    return images;
}

std::vector<FileContents> read_frames_folder(const fs::path& folder, PointsAs as,
                                             const Context& context) {
    const Camera camera = read_camera(folder / frames_index);
    const std::vector<fs::path> files = depth_images_of(folder);
    if (files.empty()) {
        throw IoError(folder.string(), "depth images", {}, "there are none in it",
                      std::string(frames_cure));
    }
    std::vector<FileContents> images;
    for (const std::size_t i : taken_images(files.size())) {
        context.throw_if_cancelled();
        const std::string file = files[i].string();
        const std::string stem = file.substr(0, file.size() - depth_suffix.size());
        FileContents image = place_pixels(files[i], camera, as);
        image.name = fs::path(stem).lexically_relative(folder).string();
        const fs::path pose = stem + ".pose.txt";
        if (fs::exists(pose)) image.map_from_scan = read_poses(pose, context).front();
        warn_of_left_images(files.size(), image);
        images.push_back(std::move(image));
    }
    return images;
}

}  // namespace roomscribe
