// SPDX-License-Identifier: Apache-2.0
#include "medium/phase_integral.h"

#include <algorithm>
#include <cmath>

#include "medium/quadrature.h"

namespace airlight {
namespace detail {
namespace {

constexpr double kLongestPanel = 2;
constexpr double kLargestExponent = 13;
// What lies past this exponent is under the rounding of the rest.
constexpr double kLastExponent = 38;
constexpr double kNegligible = 1e-18;
// And this exponent is no attenuation at all.
constexpr double kClear = 1e-17;
constexpr int kNodes = 16;

// Legs as they come up here, 1e-33 to 1e20 the longer one, have squares in range.
double length(double a, double b) {
    return std::sqrt(a * a + b * b);
}

// A point of the ray: u = cos(theta) + x and the root of K^2 + u^2.
struct Point {
    double x, u, root;
};

// The map from t = q - q(0) to points; no difference of nearly equal numbers is taken.
struct Map {
    double c, s;  // cos(theta), sin(theta)
    double scale;
    double root_0;

    Map(const RayAngle& angle, double scale_of_sine)
        : c(angle.cos_theta),
          s(angle.sin_theta),
          scale(scale_of_sine * angle.sin_theta),
          root_0(length(scale, c)) {}

    // From e^t - 1.
    Point at(double e) const {
        const double inverse = 0.5 / (1 + e), square = e * e * inverse;
        const double x = c * square + root_0 * e * (e + 2) * inverse;
        return {x, c + x, root_0 + root_0 * square + c * e * (e + 2) * inverse};
    }
    double e_of(double x) const {
        const double root = length(scale, c + x);
        const double grown = x * ((x + 2 * c) / (root + root_0));
        return (grown + x) / (root_0 + c);
    }
};

// e^o - 1 at the nodes' offsets o from a panel's begin.
struct PanelOffsets {
    double low[kNodes / 2], high[kNodes / 2];

    explicit PanelOffsets(double length) {
        const QuadratureRule rule = gauss_legendre(kNodes);
        for (int i = 0; i < kNodes / 2; ++i) {
            low[i] = std::expm1(0.5 * length * (1 - rule.nodes[i].x));
            high[i] = std::expm1(0.5 * length * (1 + rule.nodes[i].x));
        }
    }
};

// int f e^{-y x} over one panel that begins where e^t - 1 = e.
template <class Integrand>
double panel_integral(const Map& map, double y, double e, double length,
                      const PanelOffsets& offsets, bool is_clear, const Integrand& f) {
    const QuadratureRule rule = gauss_legendre(kNodes);
    double sum = 0;
    for (int i = 0; i < kNodes / 2; ++i) {
        const Point a = map.at(e + offsets.low[i] * (1 + e));
        const Point b = map.at(e + offsets.high[i] * (1 + e));
        sum += rule.nodes[i].w *
               (is_clear ? f(a) + f(b) : f(a) * std::exp(-y * a.x) + f(b) * std::exp(-y * b.x));
    }
    return 0.5 * length * sum;
}

// Adds panels from x_begin to x_end; false once nothing more can be seen.
template <class Integrand>
bool add_panels(const Map& map, double y, double x_begin, double x_end, const Integrand& f,
                double& sum) {
    static const PanelOffsets kLongest(kLongestPanel);
    static const double kGrowth = std::expm1(kLongestPanel);
    double x = x_begin, e = x_begin == 0 ? 0 : map.e_of(x_begin);
    while (x < x_end) {
        if (y * x >= kLastExponent) return false;
        double e_next = e + kGrowth * (1 + e), x_next = map.at(e_next).x, panel = 0;
        const double reach =
            std::min({x + kLargestExponent / y, (1 + 1e-15) * kLastExponent / y, x_end});
        if (reach < x_next) {
            x_next = reach;
            e_next = map.e_of(reach);
            const double length = std::log1p((e_next - e) / (1 + e));
            panel = panel_integral(map, y, e, length, PanelOffsets(length), false, f);
        } else {
            const bool is_clear = y * x_next < kClear;
            panel = panel_integral(map, y, e, kLongestPanel, kLongest, is_clear, f);
        }
        // The integrand has one maximum: past it, a small panel is followed by smaller ones.
        if (panel < kNegligible * sum) return false;
        sum += panel;
        if (!(x_next > x)) break;
        x = x_next;
        e = e_next;
    }
    return true;
}

// By as many panels as it takes.
struct Composite {
    template <class Integrand>
    double operator()(const Map& map, double y, double x_end, const Integrand& f) const {
        if (std::isinf(y)) return 0;
        double sum = 0;
        add_panels(map, std::fabs(y), 0, x_end, f, sum);
        return sum;
    }
};

// By one panel over all that can be seen.
struct SinglePanel {
    QuadratureRule rule;

