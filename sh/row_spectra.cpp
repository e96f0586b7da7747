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

template <class T>
void fold_rows(const T* values, const T* weight, std::size_t rows, std::size_t padded, T* even,
               T* odd) {
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
    std::fill(even + north, even + padded, T(0));
    std::fill(odd + north, odd + padded, T(0));
}

template <class T>
void unfold_rows(const T* even, const T* odd, std::size_t rows, T* values) {
    const std::size_t north = (rows + 1) / 2;
    for (std::size_t f = 0; f < north; ++f) {
        const std::size_t n = north - 1 - f;
        values[rows - 1 - n] = even[f] - odd[f];
        values[n] = even[f] + odd[f];
    }
}

template void fold_rows(const float*, const float*, std::size_t, std::size_t, float*, float*);
template void fold_rows(const double*, const double*, std::size_t, std::size_t, double*, double*);
template void unfold_rows(const float*, const float*, std::size_t, float*);
template void unfold_rows(const double*, const double*, std::size_t, double*);

}  // namespace airlight
