// SPDX-License-Identifier: Apache-2.0
#include "prt/ray_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/interrupt.h"
#include "prt/aim_rays.h"
#include "prt/embree_scene.h"
#include "prt/mesh_io.h"

namespace airlight {
namespace detail {

EmbreeScene::~EmbreeScene() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
}

}  // namespace detail
namespace {

using detail::EmbreeScene;
using detail::kRayPacket;

// Embree takes coordinates up to 1.8e18; its products of three of them must not overflow either.
constexpr double kFarthest = 1e15;
constexpr double kLiftOfDiagonal = 1e-5;
constexpr double kLargestLiftOfDiagonal = 4e-3;

double largest(const glm::dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

float clamped(double value) {
    return static_cast<float>(std::clamp(value, -kFarthest, kFarthest));
}

bool is_float(double value) {
    return std::abs(value) <= std::numeric_limits<float>::max() &&
           static_cast<double>(static_cast<float>(value)) == value;
}

void check_mesh(const Mesh& mesh, const std::string& what) {
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const glm::dvec3& p = mesh.positions[v];
        // Not the other way round, so that NaN is found.
        const bool usable = std::abs(p.x) <= kLargestCoordinate &&
                            std::abs(p.y) <= kLargestCoordinate &&
                            std::abs(p.z) <= kLargestCoordinate;
        if (!usable) {
            throw Error(ErrorCode::data,
                        fmt::format("vertex {} of the {} has a coordinate that is not finite or "
                                    "beyond {}",
                                    v, what, kLargestCoordinate));
        }
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const glm::uvec3 triangle = mesh.triangles[t];
        const std::size_t last = std::max({triangle.x, triangle.y, triangle.z});
        if (last >= mesh.positions.size()) {
            throw Error(ErrorCode::data,
                        fmt::format("triangle {} of the {} names vertex {}, it has {}", t, what,
                                    last, mesh.positions.size()));
        }
    }
}

// The box of all vertices that a triangle uses; of all vertices if there is no triangle.
MeshBounds used_bounds(const Mesh& mesh) {
    if (mesh.triangles.empty()) return mesh_bounds(mesh);
    const glm::dvec3 first = mesh.positions[mesh.triangles[0].x];
    MeshBounds bounds{first, first};
    for (const glm::uvec3& triangle : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3& p = mesh.positions[triangle[corner]];
            bounds.minimum =
                glm::dvec3(std::min(bounds.minimum.x, p.x), std::min(bounds.minimum.y, p.y),
                           std::min(bounds.minimum.z, p.z));
            bounds.maximum =
                glm::dvec3(std::max(bounds.maximum.x, p.x), std::max(bounds.maximum.y, p.y),
                           std::max(bounds.maximum.z, p.z));
        }
    }
    return bounds;
}

bool watch_memory(void* pointer, std::ptrdiff_t bytes, bool post) {
    EmbreeScene& scene = *static_cast<EmbreeScene*>(pointer);
    const std::ptrdiff_t now = scene.bytes += bytes;
    std::ptrdiff_t peak = scene.peak_bytes;
    while (now > peak && !scene.peak_bytes.compare_exchange_weak(peak, now)) {
    }
    // Once it is over the limit Embree gives up at the next call that it makes beforehand.
    if (bytes > 0 && now > 0 && static_cast<std::size_t>(now) > scene.max_memory) {
        scene.over_limit = true;
        return post;
    }
    return true;
}

[[noreturn]] void give_up(const EmbreeScene& scene, RTCError error) {
    if (scene.over_limit) {
        throw Error(ErrorCode::memory,
                    fmt::format("the triangles and their tree need more than {}; --max-memory "
                                "sets the limit",
                                format_bytes(scene.max_memory)));
    }
    switch (error) {
        case RTC_ERROR_OUT_OF_MEMORY:
            throw Error(ErrorCode::memory, "no memory is left for the triangles and their tree");
        case RTC_ERROR_UNSUPPORTED_CPU:
            throw Error(ErrorCode::data, "Embree does not support this processor");
        default:
            throw Error(ErrorCode::data, fmt::format("Embree refused the scene with its error {}",
                                                     static_cast<int>(error)));
    }
}

