// SPDX-License-Identifier: Apache-2.0
// The loops of shading in SIMD lanes, one vertex in each.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>

namespace airlight::detail {

/// Vertices whose coefficients lie in planes at once, and those of a task.
inline constexpr std::size_t kShadingTile = 64;
inline constexpr std::size_t kShadingBlock = 64 * kShadingTile;

/// What a run of vertices is shaded with:
///     radiance[v][c] = albedo[c] sum_j w_cj[v] sum_{k < order^2} row_v[k] lights[j][c][k]
/// or, with a weight for every degree l of k, one light and
///     radiance[v][c] = albedo[c] sum_k w_cl[v] row_v[k] light[c][k].
struct VertexLights {
    int order = 0;                  ///< degrees that count, those of both light and rows
    const float* lights = nullptr;  ///< (lights, 3, light_stride)
    std::size_t light_stride = 0;
    std::size_t terms = 1;  ///< weights of a vertex: lights, 1 ... 4, or degrees
    bool by_degree = false;
    const float* weights = nullptr;  ///< (weight_channels, terms, weight_stride); null: all 1
    std::size_t weight_channels = 1, weight_stride = 0;
    glm::vec3 albedo{1};
};

/// Of rows `stride` >= order^2 floats apart into radiance (count, 3). A vertex depends on its own
/// numbers alone.
void shade_rows(const VertexLights& lights, std::size_t stride, std::size_t count,
                const float* rows, float* radiance);

/// The same of aligned planes (order^2, kShadingTile), count <= kShadingTile.
void shade_planes(const VertexLights& lights, std::size_t count, const float* planes,
                  float* radiance);

/// planes[k * kShadingTile + v] = rows[v * size + k]; 0 for v from count to kShadingTile.
void rows_to_planes(std::size_t size, std::size_t count, const float* rows, float* planes);

/// The reverse, for the first `count` vertices.
void planes_to_rows(std::size_t size, std::size_t count, const float* planes, float* rows);

/// planes[k * kShadingTile + v] *= factors[l of k].
void scale_planes(int order, const float* factors, float* planes);

}  // namespace airlight::detail
