// SPDX-License-Identifier: Apache-2.0
// Airlight by table: Sun's table of F(u, v), and a table whose axes follow the function.
//
// Both are built by their constructor and only there; lookups are const and may run in parallel.
#pragma once

#include <vector>

namespace airlight {

enum class TableLookup { nearest, bilinear };

/// F(u, v) sampled on size x size points, u in [0, max_u], v in [0, pi/2], both ends included, and
/// airlight by [Sun05] eq. 7, 8 and 11 as printed,
///     A_0 (F(A_1, pi/4 + atan((T_vp - T_sv cos gamma) / (T_sv sin gamma)) / 2) - F(A_1, gamma/2)).
///
/// The paper's "maximum error of less than 2 %" holds with bilinear lookups, max_u = 2, T_sv < 2,
/// gamma < 2.5 and T_vp / T_sv in [.3, 4]; elsewhere the difference of two interpolated values has
/// no bound. A u beyond max_u takes the last column. A negative difference gives 0, and where A_0
/// is not finite (gamma = 0 or pi, or overflow) airlight() answers.
class SpecialFTable {
  public:
    /// size >= 2, max_u > 0 and finite. The paper's figures use 64 and, it seems, 10: it states no
    /// range, figure 5 ends there.
    explicit SpecialFTable(int size = 64, double max_u = 10);

    /// F(u, v) for u, v >= 0, with v clamped to pi/2.
    double lookup(double u, double v, TableLookup how) const;

    /// Domain and corners as airlight() in medium/airlight.h.
    double airlight(double gamma, double t_sv, double t_vp, TableLookup how) const;

  private:
    int size_;
    double max_u_;
    std::vector<double> values_;  // (v, u)
};

/// R(T, gamma) = J_inf T e^T sin(gamma) / (pi - gamma), in (0, 1], on size x size points with
/// T = 50 x^3 and gamma = pi y^3, bilinear. J_inf e^T T = R (pi - gamma) / sin(gamma).
///
/// A finite ray is the infinite one less what lies beyond its end, a second lookup; where the
/// difference is under `least_part` of the first term (a short segment) airlight_sinh_gl with 8
/// nodes answers, and so it does for T > 50. Largest relative errors at sizes 32, 64, 128: infinite
/// rays (T > .02, gamma > 1e-4) 9e-3, 2.1e-3, 5e-4; finite ones at 64 5e-3. On a CPU a lookup costs
/// what airlight() costs; the table is for those who cannot run that, such as a shader.
///
/// Deviates: [Sun05] tabulates F over even steps; R is smooth and bounded over all angles and
/// thicknesses, and the cubes put the samples where it bends.
class WarpedAirlightTable {
  public:
    /// size >= 2; least_part in [0, 1].
    explicit WarpedAirlightTable(int size = 64, double least_part = 0.3);

    /// Domain and corners as airlight() in medium/airlight.h.
    double airlight(double gamma, double t_sv, double t_vp) const;

    /// R(T, gamma) for T in [0, 50], gamma in [0, pi].
    double lookup(double t, double gamma) const;

  private:
    int size_;
    double least_part_;
    std::vector<double> values_;  // (gamma, T)
};

}  // namespace airlight
