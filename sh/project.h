// SPDX-License-Identifier: Apache-2.0
// Lat-long maps to few spherical-harmonic coefficients, in one pass over the map.
//
// The map's rows become Fourier moments (sh/row_moments.h), rows mirrored at the equator are added
// and subtracted, and each half meets normalized Legendre functions of its parity under the exact
// weights of a quadrature rule. For all bands that a map can hold, see sh/transform.h.
#pragma once

#include <cstddef>
#include <vector>

namespace airlight {

/// What the numbers of a map are taken for, and the quadrature that follows.
enum class MapRule {
    /// Means over the pixels, constant within each: c = sum over pixels of f ∫_pixel Y domega, the
    /// convention of maps here. Exact for such maps of any size, down to one row: columns are
    /// integrated in closed form, rows by a Gauss-Legendre rule within each that has as many nodes
    /// as double precision asks for (three for order 6 and 2048 rows).
    pixel_means,
    /// Samples at the centres of pixels: Fejer's first rule over the rows, equal weights in the
    /// row. Exact for f of band limit lmax as long as lmax + order <= rows and lmax + order <=
    /// columns.
    centre_samples,
};

/// The largest order of project_latlong: beyond, the turn into the world frame is what costs.
inline constexpr int kLargestProjectionOrder = 128;

/// Coefficients (channels, order^2), slots as in sh/index.h, of the lat-long map (rows, columns,
/// channels), in the world frame of sh/basis.h: the map's rows and columns look where
/// docs/CONVENTIONS.md says.
///
/// Sums run in double for float maps, too. Tests hold the error under 4e-16 (lmax + 10) for white
/// noise of that band limit with centre_samples, under 5e-14 for noise in [-1, 1] with pixel_means
/// up to order 13 (brute force being no better), and under 2.3e-15 of the value for a map of one
/// value up to 512 x 1024. The bits do not depend on the number of threads.
///
/// Cost for 4096 x 2048 float RGB, over that of a pass that only reads the map
/// (bench/sh_project_bench.cpp, AVX-512): order 6 takes 1.41, order 3 1.22, order 12 2.7, order
/// 24 6.2; a loop over pixels to order 6 takes 86 and one over batches of directions 6.9.
/// centre_samples adds 2 ms for the weights of 2048 rows. Memory beyond the map: 8 bytes * channels
/// * order^2 for every 16 pairs of rows.
///
/// Throws Error: usage if 1 <= order <= kLargestProjectionOrder does not hold or a size is below 1;
/// data if order exceeds the rows, or order - 1 is not below half the columns, with centre_samples;
/// data if a value is not finite, with the number of such values and the first one's place.
std::vector<double> project_latlong(const float* map, int rows, int columns, int channels,
                                    int order, MapRule rule = MapRule::pixel_means);
std::vector<double> project_latlong(const double* map, int rows, int columns, int channels,
                                    int order, MapRule rule = MapRule::pixel_means);

}  // namespace airlight
