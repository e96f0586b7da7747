// SPDX-License-Identifier: Apache-2.0
#include "sh/basis.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/constants.h"
#include "sh/basis_recurrence.h"
#include "sh/index.h"

namespace airlight {
namespace {

constexpr double kSqrt2 = 1.41421356237309504880;

// Orders up to this one take the tables of low_order_basis.
constexpr int kLowOrder = detail::kVectorOrder;

// A number value 2^(-kDigit borrowed), so that P_mm of any size can start a recurrence.
constexpr int kDigit = 600;
const double kDigitUp = std::ldexp(1.0, kDigit);
const double kDigitDown = std::ldexp(1.0, -kDigit);
const double kDigitHalf = std::ldexp(1.0, kDigit / 2);

struct Extended {
    double value = 0;
    int borrowed = 0;

    double rounded() const {
        return borrowed == 0 ? value : borrowed == 1 ? value * kDigitDown : 0;
    }
};

Extended extended(double mantissa, long exponent) {
    if (mantissa == 0) return {};
    const long borrowed = std::max(0L, std::lround(-static_cast<double>(exponent) / kDigit));
    return {std::ldexp(mantissa, static_cast<int>(exponent + borrowed * kDigit)),
            static_cast<int>(borrowed)};
}

// factor base^power for a base in [0, 1]; below 1/2, the power must be whole.
Extended scaled_power(double factor, double base, double power) {
    int base_exponent = 0;
    if (base < 0.5) base = std::frexp(base, &base_exponent);
    long exponent = std::lround(base_exponent * power);
    // No block of these underflows, and each costs one rounding.
    constexpr double kBlock = 512;
    for (; power > kBlock; power -= kBlock) {
        int e = 0;
        factor = std::frexp(factor * std::pow(base, kBlock), &e);
        exponent += e;
    }
    return extended(factor * std::pow(base, power), exponent);
}

// (2m+1)!! / (2m)!! = 2 / sqrt(pi) Gamma(m + 3/2) / Gamma(m + 1).
double double_factorial_ratio(int m) {
    if (m < 32) {
        double odd = 1, even = 1;
        for (int k = 1; k <= m; ++k) {
            odd *= 2 * k + 1;
            even *= 2 * k;
        }
        return odd / even;
    }
    // Stirling's series of both about z = m + 3/4, where the even powers of 1/z drop out of the
    // logarithm of the ratio ([DLMF] 5.11.8); the next term is under 3e-18.
    const double z = m + 0.75;
    const double w = 1 / (z * z);
    const double series =
        w * (1.0 / 64 - w * (5.0 / 2048 - w * (61.0 / 49152 - w * (1385.0 / 1048576))));
    return 2 * std::sqrt(z / kPi) * std::exp(series);
}

// P_mm = sqrt((2m+1)!! / (2m)!! / (4 pi)) sin^m(theta).
Extended sectoral(int m, double cos_theta, double sin_theta) {
    const double factor = std::sqrt(double_factorial_ratio(m) / (4 * kPi));
    if (std::abs(cos_theta) >= 0.7) return scaled_power(factor, sin_theta, m);
    // sin^2 = square + rest to twice the precision: near the equator the cosine holds more digits
    // of sin^m than the sine does.
    const double cos2 = cos_theta * cos_theta;
    const double square = 1 - cos2;
    const double rest = ((1 - square) - cos2) - std::fma(cos_theta, cos_theta, -cos2);
    return scaled_power(factor * std::exp(m / 2.0 * rest / square), square, m / 2.0);
}

// |x| >= 1/2, the difference form; coarse + fine = 1 - |x| to more than double precision. The
// rounding of a plain double would turn theta away from that of P_mm = sin^m, and cost m eps. The
// coarse part has few digits, or the fine one would drown in the rounding of coarse p.
void legendre_by_differences(int order, double coarse, double fine, int m, Extended seed,
                             double* out) {
    double p = seed.value;
    double difference = 0;
    for (int l = m; l < order; ++l) {
        *out++ = Extended{p, seed.borrowed}.rounded();
        const double bent = coarse * p + fine * p;
        difference = ((l - m) * difference - (2.0 * l + 1) * bent) / (l + m + 1.0);
        p += difference;
        // For m = 0 the norm is applied in closed form afterwards.
        if (m == 0) continue;
        const double norm =
            std::sqrt((2.0 * l + 3) * (l + m + 1.0) / ((2.0 * l + 1) * (l - m + 1.0)));
        p *= norm;
        difference *= norm;
        if (seed.borrowed > 0 && std::abs(p) > kDigitHalf) {
            p *= kDigitDown;
            difference *= kDigitDown;
            --seed.borrowed;
        }
    }
}

// |x| < 1/2, the three-term recurrence P_l+1 = a_l+1 (x P_l - P_l-1 / a_l).
void legendre_by_values(int order, double x, int m, Extended seed, double* out) {
    double p = seed.value;
    double scaled_previous = 0;  // P_l-1 / a_l
    for (int l = m; l < order; ++l) {
        *out++ = Extended{p, seed.borrowed}.rounded();
        const double a = std::sqrt((2.0 * l + 1) * (2.0 * l + 3) / ((l + 1.0 - m) * (l + 1.0 + m)));
        const double next = a * (x * p - scaled_previous);
        scaled_previous = p / a;
        p = next;
        if (seed.borrowed > 0 && std::abs(p) > kDigitHalf) {
            p *= kDigitDown;
            scaled_previous *= kDigitDown;
            --seed.borrowed;
        }
    }
}

struct Direction {
    double cos_theta, sin_theta;
    double cos_phi, sin_phi;
};

// (a, b) / hypot(a, b), also where both are denormal; (1, 0) for the zero vector.
void unit_pair(double& a, double& b) {
    const double largest = std::max(std::abs(a), std::abs(b));
    if (largest == 0) {
        a = 1;
        b = 0;
        return;
    }
    const int exponent = std::ilogb(largest);
    a = std::scalbn(a, -exponent);
    b = std::scalbn(b, -exponent);
    const double length = std::hypot(a, b);
    a /= length;
    b /= length;
}

Direction direction_of(double x, double y, double z) {
    const double largest = std::max({std::abs(x), std::abs(y), std::abs(z)});
    if (largest > 0) {
        const int exponent = std::ilogb(largest);
        x = std::scalbn(x, -exponent);
        y = std::scalbn(y, -exponent);
        z = std::scalbn(z, -exponent);
    }
    Direction d{z, std::hypot(x, y), x, y};
    unit_pair(d.cos_theta, d.sin_theta);
    unit_pair(d.cos_phi, d.sin_phi);
    return d;
}

// x, y, z of unit length.
template <class Real>
void low_order_basis(int order, double x, double y, double z, Real* out) {
    const detail::LoopTable<double>& table = detail::loop_table<double>();
    // Beside a pole z holds too few digits of the angle, x and y hold them all.
    const bool polar = std::abs(z) >= 0.5;
    const double delta = (x * x + y * y) / (1 + std::abs(z)), sign = z < 0 ? -1 : 1;
    double cosine = 1, sine = 0;  // sin^m(theta) cos(m phi) and sin^m(theta) sin(m phi)
    for (int m = 0; m < order; ++m) {
        const auto& steps = table.steps[m];
        double p = table.seed[m], previous = 0, difference = 0;
        for (int l = m;;) {
            out[l * (l + 1) - m] = static_cast<Real>(p * sine);
            out[l * (l + 1) + m] = static_cast<Real>(p * cosine);
            if (++l == order) break;
            const detail::Step<double>& step = steps[l];
            if (polar) {
                difference = step.keep * difference - step.bend * delta * p;
                p = sign * (step.grow * p + difference);
                difference *= sign;
            } else {
                const double next = step.a * z * p - step.b * previous;
                previous = p;
                p = next;
            }
        }
        const double turned = x * cosine - y * sine;
        sine = x * sine + y * cosine;
        cosine = turned;
    }
}

template <class Real>
void high_order_basis(int order, const Direction& d, Real* out) {
    // Eight m at a time, so that the scattered writes below fill whole cache lines.
    constexpr int kBlock = 8;
    const auto stride = static_cast<std::size_t>(order);
    std::vector<double> legendre(kBlock * stride);
    // In extended precision, where the platform has it, or the rounding of `order` turns adds up.
    const std::complex<long double> turn(d.cos_phi, d.sin_phi);
    std::complex<long double> power = static_cast<long double>(kSqrt2);
    for (int first = 0; first < order; first += kBlock) {
        const int count = std::min(kBlock, order - first);
        std::array<double, kBlock> cosine, sine;
        for (int i = 0; i < count; ++i) {
            const int m = first + i;
            cosine[i] = m == 0 ? 1 : static_cast<double>(power.real());
            sine[i] = static_cast<double>(power.imag());
            power = {power.real() * turn.real() - power.imag() * turn.imag(),
                     power.real() * turn.imag() + power.imag() * turn.real()};
            normalized_legendre(order, d.cos_theta, d.sin_theta, m, &legendre[i * stride + m]);
        }
        for (int l = first; l < order; ++l) {
            Real* const center = out + sh_index(l, 0);
            for (int i = 0; i < std::min(count, l - first + 1); ++i) {
                const double p = legendre[i * stride + static_cast<std::size_t>(l)];
                // m = 0 is written last, so that its sine half, zero, does not stay.
                center[-(first + i)] = static_cast<Real>(p * sine[i]);
                center[first + i] = static_cast<Real>(p * cosine[i]);
            }
        }
    }
}

template <class Real>
void evaluate(int order, double x, double y, double z, Real* out) {
    assert(order >= 0);
    // |v|^2 - 1, in which a unit vector cancels first; 1 / |v| - 1 = -e / 2 + 3 e^2 / 8 - ...
    const double e = x * x + (y * y + (z * z - 1));
    if (order <= kLowOrder && std::abs(e) <= detail::kNearUnit<double>) {
        const double shift = e * (0.375 * e - 0.5);
        low_order_basis(order, x + x * shift, y + y * shift, z + z * shift, out);
        return;
    }
    const double square = x * x + y * y + z * z;
    if (order <= kLowOrder && square > 1e-200 && square < 1e200) {
        const double scale = 1 / std::sqrt(square);
        low_order_basis(order, x * scale, y * scale, z * scale, out);
        return;
    }
    if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) {
        std::fill_n(out, sh_count(order), std::numeric_limits<Real>::quiet_NaN());
        return;
    }
    const Direction d = direction_of(x, y, z);
    if (order <= kLowOrder) {
        low_order_basis(order, d.sin_theta * d.cos_phi, d.sin_theta * d.sin_phi, d.cos_theta, out);
    } else {
        high_order_basis(order, d, out);
    }
}

}  // namespace

