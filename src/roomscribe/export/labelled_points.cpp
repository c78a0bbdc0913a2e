// SPDX-License-Identifier: MIT
#include "roomscribe/export/labelled_points.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/geometry/polygon.hpp"

namespace roomscribe {
namespace {

/// What the two data sets call a kind of furniture.
struct KindNames {
    std::string_view kind;
    std::uint16_t nyu40;
    std::string_view s3dis;
};

constexpr std::uint16_t other_furniture = 39;
constexpr std::uint16_t other_prop = 40;
constexpr std::array<KindNames, 21> kinds{{
    {"cabinet", 3, "clutter"},
    {"wardrobe", 3, "clutter"},
    {"base_unit", 3, "clutter"},
    {"wall_unit", 3, "clutter"},
    {"drawer_unit", 3, "clutter"},
    {"bed", 4, "clutter"},
    {"chair", 5, "chair"},
    {"office_chair", 5, "chair"},
    {"armchair", 5, "chair"},
    {"stool", 5, "chair"},
    {"bench", 5, "chair"},
    {"sofa", 6, "sofa"},
    {"table", 7, "table"},
    {"counter", 12, "table"},
    {"desk", 14, "table"},
    {"bookcase", 10, "bookcase"},
    {"shelf", 15, "bookcase"},
    {"dresser", 17, "clutter"},
    {"chest_of_drawers", 17, "clutter"},
    {"fridge", 24, "clutter"},
    {"vanity", 3, "clutter"},
}};

const KindNames* find_kind(std::string_view kind) {
    const auto* found = std::find_if(kinds.begin(), kinds.end(),
                                     [&](const KindNames& names) { return names.kind == kind; });
    return found == kinds.end() ? nullptr : found;
}

template <typename Value>
std::vector<Value> require_channel(const PointCloud& cloud, std::string_view name,
                                   ScalarType type) {
    for (const Channel& channel : cloud.channels) {
        if (channel.name != name || channel.type != type || channel.count != 1) continue;
        std::vector<Value> values(cloud.size());
        if (!values.empty())
            std::memcpy(values.data(), channel.values.data(), values.size() * sizeof(Value));
        return values;
    }
    throw InvalidArgument("the map's channels", "none called " + std::string(name),
                          "label (uint8) and instance (int32), as labels.ply has them");
}

Channel channel_of(const std::string& name, const std::vector<std::uint16_t>& values) {
    Channel channel{name, ScalarType::uint16, 1, {}};
    channel.values.resize(values.size() * sizeof(std::uint16_t));
    if (!values.empty()) std::memcpy(channel.values.data(), values.data(), channel.values.size());
    return channel;
}

/// Component by its instance.
std::map<std::int32_t, std::size_t> components_by_instance(const Scene& scene) {
    std::map<std::int32_t, std::size_t> found;
    for (std::size_t i = 0; i < scene.components.size(); ++i) {
        if (scene.components[i].instance >= 0) found.emplace(scene.components[i].instance, i);
    }
    return found;
}

/// Kind of the piece: its doors, drawers and tops are named by it.
std::string_view kind_of_piece(const Scene& scene, std::size_t index) {
    const Component& component = scene.components[index];
    const auto parent = find_component(scene, component.parent);
    const bool is_face = parent && scene.components[*parent].label == Label::furniture;
    return is_face ? scene.components[*parent].kind : component.kind;
}

/// The rooms' outlines, to ask many points for their room.
class RoomFinder {
  public:
    explicit RoomFinder(const std::vector<Room>& rooms) : rooms_(rooms) {
        for (const Room& room : rooms)
            plans_.push_back(plan_of_room(room));
    }
    std::optional<std::size_t> room_at(const Eigen::Vector3d& place) const {
        // A floor or ceiling is as thick as its noise, and things lie a step below.
        constexpr double margin = 0.3;
        for (std::size_t i = 0; i < rooms_.size(); ++i) {
            if (place.z() > rooms_[i].floor_height - margin &&
                place.z() < rooms_[i].ceiling_height + margin &&
                is_inside(plans_[i], place.head<2>())) {
                return i;
            }
        }
        return std::nullopt;
    }

