// SPDX-License-Identifier: Apache-2.0
// The optical depth around a point, averaged over all directions.
#pragma once

#include <cstddef>
#include <vector>

#include "medium/gaussian_density.h"

namespace airlight {

/// Mean over all directions of the optical depth from a point at distance u to infinity through
/// the Gaussian exp(-|x|^2):
///     T(u) = 1 / (4 pi) int_S int_0^inf exp(-|u + t w|^2) dt dw = sqrt(pi) / (2 u) D(u),
/// D Dawson's function [DLMF 7.2.5]. T(0) = sqrt(pi) / 2, T -> sqrt(pi) / (4 u^2).
///
/// Domain: u in [0, inf], T(inf) = 0; anything else gives NaN. Accuracy: relative 1e-15 in double
/// (measured against 40 digits), one rounding in float. 30 ns.
///
/// Deviates: [Zhou07] sec. 4.2 prints exp(+|u + t w|^2), which diverges, and tabulates it; the
/// closed form needs no table.
double mean_gaussian_depth(double u);
float mean_gaussian_depth(float u);

/// T(u) by linear interpolation in a table of `size` points over [0, max_u], the paper's way, and
/// by sqrt(pi) / (4 u^2) beyond. Largest absolute errors with max_u = 8: 2.5e-3 at size 64, 1.5e-4
/// at 256; relative ones 8e-3, all of it where the asymptote takes over.
class MeanDepthTable {
  public:
    /// size >= 2, max_u > 0 and finite, or an Error (usage).
    explicit MeanDepthTable(int size = 64, double max_u = 8);

    /// Domain and corners as mean_gaussian_depth.
    double operator()(double u) const;

  private:
    double max_u_;
    std::vector<double> values_;
};

/// The optical depth averaged over all directions from `point`, [Zhou07] eq. 26:
///     beta0 reach + sum_i c_i T(a_i |point - b_i|) / a_i,
/// with beta0 in [0, inf) the uniform part [1/m] and reach in [0, inf] the distance to the
/// environment [m], which Gaussians are taken to end well within. A blob with scale 0 and a
/// positive amplitude gives +inf. Anything outside the domain gives NaN.
double average_optical_depth(double beta0, double reach, const GaussianBlob* blobs,
                             std::size_t count, const glm::dvec3& point);

}  // namespace airlight
