// SPDX-License-Identifier: Apache-2.0
#include "viewer/fast_map.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/constants.h"
#include "sh/basis.h"
#include "sh/index.h"
#include "sh/lobes.h"
#include "sh/phase_psf.h"
#include "sh/project.h"
#include "viewer/environment_sampler.h"

namespace airlight {
namespace {

constexpr int kMapOrder = 32;
constexpr int kDepthLevels = 6;

// The order at which a lobe's eigenvalues are under 1e-3 of the first, about, and nodes of a table
// that follows it.
int order_of(double exponent) {
    return std::clamp(static_cast<int>(6 + 3 * std::sqrt(exponent)), 9, kMapOrder);
}
int nodes_of(int order) {
    return 4 * order + 1;
}

int order_of(FastSurfaceMap method) {
    switch (method) {
        case FastSurfaceMap::order3:
            return 3;
        case FastSurfaceMap::order4:
            return 4;
        case FastSurfaceMap::order6:
            return 6;
        case FastSurfaceMap::order8:
            return 8;
        case FastSurfaceMap::order32:
            break;
    }
    return kMapOrder;
}

}  // namespace

SphereTable filtered_map(const std::vector<double>& bands, int order, int nodes,
                         const std::vector<double>& factors) {
    const std::size_t count = sh_count(order), all = bands.size() / 3;
    std::vector<double> coefficients(3 * count), basis(count);
    for (std::size_t c = 0; c < 3; ++c) {
        for (int l = 0; l < order; ++l) {
            for (int m = -l; m <= l; ++m) {
                const std::size_t slot = sh_index(l, m);
                coefficients[c * count + slot] =
                    bands[c * all + slot] *
                    factors[c * static_cast<std::size_t>(order) + static_cast<std::size_t>(l)];
            }
        }
    }
    return SphereTable(nodes, [&](const glm::dvec3& d) {
        evaluate_basis(order, d.x, d.y, d.z, basis.data());
        glm::dvec3 sum(0);
        for (int c = 0; c < 3; ++c) {
            const double* const row = coefficients.data() + static_cast<std::size_t>(c) * count;
            for (std::size_t k = 0; k < count; ++k) sum[c] += basis[k] * row[k];
            sum[c] = std::max(sum[c], 0.0);
        }
        return sum;
    });
}

FastMap::FastMap(const World& world, const Plan& plan, const FastMethods& methods,
                 FastCounts& counts)
    : world_(world), plan_(plan), methods_(methods) {
    if (!world.sampler()) return;
    const bool media = plan.runs(Effect::airlight_environment) && !world.media().empty();
    const bool surfaces = plan.runs(Effect::surface_environment) && !world.scene().objects.empty();
    if (!media && !surfaces) return;
    const Image& map = world.sampler()->map();
    bands_ = project_latlong(map.pixels.data(), map.height, map.width, 3, kMapOrder);
    for (double& value : bands_) value *= world.scene().environment->scale;
    ++counts.tables;
    for (const MediumPart& part : world.media().parts()) {
        if (part.everywhere()) {
            uniform_ += *part.everywhere();
        } else {
            limited_ = true;
        }
    }
    if (limited_) {
        grid_ = MediumGrid(world, world.scene().environment->distance, plan.runs(Effect::shafts));
        limited_albedo_ = grid_.albedo();
        ++counts.tables;
    }
    if (media) build_media(counts);
    if (surfaces) build_surfaces(counts);
}

// A lobe's table for each depth of limited media: that much less of the map and of what endless
// media scatter, and the limited ones' own light, which is even.
void FastMap::build_surfaces(FastCounts& counts) {
    const double distance = world_.scene().environment->distance;
    const int most = order_of(methods_.surface_map);
    std::vector<double> exponents;  // 0: diffuse
    const auto lobe_number = [&](double exponent) {
        const auto found = std::find(exponents.begin(), exponents.end(), exponent);
        const auto number = static_cast<std::size_t>(found - exponents.begin());
        if (found == exponents.end()) exponents.push_back(exponent);
        return number;
    };
    for (std::size_t i = 0; i < world_.scene().objects.size(); ++i) {
        const SurfaceLobes lobes = lobes_of(world_.material(i));
        materials_.push_back(lobes);
        baked_.emplace_back();
        if (plan_.runs(Effect::product_dot) || plan_.runs(Effect::product_triple)) {
            baked_.back() =
                FastTransfer(world_, plan_, i, lobes, bands_, endless_bands(distance, kMapOrder));
            if (!baked_.back().diffuse.empty()) ++counts.tables;
        }
        diffuse_lobe_.push_back(lobe_number(0));
        const bool glossy = lobes.glossy() && plan_.objects[i].glossy;
        glossy_lobe_.push_back(glossy ? lobe_number(std::max(lobes.exponent, 1e-3)) : kNoLobe);
    }
    depth_levels_ = {0};
    if (limited_ && plan_.runs(Effect::attenuation)) {
        for (int k = 1; k < kDepthLevels; ++k) {
            const double step = double(k) / (kDepthLevels - 1);
            depth_levels_.push_back(std::max(1e-6, grid_.deepest()) * step * step);
        }
    }
    for (const double exponent : exponents) {
        const int order = std::min(order_of(exponent), most);
        std::vector<double> lobe = exponent > 0
                                       ? phong_eigenvalues(exponent, order, LobeScale::integral)
                                       : clamped_cosine_eigenvalues(order);
        if (!(exponent > 0)) {
            for (double& value : lobe) value /= kPi;
        }
        const std::vector<double> endless = endless_bands(distance, order);
        std::vector<SphereTable> tables;
        for (const double level : depth_levels_) {
            std::vector<double> factors = endless;
            for (std::size_t i = 0; i < factors.size(); ++i) {
                factors[i] *= std::exp(-level) * lobe[i % static_cast<std::size_t>(order)];
            }
            for (int c = 0; c < 3 && level > 0; ++c) {
                factors[static_cast<std::size_t>(c * order)] +=
                    limited_albedo_[c] * -std::expm1(-level) *
                    std::exp(-level - uniform_[c] * distance) * lobe[0];
            }
            tables.push_back(filtered_map(bands_, order, nodes_of(order), factors));
            ++counts.tables;
        }
        lobes_.push_back(std::move(tables));
    }
}

// e^-T and what media that are the same everywhere scatter, (3, order).
std::vector<double> FastMap::endless_bands(double distance, int order) const {
    std::vector<double> bands(3 * static_cast<std::size_t>(order), 1);
    const bool attenuates = plan_.runs(Effect::attenuation);
    for (int c = 0; c < 3; ++c) {
        const double t = uniform_[c] * distance;
        double* const row = bands.data() + c * order;
        for (int l = 0; l < order; ++l) row[l] = attenuates ? std::exp(-t) : 1;
        for (const MediumPart& part : world_.media().parts()) {
            if (!part.everywhere() || !(t > 0)) continue;
            const double own = part.albedo()[c] * (*part.everywhere())[c] * distance;
            if (!(own > 0) || !(t < 700)) continue;
            const std::vector<double> psf = psf_eigenvalues_scaled(t, part.phase(), order);
            for (int l = 0; l < order; ++l) {
                row[l] += own * std::exp(-t) * psf[static_cast<std::size_t>(l)];
            }
        }
    }
    return bands;
}

glm::dvec3 FastMap::of_lobe(std::size_t lobe, const glm::dvec3& to_map,
                            const glm::vec3& mean_depth) const {
    const std::vector<SphereTable>& tables = lobes_[lobe];
    if (tables.size() == 1) return tables[0](to_map);
    const auto at = [&](double depth) {
        const double top = depth_levels_.back();
        const double place = std::sqrt(std::clamp(depth / top, 0.0, 1.0)) * (kDepthLevels - 1);
        const std::size_t k = std::min(static_cast<std::size_t>(place), tables.size() - 2);
        const double low = depth_levels_[k], high = depth_levels_[k + 1];
        const double part = std::clamp((depth - low) / (high - low), 0.0, 1.0);
        return (1 - part) * tables[k](to_map) + part * tables[k + 1](to_map);
    };
    const glm::dvec3 first = at(double(mean_depth.x));
    if (mean_depth.x == mean_depth.y && mean_depth.x == mean_depth.z) return first;
    return {first.x, at(double(mean_depth.y)).y, at(double(mean_depth.z)).z};
}

void FastMap::light_surfaces(FastBlock& block, const RaySums& out, FastCounts& counts) const {
    if (lobes_.empty()) return;
    for (const std::uint32_t i : block.hits) {
        const FastRay& ray = block.rays[i];
        ++counts[Effect::surface_environment];
        const std::size_t object = ray.hit.object;
        const glm::vec3 depth =
            depth_levels_.size() > 1 ? grid_(ray.hit.position).mean_depth : glm::vec3(0);
        const SurfaceLobes& lobes = materials_[object];
        const EnvironmentSampler& map = *world_.sampler();
        glm::dvec3 sent(0);
        const FastTransfer& baked = baked_[object];
        // A bent ray's place in the triangle is not kept.
        const bool by_vertex = !baked.diffuse.empty() && !ray.bent;
        const auto between = [&](const std::vector<glm::vec3>& values) {
            const glm::uvec3 corner = world_.meshes()[object].triangles[ray.triangle];
            return glm::dvec3((1 - ray.u - ray.v) * values[corner.x] + ray.u * values[corner.y] +
                              ray.v * values[corner.z]) *
                   transmittance_of(glm::dvec3(depth));
        };
        if (by_vertex) {
            sent += between(baked.diffuse);
            ++counts[Effect::product_dot];
            ++counts[Effect::shadow_prt];
        } else if (lobes.diffuse != glm::dvec3(0)) {
            sent +=
                lobes.diffuse * of_lobe(diffuse_lobe_[object], map.to_map(ray.hit.normal), depth);
        }
        if (by_vertex && !baked.specular.empty()) {
            sent += between(baked.specular);
            ++counts[Effect::product_triple];
        } else if (glossy_lobe_[object] != kNoLobe) {
            const glm::dvec3 mirrored =
                ray.direction - 2 * glm::dot(ray.hit.normal, ray.direction) * ray.hit.normal;
            sent += lobes.specular * of_lobe(glossy_lobe_[object], map.to_map(mirrored), depth);
            ++counts[Effect::brdf_glossy];
        }
        out[i][RadianceLayer::surface_environment] += ray.transmittance * sent;
    }
}

void FastMap::show(FastBlock& block, const RaySums& out) const {
    if (!world_.sampler()) return;
    for (std::size_t i = 0; i < block.rays.size(); ++i) {
        const FastRay& ray = block.rays[i];
        if (ray.meets) continue;
        out[i][RadianceLayer::direct] += ray.transmittance * world_.environment(ray.direction);
    }
}

}  // namespace airlight
