// SPDX-License-Identifier: Apache-2.0
// The loops of LegendreStage over rows and bands, in SIMD.
#pragma once

#include <cstddef>

namespace airlight {

/// Bands generated at a time: arrays over bands are padded to a multiple, with zeros.
inline constexpr std::size_t kLegendreBands = 8;
/// Rows of the widest vector in use: arrays over rows are padded to a multiple.
template <class T>
inline constexpr std::size_t kLegendreRows = 64 / sizeof(T);
/// Rows that LegendreRecurrence::functions has room for.
inline constexpr std::size_t kLegendreChunk = 400;

/// Values too small to count are kept times 2^(kStepLog2 k), k < 0: in a row of exponent k they
/// move up a step once they exceed kLargest.
template <class T>
struct LegendreScale;
template <>
struct LegendreScale<double> {
    static constexpr int kStepLog2 = 192;
    static constexpr double kInverseStep = 0x1p-192, kLargest = 0x1p96;
};
template <>
struct LegendreScale<float> {
    static constexpr int kStepLog2 = 96;
    static constexpr float kInverseStep = 0x1p-96f, kLargest = 0x1p24f;
};

/// The exponent of a padding row, which never comes into range.
template <class T>
inline constexpr T kLegendreNever = static_cast<T>(-1e9);

/// The recurrence of one order m in every row, with the factor w of P_{l-1}:
///
///     step_l = step_{l-1} - (1 - b_l) step_{l-1} + w_l P_{l-1},   P_l = P_{l-1} + step_l
///     w_l = a_l cos theta - 1 - b_l = e_l - a_l (1 - cos theta),  e_l = a_l - b_l - 1
///
/// In double, `variable` is 1 - cos theta, and `recurrence` holds a, 1 - b and e. In float their
/// rounding would move the zeros of P_l by l eps. So w is computed in double for the first band of
/// each kLegendreBands; `variable` is -cos theta, and `recurrence` holds a and -b less that band's,
/// and 1 - b in between.
template <class T>
struct LegendreRecurrence {
    const T* variable;
    const double* versine;    ///< 1 - cos theta, in float only
    T* value;                 ///< P_{l-1}, mantissas
    T* step;                  ///< P_{l-1} - P_{l-2}, mantissas
    T* exponent;              ///< k of the factor 2^(kStepLog2 k): 0 is in range
    const T* seed;            ///< step at the first band
    const T* seed_exponent;   ///< exponent at the first band
    const T* recurrence;      ///< (bands, 3)
    const double* reference;  ///< (bands / kLegendreBands, 2): a, e of a block's first band
    T* functions;             ///< scratch, (kLegendreBands, kLegendreChunk)
    std::size_t rows;
    std::size_t folded_stride;  ///< from one component of the folded rows to the next
};

/// coefficients (bands, components) += sums over rows of P_lm times the folded rows.
void legendre_analyze(const LegendreRecurrence<float>& r, std::size_t bands, std::size_t components,
                      const float* even, const float* odd, float* coefficients);
void legendre_analyze(const LegendreRecurrence<double>& r, std::size_t bands,
                      std::size_t components, const double* even, const double* odd,
                      double* coefficients);

/// Folded rows, zeros before, += sums over bands of P_lm times the coefficients (bands,
/// components).
void legendre_synthesize(const LegendreRecurrence<float>& r, std::size_t bands,
                         std::size_t components, const float* coefficients, float* even,
                         float* odd);
void legendre_synthesize(const LegendreRecurrence<double>& r, std::size_t bands,
                         std::size_t components, const double* coefficients, double* even,
                         double* odd);

}  // namespace airlight
