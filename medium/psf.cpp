// SPDX-License-Identifier: Apache-2.0
#include "medium/psf.h"

#include <cmath>
#include <limits>

#include "medium/ray_integral.h"

namespace airlight {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// 2 sin(gamma / 2); halving a denormal gamma would round it away.
double chord(double gamma, const detail::RayAngle& angle) {
    return gamma < 1e-10 ? gamma : 2 * angle.cos_theta;
}

}  // namespace

double psf_scaled(double optical_thickness, double gamma) {
    gamma = detail::checked_angle(gamma);
    if (!(gamma >= 0 && optical_thickness >= 0)) return kNan;
    if (gamma == 0) return kInfinity;
    if (std::isinf(optical_thickness)) return 0;
    const detail::RayAngle angle = detail::ray_angle(gamma);
    const double rho = chord(gamma, angle);
    const double h = detail::infinite_ray_integral(optical_thickness * rho, angle);
    return h == 0 ? 0 : h / (2 * kPi * rho);
}

double psf(double optical_thickness, double gamma) {
    const double t = optical_thickness;
    gamma = detail::checked_angle(gamma);
    if (!(gamma >= 0 && t >= 0)) return kNan;
    if (t == 0) return 0;
    if (gamma == 0) return kInfinity;
    // Two factors, neither denormal while their product is not.
    const double half = std::exp(-0.5 * t);
    if (half == 0) return 0;
    const detail::RayAngle angle = detail::ray_angle(gamma);
    const double rho = chord(gamma, angle);
    const double h = detail::infinite_ray_integral(t * rho, angle) / (2 * kPi);
    return t < 1 ? t / rho * half * half * h : half * t / rho * h * half;
}

double npsf(double gamma) {
    return psf_scaled(1.0, gamma);
}

double psf_factored(double optical_thickness, double gamma) {
    const double normalised = npsf(gamma);
    if (std::isnan(normalised) || !(optical_thickness >= 0)) {
        return kNan;
    }
    if (optical_thickness == 0) return 0;
    if (std::isinf(normalised)) return normalised;
    const double transmittance = std::exp(-optical_thickness);
    return transmittance == 0 ? 0 : optical_thickness * transmittance * normalised;
}

float psf_scaled(float optical_thickness, float gamma) {
    return static_cast<float>(psf_scaled(double{optical_thickness}, double{gamma}));
}

float psf(float optical_thickness, float gamma) {
    return static_cast<float>(psf(double{optical_thickness}, double{gamma}));
}

float npsf(float gamma) {
    return static_cast<float>(npsf(double{gamma}));
}

float psf_factored(float optical_thickness, float gamma) {
    return static_cast<float>(psf_factored(double{optical_thickness}, double{gamma}));
}

}  // namespace airlight