void check(const EmbreeScene& scene) {
    const RTCError error = rtcGetDeviceError(scene.device);
    if (error != RTC_ERROR_NONE || scene.over_limit) give_up(scene, error);
}

struct GeometryRelease {
    void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using GeometryOwner = std::unique_ptr<RTCGeometryTy, GeometryRelease>;

// Returns how many triangles were too far away to be of use.
std::uint64_t add_mesh(const EmbreeScene& scene, const Mesh& mesh, const glm::dvec3& centre,
                       double scale, unsigned number) {
    if (mesh.triangles.empty()) return 0;
    const GeometryOwner geometry(rtcNewGeometry(scene.device, RTC_GEOMETRY_TYPE_TRIANGLE));
    check(scene);
    auto* positions = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), mesh.positions.size()));
    check(scene);
    auto* triangles = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), mesh.triangles.size()));
    check(scene);
    const auto is_far = [&](std::uint32_t v) {
        return !(largest((mesh.positions[v] - centre) * scale) <= kFarthest);
    };
    for (const glm::dvec3& p : mesh.positions) {
        const glm::dvec3 q = (p - centre) * scale;
        for (int axis = 0; axis < 3; ++axis) *positions++ = clamped(q[axis]);
    }
    std::uint64_t far = 0;
    for (const glm::uvec3& triangle : mesh.triangles) {
        const bool drop = is_far(triangle.x) || is_far(triangle.y) || is_far(triangle.z);
        far += drop ? 1 : 0;
        // A triangle that is a point is never hit.
        for (int corner = 0; corner < 3; ++corner) {
            *triangles++ = triangle[drop ? 0 : corner];
        }
    }
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(scene.scene, geometry.get(), number);
    check(scene);
    return far;
}

// Embree leaves rays alone whose end lies before their beginning.
constexpr float kStopped = -1;

// Rays that meet the ground, sooner or later, are blocked.
void stop_over_ground(float height, std::size_t count, RTCRay* rays) {
    for (std::size_t i = 0; i < count; ++i) {
        if (rays[i].dir_y < 0 || rays[i].org_y < height) rays[i].tfar = kStopped;
    }
}

void end_at_ground(float height, std::size_t count, RTCRay* rays) {
    for (std::size_t i = 0; i < count; ++i) {
        RTCRay& ray = rays[i];
        if (ray.org_y < height) {
            ray.tfar = kStopped;
        } else if (ray.dir_y < 0) {
            ray.tfar = (height - ray.org_y) / ray.dir_y;
        }
    }
}

RayHit to_hit(const RTCRayHit& full, std::size_t number) {
    const RTCHit& hit = full.hit;
    const RTCRay& ray = full.ray;
    const float along = hit.Ng_x * ray.dir_x + hit.Ng_y * ray.dir_y + hit.Ng_z * ray.dir_z;
    return {static_cast<std::uint32_t>(number), hit.geomID, hit.primID, hit.u, hit.v, along < 0};
}

bool is_finite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