  private:
    const std::vector<Room>& rooms_;
    std::vector<std::vector<Eigen::Vector2d>> plans_;
};

}  // namespace

std::uint16_t nyu40_id(Label label, std::string_view kind) {
    switch (label) {
        case Label::wall:
            return 1;
        case Label::floor:
            return 2;
        case Label::door:
        case Label::door_frame:
            return 8;
        case Label::window:
        case Label::window_frame:
            return 9;
        case Label::ceiling:
            return 22;
        case Label::furniture: {
            const KindNames* names = find_kind(kind);
            return names != nullptr ? names->nyu40 : other_furniture;
        }
        case Label::handle:
            return other_prop;
        case Label::unknown:
            return 0;
    }
    return 0;
}

std::string_view s3dis_class(Label label, std::string_view kind) {
    switch (label) {
        case Label::wall:
            return "wall";
        case Label::floor:
            return "floor";
        case Label::ceiling:
            return "ceiling";
        case Label::door:
        case Label::door_frame:
            return "door";
        case Label::window:
        case Label::window_frame:
            return "window";
        case Label::furniture: {
            const KindNames* names = find_kind(kind);
            return names != nullptr ? names->s3dis : "clutter";
        }
        default:
            return "clutter";
    }
}

LabelledPoints labelled_points(PointCloud cloud, const Transform& room_from_map) {
    const auto ids = require_channel<std::uint8_t>(cloud, "label", ScalarType::uint8);
    const auto instances = require_channel<std::int32_t>(cloud, "instance", ScalarType::int32);
    LabelledPoints points;
    const bool has_colors = !cloud.colors.empty();
    for (const std::uint32_t i : finite_points(cloud)) {
        const Label label = ids[i] < num_labels ? static_cast<Label>(ids[i]) : Label::unknown;
        const Eigen::Vector3d in_map = cloud.positions[i].cast<double>() + cloud.global_shift;
        points.cloud.positions.emplace_back((room_from_map * in_map).cast<float>());
        points.cloud.colors.push_back(has_colors ? cloud.colors[i] : label_color(label));
        points.labels.push_back(label);
        points.instances.push_back(instances[i]);
    }
    return points;
}

PointCloud scannet_cloud(LabelledPoints points, const Building& building) {
    const auto by_instance = components_by_instance(building.scene);
    std::vector<std::uint16_t> classes;
    std::vector<std::uint16_t> instances;
    for (std::size_t i = 0; i < points.labels.size(); ++i) {
        const auto found = by_instance.find(points.instances[i]);
        const bool is_known = found != by_instance.end();
        classes.push_back(nyu40_id(points.labels[i],
                                   is_known ? kind_of_piece(building.scene, found->second) : ""));
        // Numbered as they come in the scene, for instances may be any numbers.
        const auto number = is_known ? std::distance(by_instance.begin(), found) + 1 : 0;
        instances.push_back(static_cast<std::uint16_t>(std::min<std::ptrdiff_t>(number, 65535)));
    }
    points.cloud.channels = {channel_of("label", classes), channel_of("instance", instances)};
    return std::move(points.cloud);
}

std::vector<S3disFile> s3dis_files(const LabelledPoints& points, const Building& building) {
    const Scene& scene = building.scene;
    const auto by_instance = components_by_instance(scene);
    const RoomFinder rooms(scene.rooms);
    std::map<std::string, std::vector<std::uint32_t>> per_room;
    std::map<std::tuple<std::string, std::string, std::int32_t>, std::vector<std::uint32_t>>
        per_thing;
    for (std::size_t i = 0; i < points.labels.size(); ++i) {
        const auto found = by_instance.find(points.instances[i]);
        std::optional<std::size_t> room;
        std::string_view kind;
        if (found != by_instance.end()) {
            room = building.room_of[found->second];
            kind = kind_of_piece(scene, found->second);
        }
        if (!room) room = rooms.room_at(points.cloud.positions[i].cast<double>());
        const std::string name = room ? scene.rooms[*room].id : "room_0";
        const auto index = static_cast<std::uint32_t>(i);
        per_room[name].push_back(index);
        per_thing[{name, std::string(s3dis_class(points.labels[i], kind)), points.instances[i]}]
            .push_back(index);
    }
    std::vector<S3disFile> files;
    files.reserve(per_room.size() + per_thing.size());
    for (auto& [name, indices] : per_room)
        files.push_back({fmt::format("{0}/{0}.txt", name), std::move(indices)});
    std::map<std::pair<std::string, std::string>, int> count;
    for (auto& [key, indices] : per_thing) {
        const auto& [name, kind, instance] = key;
        files.push_back({fmt::format("{}/Annotations/{}_{}.txt", name, kind, ++count[{name, kind}]),
                         std::move(indices)});
    }
    return files;
}

std::string s3dis_text(const PointCloud& cloud, std::span<const std::uint32_t> points) {
    fmt::memory_buffer text;
    for (const std::uint32_t i : points) {
        const Eigen::Vector3f& p = cloud.positions[i];
        const auto& [red, green, blue] = cloud.colors[i];
        fmt::format_to(std::back_inserter(text), "{:.4f} {:.4f} {:.4f} {} {} {}\n", p.x(), p.y(),
                       p.z(), red, green, blue);
    }
    return fmt::to_string(text);
}

}  // namespace roomscribe
