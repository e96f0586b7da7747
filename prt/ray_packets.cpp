// SPDX-License-Identifier: Apache-2.0
#include "prt/ray_packets.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "prt/embree_scene.h"

namespace airlight {
namespace {

constexpr std::size_t kPacket = 16;

RTCIntersectContext coherent_context() {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    return context;
}

void clear(RTCRay16& rays) {
    for (std::size_t i = 0; i < kPacket; ++i) {
        rays.tnear[i] = 0;
        rays.time[i] = 0;
        rays.mask[i] = 0xffffffff;
        rays.id[i] = 0;
        rays.flags[i] = 0;
    }
}

}  // namespace

void find_nearest_packets(const RayScene& scene, const glm::dvec3& origin, std::size_t count,
                          const float* x, const float* y, const float* z, PacketHit* hits) {
    const glm::vec3 o = scene.point(origin);
    RTCIntersectContext context = coherent_context();
    alignas(64) RTCRayHit16 packet;
    alignas(64) int valid[kPacket];
    clear(packet.ray);
    const detail::FlushDenormals flush;
    for (std::size_t begin = 0; begin < count; begin += kPacket) {
        const std::size_t size = std::min(kPacket, count - begin);
        for (std::size_t i = 0; i < kPacket; ++i) {
            const std::size_t k = begin + std::min(i, size - 1);
            packet.ray.org_x[i] = o.x;
            packet.ray.org_y[i] = o.y;
            packet.ray.org_z[i] = o.z;
            packet.ray.dir_x[i] = x[k];
            packet.ray.dir_y[i] = y[k];
            packet.ray.dir_z[i] = z[k];
            packet.ray.tfar[i] = std::numeric_limits<float>::infinity();
            packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
            packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
            valid[i] = i < size ? -1 : 0;
        }
        rtcIntersect16(valid, scene.embree().scene, &context, &packet);
        for (std::size_t i = 0; i < size; ++i) {
            const bool met = packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
            hits[begin + i] = {met ? packet.hit.geomID[i] : kNoMesh, packet.hit.primID[i],
                               packet.hit.u[i], packet.hit.v[i],
                               static_cast<float>(packet.ray.tfar[i] / scene.scale())};
        }
    }
}

void find_blocked_packets(const RayScene& scene, std::size_t count, const glm::dvec3* from,
                          const glm::dvec3& to, std::uint8_t* blocked) {
    const glm::vec3 end = scene.point(to);
    RTCIntersectContext context = coherent_context();
    alignas(64) RTCRay16 packet;
    alignas(64) int valid[kPacket];
    clear(packet);
    const detail::FlushDenormals flush;
    for (std::size_t begin = 0; begin < count; begin += kPacket) {
        const std::size_t size = std::min(kPacket, count - begin);
        for (std::size_t i = 0; i < kPacket; ++i) {
            const glm::vec3 o = scene.point(from[begin + std::min(i, size - 1)]);
            const glm::vec3 d = end - o;
            packet.org_x[i] = o.x;
            packet.org_y[i] = o.y;
            packet.org_z[i] = o.z;
            packet.dir_x[i] = d.x;
            packet.dir_y[i] = d.y;
            packet.dir_z[i] = d.z;
            packet.tfar[i] = 1;
            valid[i] = i < size && std::isfinite(d.x + d.y + d.z) ? -1 : 0;
        }
        rtcOccluded16(valid, scene.embree().scene, &context, &packet);
        for (std::size_t i = 0; i < size; ++i) {
            blocked[begin + i] = valid[i] != 0 && packet.tfar[i] < 0 ? 1 : 0;
        }
    }
}

}  // namespace airlight