RayScene::RayScene(const Mesh& mesh, const std::vector<const Mesh*>& occluders,
                   const RaySceneOptions& options)
    : embree_(std::make_unique<EmbreeScene>()) {
    check_mesh(mesh, "mesh");
    for (std::size_t i = 0; i < occluders.size(); ++i) {
        check_mesh(*occluders[i], fmt::format("occluder {}", i + 1));
    }
    if (options.ground_height && !(std::abs(*options.ground_height) <= kLargestCoordinate)) {
        throw Error(ErrorCode::data, fmt::format("the height of the ground is {}, it must be "
                                                 "finite and within {}",
                                                 *options.ground_height, kLargestCoordinate));
    }

    const MeshBounds bounds = used_bounds(mesh);
    centre_ = 0.5 * bounds.minimum + 0.5 * bounds.maximum;
    const glm::dvec3 half = 0.5 * bounds.maximum - 0.5 * bounds.minimum;
    const double extent = largest(half);
    if (extent > 0) {
        int exponent = 0;
        std::frexp(extent, &exponent);
        scale_ = std::ldexp(1.0, std::clamp(-exponent, -400, 400));
    }
    const glm::dvec3 size = 2.0 * scale_ * half;
    diagonal_ = std::sqrt(size.x * size.x + size.y * size.y + size.z * size.z);
    const bool floats = std::all_of(
        mesh.positions.begin(), mesh.positions.end(),
        [](const glm::dvec3& p) { return is_float(p.x) && is_float(p.y) && is_float(p.z); });
    position_ulp_ =
        floats ? std::numeric_limits<float>::epsilon() : std::numeric_limits<double>::epsilon();
    if (options.ground_height) ground_ = clamped((*options.ground_height - centre_.y) * scale_);

    EmbreeScene& scene = *embree_;
    scene.max_memory = options.max_memory;
    scene.device = rtcNewDevice(nullptr);
    if (!scene.device) give_up(scene, rtcGetDeviceError(nullptr));
    rtcSetDeviceMemoryMonitorFunction(scene.device, watch_memory, &scene);
    scene.scene = rtcNewScene(scene.device);
    check(scene);
    rtcSetSceneFlags(scene.scene, RTC_SCENE_FLAG_ROBUST);
    report_.far_triangles += add_mesh(scene, mesh, centre_, scale_, 0);
    report_.triangles += mesh.triangles.size();
    for (std::size_t i = 0; i < occluders.size(); ++i) {
        report_.far_triangles +=
            add_mesh(scene, *occluders[i], centre_, scale_, static_cast<unsigned>(i + 1));
        report_.triangles += occluders[i]->triangles.size();
    }
    // A signal ends the building of the tree, too (core/interrupt.h).
    rtcSetSceneProgressMonitorFunction(
        scene.scene, [](void*, double) { return noted_signal() == 0; }, nullptr);
    rtcCommitScene(scene.scene);
    throw_if_interrupted();
    check(scene);
    report_.bytes = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, scene.bytes));
    report_.peak_bytes = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, scene.peak_bytes));
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

double RayScene::lift(const glm::dvec3& position) const {
    const double scene_ulps =
        4 * std::numeric_limits<float>::epsilon() * largest((position - centre_) * scale_);
    const double position_ulps = 8 * position_ulp_ * largest(position) * scale_;
    return std::max({kLiftOfDiagonal * diagonal_, scene_ulps,
                     std::min(position_ulps, kLargestLiftOfDiagonal * diagonal_)}) /
           scale_;
}

glm::vec3 RayScene::origin(const glm::dvec3& position, const glm::dvec3& normal) const {
    const glm::dvec3 q = (position - centre_) * scale_ + lift(position) * scale_ * normal;
    return {clamped(q.x), clamped(q.y), clamped(q.z)};
}

glm::vec3 RayScene::point(const glm::dvec3& position) const {
    const glm::dvec3 q = (position - centre_) * scale_;
    return {clamped(q.x), clamped(q.y), clamped(q.z)};
}

// Calls trace(begin, size, rays) for packets of the rays, aimed and checked.
template <class Trace>
void RayScene::for_packets(const glm::vec3& origin, const glm::mat3& frame, std::size_t count,
                           const float* x, const float* y, const float* z,
                           const Trace& trace) const {
    assert(count <= std::numeric_limits<std::uint32_t>::max());
    if (!is_finite(origin)) {
        throw Error(ErrorCode::data, "the origin of rays is not finite");
    }
    alignas(64) RTCRay rays[kRayPacket];
    for (std::size_t i = 0; i < std::min(kRayPacket, count); ++i) {
        rays[i] = {origin.x, origin.y, origin.z, 0, 0, 0, 0, 0, 0, 0xffffffff, 0, 0};
    }
    for (std::size_t begin = 0; begin < count; begin += kRayPacket) {
        const std::size_t size = std::min(kRayPacket, count - begin);
        if (!detail::aim_rays(frame, size, x + begin, y + begin, z + begin, rays)) {
            throw Error(ErrorCode::data, "the direction of a ray is not finite");
        }
        trace(begin, size, rays);
    }
}

