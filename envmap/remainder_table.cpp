// SPDX-License-Identifier: Apache-2.0
#include "envmap/remainder_table.h"

#include <array>
#include <cassert>
#include <cmath>

#include "core/constants.h"

namespace airlight {
namespace {

constexpr int kNodes = 8;
// Half way to the antipode; its panel ends below 2.
constexpr double kBelowTwo = 0x1.fffffffffffffp0;

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

struct PanelRange {
    double low, half;
};

// By the upper bits that all numbers of the panel share.
PanelRange panel_range(std::size_t panel, int shift) {
    const double low = value_of(static_cast<std::uint64_t>(panel) << shift);
    const double high = value_of(static_cast<std::uint64_t>(panel + 1) << shift);
    return {low, 0.5 * (high - low)};
}

// c_1 ... of C(x) = constant - half/2 * sum f_j x^(j+1) / (j+1), for f of arguments up to `most`.
void fit_energy(const std::function<double(double)>& kernel, PanelRange range, double most,
                double* c) {
    std::array<double, kNodes> values;
    for (int i = 0; i < kNodes; ++i) {
        const double t = range.low + range.half * (1 + std::cos((i + 0.5) * kPi / kNodes));
        // The panel that holds t_max is fitted as a whole, by the kernel's continuation; the
        // chord cannot pass the antipode.
        values[i] = kernel(std::min(t, most));
    }
    const std::array<double, kNodes> f = chebyshev_fit(values);
    for (int j = 0; j < kNodes; ++j) c[j + 1] = -0.5 * range.half * f[j] / (j + 1);
}

}  // namespace

RemainderTable::RemainderTable(const std::function<double(double)>& kernel, double t_max)
    : t_max_(t_max), first_panel_(bits_of(kSmallest) >> (52 - kPanelBits)) {
    assert(t_max > kSmallest && t_max <= 4);
    at_zero_ = build(kernel, t_max, 0);
}

RemainderTable::RemainderTable(const std::function<double(double)>& kernel,
                               const std::function<double(double)>& from_antipode,
                               double antipode_width)
    : t_max_(2), first_panel_(bits_of(kSmallest) >> (52 - kPanelBits)) {
    // Towards the antipode C is the energy within tau: all of it less what lies beyond tau.
    at_antipode_ = from_antipode(0);
    antipode_width_ = antipode_width;
    const std::size_t last = (bits_of(2.0) >> (52 - kPanelBits)) - 1;
    antipode_.resize((last - first_panel_ + 1) * kTerms);
    double within = 0.5 * kSmallest * at_antipode_;
    for (std::size_t panel = first_panel_; panel <= last; ++panel) {
        double* c = antipode_.data() + (panel - first_panel_) * kTerms;
        const PanelRange range = panel_range(panel, 52 - kPanelBits);
        fit_energy(from_antipode, range, 4, c);
        double at_low = 0, at_high = 0;
        for (int j = 1; j < kTerms; ++j) {
            c[j] = -c[j];
            at_low += (j % 2 ? -1 : 1) * c[j];
            at_high += c[j];
        }
        c[0] = within - at_low;
        within = c[0] + at_high;
    }
    at_zero_ = build(kernel, 2, within);
}

double RemainderTable::build(const std::function<double(double)>& kernel, double t_max,
                             double remainder) {
    const std::size_t last = bits_of(t_max) >> (52 - kPanelBits);
    coefficients_.resize((last - first_panel_ + 1) * kTerms);
    for (std::size_t panel = last + 1; panel-- > first_panel_;) {
        double* c = coefficients_.data() + (panel - first_panel_) * kTerms;
        const PanelRange range = panel_range(panel, 52 - kPanelBits);
        fit_energy(kernel, range, 4, c);
        // `remainder` is C at the upper end of the panel at hand.
        const double end = panel == last ? (t_max - range.low) / range.half - 1 : 1.0;
        double at_end = 0, power = 1;
        for (int j = 1; j < kTerms; ++j) {
            power *= end;
            at_end += c[j] * power;
        }
        c[0] = remainder - at_end;
        double at_low = c[0];
        for (int j = 1; j < kTerms; ++j) at_low += (j % 2 ? -1 : 1) * c[j];
        remainder = at_low;
    }
    inner_ = kernel(kSmallest) * kSmallest;
    return remainder + inner_;
}

double RemainderTable::beyond(double t) const {
    if (antipode_.empty() || t >= 4) return 0;
    const double tau = std::min(4 - t, kBelowTwo);
    return tau < kSmallest ? 0.5 * tau * at_antipode_ : panel_value(antipode_, first_panel_, tau);
}

void RemainderTable::scale(double factor) {
    at_zero_ *= factor;
    inner_ *= factor;
    at_antipode_ *= factor;
    for (double& c : coefficients_) c *= factor;
    for (double& c : antipode_) c *= factor;
}

}  // namespace airlight
