// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/scanning/ray_caster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

#include "roomscribe/core/error.hpp"

namespace roomscribe {

using Eigen::Vector3d;
using Eigen::Vector3f;

struct RayCaster::Tree {
    RTCDevice device;
    RTCScene scene;

    Tree() : device(rtcNewDevice(nullptr)), scene(device ? rtcNewScene(device) : nullptr) {}
    ~Tree() {
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }
    Tree(const Tree&) = delete;
    Tree& operator=(const Tree&) = delete;
};

RayCaster::RayCaster(const SimulatedWorld& world) : world_(world), tree_(std::make_unique<Tree>()) {
    if (!tree_->scene) throw Error("Embree cannot be started");
    rtcSetSceneFlags(
        tree_->scene,
        static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
    if (!world.triangles.empty()) {
        RTCGeometry mesh = rtcNewGeometry(tree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
        // Copies, because Embree reads a little past the end of a shared vertex buffer.
        void* vertices = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                 sizeof(Vector3f), world.vertices.size());
        void* triangles =
            rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    sizeof(world.triangles.front()), world.triangles.size());
        std::copy(world.vertices.begin(), world.vertices.end(), static_cast<Vector3f*>(vertices));
        std::copy(world.triangles.begin(), world.triangles.end(),
                  static_cast<std::array<std::uint32_t, 3>*>(triangles));
        rtcCommitGeometry(mesh);
        rtcAttachGeometry(tree_->scene, mesh);
        rtcReleaseGeometry(mesh);
    }
    // One thread builds: the tree, and with it the choice among surfaces that coincide, is the same
    // on every run. (Embree's own setting for that would hold back the threads of everyone else.)
    tbb::task_arena(1).execute([&] { rtcCommitScene(tree_->scene); });
    if (rtcGetDeviceError(tree_->device) != RTC_ERROR_NONE) {
        throw Error("Embree cannot build its tree over the world");
    }
}

RayCaster::~RayCaster() = default;

/// An Embree context that a filter can ask what to ignore.
struct RayCaster::Query : RTCIntersectContext {
    const RayCaster* caster = nullptr;
    const std::function<bool(std::uint32_t part)>* ignores = nullptr;

    Query() : RTCIntersectContext{} { rtcInitIntersectContext(this); }

    static void reject_ignored(const RTCFilterFunctionNArguments* arguments) {
        const auto* query = static_cast<const Query*>(arguments->context);
        const std::uint32_t triangle = RTCHitN_primID(arguments->hit, arguments->N, 0);
        const std::uint32_t part = query->caster->world_.part_of_triangle[triangle];
        if ((*query->ignores)(part)) arguments->valid[0] = 0;
    }
};

std::optional<RayHit> RayCaster::cast(const Vector3d& origin, const Vector3d& direction,
                                      double min_distance) const {
    Query query;
    return run(query, origin, direction, min_distance);
}

std::optional<RayHit> RayCaster::cast_past(const std::function<bool(std::uint32_t part)>& ignores,
                                           const Vector3d& origin, const Vector3d& direction,
                                           double min_distance) const {
    Query query;
    query.caster = this;
    query.ignores = &ignores;
    query.filter = &Query::reject_ignored;
    return run(query, origin, direction, min_distance);
}

std::optional<RayHit> RayCaster::run(Query& query, const Vector3d& origin,
                                     const Vector3d& direction, double min_distance) const {
    RTCRayHit ray{};
    ray.ray.org_x = static_cast<float>(origin.x());
    ray.ray.org_y = static_cast<float>(origin.y());
    ray.ray.org_z = static_cast<float>(origin.z());
    ray.ray.dir_x = static_cast<float>(direction.x());
    ray.ray.dir_y = static_cast<float>(direction.y());
    ray.ray.dir_z = static_cast<float>(direction.z());
    ray.ray.tnear = static_cast<float>(min_distance);
    ray.ray.tfar = std::numeric_limits<float>::infinity();
    ray.ray.mask = ~0U;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(tree_->scene, &query, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;

    RayHit hit;
    hit.distance = static_cast<double>(ray.ray.tfar);
    hit.triangle = ray.hit.primID;
    hit.part = world_.part_of_triangle[hit.triangle];
    const Vector3d normal =
        Vector3f(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z).cast<double>().normalized();
    const double cosine = -normal.dot(direction);
    hit.cosine = std::abs(cosine);
    hit.normal = (cosine < 0.0 ? Vector3d(-normal) : normal).cast<float>();
    return hit;
}

}  // namespace roomscribe
