// SPDX-License-Identifier: Apache-2.0
#include "medium/psf.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "medium/ray_integral.h"

namespace airlight {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr float kPiFloat = 3.14159274f;

bool in_domain(double optical_thickness, double gamma) {
    return optical_thickness >= 0 && gamma >= 0 && gamma <= kPi;
}

// The float nearest to pi lies above it and stands for pi.
double widen_angle(float gamma) {
    return gamma == kPiFloat ? kPi : static_cast<double>(gamma);
}

}  // namespace

double psf_scaled(double optical_thickness, double gamma) {
    if (!in_domain(optical_thickness, gamma)) return std::numeric_limits<double>::quiet_NaN();
    if (gamma == 0) return std::numeric_limits<double>::infinity();
    const detail::RayAngle angle = detail::ray_angle(gamma);
    const double rho = 2 * angle.cos_theta;
    const double h = detail::infinite_ray_integral(optical_thickness * rho, angle);
    return h == 0 ? 0 : h / (2 * kPi * rho);
}

double psf(double optical_thickness, double gamma) {
    const double scaled = psf_scaled(optical_thickness, gamma);
    if (std::isnan(scaled)) return scaled;
    if (optical_thickness == 0) return 0;
    if (std::isinf(scaled)) return scaled;
    if (scaled == 0) return 0;
    return optical_thickness * scaled * std::exp(-optical_thickness);
}

double npsf(double gamma) {
    return psf_scaled(1.0, gamma);
}

double psf_factored(double optical_thickness, double gamma) {
    const double normalised = npsf(gamma);
    if (std::isnan(normalised) || !(optical_thickness >= 0)) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    if (optical_thickness == 0) return 0;
    if (std::isinf(normalised)) return normalised;
    const double transmittance = std::exp(-optical_thickness);
    return transmittance == 0 ? 0 : optical_thickness * transmittance * normalised;
}

float psf_scaled(float optical_thickness, float gamma) {
    return static_cast<float>(psf_scaled(double{optical_thickness}, widen_angle(gamma)));
}

float psf(float optical_thickness, float gamma) {
    return static_cast<float>(psf(double{optical_thickness}, widen_angle(gamma)));
}

float npsf(float gamma) {
    return static_cast<float>(npsf(widen_angle(gamma)));
}

float psf_factored(float optical_thickness, float gamma) {
    return static_cast<float>(psf_factored(double{optical_thickness}, widen_angle(gamma)));
}

}  // namespace airlight
