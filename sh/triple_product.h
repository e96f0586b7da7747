// SPDX-License-Identifier: Apache-2.0
// Integrals of three spherical harmonics, and what a plain sum over them gives.
//
//     Gamma_ijk = int Y_i Y_j Y_k d omega,   i, j, k slots as in sh/index.h
//
// is symmetric in its three slots and mostly 0 ([DLMF] 34.3 for complex ones; [Ng04] for the use).
// The product of two functions, projected back to their order n, has the coefficients c_k = sum_ij
// Gamma_ijk a_i b_j: all of it is exact for those coefficients, and the product's degrees n ...
// 2n-2 are cut off. The frame of sh/basis.h is any, as long as all vectors share it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace airlight {

/// All Gamma_ijk of an order that are not 0.
///
/// Computed by Gauss-Legendre quadrature in cos(theta), exact for the degrees that occur, times the
/// closed form in phi. Largest error up to order 16: 2e-16, the last digit (measured against
/// exact rationals, tests/reference/make_triple_products.py). Cost of construction, one thread:
/// 40, 100, 240 us for order 4, 5, 6, 5 ms for 8, 80 ms for 16.
class TripleProducts {
  public:
    /// One value of Gamma, which belongs to c_k for the pair (i, j) and, if i != j, for (j, i).
    struct Term {
        std::uint16_t i, j;  ///< i <= j
        double value;        ///< Gamma_ijk, or half of it where i == j
    };

    /// Throws Error(usage) unless 1 <= order <= 255, Error(memory) where the terms, about
    /// 0.2 order^5 of 16 bytes, exceed kDefaultMaxMemory.
    explicit TripleProducts(int order);

    int order() const { return order_; }

    /// Number of (i, j, k) with Gamma_ijk != 0, all orderings counted: 83, 353, 1158, 2907, 12868
    /// for order 3, 4, 5, 6, 8.
    std::size_t nonzero_count() const;

    /// Gamma_ijk, for i, j, k < order^2. Cost O(log order) after O(1); for tables and tests.
    double at(std::size_t i, std::size_t j, std::size_t k) const;

    /// Terms of c_k: those of Gamma_..k, ascending by (i, j).
    const Term* begin(std::size_t k) const { return terms_.data() + first_[k]; }
    const Term* end(std::size_t k) const { return terms_.data() + first_[k + 1]; }

    /// out_k = sum_ij Gamma_ijk a_i b_j, summed in double: the reference of every product. out must
    /// not overlap a or b. Error: 1e-15 sqrt(order) |a| |b|. Cost about 1 ns per term.
    void multiply(const double* a, const double* b, double* out) const;

    /// int L V B d omega = sum_ijk Gamma_ijk l_i v_j b_k, e.g. of light, visibility and
    /// reflectance.
    double integral(const double* l, const double* v, const double* b) const;

  private:
    int order_;
    std::vector<Term> terms_;
    std::vector<std::size_t> first_;
};

}  // namespace airlight
