// SPDX-License-Identifier: Apache-2.0
#include "sh/triple_product.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <string>

#include "core/checked.h"
#include "core/constants.h"
#include "core/error.h"
#include "sh/basis.h"
#include "sh/index.h"
#include "sh/quadrature.h"

namespace airlight {
namespace {

// int t_a t_b t_c d phi of the factors 1, sqrt(2) cos(m phi), sqrt(2) sin(|m| phi) of the basis,
// where the largest |m| is the sum of the others and the number of sines is even.
double azimuthal(int a, int b, int c) {
    std::array<int, 3> m{a, b, c};
    std::sort(m.begin(), m.end(), [](int p, int q) { return std::abs(p) < std::abs(q); });
    if (m[0] == 0) return 2 * kPi;
    const bool two_sines_under_a_cosine = m[0] < 0 && m[1] < 0;
    return (two_sines_under_a_cosine ? -1 : 1) * std::sqrt(2.0) * kPi;
}

// P_l|m| at the nodes of a rule, node by node.
class LegendreNodes {
  public:
    explicit LegendreNodes(int order)
        : rule_(gauss_legendre((3 * order - 1) / 2)), nodes_(rule_.cosine.size()) {
        const auto n = static_cast<std::size_t>(order);
        values_.resize(n * (n + 1) / 2 * nodes_);
        std::vector<double> column(n);
        for (std::size_t node = 0; node < nodes_; ++node) {
            for (int m = 0; m < order; ++m) {
                normalized_legendre(order, rule_.cosine[node], rule_.sine[node], m, column.data());
                for (int l = m; l < order; ++l) values_[place(l, m) + node] = column[l - m];
            }
        }
    }

    double integral(ShDegree a, ShDegree b, ShDegree c) const {
        const double* p = values_.data() + place(a.l, std::abs(a.m));
        const double* q = values_.data() + place(b.l, std::abs(b.m));
        const double* r = values_.data() + place(c.l, std::abs(c.m));
        long double sum = 0;
        for (std::size_t i = 0; i < nodes_; ++i) {
            sum += static_cast<long double>(rule_.weight[i]) * p[i] * q[i] * r[i];
        }
        return static_cast<double>(sum);
    }

  private:
    std::size_t place(int l, int m) const {
        const auto degree = static_cast<std::size_t>(l);
        return (degree * (degree + 1) / 2 + static_cast<std::size_t>(m)) * nodes_;
    }

    PolarRule rule_;
    std::size_t nodes_;
    std::vector<double> values_;
};

// Calls visit(i) for the slots i <= j for which Y_i Y_j Y_k does not integrate to 0 by symmetry.
template <class Visit>
void for_each_partner(ShDegree j, ShDegree k, std::size_t slot_of_j, int order,
                      const Visit& visit) {
    const bool sine = (j.m < 0) != (k.m < 0);
    const int apart = std::abs(std::abs(j.m) - std::abs(k.m));
    const int together = std::abs(j.m) + std::abs(k.m);
    const int last = std::min(j.l + k.l, order - 1);
    for (int l = std::abs(j.l - k.l); l <= last; l += 2) {
        for (const int size : {apart, together}) {
            if (size > l || (sine && size == 0)) continue;
            const int m = sine ? -size : size;
            const std::size_t i = sh_index(l, m);
            if (i <= slot_of_j) visit(i);
            if (apart == together) break;
        }
    }
}

}  // namespace

TripleProducts::TripleProducts(int order) : order_(order) {
    if (order < 1 || order > 255) {
        throw Error(ErrorCode::usage, "triple products: the order is " + std::to_string(order) +
                                          ", the limits are 1 and 255");
    }
    const auto n = static_cast<std::size_t>(order);
    require_memory(n * n * n * n * n * 16 / 5, kDefaultMaxMemory,
                   "the triple products of order " + std::to_string(order));
    const LegendreNodes legendre(order);
    const std::size_t size = sh_count(order);
    for (std::size_t k = 0; k < size; ++k) {
        first_.push_back(terms_.size());
        const ShDegree degree_k = sh_degree(k);
        for (std::size_t j = 0; j < size; ++j) {
            const ShDegree degree_j = sh_degree(j);
            for_each_partner(degree_j, degree_k, j, order, [&](std::size_t i) {
                const ShDegree degree_i = sh_degree(i);
                // Always the same sequence of factors, so that Gamma is symmetric to the last bit.
                std::array<std::size_t, 3> sorted{i, j, k};
                std::sort(sorted.begin(), sorted.end());
                const double value = legendre.integral(sh_degree(sorted[0]), sh_degree(sorted[1]),
                                                       sh_degree(sorted[2])) *
                                     azimuthal(degree_i.m, degree_j.m, degree_k.m);
                // A few vanish although no symmetry says so; the least others are above 1e-4.
                if (std::abs(value) < 1e-12) return;
                terms_.push_back({static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(j),
                                  i == j ? value / 2 : value});
            });
        }
        std::sort(terms_.begin() + static_cast<std::ptrdiff_t>(first_.back()), terms_.end(),
                  [](const Term& a, const Term& b) { return a.i != b.i ? a.i < b.i : a.j < b.j; });
    }
    first_.push_back(terms_.size());
}

std::size_t TripleProducts::nonzero_count() const {
    std::size_t count = 0;
    for (const Term& term : terms_) count += term.i == term.j ? 1 : 2;
    return count;
}

double TripleProducts::at(std::size_t i, std::size_t j, std::size_t k) const {
    assert(std::max({i, j, k}) < sh_count(order_));
    if (i > j) std::swap(i, j);
    const Term* const found = std::lower_bound(
        begin(k), end(k), Term{static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(j), 0},
        [](const Term& a, const Term& b) { return a.i != b.i ? a.i < b.i : a.j < b.j; });
    if (found == end(k) || found->i != i || found->j != j) return 0;
    return i == j ? 2 * found->value : found->value;
}

void TripleProducts::multiply(const double* a, const double* b, double* out) const {
    const std::size_t size = sh_count(order_);
    for (std::size_t k = 0; k < size; ++k) {
        double sum = 0;
        for (const Term* t = begin(k); t != end(k); ++t) {
            sum += t->value * (a[t->i] * b[t->j] + a[t->j] * b[t->i]);
        }
        out[k] = sum;
    }
}

double TripleProducts::integral(const double* l, const double* v, const double* b) const {
    double sum = 0;
    for (std::size_t k = 0; k + 1 < first_.size(); ++k) {
        double product = 0;
        for (const Term* t = begin(k); t != end(k); ++t) {
            product += t->value * (l[t->i] * v[t->j] + l[t->j] * v[t->i]);
        }
        sum += product * b[k];
    }
    return sum;
}

}  // namespace airlight
