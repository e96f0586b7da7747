// SPDX-License-Identifier: Apache-2.0
#include "medium/surface_radiance.h"

#include <cmath>
#include <limits>

#include "medium/ray_integral.h"
#include "medium/surface_integral.h"

namespace airlight {

double surface_radiance_scaled(double t_sp, double theta_s, double exponent) {
    theta_s = detail::checked_angle(theta_s);
    if (!(t_sp >= 0 && theta_s >= 0 && exponent >= 1 && exponent <= 1000)) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    if (std::isinf(t_sp)) return 0;
    return detail::surface_integral(t_sp, theta_s, detail::LobeRing(exponent));
}

double surface_radiance(double t_sp, double theta_s, double exponent) {
    // Two factors, neither denormal while their product is not.
    const double half = std::exp(-0.5 * t_sp);
    return surface_radiance_scaled(t_sp, theta_s, exponent) * half * half;
}

float surface_radiance_scaled(float t_sp, float theta_s, float exponent) {
    return static_cast<float>(
        surface_radiance_scaled(double{t_sp}, double{theta_s}, double{exponent}));
}

float surface_radiance(float t_sp, float theta_s, float exponent) {
    return static_cast<float>(surface_radiance(double{t_sp}, double{theta_s}, double{exponent}));
}

}  // namespace airlight
