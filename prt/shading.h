// SPDX-License-Identifier: Apache-2.0
// Exit radiance of vertices from distant light and what was baked of them.
//
//     prt/shading.h       Lambertian, baked transfer: albedo sum_lm t_lm L_lm
//     prt/fog_shading.h   the same with fog between environment and vertex, [Zhou07] eq. 27
//     prt/lobe_shading.h  light times visibility times reflectance, clear or in fog
//
// Everything is linear in the light, in the coefficients and in the albedo. Light and visibility of
// few degrees ring, so that single vertices may come out a little negative: that is what the
// coefficients say, and nothing is clamped here. sh/window.h and sh/dering.h quieten a light once,
// and whoever makes a picture cuts off what is left (viewer/mesh_picture.h does). A coefficient, a
// light or an albedo that is not finite makes those vertices that it belongs to NaN or infinite
// and no other; nothing throws.
//
// All functions run in parallel over blocks of 4096 vertices. The result of a vertex depends on its
// own numbers and the light, to the bit, not on threads or on other vertices.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

namespace airlight {

/// Distant light: radiance as coefficients in the world frame of sh/basis.h.
struct ShLight {
    int order = 0;
    std::vector<float> coefficients;  ///< (3, order^2): R, G, B, slots as in sh/index.h
};

/// The light of double coefficients (3, order^2), such as project_latlong()'s or an ShFile's.
ShLight sh_light(int order, const double* coefficients);

/// Coefficients of a run of vertices, (count, order^2), as PrtReader::read gives them.
struct VertexRows {
    int order = 0;
    std::size_t count = 0;
    const float* values = nullptr;
};

/// radiance[v] = albedo sum_lm t_lm L_lm, (count, 3), of rows of transfer (PrtKind::transfer,
/// [Sloan02] sec. 4). The orders of light and transfer may differ: what one of them lacks is 0. A
/// white sky of radiance 1 gives ambient occlusion times the albedo.
///
/// Sums run in float: error under 1e-6 of sum |t L| up to order 13 (a test). Cost on one thread
/// with AVX-512 (bench/shading_bench.cpp), rows in cache: 2.4, 3.8, 4.6 ns per vertex for order 4,
/// 5, 6, three channels, with the vertices in the lanes; 5.3, 6.4, 7.2 with the coefficients in
/// them. AVX2: 2.6, 4.2, 5.6 ns. From memory, 1.3 to 1.7 times the time of reading the rows.
void shade_transfer(const VertexRows& transfer, const ShLight& light, const glm::vec3& albedo,
                    float* radiance);

}  // namespace airlight