void evaluate_basis(int order, double x, double y, double z, double* out) {
    evaluate(order, x, y, z, out);
}

void evaluate_basis(int order, float x, float y, float z, float* out) {
    evaluate(order, x, y, z, out);
}

void normalized_legendre(int order, double cos_theta, double sin_theta, int m, double* out) {
    assert(m >= 0);
    if (m >= order) return;
    const Extended seed = sectoral(m, cos_theta, sin_theta);
    const double absolute = std::abs(cos_theta);
    if (absolute < 0.5) {
        legendre_by_values(order, cos_theta, m, seed, out);
        return;
    }
    // 1 - |cos| is exact under 0.7; beyond, the sine holds more digits of it.
    long double delta = 1 - absolute;
    if (absolute >= 0.7) {
        const long double square = static_cast<long double>(sin_theta) * sin_theta;
        delta = square / (1 + std::sqrt(1 - square));
    }
    const auto coarse = static_cast<float>(delta);
    legendre_by_differences(order, coarse, static_cast<double>(delta - coarse), m, seed, out);
    for (int l = m; l < order; ++l) {
        if (m == 0) out[l] *= std::sqrt(2.0 * l + 1);
        if (cos_theta < 0 && (l - m) % 2 != 0) out[l - m] = -out[l - m];
    }
}

}  // namespace airlight
