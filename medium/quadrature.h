// SPDX-License-Identifier: Apache-2.0
// Gaussian quadrature rules as literal tables (written by medium/make_quadrature.py).
#pragma once

namespace airlight {
namespace detail {

struct QuadratureNode {
    double x;
    double w;
};

struct QuadratureRule {
    const QuadratureNode* nodes;
    int count;
};

/// The positive half of the symmetric Gauss-Legendre rule on [-1, 1] with `nodes` nodes, one of
/// 6, 8, 12, 16, 24, 32 (anything else: an empty rule): count = nodes / 2, ascending, and
/// int_-1^1 f dx ~ sum w (f(x) + f(-x)).
QuadratureRule gauss_legendre(int nodes);

/// Gauss-Laguerre rules of 24 and 80 nodes, int_0^inf e^{-x} f dx ~ sum w f(x), less the nodes
/// whose weight is under 1e-19: for f that does not grow they cannot be seen in a double.
QuadratureRule gauss_laguerre_24();
QuadratureRule gauss_laguerre_80();

}  // namespace detail
}  // namespace airlight
