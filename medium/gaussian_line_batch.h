// SPDX-License-Identifier: Apache-2.0
// Optical depths of many segments through Gaussians, in float vectors.
#pragma once

#include <cstddef>

namespace airlight {

/// out[i] = gaussian_line(a[i], c[i], rho_perp[i], m_proj[i], dist[i]) for i < count: meaning,
/// domain and corners of gaussian_line() in medium/gaussian_density.h, over the whole range of
/// float. Arrays, aliasing and reproducibility as airlight_batch() in medium/airlight_batch.h has
/// them.
///
/// Accuracy: relative 1.0e-6 of gaussian_line() in double at the same inputs (measured on every
/// SIMD target over the domain, segments far beside the blob and next to its center included), or
/// the least denormal. Cost: 4.6 ns per segment with AVX2, 2.7 ns with AVX-512, where
/// gaussian_line() takes 42.
///
/// The exponent is summed with its rounding errors, erfcx is one polynomial, and a short segment
/// takes a four-point rule; all lanes do all of it. Outside [2^-30, 2^30] (lengths and scale) or
/// [2^-60, 2^60] (amplitude) an element costs a scalar call, but dist = inf does not.
void gaussian_line_batch(std::size_t count, const float* a, const float* c, const float* rho_perp,
                         const float* m_proj, const float* dist, float* out);

}  // namespace airlight
