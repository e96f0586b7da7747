// SPDX-License-Identifier: Apache-2.0
// Many products with one fixed function, such as the light over all vertices.
//
// Triple-product integrals <L|V|B> = int L V B d omega = sum_ijk Gamma_ijk l_i v_j b_k come in
// three ways; all give the same number:
//   dot                 where V B (or L V) is one vector that is already there: sh_dot
//   matrix and vector   L fixed: b . (M v), M = the product matrix of L: ShProductMatrix::integral
//   product, then dot   nothing fixed: ShProduct::multiply of two, sh_dot with the third; with one
//                       light for all, TripleProducts::integral is the reference
#pragma once

#include <cstddef>
#include <vector>

#include "sh/triple_product.h"

namespace airlight {

/// The matrix M_kj = sum_i Gamma_ijk l_i of a fixed function l: the product of l with v, projected
/// to their order, is M v. Symmetric; shape (order^2, order^2).
class ShProductMatrix {
  public:
    /// `light` holds order^2 coefficients, summed in double. Cost: one multiplication per non-zero
    /// Gamma, 0.3, 0.9, 2.2 us for order 4, 5, 6.
    ShProductMatrix(const TripleProducts& triples, const double* light);
    ShProductMatrix(const TripleProducts& triples, const float* light);

    int order() const { return order_; }
    const double* data() const { return double_.data(); }

    /// out = M v of `count` vectors, (count, order^2). out may be v.
    void multiply(std::size_t count, const double* v, double* out) const;
    void multiply(std::size_t count, const float* v, float* out) const;

    /// out[i] = b_i . (M v_i) = <L|V_i|B_i>, of `count` pairs (count, order^2).
    ///
    /// Error up to order 8, over |l| |v| |b|: double 1.1e-16, float 6e-8 (measured). Cost per pair
    /// of order 4, 5, 6, 8, 64 at a time, one thread with AVX2: 10, 20, 34, 96 ns, where the plain
    /// loop over Gamma takes 370, 1200, 3000, 14000 and a product, then dot 14, 38, 57, 143.
    void integral(std::size_t count, const double* v, const double* b, double* out) const;
    void integral(std::size_t count, const float* v, const float* b, float* out) const;

  private:
    int order_;
    std::vector<double> double_;
    std::vector<float> float_;
};

/// out[i] = f . v_i = int F V_i d omega, of `count` vectors (count, order^2) with one function f.
/// Sums run in the type of the vectors. Cost per float vector of order 4, 6, 8, AVX2: 1.7, 3.5, 3.4
/// ns.
void sh_dot(int order, const double* f, std::size_t count, const double* v, double* out);
void sh_dot(int order, const float* f, std::size_t count, const float* v, float* out);

}  // namespace airlight
