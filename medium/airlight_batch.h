// SPDX-License-Identifier: Apache-2.0
// Airlight of many rays at once, in float vectors of the widest kind that the CPU has.
#pragma once

#include <cstddef>
#include <vector>

namespace airlight {

/// out[i] = airlight(gamma[i], t_sv[i], t_vp[i]) for i < count: meaning, domain and corners of
/// airlight() in medium/airlight.h, over the whole range of float.
///
/// Structure of arrays, each of `count` floats, of any alignment. `out` may be one of the inputs
/// but must not overlap them in any other way. Element i depends on the inputs i alone, not on its
/// place nor on count.
///
/// Accuracy: relative 5.5e-6 of airlight() in double at the same inputs (measured on every SIMD
/// target over the domain, denormals and segments of 1e-12 of the distance to the light included;
/// 3.9e-6 on the sets of bench/batch_bench.cpp), or the least denormal. Targets with fused
/// multiply-add (AVX2 and up) agree to the bit with each other, and so do those without (SSE4,
/// SSSE3, scalar); the two kinds differ within that error.
///
/// Cost per ray, one thread: 7.3 ns with AVX2, 5.3 ns with AVX-512, 18 ns with SSE4, where march64
/// takes 485 ns (51 ns in AVX2 vectors) and airlight() in double 120 to 150. A gamma below 2^-30 or
/// a thickness outside [2^-40, 2^40] costs a scalar call, but t_vp = inf does not.
///
/// The infinite ray is a rational fit (medium/make_ray_integral_fit.py), the finite one the
/// difference of two, and where that would cancel a four-point rule; all lanes do all of it.
void airlight_batch(std::size_t count, const float* gamma, const float* t_sv, const float* t_vp,
                    float* out);

/// The same of parts of rays, as their viewers see them: out[i] = e^(-extinction begin)
/// airlight(gamma, extinction d, extinction length), where the lamp stands `height` off the line of
/// the ray, `foot` ahead of the beginning of the part, in (-inf, inf): gamma = atan2(height, foot),
/// d^2 = height^2 + foot^2. `begin` in [0, inf) is where the part begins on the ray. No angle is
/// computed. Relative error 6e-6, and that of rounding the thickness of the way, 1.3e-5 where e^-80
/// is left; the rest as above.
void airlight_parts_batch(std::size_t count, float extinction, const float* foot,
                          const float* height, const float* begin, const float* length, float* out);

/// The same through a table of size x size floats, bilinear, instead of the fit.
///
/// It holds H(y, theta, inf) (y + 2) (medium/ray_integral.h) over sqrt(y / (y + 2)) and cos(theta),
/// y = 2 T sin(gamma / 2), cos(theta) = sin(gamma / 2): every thickness and angle has its place,
/// and the warps cost one square root, where those of WarpedAirlightTable take cube roots and
/// angles.
///
/// Accuracy at sizes 32, 64, 128: relative 3.0e-3, 1.0e-3, 3.2e-4 over the domain of float (at 64
/// 5e-4 on the sets of bench/batch_bench.cpp). Cost at 64: 6.6 ns with AVX2, 0.9 of what
/// airlight_batch() takes, and more than that where gathers are slow. It stays as the measure of
/// what a table gains, and for hardware that filters textures for nothing.
class AirlightBatchTable {
  public:
    /// size >= 2.
    explicit AirlightBatchTable(int size = 64);

    /// Arguments as airlight_batch().
    void airlight_batch(std::size_t count, const float* gamma, const float* t_sv, const float* t_vp,
                        float* out) const;

  private:
    int size_;
    std::vector<float> values_;  // (cos(theta), sqrt(y / (y + 2)))
};

}  // namespace airlight
