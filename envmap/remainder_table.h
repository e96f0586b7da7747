// SPDX-License-Identifier: Apache-2.0
// The energy of a rotationally symmetric kernel beyond an angle, as a fast table.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <vector>

namespace airlight {

/// For a kernel f(gamma) on the sphere, C(gamma) = integral of f(g) sin g dg from gamma to
/// gamma_max.
///
/// The argument is the squared chord t = 4 sin^2(gamma / 2), which needs no root or arccosine:
/// C = 1/2 ∫ f dt. Between t = 2^-62 and t_max each octave of t has eight polynomials of degree 8,
/// fitted to f at eight Chebyshev nodes each and integrated exactly. f may grow like 1/gamma and
/// ln gamma at 0. Accuracy about 1e-11 of C(0) for kernels that vary over more than an eighth of an
/// octave. C = 0 from t_max on.
///
/// A kernel over the whole sphere may also have a peak at the antipode, gamma = pi. From t = 2 on
/// such a table takes the squared chord to there, 4 - t, with panels by octaves of that.
class RemainderTable {
  public:
    /// `kernel(t)` is f at squared chord t; `t_max` <= 4 is where it ends.
    RemainderTable(const std::function<double(double)>& kernel, double t_max);

    /// For a kernel over the sphere with any peak at the antipode: `kernel(t)` for t <= 2, and
    /// `from_antipode(tau)`, f at the squared chord tau <= 2 from there. `antipode_width` is the
    /// angle over which f varies there.
    RemainderTable(const std::function<double(double)>& kernel,
                   const std::function<double(double)>& from_antipode, double antipode_width);

    /// C at squared chord t >= 0.
    double operator()(double t) const {
        if (t >= t_max_) return beyond(t);
        if (t < kSmallest) return at_zero_ - inner_ * std::sqrt(t / kSmallest);
        return panel_value(coefficients_, first_panel_, t);
    }

    /// C(0), the energy of the kernel over 2 pi.
    double total() const { return at_zero_; }
    /// Where the kernel ends, as a chord length.
    double radius() const { return antipode_.empty() ? std::sqrt(t_max_) : 2; }
    /// The angle over which the kernel varies at the antipode; infinite where it does so no faster
    /// than over the rest of the sphere.
    double antipode_width() const { return antipode_width_; }

    /// Multiplies the kernel by a constant.
    void scale(double factor);

  private:
    static constexpr int kPanelBits = 3;  // eight panels an octave
    static constexpr int kTerms = 9;      // as operator() spells out
    static constexpr double kSmallest = 0x1p-62;

    static double panel_value(const std::vector<double>& coefficients, std::size_t first_panel,
                              double t) {
        std::uint64_t bits;
        std::memcpy(&bits, &t, sizeof bits);
        const std::size_t panel = static_cast<std::size_t>(bits >> (52 - kPanelBits)) - first_panel;
        // The fraction within the panel, in [0, 1), from the lower bits of the mantissa.
        const std::uint64_t fraction =
            ((bits << kPanelBits) & 0x000fffffffffffffu) | 0x3ff0000000000000u;
        double x;
        std::memcpy(&x, &fraction, sizeof x);
        x = 2 * x - 3;
        const double* c = coefficients.data() + panel * kTerms;
        // Even and odd powers side by side: half the latency of one Horner chain.
        const double x2 = x * x;
        const double even = c[0] + x2 * (c[2] + x2 * (c[4] + x2 * (c[6] + x2 * c[8])));
        const double odd = c[1] + x2 * (c[3] + x2 * (c[5] + x2 * c[7]));
        return even + x * odd;
    }
    double beyond(double t) const;
    // Panels up to t_max for a kernel whose energy beyond t_max is `remainder`; the energy at 0.
    double build(const std::function<double(double)>& kernel, double t_max, double remainder);

    double t_max_;
    double at_zero_ = 0;
    double inner_ = 0;  // energy below kSmallest, where f goes like 1/gamma
    std::size_t first_panel_;
    std::vector<double> coefficients_;  // (panels, kTerms), monomials of x in [-1, 1]
    std::vector<double> antipode_;      // the same for 4 - t, where the kernel covers the sphere
    double at_antipode_ = 0;            // f there
    double antipode_width_ = std::numeric_limits<double>::infinity();
};

}  // namespace airlight
