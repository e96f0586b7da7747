// SPDX-License-Identifier: Apache-2.0
// Convolution of a piecewise constant lat-long map with a kernel of finitely many bands.
#pragma once

#include <vector>

#include "core/progress.h"
#include "envmap/image.h"

namespace airlight {

/// The kernel of one channel: f(gamma) = amplitude * sum_l (2l+1)/(4 pi) lambda_l P_l(cos gamma).
struct BandKernel {
    int channel = 0;
    const std::vector<double>* eigenvalues = nullptr;  ///< lambda_l, l = 0 … lmax
    double amplitude = 1;
};

/// Writes sum_j L_j ∫_{pixel j} f(gamma) domega to the pixels of `out` in the channels named, at
/// pixel centres. All kernels have the same lmax < rows and 2 lmax < columns.
///
/// Exact for the piecewise constant map: a pixel's integral over phi is the factor sinc(m pi / W)
/// of its ring's Fourier coefficients; over theta the harmonics times sin(theta) are trigonometric
/// polynomials of degree lmax + 1, for which a short symmetric filter across rows gives the
/// integral from the values at row centres (relative error below 1e-11). Cost and memory as for
/// sh/transform.h, with one pass up and one down in the Legendre functions.
void write_band_filter(const Image& map, const std::vector<BandKernel>& kernels, Image& out,
                       Progress* progress);

/// Nanoseconds of one thread, a model for choosing between methods.
double band_filter_cost(int rows, int columns, int channels, int lmax);

/// Taps h_0 … h_n of the filter h_0 f(t) + sum_k h_k (f(t - k p) + f(t + k p)) that averages a
/// trigonometric polynomial of degree below `degree` over a row of height p = pi / rows.
std::vector<double> row_average_filter(int rows, int degree);

}  // namespace airlight
