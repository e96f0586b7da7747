// SPDX-License-Identifier: Apache-2.0
#include "medium/phase_airlight_method.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/constants.h"
#include "medium/phase_airlight.h"
#include "medium/phase_integral.h"
#include "medium/ray_triangle.h"

namespace airlight {
namespace {

constexpr int kSteps = 64;
// What lies beyond this excess path is under the rounding of the rest.
constexpr double kLongestPath = 40;
// The single panel gives no mean over a vanishing segment.
constexpr double kVanishing = 1e-100;

double march(double gamma, double t_sv, double t_vp, double g) {
    const bool inside = gamma > 0 && gamma <= kPi && t_sv > 0 && std::isfinite(t_sv) && t_vp > 0;
    if (!inside) return airlight_hg(gamma, t_sv, t_vp, g);
    const double sine = std::sin(0.5 * gamma), kappa = 2 * t_sv * sine * sine;
    const double longest = kLongestPath * (kLongestPath + 2 * t_sv) / (2 * (kLongestPath + kappa));
    const double step = std::min(t_vp, longest) / kSteps;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double t = (i + 0.5) * step, beyond = t - t_sv;
        const double squared = beyond * beyond + 2 * kappa * t, distance = std::sqrt(squared);
        const double cosine = std::clamp(-(beyond + kappa) / distance, -1.0, 1.0);
        sum += phase_hg(cosine, g) * std::exp(-(beyond + distance)) / squared;
    }
    const double value = sum * step * std::exp(-t_sv);
    // A step can land on the light, and squares leave the range where lengths do not.
    return std::isfinite(value) ? value : airlight_hg(gamma, t_sv, t_vp, g);
}

double by_panel(double gamma, double t_sv, double t_vp, double g, int nodes) {
    return detail::airlight_by(
        gamma, t_sv, t_vp, std::exp(-0.5 * t_sv), [=](const detail::RayTriangle<double>& r) {
            const detail::RayAngle angle = detail::ray_angle(r.gamma);
            if (r.ends_near && r.x_end < kVanishing) {
                return detail::mean_hg_ray_integral(g, r.y, angle, r.x_end);
            }
            const double h = detail::hg_panel_integral(g, r.y, angle, r.x_end, nodes);
            return r.ends_near ? h / r.x_end : h;
        });
}

}  // namespace

double airlight_hg(double gamma, double t_sv, double t_vp, double g, PhaseAirlightMethod method) {
    if (!(g > -1 && g < 1)) return std::numeric_limits<double>::quiet_NaN();
    switch (method) {
        case PhaseAirlightMethod::march64:
            return march(gamma, t_sv, t_vp, g);
        case PhaseAirlightMethod::gl8:
            return by_panel(gamma, t_sv, t_vp, g, 8);
        case PhaseAirlightMethod::gl16:
            return by_panel(gamma, t_sv, t_vp, g, 16);
        case PhaseAirlightMethod::gl32:
            return by_panel(gamma, t_sv, t_vp, g, 32);
        case PhaseAirlightMethod::exact:
            break;
    }
    return airlight_hg(gamma, t_sv, t_vp, g);
}

}  // namespace airlight
