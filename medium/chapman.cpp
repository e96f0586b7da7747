// SPDX-License-Identifier: Apache-2.0
#include "medium/chapman.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/constants.h"
#include "medium/chapman_fp32.h"
#include "medium/curved_column.h"
#include "medium/scaled_erfc.h"
#include "medium/spherical_density.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
bool is_in_domain(double z, double c) {
    return z >= 0 && c >= -1 && c <= 1;
}

double sine_of(double c) {
    return std::sqrt((1 - c) * (1 + c));
}

// z - z sin(theta), the depth of the periapsis.
double drop(double z, double c) {
    return z * (c * (c / (1 + sine_of(c))));
}

// C of both halves from those of the upper one, less 1, with the exponential left out at the end:
// ln C = ln(2 C_h - C_u e^-drop) + drop.
double lower_ln(double z, double c, double horizontal_excess, double upper_excess) {
    const double exponent = drop(z, c);
    if (exponent < 1) {
        return std::log1p(2 * (horizontal_excess * std::exp(exponent) + std::expm1(exponent)) -
                          upper_excess);
    }
    return exponent +
           std::log(2 * (1 + horizontal_excess) - (1 + upper_excess) * std::exp(-exponent));
}

double secant_ln(double c) {
    return c > 0 ? -std::log(c) : kInfinity;
}

// [Golubev] eq. 47.
double horizontal_series(double z) {
    return std::sqrt(0.5 * kPi * z) * (1 + (0.375 - 15 / (128 * z)) / z);
}

double schueler_upper(double z, double c) {
    const double horizontal = horizontal_series(z);
    return horizontal / ((horizontal - 1) * c + 1);
}

// [Golubev] eq. 46.
double huestis_upper(double z, double c) {
    const double sine = sine_of(c), one_more = 1 + sine;
    const double argument = std::sqrt(z) * (c / std::sqrt(one_more));
    const double first = c / one_more * (1 - 0.5 / one_more);
    const double factor = -0.5 + sine + 1 / one_more + (2 * one_more - 1) / (4 * z * one_more);
    return first + std::sqrt(kPi * z / one_more) * erfcx(argument) * factor;
}

template <class Upper>
double ln_by_series(double z, double c, const Upper& upper) {
    if (c >= 0) return std::log(upper(z, c));
    return lower_ln(z, c, horizontal_series(z * sine_of(c)) - 1, upper(z, -c) - 1);
}

}  // namespace

double ln_chapman(double z, double cos_theta) {
    if (!is_in_domain(z, cos_theta)) return kNan;
    if (std::isinf(z)) return secant_ln(cos_theta);
    if (cos_theta >= 0) return std::log1p(detail::curved_column_excess(z, cos_theta));
    const double horizontal = detail::curved_column_excess(z * sine_of(cos_theta), 0);
    return lower_ln(z, cos_theta, horizontal, detail::curved_column_excess(z, -cos_theta));
}

double chapman(double z, double cos_theta) {
    if (is_in_domain(z, cos_theta) && cos_theta >= 0) {
        return std::isinf(z) ? 1 / std::abs(cos_theta)
                             : 1 + detail::curved_column_excess(z, cos_theta);
    }
    return std::exp(ln_chapman(z, cos_theta));
}

float chapman(float z, float cos_theta) {
    return static_cast<float>(chapman(double{z}, double{cos_theta}));
}

float ln_chapman(float z, float cos_theta) {
    return static_cast<float>(ln_chapman(double{z}, double{cos_theta}));
}

double chapman_distance(double z, double cos_theta, double depth) {
    // Around a sphere whose surface is the start the density there is 1.
    return spherical_distance({z, 1}, {z, cos_theta}, kInfinity, depth);
}

double ln_chapman(double z, double cos_theta, ChapmanMethod method) {
    if (!is_in_domain(z, cos_theta)) return kNan;
    switch (method) {
        case ChapmanMethod::secant:
            return secant_ln(cos_theta);
        case ChapmanMethod::schueler:
            return ln_by_series(z, cos_theta, schueler_upper);
        case ChapmanMethod::huestis:
            return ln_by_series(z, cos_theta, huestis_upper);
        case ChapmanMethod::huestis_fp32:
            return detail::ln_chapman_fp32(static_cast<float>(z), static_cast<float>(cos_theta));
        case ChapmanMethod::exact:
            break;
    }
    return ln_chapman(z, cos_theta);
}

}  // namespace airlight
