// SPDX-License-Identifier: Apache-2.0
// Surface radiance of many points at once, in float vectors of the widest kind that the CPU has.
#pragma once

#include <cstddef>
#include <vector>

namespace airlight {

/// The cubic table of medium/surface_radiance_tables.h in float, for one exponent n.
class SurfaceBatchTable {
  public:
    /// exponent in [1, 1000], size in [8, 4096]; Error (usage) otherwise. Building takes 20 to 40
    /// us per point of size^2, on all cores.
    explicit SurfaceBatchTable(double exponent = 1, int size = 128);

    /// out[i] = surface_radiance(t_sp[i], theta_s[i], n) for i < count: meaning, domain and corners
    /// of medium/surface_radiance.h, over the whole range of float. Arrays, aliasing and
    /// reproducibility as airlight_batch() in medium/airlight_batch.h has them.
    ///
    /// Accuracy: relative to surface_radiance() in double at the same inputs, measured over the
    /// domain, @acc for n = 1, 20, 200, or the least denormal. Cost: @cost ns per value with AVX2.
    void surface_batch(std::size_t count, const float* t_sp, const float* theta_s,
                       float* out) const;

    double exponent() const { return exponent_; }

  private:
    double exponent_;
    int columns_, rows_;
    std::vector<float> values_;  // ln(G_n e^T), (theta, T)
};

}  // namespace airlight
