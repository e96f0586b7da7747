// SPDX-License-Identifier: Apache-2.0
#include "sh/basis_recurrence.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace airlight::detail {
namespace {

template <class Real>
void rescale(std::size_t count, Real* x, Real* y, Real* z) {
    for (std::size_t i = 0; i < count; ++i) {
        const Real square = x[i] * x[i] + y[i] * y[i] + z[i] * z[i];
        if (square >= kLeastSquare<Real> && square <= kLargestSquare<Real>) continue;
        const Real largest = std::max({std::abs(x[i]), std::abs(y[i]), std::abs(z[i])});
        if (!std::isfinite(x[i]) || !std::isfinite(y[i]) || !std::isfinite(z[i])) {
            x[i] = y[i] = z[i] = std::numeric_limits<Real>::quiet_NaN();
        } else if (largest == 0) {
            z[i] = 1;
        } else {
            const int exponent = -std::ilogb(largest);
            x[i] = std::scalbn(x[i], exponent);
            y[i] = std::scalbn(y[i], exponent);
            z[i] = std::scalbn(z[i], exponent);
        }
    }
}

template <class Real>
LoopTable<Real> make_loop_table() {
    LoopTable<Real> table{};
    double square = 1 / (4 * kPi);
    for (int m = 0; m < kVectorOrder; ++m) {
        if (m > 0) square *= (2.0 * m + 1) / (2.0 * m);
        table.seed[m] = static_cast<Real>(std::sqrt(m > 0 ? 2 * square : square));
        double previous = 0;
        for (int l = m + 1; l < kVectorOrder; ++l) {
            const double a = std::sqrt((2.0 * l - 1) * (2.0 * l + 1) / ((l - m) * (l + m)));
            const double grow = std::sqrt((2.0 * l + 1) * (l + m) / ((2.0 * l - 1) * (l - m)));
            table.steps[m][l] = {
                static_cast<Real>(a), static_cast<Real>(l == m + 1 ? 0 : a / previous),
                static_cast<Real>(grow), static_cast<Real>(grow * (l - 1 - m) / (l + m)),
                static_cast<Real>(grow * (2 * l - 1) / (l + m))};
            previous = a;
        }
    }
    return table;
}

}  // namespace

template <class Real>
const LoopTable<Real>& loop_table() {
    static const LoopTable<Real> table = make_loop_table<Real>();
    return table;
}
template const LoopTable<float>& loop_table();
template const LoopTable<double>& loop_table();

void rescale_directions(std::size_t count, float* x, float* y, float* z) {
    rescale(count, x, y, z);
}
void rescale_directions(std::size_t count, double* x, double* y, double* z) {
    rescale(count, x, y, z);
}

}  // namespace airlight::detail
