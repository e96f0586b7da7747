// SPDX-License-Identifier: Apache-2.0
#include "envmap/fog_kernel.h"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/expint.hpp>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/constants.h"
#include "envmap/chord.h"
#include "envmap/phase_singularity.h"
#include "medium/phase_airlight.h"
#include "medium/psf.h"
#include "sh/npsf.h"
#include "sh/quadrature.h"
#include "sh/zonal.h"

namespace airlight {
namespace {

// Angles at which a split is compared with the exact kernel: inside the near part, just past its
// end, ten to a ripple as far as the taper lets ripples go, and up to the antipode.
std::vector<double> probe_angles(double radius, int lmax) {
    std::vector<double> angles;
    const double end = 2 * std::asin(0.5 * radius);
    for (int i = 0; i < 24; ++i) angles.push_back(end * (i + 0.5) / 24);
    const double quiet = std::min(kPi, end + 80.0 / lmax);
    for (double angle = end * (1 + 1e-9); angle < quiet; angle += 0.6 / lmax)
        angles.push_back(angle);
    const int count = 100;
    for (int i = 0; i < count; ++i) {
        angles.push_back(quiet * std::pow(kPi / quiet, static_cast<double>(i) / count));
    }
    angles.push_back(kPi);
    return angles;
}

double taper(int l, int lmax) {
    const int width = std::max(1, (lmax + 1) / 16);
    const int first = lmax + 1 - width;
    if (l < first) return 1;
    return 0.5 * (1 + std::cos(kPi * (l - first + 0.5) / width));
}

// What pixel integrals and sums in float add, relative to the near part. In a dense medium that
// part is larger than the kernel itself, since it falls off more slowly.
constexpr double kArithmeticError = 1e-6;

// Errors between two probes exceed theirs by 2.2 % at most, as seen on 400 kernels.
constexpr double kProbeMargin = 1.03;

// The two tails, erfc(a) at the near part's end and about erfc(b) beyond the last band, for one
// tolerance on their sum.
struct Tails {
    double a, b;
};

Tails tails_for(double tolerance) {
    const double a = boost::math::erfc_inv(std::min(0.5, 0.9 * tolerance));
    return {a, 1.03 * a + 0.05};
}

// A kernel to split, by its parts.
class Shape {
  public:
    Shape(double thickness, const PhaseFunction& phase)
        : thickness_(thickness), phase_(phase), singularity_(PhaseSingularity::of(phase)) {
        energy_ = is_isotropic() ? psf_eigenvalues_scaled(thickness, 1)[0]
                                 : 2 * kPi * whole_kernel(thickness, phase).total();
    }

    bool is_isotropic() const { return phase_.kind() == PhaseKind::isotropic; }
    /// Whether its singular part is known.
    bool splits() const { return is_isotropic() || singularity_.has_value(); }
    double thickness() const { return thickness_; }
    double energy() const { return energy_; }

    double exact(double angle) const { return psf_scaled(thickness_, angle, phase_); }

    double near(double alpha, double t) const {
        if (!singularity_) return near_kernel(thickness_, alpha, t);
        const double z = alpha * alpha * t;
        if (z > kEndOfTail) return 0;
        const double s = std::sqrt(t), sine = s * std::sqrt(std::max(0.0, 1 - 0.25 * t));
        if (sine == 0) return 0;
        const double h = thickness_ * sine;
        return std::exp(0.5 * thickness_ * t) / sine *
               (singularity_->even(h) * std::erfc(alpha * s) -
                0.5 * singularity_->odd(h) * boost::math::expint(1, z));
    }

    /// Whether the near part's series hold as far as it reaches.
    bool holds(double alpha) const {
        if (!singularity_) return true;
        return thickness_ * std::sqrt(kThinTail) / alpha < singularity_->limit();
    }

  private:
    // Beyond this erfc(sqrt(z)) is below 1e-20.
    static constexpr double kEndOfTail = 45;
    // And beyond this below 2e-10, which takes what series past their limit are off by.
    static constexpr double kThinTail = 20;

