// SPDX-License-Identifier: Apache-2.0
// Airlight the slow way: long double, many panels, none of the library's code.
#pragma once

#include <algorithm>
#include <cmath>

namespace airlight {

/// airlight_scaled(gamma, t_sv, t_vp) for 0 < gamma <= pi and thicknesses whose squares stay in
/// range: the excess-path integral in p + kappa = omega sinh q, 48 panels of 8-node
/// Gauss-Legendre. Error under 1e-16.
inline double slow_airlight_scaled(double gamma_d, double t_sv, double t_vp) {
    constexpr long double pi = 3.14159265358979323846264338327950288L;
    constexpr long double kNodes[4][2] = {
        {0.1834346424956498049394761L, 0.3626837833783619829651504L},
        {0.5255324099163289858177390L, 0.3137066458778872873379622L},
        {0.7966664774136267395915539L, 0.2223810344533744705443560L},
        {0.9602898564975362316835609L, 0.1012285362903762591525314L}};
    const long double gamma = gamma_d, s = t_sv, v = t_vp;
    const long double sine = std::sin(gamma / 2), kappa = 2 * s * sine * sine;
    const long double omega = 2 * s * sine * std::cos(gamma / 2);
    long double path = 45;
    if (!std::isinf(t_vp)) {
        const long double d = std::sqrt((v - s) * (v - s) + 4 * v * s * sine * sine);
        const long double far = (v - s) + kappa;
        const long double u = far >= 0 ? far + d : omega * omega / (d - far);
        path = std::min(path, 2 * v * u / (v + d + s));
    }
    // In units of omega the radius sqrt(a^2 + 1) is that of the point p = 0.
    const long double a = kappa / omega, b = (path + kappa) / omega;
    const long double ra = std::sqrt(1 + a * a), rb = std::sqrt(1 + b * b);
    const long double width =
        std::min(45.0L, std::asinh(path / omega * (a + b) / (b * ra + a * rb)));
    const int panels = 48;
    const long double half = width / (2 * panels);
    long double sum = 0;
    for (int i = 0; i < panels; ++i) {
        for (const auto& node : kNodes) {
            for (const long double sign : {-1.0L, 1.0L}) {
                const long double t = half * (2 * i + 1 + sign * node[0]);
                const long double sh = std::sinh(t / 2);
                const long double p = omega * (2 * a * sh * sh + ra * std::sinh(t));
                sum += node[1] * std::exp(-p) / (ra * std::cosh(t) + a * std::sinh(t));
            }
        }
    }
    return static_cast<double>(2 * sum * half / omega / (4 * pi));
}

}  // namespace airlight
