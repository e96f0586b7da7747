// SPDX-License-Identifier: Apache-2.0
#include "viewer/fast.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "prt/ray_packets.h"
#include "viewer/medium_depths.h"

namespace airlight {

FastRenderer::FastRenderer(const World& world, const Plan& plan, const FastMethods& methods)
    : world_(world),
      plan_(plan),
      methods_(methods),
      lamps_(world_, plan_, methods_, built_),
      map_(world_, plan_, methods_, built_) {}

void FastRenderer::trace(FastBlock& block, FastCounts& counts) const {
    const auto& environment = world_.scene().environment;
    const double left =
        environment ? environment->distance : std::numeric_limits<double>::infinity();
    const std::size_t count = block.rays.size();
    counts.rays += count;
    std::vector<PacketHit> found(count);
    if (world_.rays()) {
        auto& [x, y, z, spare, unused] = block.columns;
        for (std::vector<float>* column : {&x, &y, &z}) column->resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            const glm::dvec3& d = block.rays[i].direction;
            x[i] = static_cast<float>(d.x);
            y[i] = static_cast<float>(d.y);
            z[i] = static_cast<float>(d.z);
        }
        find_nearest_packets(*world_.rays(), block.origin, count, x.data(), y.data(), z.data(),
                             found.data());
    }
    block.hits.clear();
    MediumDepths depths(world_.media());
    const bool attenuates = plan_.runs(Effect::attenuation) && !world_.media().empty();
    for (std::size_t i = 0; i < count; ++i) {
        FastRay& ray = block.rays[i];
        ray.meets = found[i].mesh != kNoMesh;
        ray.slow = false;
        ray.distance = left;
        ray.transmittance = glm::dvec3(1);
        if (ray.meets) {
            ray.hit = world_.hit_at(found[i].mesh, found[i].triangle, found[i].u, found[i].v,
                                    block.origin, ray.direction);
            ray.from = world_.lifted(ray.hit);
            ray.distance = ray.hit.distance;
            block.hits.push_back(static_cast<std::uint32_t>(i));
        }
        if (attenuates && (ray.meets || environment)) {
            ++counts[Effect::attenuation];
            ray.transmittance =
                transmittance_of(world_.media().depth(block.origin, ray.direction, ray.distance));
        }
    }
}

void FastRenderer::shade_block(FastBlock& block, LayeredRadiance* out, FastCounts& counts) const {
    trace(block, counts);
    map_.show(block, out);
    map_.light_surfaces(block, out, counts);
    map_.light_media(block, out, counts);
    lamps_.light_surfaces(block, out, counts);
    lamps_.light_media(block, out, counts);
}

void FastRenderer::shade(const glm::dvec3* directions, std::size_t count, LayeredRadiance* out,
                         FastCounts& counts) const {
    FastBlock block;
    block.origin = world_.scene().camera.position;
    for (std::size_t begin = 0; begin < count; begin += FastBlock::kRays) {
        const std::size_t size = std::min(FastBlock::kRays, count - begin);
        block.rays.resize(size);
        for (std::size_t i = 0; i < size; ++i) {
            block.rays[i].direction = directions[begin + i];
            out[begin + i] = LayeredRadiance();
        }
        shade_block(block, out + begin, counts);
    }
}

}  // namespace airlight