    double thickness_;
    PhaseFunction phase_;
    std::optional<PhaseSingularity> singularity_;
    double energy_;
};

SplitKernel build(const Shape& shape, int lmax, Tails tails) {
    const double thickness = shape.thickness();
    const double radius = 2 * tails.a * tails.b / lmax;
    const double alpha = tails.a / radius;
    const PolarRule rule = gauss_legendre(lmax + 64 + lmax / 4);
    std::vector<double> far(rule.angle.size());
    for (std::size_t i = 0; i < far.size(); ++i) {
        far[i] = shape.exact(rule.angle[i]) - shape.near(alpha, squared_chord(rule.angle[i]));
    }
    SplitKernel split{
        thickness, radius, zonal_eigenvalues(rule, far, lmax + 1),
        RemainderTable([&](double t) { return shape.near(alpha, t); }, radius * radius)};
    // The near part was cut at the radius: what it lost goes back in proportion, so that a constant
    // map sees the energy of the exact kernel.
    const double energy = shape.energy() - split.eigenvalues[0];
    const double scale = energy / (2 * kPi * split.near.total());
    split.near.scale(scale);
    for (int l = 0; l <= lmax; ++l) split.eigenvalues[l] *= taper(l, lmax);

    const std::vector<double> angles = probe_angles(radius, lmax);
    const std::vector<double> smooth = zonal_evaluate(split.eigenvalues, angles);
    for (std::size_t i = 0; i < angles.size(); ++i) {
        const double t = squared_chord(angles[i]);
        const double near = t < radius * radius ? scale * shape.near(alpha, t) : 0.0;
        const double exact = shape.exact(angles[i]);
        const double rounding = kArithmeticError * std::max(1.0, std::fabs(near) / exact);
        const double error = std::fabs(near + smooth[i] - exact) / exact + rounding;
        assert(std::isfinite(error));
        split.error = std::max(split.error, kProbeMargin * error);
    }
    return split;
}

// A backward peak of the phase function is one of the kernel at the antipode.
double antipode_width(const PhaseFunction& phase) {
    double width = std::numeric_limits<double>::infinity();
    if (phase.g() < 0) width = 1 + phase.g();
    if (phase.table() != nullptr) {
        const std::vector<double>& knots = phase.table()->knots();
        for (std::size_t k = 1; k < knots.size(); ++k) {
            if (knots[k] > 0.5 * kPi) width = std::min(width, knots[k] - knots[k - 1]);
        }
    }
    return width;
}

}  // namespace

double near_kernel(double optical_thickness, double alpha, double t) {
    const double z = alpha * alpha * t;
    if (z > 700) return 0;
    const double s = std::sqrt(t), sine = s * std::sqrt(std::max(0.0, 1 - 0.25 * t));
    if (sine == 0) return 0;
    const double phase = optical_thickness * sine;
    return std::exp(0.5 * optical_thickness * t) / (2 * kPi * sine) *
           (0.5 * kPi * std::cos(phase) * std::erfc(alpha * s) -
            0.5 * std::sin(phase) * boost::math::expint(1, z));
}

double split_radius(int lmax, double tolerance) {
    const Tails tails = tails_for(tolerance);
    return 2 * tails.a * tails.b / lmax;
}

std::optional<SplitKernel> make_split_kernel(double optical_thickness, int lmax, double tolerance,
                                             const PhaseFunction& phase) {
    const Shape shape(optical_thickness, phase);
    if (!shape.splits()) return std::nullopt;
    Tails tails = tails_for(tolerance);
    double before = std::numeric_limits<double>::infinity();
    // A dense medium damps the kernel away from its peak, so that the tails weigh more.
    // With alpha = lmax / (2 b) the near part falls off like exp(-(alpha^2 - T/2) s^2).
    while (2 * tails.a * tails.b / lmax < 1 &&
           static_cast<double>(lmax) * lmax > 2.2 * tails.b * tails.b * optical_thickness &&
           shape.holds(lmax / (2 * tails.b))) {
        SplitKernel split = build(shape, lmax, tails);
        if (split.error <= tolerance) return split;
        // A peak narrower than the bands does not care for longer tails.
        if (!shape.is_isotropic() && split.error > 0.97 * before) break;
        before = split.error;
        const double grow = split.error > 4 * tolerance ? 1.08 : 1.03;
        tails.a *= grow;
        tails.b *= grow;
    }
    return std::nullopt;
}

RemainderTable whole_kernel(double optical_thickness) {
    return RemainderTable(
        [=](double t) { return psf_scaled(optical_thickness, angle_of_squared_chord(t)); }, 4.0);
}

RemainderTable whole_kernel(double optical_thickness, const PhaseFunction& phase) {
    if (phase.kind() == PhaseKind::isotropic) return whole_kernel(optical_thickness);
    return RemainderTable(
        [&](double t) { return psf_scaled(optical_thickness, angle_of_squared_chord(t), phase); },
        [&](double tau) {
            return psf_scaled(optical_thickness, kPi - angle_of_squared_chord(tau), phase);
        },
        antipode_width(phase));
}

double whole_kernel_error(double optical_thickness, const PhaseFunction& phase,
                          const RemainderTable& table, double pixel) {
    double error = kArithmeticError;
    if (phase.kind() == PhaseKind::isotropic) return error;
    if (phase.g() < 0) error = std::max(error, 1.5e-7 / (1 + phase.g()));
    double least = std::numeric_limits<double>::infinity();
    // Shells of a ten-thousandth, between the panels' nodes as well as on them; three of their
    // errors meet in a pixel. Closer to the antipode than 0.03 their difference has no digits.
    const bool has_knots = phase.table() != nullptr;
    for (double angle = 1e-4; angle < kPi - 0.03; angle *= has_knots ? 1.003 : 1.05) {
        const double exact = psf_scaled(optical_thickness, angle, phase);
        least = std::min(least, exact);
        if (!has_knots || exact == 0) continue;
        const double low = squared_chord(angle * 0.9999), high = squared_chord(angle * 1.0001);
        const double shell = 2 * (table(low) - table(high)) / (high - low);
        error = std::max(error, 3 * std::fabs(shell / exact - 1));
    }
    // A phase function that vanishes backwards leaves pixels that see nothing, exactly.
    const double rounding = 5e-16;
    return least > 0 ? std::max(error, rounding * 2 * kPi * table.total() / (least * pixel))
                     : error;
}

}  // namespace airlight
