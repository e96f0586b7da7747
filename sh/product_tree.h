// SPDX-License-Identifier: Apache-2.0
// Products by straight-line code: the tables that sh/product.h runs on.
#pragma once

#include <cstddef>
#include <vector>

#include "sh/triple_product.h"

namespace airlight::detail {

/// The sum over Gamma without loops, of orders kFirst to kLast. Slots m and -m are the parts
/// of one complex number, so that one value of Gamma serves four of the integrals of real factors,
/// and what two slots contribute is formed once for all degrees it goes to. [Snyder06] generates
/// such code with a program; here templates do.
///
/// From order 6 on Gauss-Legendre rows (sh/product_rows.h) need fewer operations, and the code
/// would leave the instruction cache.
template <class T>
struct ProductTree {
    static constexpr int kFirst = 2, kLast = 5;

    explicit ProductTree(const TripleProducts& triples);

    int order;
    std::vector<T> values;  ///< Gamma in the sequence of the code
};

/// As multiply_rows of sh/product_rows.h.
void multiply_tree(const ProductTree<float>& tree, std::size_t count, std::size_t stride,
                   const float* a, const float* b, float* out);
void multiply_tree(const ProductTree<float>& tree, std::size_t count, const float* a,
                   const float* b, float* out);

}  // namespace airlight::detail
