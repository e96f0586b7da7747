// SPDX-License-Identifier: Apache-2.0
#include "medium/gaussian_density.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/constants.h"
#include "medium/quadrature.h"
#include "medium/scaled_erfc.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
// amplitude / scale is below e^1455 and amplitude * dist below e^1420; a double ends at e^-745.
constexpr double kExponentOfNothing = 2300;

/// x^2 + y^2 with its rounding errors: the sum is value + rest. Each argument is a double and the
/// small part that it lacks.
struct Exponent {
    double value;
    double rest;
};

Exponent squared_norm(double x, double x_rest, double y, double y_rest) {
    const double xx = x * x, yy = y * y;
    const double sum = xx + yy;
    const double larger = std::max(xx, yy), smaller = std::min(xx, yy);
    const double rest = (smaller - (sum - larger)) + std::fma(x, x, -xx) + std::fma(y, y, -yy) +
                        2 * (x * x_rest + y * y_rest);
    return {sum, rest};
}

/// A factor as mantissa * 2^exponent.
struct Split {
    double mantissa;
    int exponent;
};

Split split(double x) {
    Split s;
    s.mantissa = std::frexp(x, &s.exponent);
    return s;
}

/// amplitude length exp(-e) rounded once, or amplitude / length exp(-e) where `divide`. The factor
/// is of moderate size.
double scaled_product(double amplitude, double length, bool divide, double factor, Exponent e) {
    factor *= 1 - e.rest;
    const auto moderate = [](double x) { return x > 1e-90 && x < 1e90; };
    if (moderate(amplitude) && moderate(length) && e.value < 200) {
        const double size = divide ? amplitude / length : amplitude * length;
        return size * factor * std::exp(-e.value);
    }
    const Split c = split(amplitude), l = split(length);
    const Split root = split(std::exp(-0.25 * e.value));
    const double square = root.mantissa * root.mantissa;
    const double mantissa =
        (divide ? c.mantissa / l.mantissa : c.mantissa * l.mantissa) * factor * (square * square);
    return std::ldexp(mantissa,
                      c.exponent + (divide ? -l.exponent : l.exponent) + 4 * root.exponent);
}

/// The mean of f over [0, 1] by the 8-node Gauss-Legendre rule.
template <class Function>
double mean_of(const Function& f) {
    const detail::QuadratureRule rule = detail::gauss_legendre(8);
    double sum = 0;
    for (int i = 0; i < rule.count; ++i) {
        const double x = rule.nodes[i].x;
        sum += rule.nodes[i].w * (f(0.5 - 0.5 * x) + f(0.5 + 0.5 * x));
    }
    return 0.5 * sum;
}

/// The segment in units of 1 / a where it does not hold the peak: it starts `lo` from it.
struct Beyond {
    double lo;
    double lo_rest;
};

Beyond beyond_peak(double a, double m, double dist) {
    if (m <= 0) {
        const double lo = -a * m;
        return {lo, std::fma(a, -m, -lo)};
    }
    const double gap = m - dist;
    const double part = gap - m;
    const double gap_rest = (m - (gap - part)) - (dist + part);
    const double lo = a * gap;
    return {lo, std::fma(a, gap, -lo) + a * gap_rest};
}

bool is_gaussian(double a, double c, double rho_perp, double m_proj) {
    return a >= 0 && a < kInfinity && c >= 0 && c < kInfinity && rho_perp >= 0 &&
           rho_perp < kInfinity && std::abs(m_proj) < kInfinity;
}

/// The line integral as amplitude (length or 1 / length) factor exp(-exponent), so that its
/// logarithm can be had where it underflows. Arguments in the domain, a > 0 and dist > 0.
struct LineParts {
    double length;
    bool divide;
    double factor;
    Exponent exponent;
};

LineParts line_parts(double a, double rho_perp, double m_proj, double dist) {
    const double x = a * rho_perp, x_rest = std::fma(a, rho_perp, -x);
    const double width = a * dist;
    if (m_proj > 0 && m_proj < dist) {
        const Exponent e = squared_norm(x, x_rest, 0, 0);
        if (width < 0.5) {
            const double mean = mean_of([&](double part) {
                const double s = a * (part * dist - m_proj);
                return std::exp(-s * s);
            });
            return {dist, false, mean, e};
        }
        const double sum = std::erf(a * m_proj) + std::erf(a * (dist - m_proj));
        return {a, true, 0.5 * std::sqrt(kPi) * sum, e};
    }
    const Beyond start = beyond_peak(a, m_proj, dist);
    const double lo = start.lo;
    const Exponent e = squared_norm(x, x_rest, lo, start.lo_rest);
    const double growth = width * (2 * lo + width);
    if (width < 0.5 && growth < 3) {
        const double mean = mean_of([&](double part) {
            const double u = part * width;
            return std::exp(-u * (2 * lo + u));
        });
        return {dist, false, mean, e};
    }
    const double difference = erfcx(lo) - std::exp(-growth) * erfcx(lo + width);
    return {a, true, 0.5 * std::sqrt(kPi) * difference, e};
}

double log_line(double a, double log_c, double rho, double m, double dist) {
    const LineParts p = line_parts(a, rho, m, dist);
    const double log_length = std::log(p.length);
    return log_c + std::log(p.factor) + (p.divide ? -log_length : log_length) - p.exponent.value -
           p.exponent.rest;
}

