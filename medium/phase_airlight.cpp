// SPDX-License-Identifier: Apache-2.0
#include "medium/phase_airlight.h"

#include <cmath>
#include <limits>

#include "medium/airlight.h"
#include "medium/phase_integral.h"
#include "medium/psf.h"
#include "medium/ray_triangle.h"

namespace airlight {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool is_isotropic(const PhaseFunction& phase) {
    return phase.kind() == PhaseKind::isotropic;
}

bool is_asymmetry(double g) {
    return g > -1 && g < 1;
}

// Either integral of a triangle, as detail::airlight_by wants it.
auto integral_of(const PhaseFunction& phase) {
    return [&phase](const detail::RayTriangle<double>& r) {
        const detail::RayAngle angle = detail::ray_angle(r.gamma);
        return r.ends_near ? detail::mean_phase_ray_integral(phase, r.y, angle, r.x_end)
                           : detail::phase_ray_integral(phase, r.y, angle, r.x_end);
    };
}

auto hg_integral(double g) {
    return [g](const detail::RayTriangle<double>& r) {
        const detail::RayAngle angle = detail::ray_angle(r.gamma);
        return r.ends_near ? detail::mean_hg_ray_integral(g, r.y, angle, r.x_end)
                           : detail::hg_ray_integral(g, r.y, angle, r.x_end);
    };
}

// PSF e^T / T times T and two factors of half the transmittance, by H_p of the infinite ray.
template <class Integral>
double psf_by(double t, double gamma, const Integral& integral) {
    gamma = detail::checked_angle(gamma);
    if (!(gamma >= 0 && t >= 0)) return kNan;
    if (t == 0) return 0;
    if (gamma == 0) return kInfinity;
    // Two factors, neither denormal while their product is not.
    const double half = std::exp(-0.5 * t);
    if (half == 0) return 0;
    const detail::RayAngle angle = detail::ray_angle(gamma);
    // Halving a denormal gamma would round it away.
    const double rho = gamma < 1e-10 ? gamma : 2 * angle.cos_theta;
    const double h = integral(t * rho, angle) / (2 * kPi);
    return t < 1 ? t / rho * half * half * h : half * t / rho * h * half;
}

}  // namespace

double airlight(double gamma, double t_sv, double t_vp, const PhaseFunction& phase) {
    if (is_isotropic(phase)) return airlight(gamma, t_sv, t_vp);
    return detail::airlight_by(gamma, t_sv, t_vp, std::exp(-0.5 * t_sv), integral_of(phase));
}

double airlight_scaled(double gamma, double t_sv, double t_vp, const PhaseFunction& phase) {
    if (is_isotropic(phase)) return airlight_scaled(gamma, t_sv, t_vp);
    return detail::airlight_by(gamma, t_sv, t_vp, 1.0, integral_of(phase));
}

double airlight_hg(double gamma, double t_sv, double t_vp, double g) {
    if (!is_asymmetry(g)) return kNan;
    if (g == 0) return airlight(gamma, t_sv, t_vp);
    return detail::airlight_by(gamma, t_sv, t_vp, std::exp(-0.5 * t_sv), hg_integral(g));
}

double psf(double optical_thickness, double gamma, const PhaseFunction& phase) {
    if (is_isotropic(phase)) return psf(optical_thickness, gamma);
    return psf_by(optical_thickness, gamma, [&](double y, const detail::RayAngle& angle) {
        return detail::phase_ray_integral(phase, y, angle, kInfinity);
    });
}

double psf_hg(double optical_thickness, double gamma, double g) {
    if (!is_asymmetry(g)) return kNan;
    if (g == 0) return psf(optical_thickness, gamma);
    return psf_by(optical_thickness, gamma, [g](double y, const detail::RayAngle& angle) {
        return detail::hg_ray_integral(g, y, angle, kInfinity);
    });
}

double psf_scaled(double optical_thickness, double gamma, const PhaseFunction& phase) {
    if (is_isotropic(phase)) return psf_scaled(optical_thickness, gamma);
    gamma = detail::checked_angle(gamma);
    if (!(gamma >= 0 && optical_thickness >= 0)) return kNan;
    if (gamma == 0) return kInfinity;
    if (std::isinf(optical_thickness)) return 0;
    const detail::RayAngle angle = detail::ray_angle(gamma);
    const double rho = gamma < 1e-10 ? gamma : 2 * angle.cos_theta;
    return detail::phase_ray_integral(phase, optical_thickness * rho, angle, kInfinity) /
           (2 * kPi) / rho;
}

double npsf(double gamma, const PhaseFunction& phase) {
    return psf_scaled(1.0, gamma, phase);
}

double psf_factored(double optical_thickness, double gamma, const PhaseFunction& phase) {
    const double normalised = npsf(gamma, phase);
    if (std::isnan(normalised) || !(optical_thickness >= 0)) return kNan;
    if (optical_thickness == 0) return 0;
    if (std::isinf(normalised)) return normalised;
    const double transmittance = std::exp(-optical_thickness);
    return transmittance == 0 ? 0 : optical_thickness * transmittance * normalised;
}

float airlight(float gamma, float t_sv, float t_vp, const PhaseFunction& phase) {
    return static_cast<float>(airlight(double{gamma}, double{t_sv}, double{t_vp}, phase));
}

float airlight_scaled(float gamma, float t_sv, float t_vp, const PhaseFunction& phase) {
    return static_cast<float>(airlight_scaled(double{gamma}, double{t_sv}, double{t_vp}, phase));
}

float airlight_hg(float gamma, float t_sv, float t_vp, float g) {
    return static_cast<float>(airlight_hg(double{gamma}, double{t_sv}, double{t_vp}, double{g}));
}

float psf(float optical_thickness, float gamma, const PhaseFunction& phase) {
    return static_cast<float>(psf(double{optical_thickness}, double{gamma}, phase));
}

float psf_scaled(float optical_thickness, float gamma, const PhaseFunction& phase) {
    return static_cast<float>(psf_scaled(double{optical_thickness}, double{gamma}, phase));
}

float npsf(float gamma, const PhaseFunction& phase) {
    return static_cast<float>(npsf(double{gamma}, phase));
}

float psf_factored(float optical_thickness, float gamma, const PhaseFunction& phase) {
    return static_cast<float>(psf_factored(double{optical_thickness}, double{gamma}, phase));
}

float psf_hg(float optical_thickness, float gamma, float g) {
    return static_cast<float>(psf_hg(double{optical_thickness}, double{gamma}, double{g}));
}

}  // namespace airlight
