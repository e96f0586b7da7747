// SPDX-License-Identifier: Apache-2.0
// Products on Gauss-Legendre rows: the tables that sh/product.h runs on.
#pragma once

#include <cstddef>
#include <vector>

namespace airlight::detail {

/// On each row of constant theta the factors of order n are trigonometric polynomials of degree n-1
/// in phi. Those are multiplied coefficient by coefficient, degrees from n on dropped, so no
/// longitudes are needed, and (3n-1)/2 Gauss-Legendre rows integrate Y_lm times the product exactly
/// over theta. Rows north and south of the equator share the even and odd halves of their sums.
///
/// A row's function is z_0 / 2 + sum_m (x_m cos m phi + y_m sin m phi) up to a factor sqrt(2), and
/// z = x - i y makes the product a convolution over all m; all factors are in the tables.
template <class T>
struct ProductRows {
    explicit ProductRows(int order);

    int order;
    std::size_t pairs;         ///< of rows north and south
    std::size_t rows;          ///< pairs, and one more if a row lies on the equator
    std::size_t columns;       ///< (l, m >= 0), sequences of l for m = 0, 1 ...
    std::vector<T> synthesis;  ///< (rows, columns)
    std::vector<T> analysis;   ///< (columns, rows), times the weight of both rows
};

/// Multiplies `count` pairs, slot k of pair v at [k * stride + v]. out may be a or b.
void multiply_rows(const ProductRows<float>& tables, std::size_t count, std::size_t stride,
                   const float* a, const float* b, float* out);
void multiply_rows(const ProductRows<double>& tables, std::size_t count, std::size_t stride,
                   const double* a, const double* b, double* out);

/// The same for vectors one after the other.
void multiply_rows(const ProductRows<float>& tables, std::size_t count, const float* a,
                   const float* b, float* out);
void multiply_rows(const ProductRows<double>& tables, std::size_t count, const double* a,
                   const double* b, double* out);

}  // namespace airlight::detail
