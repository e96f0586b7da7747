// SPDX-License-Identifier: Apache-2.0
// Products of pairs of functions, projected to their order.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <variant>

#include "sh/function_grid.h"
#include "sh/product_rows.h"
#include "sh/product_tree.h"
#include "sh/triple_product.h"

namespace airlight {

/// The rungs. All are exact but for rounding; the error is the largest of a coefficient over the
/// largest coefficient of the product, in float. Nanoseconds per pair, one thread with AVX2, 64
/// pairs slot by slot (and one after the other), bench/sh_product_bench.cpp:
///
///     order      3           4            5            6            8          error
///     sparse     57 (54)     180 (170)    530 (530)    1400 (1400)  6100 (5900)  6e-8
///     tree       2.3 (5.3)   8.7 (12)     27 (34)                                2e-7
///     rows       7.1 (9.0)   14 (16)      29 (32)      49 (52)      135 (136)    1.5e-7
///     grid       (25)        (57)         (168)        (302)        (1000)       5e-7
///     plain loop (82)        (440)        (1700)       (4900)       (26000)      5e-7
///
/// `sparse` sums over all Gamma_ijk in double; `tree` is the same sum as straight-line code, for
/// orders 2 to 5; `rows` multiplies trigonometric polynomials on Gauss-Legendre rows; `grid`
/// multiplies values at points.
enum class ShProductMethod { sparse, tree, rows, grid };

struct ShProductMethodInfo {
    ShProductMethod method;
    std::string_view name;
};

/// Every method with its name, in the order of the enum.
inline constexpr ShProductMethodInfo kShProductMethods[] = {
    {ShProductMethod::sparse, "sparse"},
    {ShProductMethod::tree, "tree"},
    {ShProductMethod::rows, "rows"},
    {ShProductMethod::grid, "grid"},
};

std::string_view sh_product_method_name(ShProductMethod method);

/// Nothing when no method has that name.
std::optional<ShProductMethod> sh_product_method_from_name(std::string_view name);

/// c_k = int A B Y_k d omega = sum_ij Gamma_ijk a_i b_j of many pairs of order-n vectors, the
/// degrees from n on cut off: exact where n_a + n_b - 1 <= n for the orders that a and b fill.
/// Vectors share one frame, any. Objects are immutable and may be shared between threads.
class ShProduct {
  public:
    /// The fastest method: tree to order 5, rows above. Throws Error(usage) for an order that is
    /// not from 1 to 255, or that the method does not have, Error(memory) where its tables exceed
    /// kDefaultMaxMemory.
    explicit ShProduct(int order);
    ShProduct(int order, ShProductMethod method);

    int order() const { return order_; }
    ShProductMethod method() const { return method_; }

    /// `count` products of vectors one after the other, (count, order^2). out may be a or b. In
    /// double, `tree` computes as `rows`; error 1e-15 of the largest coefficient.
    void multiply(std::size_t count, const double* a, const double* b, double* out) const;
    void multiply(std::size_t count, const float* a, const float* b, float* out) const;

    /// The same slot by slot: slot k of vector v at [k * stride + v], stride >= count. What the
    /// SIMD lanes work on, so cheaper.
    void multiply_planes(std::size_t count, std::size_t stride, const double* a, const double* b,
                         double* out) const;
    void multiply_planes(std::size_t count, std::size_t stride, const float* a, const float* b,
                         float* out) const;

  private:
    struct Tree {
        detail::ProductTree<float> in_float;
        detail::ProductRows<double> in_double;
    };
    struct Rows {
        detail::ProductRows<float> in_float;
        detail::ProductRows<double> in_double;
    };
    using Tables = std::variant<TripleProducts, Tree, Rows, ShGrid>;

    static Tables tables(int order, ShProductMethod method);

    int order_;
    ShProductMethod method_;
    Tables tables_;
};

}  // namespace airlight
