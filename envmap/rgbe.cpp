// SPDX-License-Identifier: Apache-2.0
#include "envmap/rgbe.h"

#include <algorithm>
#include <cmath>

namespace airlight::detail {

void round_to_rgbe(float* pixels, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        float* pixel = pixels + 3 * i;
        const double largest = std::max({pixel[0], pixel[1], pixel[2]});
        if (largest <= 0) continue;
        int exponent = 0;
        const double mantissa = std::frexp(largest, &exponent);
        // Beyond 255.5 units the largest rounds up to a power of two, which has the next exponent.
        if (mantissa * 256 >= 255.5 && exponent < 127) ++exponent;
        for (int c = 0; c < 3; ++c) {
            const double units = std::min(
                255.0, std::nearbyint(std::ldexp(static_cast<double>(pixel[c]), 8 - exponent)));
            // A quarter of a unit more than what is meant survives the writer's own rounding.
            pixel[c] = static_cast<float>(std::ldexp(units + 0.25, exponent - 8));
        }
    }
}

}  // namespace airlight::detail