/// Newton's method on the logarithm of the line integral, and past half of what the ray holds on
/// that of what lies beyond: both are all but linear far from the peak. Bisection guards it, and
/// the last step is taken on the integral itself.
double find_distance(double a, double c, double rho, double m, double tau, double total) {
    const double largest = std::numeric_limits<double>::max();
    const double log_c = std::log(c);
    const auto log_density = [&](double t) {
        const Exponent e = squared_norm(a * rho, 0, a * (t - m), 0);
        return log_c - e.value;
    };
    const bool by_rest = tau > 0.5 * total;
    const double goal = by_rest ? total - tau : tau;
    const double log_goal = std::log(goal);
    // No digit changes past `high`; at `low` not even the peak's density would do.
    double high = std::min(std::max(m, 0.0) + 30 / a, largest);
    double low = std::exp(std::log(tau) - log_density(std::max(m, 0.0))) * (1 - 1e-9);
    low = std::clamp(low, std::numeric_limits<double>::denorm_min(), high);
    double t = low;
    for (int i = 0; i < 300; ++i) {
        const double from = by_rest ? m - t : m, length = by_rest ? kInfinity : t;
        const double log_value = log_line(a, log_c, rho, from, length);
        const double reach = std::exp(log_value - log_density(t));
        const double step =
            by_rest ? (log_value - log_goal) * reach : (log_goal - log_value) * reach;
        double next = t + step;
        if (std::abs(log_goal - log_value) < 1e-12 || next == t) {
            const double value = gaussian_line(a, c, rho, from, length);
            next = t + (by_rest ? value / goal - 1 : goal / value - 1) * reach;
            return next > 0 && next < largest ? next : t;
        }
        (step > 0 ? low : high) = t;
        if (next > low && next < high) {
            t = next;
            continue;
        }
        // A range over many orders of magnitude is halved in its logarithm.
        t = high > 4 * low ? std::sqrt(low) * std::sqrt(high) : low + 0.5 * (high - low);
        if (t <= low || t >= high) return t;
    }
    return t;
}

}  // namespace

double gaussian_density(const GaussianBlob& blob, const glm::dvec3& x) {
    const double a = blob.scale, c = blob.amplitude;
    const glm::dvec3 far = x - blob.center;
    const double spread = std::abs(far.x) + std::abs(far.y) + std::abs(far.z);
    if (!(a >= 0 && a < kInfinity && c >= 0 && c < kInfinity) || std::isnan(spread)) return kNan;
    if (a == 0) return c;
    const double u = a * far.x, v = a * far.y, w = a * far.z;
    return c * std::exp(-(u * u + v * v + w * w));
}

GaussianPass gaussian_pass(const glm::dvec3& center, const glm::dvec3& origin,
                           const glm::dvec3& direction) {
    const double square = glm::dot(direction, direction);
    if (!(std::abs(square - 1) <= 1e-5)) return {kNan, kNan};
    const double length = std::sqrt(square);
    const glm::dvec3 to = center - origin;
    const glm::dvec3 across = glm::cross(to, direction);
    return {std::hypot(across.x, across.y, across.z) / length, glm::dot(to, direction) / length};
}

double gaussian_line(double a, double c, double rho_perp, double m_proj, double dist) {
    if (!is_gaussian(a, c, rho_perp, m_proj) || !(dist >= 0)) return kNan;
    if (c == 0 || dist == 0) return 0;
    if (a == 0) return c * dist;
    const LineParts p = line_parts(a, rho_perp, m_proj, dist);
    if (!(p.exponent.value < kExponentOfNothing)) return 0;
    return scaled_product(c, p.length, p.divide, p.factor, p.exponent);
}

float gaussian_line(float a, float c, float rho_perp, float m_proj, float dist) {
    return static_cast<float>(
        gaussian_line(double{a}, double{c}, double{rho_perp}, double{m_proj}, double{dist}));
}

double gaussian_line_inverse(double a, double c, double rho_perp, double m_proj, double tau) {
    if (!is_gaussian(a, c, rho_perp, m_proj) || !(tau >= 0)) return kNan;
    if (tau == 0) return 0;
    if (c == 0) return kInfinity;
    if (a == 0) return tau / c;
    const double total = gaussian_line(a, c, rho_perp, m_proj, kInfinity);
    if (tau >= total) return kInfinity;
    return find_distance(a, c, rho_perp, m_proj, tau, total);
}

float gaussian_line_inverse(float a, float c, float rho_perp, float m_proj, float tau) {
    return static_cast<float>(
        gaussian_line_inverse(double{a}, double{c}, double{rho_perp}, double{m_proj}, double{tau}));
}

double gaussian_optical_depth(const GaussianBlob& blob, const glm::dvec3& origin,
                              const glm::dvec3& direction, double dist) {
    const GaussianPass pass = gaussian_pass(blob.center, origin, direction);
    return gaussian_line(blob.scale, blob.amplitude, pass.rho_perp, pass.m_proj, dist);
}

double gaussian_optical_depth(const GaussianBlob& blob, const glm::dvec3& from,
                              const glm::dvec3& to) {
    const glm::dvec3 span = to - from;
    const double dist = std::hypot(span.x, span.y, span.z);
    if (dist == 0) return gaussian_line(blob.scale, blob.amplitude, 0, 0, 0);
    return gaussian_optical_depth(blob, from, span / dist, dist);
}

}  // namespace airlight
