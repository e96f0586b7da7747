// SPDX-License-Identifier: Apache-2.0
// The eigenvalues of PSF_T at any optical thickness from a small table, for shading in float.
//
// lambda_l(T) / (T e^-T) is smooth in T^{1/4} but for the T ln T of its start, so that few nodes
// over 0 <= T <= 20 carry all degrees at once; beyond, sh/npsf.h computes.
#pragma once

#include <vector>

#include "core/method_names.h"

namespace airlight {

/// The rungs. Largest relative error over T in [0, 20] and l < 1024; time per call at order 6 and
/// 64, one thread (bench/zonal_bench.cpp):
///
///     method        nodes, in T^{1/4}               error    order 6   order 64
///     cubic16       16 even, four-point Lagrange    4.1e-4   28 ns     59 ns
///     cubic32       32 even, four-point Lagrange    2.5e-5   28 ns     59 ns
///     chebyshev20   20 Chebyshev, all of them       5e-7     140 ns    250 ns
///     exact         none, sh/npsf.h rounded         6e-8     1.0 ms    1.0 ms
///
/// In T^{1/3} the cubics err by 2.0e-3 and 3.4e-4, near T = 1e-4.
enum class PsfBandsMethod { cubic16, cubic32, chebyshev20, exact };

inline constexpr NamedMethod<PsfBandsMethod> kPsfBandsMethods[] = {
    {PsfBandsMethod::cubic16, "cubic16"},
    {PsfBandsMethod::cubic32, "cubic32"},
    {PsfBandsMethod::chebyshev20, "chebyshev20"},
    {PsfBandsMethod::exact, "exact"},
};

/// The table of one order, ready to evaluate; evaluations are const and may run in parallel.
/// Its construction takes one call of psf_eigenvalues_scaled() per node.
class PsfBands {
  public:
    explicit PsfBands(int order, PsfBandsMethod method = PsfBandsMethod::chebyshev20);

    int order() const { return order_; }
    PsfBandsMethod method() const { return method_; }

    /// lambda_l / (T e^-T), l < order, into out[order], as psf_eigenvalues_scaled() has them.
    /// Throws Error (data) if T is negative or not finite.
    void eigenvalues_scaled(double optical_thickness, float* out) const;

    /// lambda_l of PSF_T, T e^-T times the above: what convolution with PSF_T multiplies degree l
    /// by. 0 for T = 0, and where it underflows.
    void eigenvalues(double optical_thickness, float* out) const;

  private:
    int order_;
    PsfBandsMethod method_;
    std::vector<double> nodes_;  // T^{1/4}, ascending
    std::vector<float> values_;  // (nodes, order)
};

}  // namespace airlight
