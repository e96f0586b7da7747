// SPDX-License-Identifier: Apache-2.0
#include "medium/phase_function.h"

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/constants.h"
#include "core/error.h"
#include "medium/ray_integral.h"

namespace airlight {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kIsotropic = 1 / (4 * kPi);
// The float next above 1.
constexpr double kOneOfFloat = 1.00000011920928955;

bool is_asymmetry(double g) {
    return g > -1 && g < 1;
}

double checked_cosine(double cosine) {
    if (!(cosine >= -kOneOfFloat && cosine <= kOneOfFloat)) return kNan;
    return cosine > 1 ? 1 : cosine < -1 ? -1 : cosine;
}

// With the squared denominator k = 1 + g^2 - 2 g cos.
double hg(double g, double k) {
    return kIsotropic * ((1 - g) * (1 + g)) / (k * std::sqrt(k));
}

double rayleigh(double cosine) {
    return 0.75 * kIsotropic * (1 + cosine * cosine);
}

double angle_of(double sine_half, double cosine_half) {
    return 2 * std::atan2(sine_half, cosine_half);
}

// sin^2(angle/2) below which Rayleigh scatters the part xi <= 1/2: the root of
// s^3 - 3/2 s^2 + 3/2 s = xi.
double rayleigh_quantile(double xi) {
    double s = 0.5 - std::sinh(std::asinh(2 - 4 * xi) / 3);
    for (int i = 0; i < 2; ++i) {
        s -= (s * (1.5 + s * (s - 1.5)) - xi) / (1.5 + s * (3 * s - 3));
    }
    return s > 0 ? s : 0;
}

}  // namespace

double phase_rayleigh(double cosine) {
    return rayleigh(checked_cosine(cosine));
}

float phase_rayleigh(float cosine) {
    return static_cast<float>(phase_rayleigh(double{cosine}));
}

double phase_hg(double cosine, double g) {
    cosine = checked_cosine(cosine);
    if (!is_asymmetry(g)) return kNan;
    const double a = std::fabs(g);
    return hg(g, (1 - a) * (1 - a) + 2 * a * (g < 0 ? 1 + cosine : 1 - cosine));
}

float phase_hg(float cosine, float g) {
    return static_cast<float>(phase_hg(double{cosine}, double{g}));
}

double phase_hg_at_angle(double angle, double g) {
    angle = detail::checked_angle(angle);
    if (!is_asymmetry(g)) return kNan;
    const double near = (1 - g) * std::cos(0.5 * angle), far = (1 + g) * std::sin(0.5 * angle);
    return hg(g, near * near + far * far);
}

float phase_hg_at_angle(float angle, float g) {
    return static_cast<float>(phase_hg_at_angle(double{angle}, double{g}));
}

double sample_hg(double xi, double g) {
    if (!(xi >= 0 && xi <= 1) || !is_asymmetry(g)) return kNan;
    return angle_of((1 - g) * std::sqrt(xi * (g < 0 ? (1 + g) - g * xi : 1 + g * (1 - xi))),
                    (1 + g) * std::sqrt((1 - xi) * (g < 0 ? 1 - g * xi : (1 - g) + g * (1 - xi))));
}

PhaseFunction PhaseFunction::rayleigh() {
    PhaseFunction phase;
    phase.kind_ = PhaseKind::rayleigh;
    return phase;
}

PhaseFunction PhaseFunction::henyey_greenstein(double g) {
    if (!is_asymmetry(g)) {
        throw Error(ErrorCode::usage, "the Henyey-Greenstein parameter g = " + std::to_string(g) +
                                          " is not in (-1, 1)");
    }
    PhaseFunction phase;
    phase.kind_ = PhaseKind::henyey_greenstein;
    phase.g_ = g;
    return phase;
}

PhaseFunction PhaseFunction::tabulated(PhaseTable table) {
    PhaseFunction phase;
    phase.kind_ = PhaseKind::tabulated;
    phase.table_ = std::make_shared<const PhaseTable>(std::move(table));
    return phase;
}

double PhaseFunction::at_angle(double angle) const {
    angle = detail::checked_angle(angle);
    if (std::isnan(angle)) return kNan;
    switch (kind_) {
        case PhaseKind::isotropic:
            break;
        case PhaseKind::rayleigh:
            return airlight::rayleigh(std::cos(angle));
        case PhaseKind::henyey_greenstein:
            return phase_hg_at_angle(angle, g_);
        case PhaseKind::tabulated:
            return table_->density(angle);
    }
    return kIsotropic;
}

double PhaseFunction::at_cosine(double cosine) const {
    cosine = checked_cosine(cosine);
    if (std::isnan(cosine)) return kNan;
    switch (kind_) {
        case PhaseKind::isotropic:
            break;
        case PhaseKind::rayleigh:
            return airlight::rayleigh(cosine);
        case PhaseKind::henyey_greenstein:
            return phase_hg(cosine, g_);
        case PhaseKind::tabulated:
            return table_->density(angle_of(std::sqrt(1 - cosine), std::sqrt(1 + cosine)));
    }
    return kIsotropic;
}

double PhaseFunction::sample_angle(double xi) const {
    if (!(xi >= 0 && xi <= 1)) return kNan;
    switch (kind_) {
        case PhaseKind::isotropic:
            break;
        case PhaseKind::rayleigh: {
            const double s = rayleigh_quantile(xi <= 0.5 ? xi : 1 - xi);
            const double a = std::sqrt(s), b = std::sqrt(1 - s);
            return xi <= 0.5 ? angle_of(a, b) : angle_of(b, a);
        }
        case PhaseKind::henyey_greenstein:
            return sample_hg(xi, g_);
        case PhaseKind::tabulated:
            return table_->quantile(xi);
    }
    return angle_of(std::sqrt(xi), std::sqrt(1 - xi));
}

double PhaseFunction::mean_cosine() const {
    switch (kind_) {
        case PhaseKind::isotropic:
        case PhaseKind::rayleigh:
            break;
        case PhaseKind::henyey_greenstein:
            return g_;
        case PhaseKind::tabulated:
            return table_->mean_cosine();
    }
    return 0;
}

}  // namespace airlight
