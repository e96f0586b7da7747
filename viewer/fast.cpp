// SPDX-License-Identifier: Apache-2.0
#include "viewer/fast.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "prt/ray_packets.h"

namespace airlight {
namespace {

bool meets_slab(const SceneSlabs& slabs, const glm::dvec3& origin, const FastRay& ray) {
    for (const Slab& slab : slabs.all()) {
        const auto entry = entry_of(slab.box, origin, ray.direction);
        if (entry && entry->distance < ray.distance) return true;
    }
    return false;
}

}  // namespace

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
    block.paths.clear();
    const SceneSlabs& slabs = world_.slabs();
    const bool refracts = plan_.runs(Effect::slab) && !slabs.empty();
    const bool attenuates = plan_.runs(Effect::attenuation) && !world_.media().empty();
    for (std::size_t i = 0; i < count; ++i) {
        FastRay& ray = block.rays[i];
        ray.meets = found[i].mesh != kNoMesh;
        ray.distance = left;
        ray.transmittance = glm::dvec3(1);
        ray.bent = false;
        if (ray.meets) {
            ray.hit = world_.hit_at(found[i].mesh, found[i].triangle, found[i].u, found[i].v,
                                    block.origin, ray.direction);
            ray.triangle = found[i].triangle;
            ray.u = found[i].u;
            ray.v = found[i].v;
            ray.from = world_.lifted(ray.hit);
            ray.distance = ray.hit.distance;
        }
        if (refracts && (slabs.at(block.origin) || meets_slab(slabs, block.origin, ray))) {
            ray.bent = true;
            trace_bent(ray, block, counts);
            if (ray.meets) block.hits.push_back(static_cast<std::uint32_t>(i));
            continue;
        }
        if (ray.meets) block.hits.push_back(static_cast<std::uint32_t>(i));
        if (attenuates && (ray.meets || environment)) {
            ++counts[Effect::attenuation];
            ray.transmittance =
                transmittance_of(world_.media().depth(block.origin, ray.direction, ray.distance));
        }
    }
}

// What it ends at, as the last of its pieces has it; the pieces before go to block.paths.
void FastRenderer::trace_bent(FastRay& ray, FastBlock& block, FastCounts& counts) const {
    ++counts[Effect::slab];
    RayPath path = follow_ray(world_, block.origin, ray.direction, plan_.runs(Effect::attenuation));
    counts.shadow_rays += path.rays;
    ray.direction = path.pieces.back().direction;
    ray.distance = path.pieces.back().distance;
    ray.transmittance = path.throughput;
    ray.meets = path.hit.has_value();
    if (ray.meets) {
        ray.hit = *path.hit;
        ray.from = world_.lifted(ray.hit);
    }
    block.paths.push_back(std::move(path));
}

// Media along the pieces of bent rays.
void FastRenderer::light_bent(FastBlock& block, const RaySums& out, FastCounts& counts) const {
    if (block.paths.empty()) return;
    auto path = block.paths.begin();
    FastBlock single;
    single.rays.resize(1);
    for (std::size_t i = 0; i < block.rays.size(); ++i) {
        if (!block.rays[i].bent) continue;
        for (const RayPiece& piece : path->pieces) {
            if (!(largest(piece.throughput) > 0)) continue;
            if (piece.slab) {
                for (std::size_t lamp = 0; lamp < world_.scene().lights.size(); ++lamp) {
                    if (!plan_.lights[lamp].airlight_point) continue;
                    out[i][RadianceLayer::airlight_point] +=
                        piece.throughput * lamps_.light_slab(lamp, piece, counts);
                }
                out[i][RadianceLayer::airlight_environment] +=
                    piece.throughput * map_.light_slab(piece, counts);
                continue;
            }
            if (world_.media().empty()) continue;
            single.origin = piece.origin;
            single.rays[0] = FastRay();
            single.rays[0].direction = piece.direction;
            single.rays[0].distance = piece.distance;
            single.rays[0].meets = &piece != &path->pieces.back() || path->hit;
            single.write_columns();
            LayeredRadiance sent;
            const RaySums sum{&sent, {}};
            lamps_.light_media(single, sum, counts);
            lamps_.light_particles(single, sum, counts);
            map_.light_media(single, sum, counts);
            for (std::size_t l = 0; l < kRadianceLayerCount; ++l) {
                out[i].layers[l] += piece.throughput * sent.layers[l];
            }
        }
        ++path;
    }
}

void FastRenderer::shade_block(FastBlock& block, const RaySums& out, FastCounts& counts) const {
    trace(block, counts);
    block.write_columns();
    map_.show(block, out);
    map_.light_surfaces(block, out, counts);
    map_.light_media(block, out, counts);
    lamps_.light_surfaces(block, out, counts);
    lamps_.light_media(block, out, counts);
    lamps_.light_particles(block, out, counts);
    light_bent(block, out, counts);
}

void FastRenderer::shade(const glm::dvec3* directions, std::size_t count, std::size_t together,
                         LayeredRadiance* out, FastCounts& counts) const {
    std::fill_n(out, count, LayeredRadiance());
    FastBlock block;
    block.origin = world_.scene().camera.position;
    RaySums sums;
    sums.sums = out;
    std::size_t sum = 0, in_sum = 0;
    for (std::size_t begin = 0; begin < count * together; begin += FastBlock::kRays) {
        const std::size_t size = std::min(FastBlock::kRays, count * together - begin);
        block.rays.resize(size);
        for (std::size_t i = 0; i < size; ++i) {
            block.rays[i].direction = directions[begin + i];
            sums.number[i] = static_cast<std::uint32_t>(sum);
            if (++in_sum < together) continue;
            in_sum = 0;
            ++sum;
        }
        shade_block(block, sums, counts);
    }
}

}  // namespace airlight
