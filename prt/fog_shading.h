// SPDX-License-Identifier: Apache-2.0
// Exit radiance of vertices with fog between them and the environment.
//
// Around each vertex the fog counts as uniform, with the optical depth T averaged over all
// directions ([Zhou07] sec. 4.2; average_depths() below). The light that arrives is then
//     L_lm e^-T (1 + albedo T Lambda_l(T)),   Lambda_l = lambda_l / (T e^-T) of PSF_T, sh/npsf.h,
// per vertex. Methods differ in how they get by without a light per vertex:
//     factored  Lambda_l(T) = Lambda_l(1): [Zhou07] eq. 27. Two fixed lights, L and L * NPSF, and
//               two weights per vertex, e^-T and albedo T e^-T.
//     fittedJ   Lambda_l(T) = sum_j a_j(T) Lambda_l(T_j): J + 1 fixed lights, the a_j fitted over l
//               for each T and tabulated. fitted1 keeps both lights of eq. 27 and mends the weight.
//     bands     a weight for every degree, from the table of sh/psf_bands.h.
//     exact     the same from sh/npsf.h.
// Weights depend on T alone: make them once per medium. Lights are made once per light. Shading
// takes both.
//
// Largest error of the exit radiance over 300 surfaces under four lamps at order 6, relative to the
// mean at that T, against `exact`, which agrees with quadrature of medium/psf.h to 4e-7 (a test);
// time per vertex at order 6, rows in cache, where the clear dot takes 4.6 ns, and of its weights;
// one thread with AVX-512 (bench/shading_bench.cpp):
//     T         0.01    0.1     0.3     1       2       4       10        shading   weights
//     factored  1.6e-2  0.10    0.15    5e-7    0.36    1.1     3.4       6.6 ns    9 ns
//     fitted1   4.8e-3  2.6e-2  3.3e-2  2e-6    4.3e-2  9.8e-2  0.17      6.7 ns    19 ns
//     fitted2   2.5e-4  1e-6    2.6e-3  6.2e-3  5.3e-3  1e-6    1.3e-2    8.8 ns    23 ns
//     fitted3   1.3e-5  1.2e-4  2.7e-4  1.5e-4  6.9e-4  8.2e-4  4.9e-4   10.5 ns    27 ns
//     bands     6e-7    1e-6    2e-6    8e-6    9e-6    4e-6    9e-7      6.1 ns    48 ns
// So `bands` is the most exact and as cheap to shade with as eq. 27 (with AVX2 8.0 ns,
// factored 7.6, clear 5.6): a weight for every degree costs no more than another light. The others
// are for shaders that hold two or four lights and as many weights.
//
// T = 0 gives the clear result, to the bit except for bands and exact, which sum in another order.
// T = inf gives 0. Negative and NaN T give NaN for their vertex.
//
// Deviates: eq. 27 takes Lambda_l at T = 1 for all T. Its scattered light is too weak below and too
// strong beyond, by a third at T = 2 and several times from 4 on.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "core/method_names.h"
#include "medium/gaussian_medium.h"
#include "prt/shading.h"
#include "sh/psf_bands.h"

namespace airlight {

/// The rungs.
enum class FogShadingMethod { factored, fitted1, fitted2, fitted3, bands, exact };

inline constexpr NamedMethod<FogShadingMethod> kFogShadingMethods[] = {
    {FogShadingMethod::factored, "factored"}, {FogShadingMethod::fitted1, "fitted1"},
    {FogShadingMethod::fitted2, "fitted2"},   {FogShadingMethod::fitted3, "fitted3"},
    {FogShadingMethod::bands, "bands"},       {FogShadingMethod::exact, "exact"},
};

/// What fog makes of one light; FogShading::light().
struct FogLight {
    int order = 0;
    bool by_degree = false;           ///< weights are one per degree, not one per light
    std::size_t terms = 0;            ///< weights of a vertex and channel
    std::vector<float> coefficients;  ///< (lights, 3, order^2)
};

/// What fog makes of the light at each vertex; FogShading::weights().
struct FogWeights {
    int channels = 1;  ///< 1 for all of R, G, B, or 3
    std::size_t terms = 0, vertices = 0;
    std::vector<float> values;  ///< (channels, terms, vertices)
};

/// The tables of one method and order. Immutable.
class FogShading {
  public:
    /// order >= 1: that of the lights. Takes 20 to 50 ms but for factored and exact.
    explicit FogShading(int order, FogShadingMethod method = FogShadingMethod::bands);

    int order() const { return order_; }
    FogShadingMethod method() const { return method_; }
    std::size_t terms() const;

    /// A light of the same order.
    FogLight light(const ShLight& light) const;

    /// Weights of `count` vertices with the optical thicknesses (count, channels), channels 1 or 3;
    /// albedo of the medium for each of them, 0 ... 1. Beyond T = 20, where e^-T is 2e-9, tables
    /// hold the shape of their end.
    FogWeights weights(std::size_t count, const float* optical_thickness,
                       const glm::dvec3& albedo = glm::dvec3(1), int channels = 1) const;

  private:
    void fit();
    void vertex_weights(double optical_thickness, double albedo, float* out) const;

    int order_;
    FogShadingMethod method_;
    std::vector<double> nodes_;    // the T_j
    std::vector<double> kernels_;  // (J, order): Lambda_l(T_j)
    std::vector<double> shares_;   // (kShareRows, J): a_j at even steps of T^{1/4}
    std::vector<PsfBands> bands_;  // one for bands, else none
};

/// Exit radiance (count, 3) of rows of transfer in fog; `weights` has their vertices in the same
/// order. Domain and orders as in shade_transfer.
void shade_transfer(const VertexRows& transfer, const FogLight& light, const FogWeights& weights,
                    const glm::vec3& albedo, float* radiance);

/// The averaged optical depth [Zhou07] eq. 26 at each point, in float: average_optical_depth() of
/// medium/average_depth.h with the environment `reach` metres away (blobs end within). NaN where
/// medium, reach or point are outside its domain. For a uniform medium leave out the blobs.
std::vector<float> average_depths(const GaussianMedium& medium, double reach,
                                  const std::vector<glm::dvec3>& points);

}  // namespace airlight
