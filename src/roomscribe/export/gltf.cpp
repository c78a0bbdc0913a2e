// SPDX-License-Identifier: MIT
#include "roomscribe/export/gltf.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "roomscribe/export/wall_openings.hpp"

namespace roomscribe {
namespace {

using Json = nlohmann::ordered_json;

// Numbers that glTF gives to types.
constexpr int type_float = 5126;
constexpr int type_uint32 = 5125;
constexpr int target_vertices = 34962;
constexpr int target_indices = 34963;

/// Corners of faces that share none, so that every face is flat, and the triangles' corners.
struct Mesh {
    std::vector<std::array<float, 3>> positions;
    std::vector<std::uint32_t> indices;

    void add(const SpacePolygon& convex) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        for (const Eigen::Vector3d& p : convex) {
            positions.push_back(
                {static_cast<float>(p.x()), static_cast<float>(p.z()), static_cast<float>(-p.y())});
        }
        for (std::uint32_t i = 1; i + 1 < convex.size(); ++i)
            indices.insert(indices.end(), {first, first + i, first + i + 1});
    }
    void add(const std::vector<SpacePolygon>& pieces) {
        for (const SpacePolygon& piece : pieces)
            add(piece);
    }
};

void add_box(Mesh& mesh, const OrientedBox& box) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto half = [&](std::size_t i) {
            return Eigen::Vector3d(0.5 * box.size(static_cast<Eigen::Index>(i % 3)) *
                                   box.axes[i % 3]);
        };
        for (const double side : {-1.0, 1.0}) {
            const Eigen::Vector3d middle = box.center + side * half(axis);
            const Eigen::Vector3d u = side * half(axis + 1);
            const Eigen::Vector3d v = half(axis + 2);
            mesh.add(SpacePolygon{middle - u - v, middle + u - v, middle + u + v, middle - u + v});
        }
    }
}

/// glTF wants colours by their light, images have them by the eye (sRGB).
double linear(std::uint8_t value) {
    const double share = value / 255.0;
    return share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
}

class GlbWriter {
  public:
    explicit GlbWriter(const Building& building) : building_(building) {
        json_["asset"] = {{"version", "2.0"}, {"generator", "roomscribe"}};
    }

    std::string write() {
        const std::size_t root = add_node("building");
        for (std::size_t i = 0; i < building_.storeys.size(); ++i)
            add_child(root, add_storey(i));
        json_["scene"] = 0;
        json_["scenes"] = Json::array({{{"name", "roomscribe"}, {"nodes", {root}}}});
        return pack();
    }

  private:
    std::size_t add_node(const std::string& name) {
        json_["nodes"].push_back({{"name", name}});
        return json_["nodes"].size() - 1;
    }
    void add_child(std::size_t parent, std::size_t child) {
        json_["nodes"][parent]["children"].push_back(child);
    }

    std::size_t add_storey(std::size_t storey) {
        const std::size_t node = add_node("storey-" + std::to_string(storey + 1));
        for (const std::size_t room : building_.storeys[storey].rooms) {
            const Room& said = building_.scene.rooms[room];
            const std::size_t room_node = add_node(said.id);
            json_["nodes"][room_node]["extras"] = {{"label", "room"},
                                                   {"area", said.area},
                                                   {"volume", said.volume},
                                                   {"floor_height", said.floor_height},
                                                   {"ceiling_height", said.ceiling_height}};
            add_components(room_node, storey, room);
            add_child(node, room_node);
        }
        add_components(node, storey, std::nullopt);
        return node;
    }

    void add_components(std::size_t parent, std::size_t storey, std::optional<std::size_t> room) {
        for (std::size_t i = 0; i < building_.scene.components.size(); ++i) {
            if (building_.storey_of[i] != storey || building_.room_of[i] != room) continue;
            const Mesh mesh = mesh_of(i);
            if (mesh.indices.empty()) continue;
            const Component& component = building_.scene.components[i];
            const std::size_t mesh_index = add_mesh(component, mesh);
            const std::size_t node = add_node(component.id);
            Json& json = json_["nodes"][node];
            json["mesh"] = mesh_index;
            json["extras"] = {{"label", label_name(component.label)},
                              {"kind", component.kind},
                              {"parent", component.parent},
                              {"confidence", component.confidence},
                              {"verdict", verdict_name(component.verdict)}};
            add_child(parent, node);
        }
    }

