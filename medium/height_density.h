// SPDX-License-Identifier: Apache-2.0
// Fog whose density depends on the height alone: exponential, and linear down to zero.
//
// Columns of the ray. With h the height at which it starts, u the upward component of its unit
// direction and s the distance along it, the height is h + u s.
//
// Arguments: heights, slopes and falloffs are finite, u lies in [-1, 1], distances and depths in
// [0, inf]; anything else, NaN included, gives NaN. Results over- and underflow as they must and
// are never negative; +inf is a depth without bound, or the distance of a depth that the ray never
// gathers.
//
// Accuracy, measured against 60 digits over all of a double's range, cancelling heights and merging
// exponents included: depths relative 1e-15, inverses 1e-15 when judged in the depth. A float
// result is that of double, rounded once.
#pragma once

namespace airlight {

/// Column of the density e^{-n z}:
///     int_0^d e^{-n (h + u s)} ds = d e^{-n h} phi(n u d),  phi(y) = (1 - e^{-y}) / y
/// ([Golubev] eq. 34). `falloff` n [1/m] is the reciprocal of the scale height, of either sign; 0
/// is a uniform medium. Multiply by the extinction at height 0. 70 ns.
///
/// Deviates: the article divides by n u, which horizontal rays and n = 0 make 0, and its
/// exponentials overflow on their own. Here the exponent of the densest end is taken out of the
/// integral with the digits that n (h + u d) loses.
double exponential_height_depth(double height, double up, double distance, double falloff);
float exponential_height_depth(float height, float up, float distance, float falloff);

/// The distance at which that column is `depth`: -ln(1 - n u X) / (n u), X = depth e^{n h}
/// ([Golubev] eq. 35). +inf if the ray never gathers it, n u X >= 1. 60 ns.
double exponential_height_distance(double depth, double height, double up, double falloff);
float exponential_height_distance(float depth, float height, float up, float falloff);

/// Column of the density max(0, a z + k), `slope` a [1/m^2] and `density` k [1/m] at height 0:
///     int_0^d max(0, a (h + u s) + k) ds
/// ([Golubev] eq. 30). 180 ns.
///
/// Deviates: the article integrates a z + k where it is negative, too. Here the density ends at 0.
double linear_height_depth(double slope, double density, double height, double up, double distance);
float linear_height_depth(float slope, float density, float height, float up, float distance);

/// The least distance at which that column is `depth`; +inf if the ray never gathers it. A depth
/// that exceeds the whole column by rounding alone, 1e-15, gives the end of the medium. 190 ns.
///
/// Deviates: [Golubev] eq. 31 is 0/0 for a u = 0 and cancels near it; with b = a h + k this is
/// 2 depth / (b + sqrt(b^2 + 2 a u depth)), whose discriminant is summed exactly.
double linear_height_distance(double depth, double slope, double density, double height, double up);
float linear_height_distance(float depth, float slope, float density, float height, float up);

}  // namespace airlight
