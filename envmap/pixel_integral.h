// SPDX-License-Identifier: Apache-2.0
// Integrals of a rotationally symmetric kernel over the pixels of a lat-long map.
#pragma once

#include <cstddef>
#include <vector>

#include "core/constants.h"
#include "envmap/kernel_reach.h"
#include "envmap/remainder_table.h"

namespace airlight {

/// Integrates f(angle to a pixel centre) over other pixels of a map of `rows` by `columns`:
///
///     K_ij(k) = ∫ over the pixel of row j, k columns away, f(gamma) domega
///
/// with gamma the angle to the centre of a pixel in row i. By Green's theorem in polar coordinates
/// about that centre the area integral is a boundary integral of C(gamma) dpsi, C being the
/// kernel's energy beyond gamma, so the singularity at gamma = 0 never appears: one formula serves
/// the own pixel, its neighbours, needle-shaped pixels at the poles and whole hemispheres. Edges
/// are cut until each piece is shorter than its distance, then integrated by Gauss-Legendre.
/// Relative error about 1e-9 of an edge, 1e-7 of a pixel. Neighbouring pixels share edges, so the
/// taps of all pixels sum to the kernel's energy to rounding.
class PixelIntegrator {
  public:
    PixelIntegrator(int rows, int columns);

    /// Taps of output row `row` over the rows that the kernel reaches; `visit(j, count, taps)` gets
    /// K_ij(k) for k = 0 … count-1 (K is even in k and periodic in `columns`); count is at most
    /// columns/2 + 1 and pixels from `count` on lie beyond the kernel's end.
    template <class Visit>
    void integrate_row(const RemainderTable& remainder, int row, const Visit& visit) const;

    const KernelReach& reach() const { return reach_; }

  private:
    // Gauss-Legendre nodes of all rules in use, one after the other, per edge.
    static constexpr int kRuleNodes = 2 + 3 + 4 + 6 + 8;

    // Row j as seen from an output row: what its edges share.
    struct RowView {
        double theta_i, sine_i;
        double top, bottom;                           // colatitudes of the row's edges
        double across[kRuleNodes], sine[kRuleNodes];  // 4 sin^2((theta - theta_i)/2), sin theta
        double nearest_across, smallest_sine;
    };
    // A parallel as seen from an output row.
    struct ParallelView {
        double theta, sine, across, along, base, bend;
    };

    double colatitude(int row) const;
    double edge(int row) const;  // upper edge of a row
    RowView view_row(int row, int j) const;
    ParallelView view_parallel(int row, int j) const;
    double parallel(const RemainderTable& remainder, const ParallelView& view, std::size_t k) const;
    double meridian(const RemainderTable& remainder, const RowView& view, std::size_t k) const;

    int rows_, columns_;
    KernelReach reach_;
    std::vector<double>
        half_sine_;  // sin^2(phi/2) at the rule nodes within column k, (k, kRuleNodes)
    std::vector<double> edge_half_sine_;  // sin^2(phi/2) at the inner edge of column k
};

template <class Visit>
void PixelIntegrator::integrate_row(const RemainderTable& remainder, int row,
                                    const Visit& visit) const {
    std::vector<double> taps, upper, lower;
    const RowRange reached = reach_.rows(remainder.radius(), row);
    for (int j = reached.first; j <= reached.last; ++j) {
        const std::size_t count = reach_.columns(remainder.radius(), row, j);
        // Edges along the row's boundaries; the upper ones were the last row's lower ones.
        upper.swap(lower);
        const ParallelView top = view_parallel(row, j), bottom = view_parallel(row, j + 1);
        for (std::size_t k = upper.size(); k < count; ++k) {
            upper.push_back(parallel(remainder, top, k));
        }
        lower.clear();
        for (std::size_t k = 0; k < count; ++k) lower.push_back(parallel(remainder, bottom, k));
        const RowView view = view_row(row, j);
        taps.assign(count, 0.0);
        double left = 0;
        for (std::size_t k = 0; k < count; ++k) {
            const double right = meridian(remainder, view, k);
            if (k == 0) left = -right;
            taps[k] = upper[k] - lower[k] + right - left;
            left = right;
        }
        if (j == row) taps[0] += 2 * kPi * remainder.total();
        visit(j, count, taps.data());
    }
}

}  // namespace airlight