    Mesh mesh_of(std::size_t index) const {
        const Component& component = building_.scene.components[index];
        Mesh mesh;
        if (component.box) {
            if ((component.box->size.array() > 0.0).all()) add_box(mesh, *component.box);
            return mesh;
        }
        mesh.add(pieces_of_component(building_, index));
        return mesh;
    }

    std::size_t add_mesh(const Component& component, const Mesh& mesh) {
        std::array<float, 3> low = mesh.positions.front();
        std::array<float, 3> high = low;
        for (const auto& position : mesh.positions) {
            for (std::size_t i = 0; i < 3; ++i) {
                low[i] = std::min(low[i], position[i]);
                high[i] = std::max(high[i], position[i]);
            }
        }
        // References into an ordered object end where a key is added to it.
        const std::size_t material_index = material(component.label);
        Json& accessors = json_["accessors"];
        const std::size_t first = accessors.is_null() ? 0 : accessors.size();
        accessors.push_back({{"bufferView", 0},
                             {"byteOffset", positions_.size()},
                             {"componentType", type_float},
                             {"count", mesh.positions.size()},
                             {"type", "VEC3"},
                             {"min", low},
                             {"max", high}});
        accessors.push_back({{"bufferView", 1},
                             {"byteOffset", indices_.size()},
                             {"componentType", type_uint32},
                             {"count", mesh.indices.size()},
                             {"type", "SCALAR"}});
        append(positions_, mesh.positions.data(),
               mesh.positions.size() * sizeof(mesh.positions[0]));
        append(indices_, mesh.indices.data(), mesh.indices.size() * sizeof(mesh.indices[0]));
        json_["meshes"].push_back(
            {{"name", component.id},
             {"primitives", Json::array({{{"attributes", {{"POSITION", first}}},
                                          {"indices", first + 1},
                                          {"material", material_index}}})}});
        return json_["meshes"].size() - 1;
    }

    std::size_t material(Label label) {
        const auto found = materials_.find(label);
        if (found != materials_.end()) return found->second;
        // Glass is seen through, and the lid of a room too.
        const double alpha = label == Label::window ? 0.4 : label == Label::ceiling ? 0.3 : 1.0;
        const auto rgb = label_color(label);
        Json json = {{"name", label_name(label)},
                     {"pbrMetallicRoughness",
                      {{"baseColorFactor", {linear(rgb[0]), linear(rgb[1]), linear(rgb[2]), alpha}},
                       {"metallicFactor", 0.0},
                       {"roughnessFactor", 0.9}}},
                     {"doubleSided", true}};
        if (alpha < 1.0) json["alphaMode"] = "BLEND";
        json_["materials"].push_back(std::move(json));
        return materials_[label] = json_["materials"].size() - 1;
    }

    static void append(std::string& bytes, const void* data, std::size_t size) {
        bytes.append(static_cast<const char*>(data), size);
    }
    static void append_number(std::string& bytes, std::size_t value) {
        for (const unsigned shift : {0U, 8U, 16U, 24U})
            bytes += static_cast<char>((value >> shift) & 0xffU);
    }
    static void append_chunk(std::string& bytes, const char* type, const std::string& content) {
        append_number(bytes, content.size());
        bytes.append(type, 4);
        bytes += content;
    }

    std::string pack() {
        const std::string buffer = positions_ + indices_;
        if (!buffer.empty()) {
            json_["buffers"] = Json::array({{{"byteLength", buffer.size()}}});
            json_["bufferViews"] = Json::array({{{"buffer", 0},
                                                 {"byteOffset", 0},
                                                 {"byteLength", positions_.size()},
                                                 {"byteStride", sizeof(std::array<float, 3>)},
                                                 {"target", target_vertices}},
                                                {{"buffer", 0},
                                                 {"byteOffset", positions_.size()},
                                                 {"byteLength", indices_.size()},
                                                 {"target", target_indices}}});
        }
        std::string text = json_.dump(-1, ' ', false, Json::error_handler_t::replace);
        text.append((4 - text.size() % 4) % 4, ' ');
        std::string chunks;
        append_chunk(chunks, "JSON", text);
        if (!buffer.empty()) append_chunk(chunks, "BIN\0", buffer);
        std::string file = "glTF";
        append_number(file, 2);
        append_number(file, 12 + chunks.size());
        return file + chunks;
    }

    const Building& building_;
    Json json_;
    std::string positions_;
    std::string indices_;
    std::map<Label, std::size_t> materials_;
};

}  // namespace

std::string building_to_glb(const Building& building) {
    return GlbWriter(building).write();
}

}  // namespace roomscribe
