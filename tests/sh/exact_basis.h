// SPDX-License-Identifier: Apache-2.0
// The basis in long double, for tests: the textbook recurrence, whose error at a pole, l^2 of its
// own eps, is under one eps of double up to order 64.
#pragma once

#include <cmath>
#include <vector>

#include "sh/index.h"

namespace airlight {

/// Y_lm of the direction of (x, y, z), l < order <= 64.
inline std::vector<long double> exact_basis(int order, long double x, long double y,
                                            long double z) {
    const long double length = std::sqrt(x * x + y * y + z * z);
    x /= length;
    y /= length;
    z /= length;
    std::vector<long double> out(sh_count(order));
    long double cosine = 1, sine = 0, square = 1 / (16 * std::atan(1.0L));
    for (int m = 0; m < order; ++m) {
        if (m > 0) square *= (2.0L * m + 1) / (2.0L * m);
        long double q = std::sqrt(m > 0 ? 2 * square : square), before = 0, last = 1;
        for (int l = m; l < order; ++l) {
            if (l > m) {
                const long double a =
                    std::sqrt((2.0L * l - 1) * (2.0L * l + 1) / ((l - m) * (l + m)));
                const long double next = a * z * q - a / last * before;
                last = a;
                before = q;
                q = next;
            }
            out[sh_index(l, -m)] = q * sine;
            out[sh_index(l, m)] = q * cosine;
        }
        const long double turned = x * cosine - y * sine;
        sine = x * sine + y * cosine;
        cosine = turned;
    }
    return out;
}

}  // namespace airlight
