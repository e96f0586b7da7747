// SPDX-License-Identifier: Apache-2.0
#include "medium/airlight.h"

#include <cmath>

#include "medium/ray_integral.h"
#include "medium/ray_triangle.h"

namespace airlight {
namespace {

double integral(const detail::RayTriangle<double>& r) {
    const detail::RayAngle angle = detail::ray_angle(r.gamma);
    return r.ends_near ? detail::mean_ray_integral(r.y, angle, r.x_end)
                       : detail::finite_ray_integral(r.y, angle, r.x_end);
}

}  // namespace

double airlight(double gamma, double t_sv, double t_vp) {
    return detail::airlight_by(gamma, t_sv, t_vp, std::exp(-0.5 * t_sv), integral);
}

double airlight_scaled(double gamma, double t_sv, double t_vp) {
    return detail::airlight_by(gamma, t_sv, t_vp, 1.0, integral);
}

float airlight(float gamma, float t_sv, float t_vp) {
    return static_cast<float>(airlight(double{gamma}, double{t_sv}, double{t_vp}));
}

float airlight_scaled(float gamma, float t_sv, float t_vp) {
    return static_cast<float>(airlight_scaled(double{gamma}, double{t_sv}, double{t_vp}));
}

}  // namespace airlight
