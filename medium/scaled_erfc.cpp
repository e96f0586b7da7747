// SPDX-License-Identifier: Apache-2.0
#include "medium/scaled_erfc.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "medium/scaled_erfc_table.h"

namespace airlight {
namespace {

// Of x >= 0. t takes [0, inf] to [0, 1]; erfcx / t is smooth on it, both ends included.
double right_half(double x) {
    const double t = 4 / (4 + x);
    const double scaled = t * detail::kErfcxPieces;
    const int piece = std::min(static_cast<int>(scaled), detail::kErfcxPieces - 1);
    const double u = 2 * (scaled - piece) - 1;
    const double* const powers = detail::kErfcxTable[piece];
    double sum = powers[detail::kErfcxDegree];
    for (int i = detail::kErfcxDegree - 1; i >= 0; --i) sum = sum * u + powers[i];
    return sum * t;
}

}  // namespace

double erfcx(double x) {
    if (std::isnan(x)) return x;
    if (x >= 0) return right_half(x);
    const double square = x * x;
    // The exponent needs more than a double's digits.
    const double rest = std::fma(x, x, -square);
    const double power = std::exp(square);
    if (std::isinf(power)) return power;
    return 2 * (power + power * rest) - right_half(-x);
}

float erfcx(float x) {
    return static_cast<float>(erfcx(double{x}));
}

float erfcx_rational9(float x) {
    if (!(x >= 0)) return std::numeric_limits<float>::quiet_NaN();
    const float t = 3.9788608f / (x + 3.9788608f);
    const float u = t - 0.5f;
    constexpr float kPowers[] = {0.275374621152878f, 0.490166693925858f, 0.774399876594543f,
                                 1.079175233840942f, 1.312000870704651f, 1.371236562728882f,
                                 1.203098773956299f, 0.805188119411469f, 0.288184314966202f};
    float sum = -0.010297533124685f;
    for (int i = 8; i >= 0; --i) sum = sum * u + kPowers[i];
    return sum * t;
}

}  // namespace airlight
