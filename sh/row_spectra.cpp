// SPDX-License-Identifier: Apache-2.0
#include "sh/row_spectra.h"

#include "core/constants.h"

namespace airlight {

std::vector<double> northern_colatitudes(std::size_t rows) {
    std::vector<double> colatitude;
    for (std::size_t row = (rows + 1) / 2; row-- > 0;) {
        colatitude.push_back(kPi * (row + 0.5) / rows);
    }
    return colatitude;
}

void fold_rows(const double* values, const double* weight, std::size_t rows, std::size_t padded,
               double* even, double* odd) {
    const std::size_t north = (rows + 1) / 2;
    for (std::size_t f = 0; f < north; ++f) {
        const std::size_t n = north - 1 - f, s = rows - 1 - n;
        if (n == s) {
            even[f] = weight[n] * values[n];
            odd[f] = 0;
        } else {
            even[f] = weight[n] * values[n] + weight[s] * values[s];
            odd[f] = weight[n] * values[n] - weight[s] * values[s];
        }
    }
    std::fill(even + north, even + padded, 0.0);
    std::fill(odd + north, odd + padded, 0.0);
}

void unfold_rows(const double* even, const double* odd, std::size_t rows, double* values) {
    const std::size_t north = (rows + 1) / 2;
    for (std::size_t f = 0; f < north; ++f) {
        const std::size_t n = north - 1 - f;
        values[rows - 1 - n] = even[f] - odd[f];
        values[n] = even[f] + odd[f];
    }
}

}  // namespace airlight
