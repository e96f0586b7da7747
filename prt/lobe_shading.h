// SPDX-License-Identifier: Apache-2.0
// Exit radiance of vertices as the triple product of light, visibility and reflectance,
//     <L|V|B> = int L V B d omega,  B = f max(0, n omega),
// for reflectances that follow the viewer ([Zhou07] eq. 20; [Ng04]). All three are cut off at the
// shader's order n; beyond that the result is exact: that of the band-limited functions.
//
// A lobe is zonal about an axis, given by its eigenvalues (sh/lobes.h): the clamped cosine over pi
// about the normal is Lambert's, (n+1) / (2 pi) cos^n about the mirrored direction of view Phong's
// with the foreshortening in it, as in medium/surface_shading.h. V cuts off what of the lobe is
// under the horizon. Tabulated BRDFs are BrdfShader's.
//
// Visibility and transfer agree where the lobe is Lambert's but for the truncation of V to n:
// transfer has the cosine multiplied in before it is cut off.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "core/method_names.h"
#include "prt/fog_shading.h"
#include "prt/mesh.h"
#include "prt/shading.h"
#include "sh/brdf.h"
#include "sh/product.h"
#include "sh/triple_product.h"

namespace airlight {

/// The rungs; both give the same number but for rounding (sh/product.h, sh/product_matrix.h). Cost
/// per vertex of order 4, 5, 6, three channels, the lobe's coefficients included, one thread with
/// AVX-512 (bench/shading_bench.cpp):
///     product   11, 27, 53 ns     in fog by bands 1 ns more, for a light of any kind
///     matrix    36, 64, 101 ns    one channel alone would take about a third
/// with AVX2 16, 37, 63 and 38, 70, 120 ns.
enum class LobeShadingMethod {
    product,  ///< V B per vertex (sh/product.h), then dots with R, G, B and with all lights of fog
    matrix,   ///< B (M V) with the product matrices M of R, G and B (sh/product_matrix.h)
};

inline constexpr NamedMethod<LobeShadingMethod> kLobeShadingMethods[] = {
    {LobeShadingMethod::product, "product"}, {LobeShadingMethod::matrix, "matrix"}};

/// One lobe for all vertices. Immutable.
class LobeShader {
  public:
    /// The order is the number of eigenvalues, 1 ... 32. Throws Error(usage) for others.
    explicit LobeShader(const std::vector<double>& eigenvalues,
                        LobeShadingMethod method = LobeShadingMethod::product);

    int order() const { return order_; }

    /// radiance (count, 3) = reflectance <L|V_v|B about axes[v]>. Rows are PrtKind::visibility of
    /// any order; axes of any length but 0, one that is not finite makes its vertex NaN.
    void shade(const VertexRows& visibility, const glm::vec3* axes, const ShLight& light,
               const glm::vec3& reflectance, float* radiance) const;

    /// The same in fog. Always by products.
    void shade(const VertexRows& visibility, const glm::vec3* axes, const FogLight& light,
               const FogWeights& weights, const glm::vec3& reflectance, float* radiance) const;

  private:
    template <class LightsFrom>
    void shade_by_product(const VertexRows& visibility, const glm::vec3* axes, float* radiance,
                          const LightsFrom& lights_from) const;
    void shade_by_matrix(const VertexRows& visibility, const glm::vec3* axes, const ShLight& light,
                         const glm::vec3& reflectance, float* radiance) const;

    int order_;
    LobeShadingMethod method_;
    std::vector<float> eigenvalues_;
    ShProduct product_;
    std::optional<TripleProducts> triples_;  // of matrix
};

/// A tabulated BRDF, from its bands (sh/brdf_bands.h) at even steps of the viewer's angle, linear
/// in between, turned into the frame of each vertex. Immutable. Cost per vertex of order 4, 5, 6:
/// 1.9, 3.1, 4.7 us, of which most builds the rotation. Error for a metal of roughness 0.5 at order
/// 4: 2e-3 of a light of coefficients up to 1, held by a test.
class BrdfShader {
  public:
    /// order 1 ... 32, or Error(usage). Takes `angles` calls of BrdfBands::coefficients of order
    /// 32 or more.
    explicit BrdfShader(int order, const BrdfTable& table, int angles = 64);

    int order() const { return order_; }

    /// radiance (count, 3); normals and directions to the viewer are unit. A viewer below the
    /// horizon of a vertex counts as one at it, for vertices beside a silhouette.
    void shade(const VertexRows& visibility, const glm::vec3* normals, const glm::vec3* to_viewer,
               const ShLight& light, float* radiance) const;

  private:
    void reflectance(const glm::vec3& normal, const glm::vec3& to_viewer, float* out) const;

    int order_;
    int angles_;
    std::vector<double> bands_;  // (angles, 3, order^2)
    ShProduct product_;
};

/// The normals of a mesh as axes.
std::vector<glm::vec3> normal_axes(const Mesh& mesh);

/// 2 (n v) n - v with v the unit vector from each vertex to `viewer`; 0 where both coincide.
std::vector<glm::vec3> mirrored_axes(const Mesh& mesh, const glm::dvec3& viewer);

}  // namespace airlight
