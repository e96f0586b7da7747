// SPDX-License-Identifier: Apache-2.0
#include "medium/slab_method.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "medium/quadrature.h"
#include "medium/slab.h"
#include "medium/slab_integral.h"

namespace airlight {
namespace {

constexpr int kMarchSteps = 64;
// e^-40 is under 1e-17.
constexpr double kDeepest = 40;

struct Case {
    double sigma_t, s, l;
    detail::SlabCosines cosines;
};

// e^{-sigma_t (x + k)} at the distance h from the light.
double transmittance(const Case& c, double x, double h) {
    const double inside = x * c.cosines.w_dot_n;
    const double all = c.l * c.cosines.wl_dot_n + inside;
    const double k = c.cosines.wl_dot_n == 0 ? h : all > 0 ? h * (inside / all) : 0;
    return std::exp(-c.sigma_t * (x + k));
}

double march(const Case& c, double end) {
    const double step = end / kMarchSteps;
    double sum = 0;
    for (int i = 0; i < kMarchSteps; ++i) {
        const double x = (i + 0.5) * step;
        const double h2 = (x - c.l) * (x - c.l) + 2 * x * c.l * (1 + c.cosines.w_dot_wl);
        sum += transmittance(c, x, std::sqrt(h2)) / h2;
    }
    return sum * step;
}

// x = l sin(t) / sin(a + t) and h = l sin(a) / sin(a + t), with a the angle between ray and light.
double equiangular(const Case& c, double end, int nodes) {
    const double g = c.cosines.w_dot_wl;
    const double sin_a = std::sqrt((1 - g) * (1 + g));
    const double angle = slab_falloff(end, c.l, g) * c.l * sin_a;
    const detail::QuadratureRule rule = detail::gauss_legendre(nodes);
    const double half = 0.5 * angle;
    double sum = 0;
    for (int i = 0; i < rule.count; ++i) {
        for (const double offset : {-half * rule.nodes[i].x, half * rule.nodes[i].x}) {
            const double t = half + offset;
            const double toward = c.l / (std::cos(t) * sin_a - std::sin(t) * g);
            sum += rule.nodes[i].w * transmittance(c, std::sin(t) * toward, sin_a * toward);
        }
    }
    return sum * half / (c.l * sin_a);
}

}  // namespace

double slab_near(SlabMethod method, double sigma_t, double s, double l, double w_dot_n,
                 double wl_dot_n, double w_dot_wl) {
    const auto by_panels = [&](int nodes) {
        return detail::slab_near_by(sigma_t, s, l, w_dot_n, wl_dot_n, w_dot_wl, 2, nodes);
    };
    switch (method) {
        case SlabMethod::thin:
            return slab_thin(sigma_t, s, l, w_dot_n, wl_dot_n, w_dot_wl);
        case SlabMethod::panels_gl6:
            return by_panels(6);
        case SlabMethod::panels_gl8:
            return by_panels(8);
        case SlabMethod::panels_gl12:
            return by_panels(12);
        case SlabMethod::exact:
            return slab_near(sigma_t, s, l, w_dot_n, wl_dot_n, w_dot_wl);
        default:
            break;
    }
    const auto cosines = detail::slab_cosines(w_dot_n, wl_dot_n, w_dot_wl);
    if (!cosines || !(sigma_t >= 0 && s >= 0 && l >= 0)) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    // Corners, and lengths whose squares or products leave the range.
    const double end = std::min(s, kDeepest / sigma_t);
    const double g = cosines->w_dot_wl;
    const bool ordinary = end > 1e-100 && end < 1e100 && l > 1e-100 && l < 1e100 &&
                          sigma_t < 1e100 && (1 - g) * (1 + g) > 1e-14;
    if (!ordinary) return slab_near(sigma_t, s, l, w_dot_n, wl_dot_n, w_dot_wl);
    const Case c = {sigma_t, s, l, *cosines};
    if (method == SlabMethod::march64) return march(c, end);
    return equiangular(c, end, method == SlabMethod::equiangular_gl8 ? 8 : 16);
}

}  // namespace airlight
