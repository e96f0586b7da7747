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
    /// Accuracy: relative to surface_radiance() in double at the same inputs 4.5e-6, 5.1e-6,
    /// 7.6e-6, 3.2e-5, 1.0e-4 for n = 1, 5, 20, 200, 1000, size 128 (measured over the domain, down
    /// to the least normal float): the table's own error and 3e-6 for the arithmetic. Cost: 4.3 ns
    /// per value with AVX-512, where surface_radiance() takes 12000 and more.
    void surface_batch(std::size_t count, const float* t_sp, const float* theta_s,
                       float* out) const;

    /// The same at theta_s = 2 asin(sqrt(q[i])), q in [0, 1]: a quarter of the square of the
    /// difference of the two unit vectors that theta_s lies between. No angle need be computed.
    void surface_batch_by_chord(std::size_t count, const float* t_sp, const float* q,
                                float* out) const;

    double exponent() const { return exponent_; }

  private:
    double exponent_;
    int columns_, rows_;
    std::vector<float> values_;  // ln(G_n e^T), (theta, T)
};

}  // namespace airlight
