// SPDX-License-Identifier: Apache-2.0
// Functions of a function on the sphere: its values on a Gauss grid, changed point by point, and
// projected back.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace airlight {

/// A grid of `rows` Gauss-Legendre latitudes by 2 rows longitudes for vectors of one order.
///
/// With f the function that coefficients c stand for, out_k = int F(f(d)) Y_k(d) d omega by
/// quadrature. That is exact where F(f) Y_k has degrees under 2 rows: for F(f) = f if rows >=
/// order, for f^2 and products if rows >= (3 order - 1) / 2. exp, log and clamps have no last
/// degree. Error over the largest coefficient, order 6, measured against 48 rows:
///
///     rows     exp, |f| <= 1   exp, |f| <= 3   clamp to [0, 1]   ns per vector: exp, clamp
///     12       7e-5            5e-3            3e-2              580, 450 (the default, 2 order)
///     18       1.5e-8          3e-5            1.5e-2            2.25 times that
///     24       5e-12           1e-7            5e-3              4 times
///
/// Float sums add under 5e-6. Cost is that of two dense matrices, (2 rows^2, order^2): one thread
/// with AVX2, 64 vectors at a time.
class ShGrid {
  public:
    /// Throws Error(usage) unless order >= 1 and rows is 0, for 2 order, or at least order;
    /// Error(memory) where the matrices exceed kDefaultMaxMemory, beyond order 64 by default.
    explicit ShGrid(int order, int rows = 0);

    int order() const { return order_; }
    std::size_t points() const { return points_; }

    /// Any F, in double: one vector. out may be in.
    void apply(const std::function<double(double)>& function, const double* in, double* out) const;

    /// The product a b, truncated to the order: one pair, in double. Exact if rows >= (3n-1)/2.
    void multiply(const double* a, const double* b, double* out) const;

    /// exp(f), of `count` vectors (count, order^2), in float. out may be in. Where f > 88 at a
    /// point the result is not finite; vectors that hold NaN give NaN, here and below, and leave
    /// the others alone.
    void exponential(std::size_t count, const float* in, float* out) const;

    /// log(max(f, floor)), floor > 0 and finite: the truncated series of a positive function dips
    /// below 0. Throws Error(usage) for other floors.
    void logarithm(std::size_t count, float floor, const float* in, float* out) const;

    /// min(max(f, low), high). Throws Error(usage) unless low <= high.
    void clamp(std::size_t count, float low, float high, const float* in, float* out) const;

    /// a b, as above, in float.
    void multiply(std::size_t count, const float* a, const float* b, float* out) const;

  private:
    int order_;
    std::size_t points_;
    std::vector<double> basis_;     // (points, order^2)
    std::vector<double> weights_;   // per point
    std::vector<float> synthesis_;  // (points, order^2)
    std::vector<float> analysis_;   // (order^2, points), weights in
};

}  // namespace airlight