std::size_t RayScene::find_blocked(const glm::vec3& origin, const glm::mat3& frame,
                                   std::size_t count, const float* x, const float* y,
                                   const float* z, std::uint32_t* hits) const {
    RTCIntersectContext context = detail::incoherent_context();
    std::size_t found = 0;
    const auto trace = [&](std::size_t begin, std::size_t size, RTCRay* rays) {
        if (ground_) stop_over_ground(*ground_, size, rays);
        {
            const detail::FlushDenormals flush;
            rtcOccluded1M(embree_->scene, &context, rays, static_cast<unsigned>(size),
                          sizeof(RTCRay));
        }
        // Embree marks a hit with an end before the beginning.
        for (std::size_t i = 0; i < size; ++i) {
            hits[found] = static_cast<std::uint32_t>(begin + i);
            found += rays[i].tfar < 0 ? 1 : 0;
        }
    };
    for_packets(origin, frame, count, x, y, z, trace);
    return found;
}

std::size_t RayScene::find_hits(const glm::vec3& origin, const glm::mat3& frame, std::size_t count,
                                const float* x, const float* y, const float* z,
                                RayHit* hits) const {
    RTCIntersectContext context = detail::incoherent_context();
    alignas(64) RTCRayHit full[kRayPacket];
    std::size_t found = 0;
    const auto trace = [&](std::size_t begin, std::size_t size, RTCRay* rays) {
        if (ground_) end_at_ground(*ground_, size, rays);
        for (std::size_t i = 0; i < size; ++i) {
            full[i].ray = rays[i];
            full[i].hit.geomID = RTC_INVALID_GEOMETRY_ID;
            full[i].hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        }
        {
            const detail::FlushDenormals flush;
            rtcIntersect1M(embree_->scene, &context, full, static_cast<unsigned>(size),
                           sizeof(RTCRayHit));
        }
        for (std::size_t i = 0; i < size; ++i) {
            if (full[i].hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
            hits[found++] = to_hit(full[i], begin + i);
        }
    };
    for_packets(origin, frame, count, x, y, z, trace);
    return found;
}

std::optional<RayHit> RayScene::find_nearest(const glm::dvec3& origin, const glm::dvec3& direction,
                                             double distance) const {
    const glm::vec3 o = point(origin), d(direction);
    if (!is_finite(o) || !is_finite(d) || !(distance > 0)) return {};
    RTCRayHit full = {};
    full.ray = {o.x,        o.y, o.z, 0, d.x, d.y, d.z, 0, static_cast<float>(distance * scale_),
                0xffffffff, 0,   0};
    full.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    full.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    {
        const detail::FlushDenormals flush;
        rtcIntersect1(embree_->scene, &context, &full);
    }
    if (full.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return to_hit(full, 0);
}

bool RayScene::is_blocked(const glm::dvec3& from, const glm::dvec3& to) const {
    const glm::vec3 o = point(from), end = point(to);
    const glm::vec3 d = end - o;
    if (!is_finite(o) || !is_finite(d)) return false;
    if (ground_ && (o.y < *ground_ || end.y < *ground_)) return true;
    RTCRay ray = {o.x, o.y, o.z, 0, d.x, d.y, d.z, 0, 1, 0xffffffff, 0, 0};
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    const detail::FlushDenormals flush;
    rtcOccluded1(embree_->scene, &context, &ray);
    return ray.tfar < 0;
}

}  // namespace airlight
