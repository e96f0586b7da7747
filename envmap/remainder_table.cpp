// SPDX-License-Identifier: Apache-2.0
#include "envmap/remainder_table.h"

#include <array>
#include <cassert>
#include <cmath>

#include "core/constants.h"

namespace airlight {
namespace {

constexpr int kNodes = 8;

// Monomial coefficients of the polynomial through values at the Chebyshev nodes cos((i + 1/2)
// pi/8).
std::array<double, kNodes> chebyshev_fit(const std::array<double, kNodes>& values) {
    std::array<double, kNodes> chebyshev{};
    for (int k = 0; k < kNodes; ++k) {
        for (int i = 0; i < kNodes; ++i) {
            chebyshev[k] += values[i] * std::cos(k * (i + 0.5) * kPi / kNodes);
        }
        chebyshev[k] *= (k == 0 ? 1.0 : 2.0) / kNodes;
    }
    // T_{k+1} = 2 x T_k - T_{k-1}, accumulated in monomials.
    std::array<double, kNodes> result{}, before{}, current{};
    before[0] = 1;
    current[1] = 1;
    result[0] = chebyshev[0];
    for (int k = 1; k < kNodes; ++k) {
        for (int j = 0; j <= k; ++j) result[j] += chebyshev[k] * current[j];
        std::array<double, kNodes> next{};
        for (int j = 0; j + 1 < kNodes; ++j) next[j + 1] = 2 * current[j];
        for (int j = 0; j < kNodes; ++j) next[j] -= before[j];
        before = current;
        current = next;
    }
    return result;
}

std::uint64_t bits_of(double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
}

double value_of(std::uint64_t bits) {
    double value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

}  // namespace

RemainderTable::RemainderTable(const std::function<double(double)>& kernel, double t_max)
    : t_max_(t_max), first_panel_(bits_of(kSmallest) >> (52 - kPanelBits)) {
    assert(t_max > kSmallest && t_max <= 4);
    const std::size_t last = bits_of(t_max) >> (52 - kPanelBits);
    coefficients_.resize((last - first_panel_ + 1) * kTerms);
    double remainder = 0;  // C at the upper end of the panel at hand
    for (std::size_t panel = last + 1; panel-- > first_panel_;) {
        const double low = value_of(static_cast<std::uint64_t>(panel) << (52 - kPanelBits));
        const double high = value_of(static_cast<std::uint64_t>(panel + 1) << (52 - kPanelBits));
        const double half = 0.5 * (high - low);
        std::array<double, kNodes> values;
        for (int i = 0; i < kNodes; ++i) {
            const double t = low + half * (1 + std::cos((i + 0.5) * kPi / kNodes));
            // The panel that holds t_max is fitted as a whole, by the kernel's continuation; the
            // chord cannot pass the antipode.
            values[i] = kernel(std::min(t, 4.0));
        }
        const std::array<double, kNodes> f = chebyshev_fit(values);
        double* c = coefficients_.data() + (panel - first_panel_) * kTerms;
        // C(x) = constant - half/2 * sum f_j x^(j+1) / (j+1), with C = remainder at the upper end.
        const double end = panel == last ? (t_max - low) / half - 1 : 1.0;
        double at_end = 0, power = 1;
        for (int j = 0; j < kNodes; ++j) {
            c[j + 1] = -0.5 * half * f[j] / (j + 1);
            power *= end;
            at_end += c[j + 1] * power;
        }
        c[0] = remainder - at_end;
        double at_low = c[0];
        for (int j = 1; j < kTerms; ++j) at_low += (j % 2 ? -1 : 1) * c[j];
        remainder = at_low;
    }
    inner_ = kernel(kSmallest) * kSmallest;
    at_zero_ = remainder + inner_;
}

void RemainderTable::scale(double factor) {
    at_zero_ *= factor;
    inner_ *= factor;
    for (double& c : coefficients_) c *= factor;
}

}  // namespace airlight
