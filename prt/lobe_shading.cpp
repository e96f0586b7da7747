// SPDX-License-Identifier: Apache-2.0
#include "prt/lobe_shading.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "core/error.h"
#include "core/parallel.h"
#include "prt/fog_lights.h"
#include "prt/prt_file.h"
#include "prt/shading_lanes.h"
#include "sh/aligned.h"
#include "sh/basis_batch.h"
#include "sh/index.h"
#include "sh/product_matrix.h"

namespace airlight {
namespace {

using detail::kShadingBlock;
using detail::kShadingTile;

int checked_order(std::size_t order) {
    if (order < 1 || order > static_cast<std::size_t>(kLargestPrtOrder)) {
        throw Error(ErrorCode::usage, "order " + std::to_string(order) +
                                          " of reflectance: it must be from 1 to " +
                                          std::to_string(kLargestPrtOrder));
    }
    return static_cast<int>(order);
}

// A tile of vertices: planes of visibility and reflectance of the shader's order.
class LobeTile {
  public:
    explicit LobeTile(int order)
        : visibility(sh_count(order) * kShadingTile), lobe(visibility.size()), order_(order) {}

    void load_visibility(const VertexRows& rows, std::size_t first, std::size_t count) {
        const std::size_t size = sh_count(rows.order), wanted = sh_count(order_);
        const float* const from = rows.values + first * size;
        if (size <= wanted) {
            detail::rows_to_planes(size, count, from, visibility.data());
            std::fill(visibility.begin() + static_cast<std::ptrdiff_t>(size * kShadingTile),
                      visibility.end(), 0.0f);
        } else {
            wide_.resize(size * kShadingTile);
            detail::rows_to_planes(size, count, from, wide_.data());
            std::copy_n(wide_.begin(), visibility.size(), visibility.begin());
        }
    }

    void load_lobe(const std::vector<float>& eigenvalues, const glm::vec3* axes,
                   std::size_t count) {
        float x[kShadingTile], y[kShadingTile], z[kShadingTile];
        for (std::size_t v = 0; v < kShadingTile; ++v) {
            const glm::vec3 axis = v < count ? axes[v] : glm::vec3(0, 0, 1);
            x[v] = axis.x;
            y[v] = axis.y;
            z[v] = axis.z;
        }
        evaluate_basis_batch(order_, kShadingTile, x, y, z, lobe.data(), kShadingTile);
        detail::scale_planes(order_, eigenvalues.data(), lobe.data());
    }

    AlignedVector<float> visibility, lobe;  // (order^2, kShadingTile)

  private:
    int order_;
    AlignedVector<float> wide_;
};

}  // namespace

LobeShader::LobeShader(const std::vector<double>& eigenvalues, LobeShadingMethod method)
    : order_(checked_order(eigenvalues.size())),
      method_(method),
      eigenvalues_(eigenvalues.begin(), eigenvalues.end()),
      product_(order_) {
    if (method == LobeShadingMethod::matrix) triples_.emplace(order_);
}

void LobeShader::shade(const VertexRows& visibility, const glm::vec3* axes, const ShLight& light,
                       const glm::vec3& reflectance, float* radiance) const {
    if (method_ == LobeShadingMethod::matrix) {
        shade_by_matrix(visibility, axes, light, reflectance, radiance);
        return;
    }
    detail::VertexLights lights;
    lights.order = std::min(order_, light.order);
    lights.lights = light.coefficients.data();
    lights.light_stride = sh_count(light.order);
    lights.albedo = reflectance;
    shade_by_product(visibility, axes, radiance, [&](std::size_t) { return lights; });
}

void LobeShader::shade(const VertexRows& visibility, const glm::vec3* axes, const FogLight& light,
                       const FogWeights& weights, const glm::vec3& reflectance,
                       float* radiance) const {
    assert(weights.vertices == visibility.count);
    shade_by_product(visibility, axes, radiance, [&](std::size_t first) {
        return detail::fog_lights(order_, light, weights, reflectance, first);
    });
}

// lights_from(v) are those of the vertices from number v on.
template <class LightsFrom>
void LobeShader::shade_by_product(const VertexRows& visibility, const glm::vec3* axes,
                                  float* radiance, const LightsFrom& lights_from) const {
    parallel_blocks(visibility.count, kShadingBlock, [&](std::size_t begin, std::size_t end) {
        LobeTile tile(order_);
        for (std::size_t v = begin; v < end; v += kShadingTile) {
            const std::size_t here = std::min(kShadingTile, end - v);
            tile.load_visibility(visibility, v, here);
            tile.load_lobe(eigenvalues_, axes + v, here);
            product_.multiply_planes(kShadingTile, kShadingTile, tile.visibility.data(),
                                     tile.lobe.data(), tile.lobe.data());
            detail::shade_planes(lights_from(v), here, tile.lobe.data(), radiance + 3 * v);
        }
    });
}

void LobeShader::shade_by_matrix(const VertexRows& visibility, const glm::vec3* axes,
                                 const ShLight& light, const glm::vec3& reflectance,
                                 float* radiance) const {
    const std::size_t size = sh_count(order_), light_size = sh_count(light.order);
    std::vector<ShProductMatrix> matrices;
    for (std::size_t c = 0; c < 3; ++c) {
        std::vector<float> channel(size, 0.0f);
        std::copy_n(light.coefficients.begin() + static_cast<std::ptrdiff_t>(c * light_size),
                    std::min(size, light_size), channel.begin());
        matrices.emplace_back(*triples_, channel.data());
    }
    parallel_blocks(visibility.count, kShadingBlock, [&](std::size_t begin, std::size_t end) {
        LobeTile tile(order_);
        std::vector<float> seen(size * kShadingTile), lobe(size * kShadingTile);
        float sums[kShadingTile];
        for (std::size_t v = begin; v < end; v += kShadingTile) {
            const std::size_t here = std::min(kShadingTile, end - v);
            const float* rows = visibility.values + v * size;
            if (visibility.order != order_) {
                tile.load_visibility(visibility, v, here);
                detail::planes_to_rows(size, here, tile.visibility.data(), seen.data());
                rows = seen.data();
            }
            tile.load_lobe(eigenvalues_, axes + v, here);
            detail::planes_to_rows(size, here, tile.lobe.data(), lobe.data());
            for (std::size_t c = 0; c < 3; ++c) {
                matrices[c].integral(here, rows, lobe.data(), sums);
                for (std::size_t i = 0; i < here; ++i) {
                    radiance[3 * (v + i) + c] = reflectance[static_cast<int>(c)] * sums[i];
                }
            }
        }
    });
}

std::vector<glm::vec3> normal_axes(const Mesh& mesh) {
    return {mesh.normals.begin(), mesh.normals.end()};
}

std::vector<glm::vec3> mirrored_axes(const Mesh& mesh, const glm::dvec3& viewer) {
    assert(mesh.normals.size() == mesh.positions.size());
    std::vector<glm::vec3> axes(mesh.positions.size());
    for (std::size_t v = 0; v < axes.size(); ++v) {
        const glm::dvec3 way = viewer - mesh.positions[v];
        const double distance = glm::length(way);
        const glm::dvec3 view = distance > 0 ? way / distance : glm::dvec3(0);
        axes[v] = glm::vec3(2 * glm::dot(mesh.normals[v], view) * mesh.normals[v] - view);
    }
    return axes;
}

}  // namespace airlight
