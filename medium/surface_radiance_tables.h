// SPDX-License-Identifier: Apache-2.0
// Surface radiance by table: the paper's table of G_n, and one whose axes follow the function.
//
// Each holds one exponent n. All are built by their constructor, 20 to 40 us per point on all
// cores, and only there; lookups are const and may run in parallel. T, theta and the corners as
// surface_radiance() in medium/surface_radiance.h has them. A constructor throws Error (usage)
// where an argument is outside its limits.
#pragma once

#include <vector>

#include "medium/airlight_tables.h"
#include "medium/lobe_ring.h"

namespace airlight {

/// G_n itself on size x size even steps of T in [0, max_t] and theta in [0, pi], as [Sun05] sec. 5
/// stores it. A T beyond max_t takes the last column, as the texture does.
///
/// At 64 with max_t = 10 the largest relative errors for T <= 10 are, nearest and bilinear, 0.42
/// and 0.12 for n = 1, 0.45 and 0.13 for n = 20, 0.83 and 0.23 for n = 1000 (rms 0.07 and 0.015,
/// 0.07 and 0.017, 0.10 and 0.03), most of it at T near 0. Beyond max_t there is no bound.
class RawSurfaceTable {
  public:
    /// exponent in [1, 1000], size in [2, 4096], max_t > 0 and finite.
    explicit RawSurfaceTable(double exponent, int size = 64, double max_t = 10);

    /// G_n(t, theta).
    double radiance(double t, double theta, TableLookup how) const;

  private:
    int size_;
    double max_t_;
    std::vector<double> values_;  // (theta, T)
};

enum class SurfaceInterpolation { linear, cubic };

/// ln(G_n e^T) on size columns, T = 106 x^4, and size | 1 rows, for n < 6 theta = pi/2 (1 + y |y|)
/// with y in [-1, 1], so that the rows crowd where the source sets, for larger n theta = pi y^2
/// with y in [0, 1], so that they crowd in the lobe. Bilinear, or by cubics through four points
/// of an axis, which do not reach across theta = pi/2 when n < 6. For T > 106 the exact integral
/// answers: there is no G_n e^T without a value.
///
/// Largest relative error for T in [0, 106] and theta in [0, pi]:
///     size    n = 1, 2          n = 20            n = 200           n = 1000
///             linear   cubic    linear   cubic    linear   cubic    linear   cubic
///      64     2.6e-3   7.6e-5   3.5e-3   1.1e-4   7.2e-3   4.5e-4   1.4e-2   1.7e-3
///     128     6.6e-4   3.8e-6   9.0e-4   7.7e-6   1.8e-3   3.5e-5   3.6e-3   1.2e-4
///     256     1.7e-4   7.8e-7   2.3e-4   4.8e-7   4.5e-4   2.2e-6   9.0e-4   6.1e-6
/// A lookup costs 19 ns (linear) or 32 ns (cubic), one exponential included.
///
/// Deviates: [Sun05] tabulates G_n; its logarithm less T has no range to speak of, and the warps
/// put the samples where it bends.
class WarpedSurfaceTable {
  public:
    static constexpr double kThickest = 106;   ///< beyond it e^-T is 0 in float
    static constexpr double kFirstNarrow = 6;  ///< exponent

    /// exponent in [1, 1000], size in [8, 4096].
    explicit WarpedSurfaceTable(double exponent, int size = 64,
                                SurfaceInterpolation how = SurfaceInterpolation::linear);

    /// G_n(t, theta).
    double radiance(double t, double theta) const;
    /// G_n(t, theta) e^t.
    double radiance_scaled(double t, double theta) const;

    double exponent() const { return ring_.exponent(); }
    int columns() const { return size_; }
    int rows() const { return size_ | 1; }
    /// ln(G_n e^T), row by row.
    const std::vector<double>& values() const { return values_; }

  private:
    double lookup(double t, double theta) const;

    detail::LobeRing ring_;
    int size_;
    SurfaceInterpolation how_;
    std::vector<double> values_;  // (theta, T)
};

}  // namespace airlight