    template <class Integrand>
    double operator()(const Map& map, double y, double x_end, const Integrand& f) const {
        // Past 1/epsilon^2 even 1/x^2 has no weight left.
        const double x = std::min({x_end, kLastExponent / std::fabs(y), 1e18});
        const double half = 0.5 * std::log1p(map.e_of(x));
        double sum = 0;
        for (int i = 0; i < rule.count; ++i) {
            for (const double node : {rule.nodes[i].x, -rule.nodes[i].x}) {
                const Point p = map.at(std::expm1(half * (1 + node)));
                sum += rule.nodes[i].w * f(p) * std::exp(-std::fabs(y) * p.x);
            }
        }
        return half * sum;
    }
};

// Below this the phase function is that of the viewer's end, and X may be denormal.
constexpr double kVanishing = 1e-250;

// (1 - e^{-p}) / p
double mean_transmittance(double p) {
    return p > 0 ? -std::expm1(-p) / p : 1;
}

template <class Integral>
double mean(double at_viewer, double y, double x_end, const Integral& integral) {
    return x_end < kVanishing ? at_viewer * mean_transmittance(y * x_end) : integral() / x_end;
}

double rayleigh_integral(double y, const RayAngle& angle, double x_end) {
    const Map map(angle, 1);
    const double s2 = map.s * map.s;
    return Composite()(map, y, x_end, [=](const Point& p) {
        // The squares of cos(alpha/2) and sin(alpha/2), which sum to 1.
        const double r = 1 / (p.root * p.root), a = s2 * r, b = p.u * p.u * r;
        return 1.5 * (a * a + b * b) / p.root;
    });
}

double table_integral(const PhaseTable& table, double y, const RayAngle& angle, double x_end) {
    const Map map(angle, 1);
    const std::vector<double>& knots = table.knots();
    const double gamma = 2 * std::atan2(map.c, map.s);
    if (std::isinf(y)) return 0;
    double sum = 0, x = 0;
    for (std::size_t k = table.interval(gamma); k + 1 < knots.size() && x < x_end; ++k) {
        // Where the scattering angle is knot k + 1.
        double x_next = x_end;
        if (k + 2 < knots.size()) {
            const double half = 0.5 * knots[k + 1];
            x_next = std::min(x_end, std::sin(half - 0.5 * gamma) / std::cos(half));
        }
        if (!(x_next > x)) continue;
        double part = 0;
        const bool more = add_panels(
            map, y, x, x_next,
            [&, k](const Point& p) {
                const double alpha = 2 * std::atan2(p.u, map.s);
                return 4 * kPi * table.density(alpha, k) / p.root;
            },
            part);
        sum += part;
        if (!more && part < kNegligible * sum) break;
        x = x_next;
    }
    return sum;
}

// g < 0 and g >= 0 differ in the scale that keeps singularities away.
template <class Rule>
double hg_integral(const Rule& integrate, double g, double y, const RayAngle& angle, double x_end) {
    const double ratio = (1 - g) / (1 + g);
    if (g < 0) {
        const Map map(angle, 1);
        const double a = (1 - g) * map.s, factor = (1 - g) * (1 + g);
        return integrate(map, y, x_end, [=](const Point& p) {
            // In units of the root, so that no power leaves the range.
            const double near = a / p.root, far = (1 + g) * (p.u / p.root);
            const double k = near * near + far * far;
            return factor / (k * std::sqrt(k) * p.root);
        });
    }
    const Map map(angle, ratio);
    const double factor = (1 - g) / ((1 + g) * (1 + g));
    return integrate(map, y, x_end, [=](const Point& p) {
        return factor * (length(map.s, p.u) / p.root) / p.root;
    });
}

}  // namespace

double hg_ray_integral(double g, double y, const RayAngle& angle, double x_end) {
    return hg_integral(Composite(), g, y, angle, x_end);
}

double hg_panel_integral(double g, double y, const RayAngle& angle, double x_end, int nodes) {
    return hg_integral(SinglePanel{gauss_legendre(nodes)}, g, y, angle, x_end);
}

double mean_hg_ray_integral(double g, double y, const RayAngle& angle, double x_end) {
    const double at_viewer =
        x_end < kVanishing
            ? 4 * kPi * phase_hg_at_angle(2 * std::atan2(angle.cos_theta, angle.sin_theta), g)
            : 0;
    return mean(at_viewer, y, x_end, [&] { return hg_ray_integral(g, y, angle, x_end); });
}

double phase_ray_integral(const PhaseFunction& phase, double y, const RayAngle& angle,
                          double x_end) {
    switch (phase.kind()) {
        case PhaseKind::isotropic:
            break;
        case PhaseKind::rayleigh:
            return rayleigh_integral(y, angle, x_end);
        case PhaseKind::henyey_greenstein:
            return hg_ray_integral(phase.g(), y, angle, x_end);
        case PhaseKind::tabulated:
            return table_integral(*phase.table(), y, angle, x_end);
    }
    return finite_ray_integral(y, angle, x_end);
}

double mean_phase_ray_integral(const PhaseFunction& phase, double y, const RayAngle& angle,
                               double x_end) {
    if (phase.kind() == PhaseKind::isotropic) return mean_ray_integral(y, angle, x_end);
    const double at_viewer =
        x_end < kVanishing
            ? 4 * kPi * phase.at_angle(2 * std::atan2(angle.cos_theta, angle.sin_theta))
            : 0;
    return mean(at_viewer, y, x_end, [&] { return phase_ray_integral(phase, y, angle, x_end); });
}

}  // namespace detail
}  // namespace airlight
