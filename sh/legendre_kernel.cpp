// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sh/legendre_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <type_traits>

#include "sh/legendre_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kBlock = kLegendreBands;
// Rows at a time, so that the functions and the folded rows stay in the first-level cache.
constexpr std::size_t kAnalysisRows = kLegendreChunk, kSynthesisRows = 128;

template <class T>
using Tag = hn::CappedTag<T, kLegendreRows<T>>;
template <class T>
using Vec = hn::Vec<Tag<T>>;
template <class T>
using Block = LegendreRecurrence<T>;

// Registers decide how much of a product stays in them.
#if HWY_TARGET <= HWY_AVX3
constexpr int kBandTile = 4, kRowTile = 4, kStreams = 8;
constexpr bool kSumsFit = true;
#else
constexpr int kBandTile = 2, kRowTile = 2, kStreams = 4;
constexpr bool kSumsFit = false;
#endif

// e - a versine in double as a sum of two floats, for one vector of rows.
HWY_INLINE void split_factor(const double* reference, const double* versine, Vec<float>& high,
                             Vec<float>& low) {
    const Tag<float> d;
#if HWY_TARGET == HWY_SCALAR
    const hn::Rebind<double, Tag<float>> wide;
    const auto factor = hn::NegMulAdd(hn::Set(wide, reference[0]), hn::Load(wide, versine),
                                      hn::Set(wide, reference[1]));
    high = hn::DemoteTo(d, factor);
    low = hn::DemoteTo(d, hn::Sub(factor, hn::PromoteTo(wide, high)));
#else
    const hn::Half<Tag<float>> half;
    const hn::Rebind<double, decltype(half)> wide;
    const auto a = hn::Set(wide, reference[0]), e = hn::Set(wide, reference[1]);
    const auto first = hn::NegMulAdd(a, hn::Load(wide, versine), e);
    const auto second = hn::NegMulAdd(a, hn::Load(wide, versine + hn::Lanes(wide)), e);
    const auto first_high = hn::DemoteTo(half, first), second_high = hn::DemoteTo(half, second);
    const auto first_low = hn::Sub(first, hn::PromoteTo(wide, first_high));
    const auto second_low = hn::Sub(second, hn::PromoteTo(wide, second_high));
    high = hn::Combine(d, second_high, first_high);
    low = hn::Combine(d, hn::DemoteTo(half, second_low), hn::DemoteTo(half, first_low));
#endif
}

// The recurrence in `kVectors` vectors of rows. Before each kBlock bands comes begin_block().
template <class T, int kVectors>
struct State {
    Vec<T> variable[kVectors], value[kVectors], step[kVectors];
    Vec<T> high[kVectors], low[kVectors];  // in float: the factor of the block's first band

    HWY_INLINE void load(const Block<T>& b, std::size_t row) {
        const Tag<T> d;
        for (int v = 0; v < kVectors; ++v) {
            variable[v] = hn::Load(d, b.variable + row + v * hn::Lanes(d));
        }
        load_values(b, row);
    }

    HWY_INLINE void load_values(const Block<T>& b, std::size_t row) {
        const Tag<T> d;
        for (int v = 0; v < kVectors; ++v) {
            value[v] = hn::Load(d, b.value + row + v * hn::Lanes(d));
            step[v] = hn::Load(d, b.step + row + v * hn::Lanes(d));
        }
    }

    HWY_INLINE void store_values(const Block<T>& b, std::size_t row) const {
        const Tag<T> d;
        for (int v = 0; v < kVectors; ++v) {
            hn::Store(value[v], d, b.value + row + v * hn::Lanes(d));
            hn::Store(step[v], d, b.step + row + v * hn::Lanes(d));
        }
    }

    HWY_INLINE void begin_block(const Block<T>& b, std::size_t row) {
        if constexpr (std::is_same_v<T, float>) {
            for (int v = 0; v < kVectors; ++v) {
                split_factor(b.reference, b.versine + row + v * hn::Lanes(Tag<T>()), high[v],
                             low[v]);
            }
        }
    }

    // Goes to the next band, whose three constants these are.
    HWY_INLINE void advance(const T* recurrence) {
        const Tag<T> d;
        const Vec<T> a = hn::Set(d, recurrence[0]), b = hn::Set(d, recurrence[1]);
        const Vec<T> e = hn::Set(d, recurrence[2]);
        for (int v = 0; v < kVectors; ++v) {
            Vec<T> factor = hn::NegMulAdd(a, variable[v], e);
            Vec<T> carried = hn::NegMulAdd(b, step[v], step[v]);
            if constexpr (std::is_same_v<T, float>) {
                factor = hn::Add(factor, low[v]);
                carried = hn::MulAdd(high[v], value[v], carried);
            }
            step[v] = hn::MulAdd(factor, value[v], carried);
            value[v] = hn::Add(value[v], step[v]);
        }
    }
};

HWY_INLINE void next_block(Block<float>& b) {
    b.recurrence += 3 * kBlock;
    b.reference += 2;
}

HWY_INLINE void next_block(Block<double>& b) {
    b.recurrence += 3 * kBlock;
}

// kBlock bands in kVectors vectors of rows from `row` on; kStore keeps them in b.functions.
template <int kVectors, bool kStore, class T>
HWY_INLINE void advance(const Block<T>& b, std::size_t row) {
    const Tag<T> d;
    State<T, kVectors> state;
    state.load(b, row);
    state.begin_block(b, row);
    for (std::size_t i = 0; i < kBlock; ++i) {
        state.advance(b.recurrence + 3 * i);
        for (int v = 0; v < kVectors && kStore; ++v) {
            hn::Store(state.value[v], d, b.functions + i * b.rows + row + v * hn::Lanes(d));
        }
    }
    state.store_values(b, row);
}

template <class T>
HWY_INLINE bool all_tiny(const Block<T>& b, std::size_t row) {
    const Tag<T> d;
    return hn::AllTrue(d, hn::Lt(hn::Load(d, b.exponent + row), hn::Zero(d)));
}

// Moves grown mantissas of negligible rows up one step; returns whether all rows are in range.
template <class T>
HWY_INLINE bool rescale(const Block<T>& b, std::size_t row) {
    const Tag<T> d;
    const Vec<T> zero = hn::Zero(d), one = hn::Set(d, T(1));
    const Vec<T> exponent = hn::Load(d, b.exponent + row);
    const Vec<T> value = hn::Load(d, b.value + row);
    const Vec<T> step = hn::Load(d, b.step + row);
    const Vec<T> size = hn::Max(hn::Abs(value), hn::Abs(step));
    const auto too_large = hn::Gt(size, hn::Set(d, LegendreScale<T>::kLargest));
    const auto grown = hn::And(hn::Lt(exponent, zero), too_large);
    const Vec<T> factor = hn::IfThenElse(grown, hn::Set(d, LegendreScale<T>::kInverseStep), one);
    const Vec<T> raised = hn::Add(exponent, hn::IfThenElseZero(grown, one));
    hn::Store(hn::Mul(value, factor), d, b.value + row);
    hn::Store(hn::Mul(step, factor), d, b.step + row);
    hn::Store(raised, d, b.exponent + row);
    return hn::AllTrue(d, hn::Ge(raised, zero));
}

// Generates bands from `row` on as long as `kVectors` vectors fit before `end`, then fewer. Several
// recurrences side by side hide the latency of each.
template <int kVectors, bool kStore, class T>
HWY_INLINE void advance_rows(const Block<T>& b, std::size_t row, std::size_t end) {
    const std::size_t step = kVectors * hn::Lanes(Tag<T>());
    for (; row + step <= end; row += step) advance<kVectors, kStore>(b, row);
    if constexpr (kVectors > 1) advance_rows<kVectors / 2, kStore>(b, row, end);
}

// Generates kBlock bands; returns the number of rows (whole vectors) that hold usable values.
// `in_range` rows at the front need no scaling any more; it grows towards the pole.
template <class T>
HWY_ATTR std::size_t generate(const Block<T>& b, std::size_t* in_range) {
    const Tag<T> d;
    const std::size_t lanes = hn::Lanes(d);
    const Vec<T> zero = hn::Zero(d);
    advance_rows<kStreams, true>(b, 0, *in_range);
    std::size_t tiny = b.rows;  // all rows from here on are negligible
    while (tiny > *in_range && all_tiny(b, tiny - lanes)) tiny -= lanes;
    advance_rows<kStreams, false>(b, tiny, b.rows);
    for (std::size_t row = *in_range; row < tiny; row += lanes) {
        advance<1, true>(b, row);
        const auto negligible = hn::Lt(hn::Load(d, b.exponent + row), zero);
        for (std::size_t i = 0; i < kBlock; ++i) {
            T* out = b.functions + i * b.rows + row;
            hn::Store(hn::IfThenZeroElse(negligible, hn::Load(d, out)), d, out);
        }
    }
    for (std::size_t row = *in_range; row < b.rows; row += lanes) {
        if (rescale(b, row) && row == *in_range) *in_range = row + lanes;
    }
    return tiny;
}

// coefficients[(first + 2 t) * stride + c] += sum over rows of functions * folded, t < kBandTile.
template <int kComponents, class T>
HWY_ATTR void analyze_tile(const T* functions, std::size_t rows, std::size_t usable,
                           const T* folded, std::size_t folded_stride, T* coefficients,
                           std::size_t stride) {
    const Tag<T> d;
    const std::size_t lanes = hn::Lanes(d);
    Vec<T> sum[kBandTile][kComponents];
    for (int t = 0; t < kBandTile; ++t) {
        for (int c = 0; c < kComponents; ++c) sum[t][c] = hn::Zero(d);
    }
    for (std::size_t row = 0; row < usable; row += lanes) {
        Vec<T> p[kBandTile];
        for (int t = 0; t < kBandTile; ++t) p[t] = hn::Load(d, functions + 2 * t * rows + row);
        for (int c = 0; c < kComponents; ++c) {
            const Vec<T> f = hn::Load(d, folded + c * folded_stride + row);
            for (int t = 0; t < kBandTile; ++t) sum[t][c] = hn::MulAdd(p[t], f, sum[t][c]);
        }
    }
    for (int t = 0; t < kBandTile; ++t) {
        for (int c = 0; c < kComponents; ++c) {
            coefficients[2 * t * stride + c] += hn::GetLane(hn::SumOfLanes(d, sum[t][c]));
        }
    }
}

template <int kComponents, class T>
HWY_ATTR void analyze_block(const Block<T>& b, std::size_t usable, std::size_t stride,
                            const T* even, const T* odd, T* coefficients) {
    for (std::size_t i = 0; i < kBlock; i += 2 * kBandTile) {
        analyze_tile<kComponents>(b.functions + i * b.rows, b.rows, usable, even, b.folded_stride,
                                  coefficients + i * stride, stride);
        analyze_tile<kComponents>(b.functions + (i + 1) * b.rows, b.rows, usable, odd,
                                  b.folded_stride, coefficients + (i + 1) * stride, stride);
    }
}

// folded += functions^T coefficients for the kBlock / 2 bands of one parity.
template <int kComponents, int kVectors, class T>
HWY_INLINE void synthesize_tile(const T* functions, std::size_t rows, std::size_t row, T* folded,
                                std::size_t folded_stride, const T* coefficients,
                                std::size_t stride) {
    const Tag<T> d;
    const std::size_t lanes = hn::Lanes(d);
    Vec<T> sum[kVectors][kComponents];
    for (int v = 0; v < kVectors; ++v) {
        for (int c = 0; c < kComponents; ++c) {
            sum[v][c] = hn::Load(d, folded + c * folded_stride + row + v * lanes);
        }
    }
    for (std::size_t i = 0; i < kBlock; i += 2) {
        Vec<T> p[kVectors];
        for (int v = 0; v < kVectors; ++v)
            p[v] = hn::Load(d, functions + i * rows + row + v * lanes);
        for (int c = 0; c < kComponents; ++c) {
            const Vec<T> a = hn::Set(d, coefficients[i * stride + c]);
            for (int v = 0; v < kVectors; ++v) sum[v][c] = hn::MulAdd(p[v], a, sum[v][c]);
        }
    }
    for (int v = 0; v < kVectors; ++v) {
        for (int c = 0; c < kComponents; ++c) {
            hn::Store(sum[v][c], d, folded + c * folded_stride + row + v * lanes);
        }
    }
}

template <int kComponents, class T>
HWY_ATTR void synthesize_block(const Block<T>& b, std::size_t usable, std::size_t stride,
                               const T* coefficients, T* even, T* odd) {
    const Tag<T> d;
    const std::size_t lanes = hn::Lanes(d);
    for (int parity = 0; parity < 2; ++parity) {
        const T* functions = b.functions + parity * b.rows;
        const T* bands = coefficients + parity * stride;
        T* folded = parity == 0 ? even : odd;
        std::size_t row = 0;
        for (; row + kRowTile * lanes <= usable; row += kRowTile * lanes) {
            synthesize_tile<kComponents, kRowTile>(functions, b.rows, row, folded, b.folded_stride,
                                                   bands, stride);
        }
        for (; row < usable; row += lanes) {
            synthesize_tile<kComponents, 1>(functions, b.rows, row, folded, b.folded_stride, bands,
                                            stride);
        }
    }
}

// Bands of one m for some of its rows, a block of bands at a time: for targets whose registers
// cannot hold the sums of all components.
template <int kComponents, class T>
HWY_ATTR void synthesize_part(Block<T> b, std::size_t bands, std::size_t stride,
                              const T* coefficients, T* even, T* odd) {
    std::size_t in_range = 0;
    for (std::size_t l = 0; l < bands; l += kBlock, next_block(b)) {
        const std::size_t usable = generate(b, &in_range);
        synthesize_block<kComponents>(b, usable, stride, coefficients + l * stride, even, odd);
    }
}

// Adds a state's band to the sums of all components; with kMasked, where the exponent is 0 only.
template <bool kMasked, int kComponents, int kVectors, class T>
HWY_INLINE void add_band(const State<T, kVectors>& state, const T* coefficients,
                         const Vec<T>* exponent, Vec<T> (&sums)[kVectors][kComponents]) {
    const Tag<T> d;
    Vec<T> function[kVectors];
    for (int v = 0; v < kVectors; ++v) {
        function[v] = state.value[v];
        if (kMasked) {
            function[v] = hn::IfThenZeroElse(hn::Lt(exponent[v], hn::Zero(d)), function[v]);
        }
    }
    for (int c = 0; c < kComponents; ++c) {
        const Vec<T> coefficient = hn::Set(d, coefficients[c]);
        for (int v = 0; v < kVectors; ++v) {
            sums[v][c] = hn::MulAdd(function[v], coefficient, sums[v][c]);
        }
    }
}

// All bands of kVectors vectors of rows from `row` on: rows far below the others first, then those
// where some are, then what is left, all in registers.
template <int kComponents, int kVectors, class T>
HWY_ATTR void synthesize_rows(Block<T> b, std::size_t row, std::size_t bands, std::size_t stride,
                              const T* coefficients, T* even, T* odd) {
    const Tag<T> d;
    const std::size_t lanes = hn::Lanes(d);
    const auto all_negligible = [&]() HWY_ATTR {
        bool all = true;
        for (int v = 0; v < kVectors; ++v) all = all && all_tiny(b, row + v * lanes);
        return all;
    };
    const auto raise = [&]() HWY_ATTR {
        bool in_range = true;
        for (int v = 0; v < kVectors; ++v) in_range = rescale(b, row + v * lanes) && in_range;
        return in_range;
    };
    bool in_range = raise();
    std::size_t l = 0;
    for (; l < bands && all_negligible(); l += kBlock, next_block(b)) {
        advance<kVectors, false>(b, row);
        in_range = raise();
    }
    if (l >= bands) return;
    State<T, kVectors> state;
    state.load(b, row);
    Vec<T> sums[2][kVectors][kComponents];  // of even and odd l - m
    for (int v = 0; v < kVectors; ++v) {
        for (int c = 0; c < kComponents; ++c) sums[0][v][c] = sums[1][v][c] = hn::Zero(d);
    }
    coefficients += l * stride;
    for (; l < bands && !in_range; l += kBlock, next_block(b)) {
        Vec<T> exponent[kVectors];
        for (int v = 0; v < kVectors; ++v) {
            exponent[v] = hn::Load(d, b.exponent + row + v * lanes);
        }
        state.begin_block(b, row);
        for (std::size_t i = 0; i < kBlock; i += 2, coefficients += 2 * stride) {
            state.advance(b.recurrence + 3 * i);
            add_band<true>(state, coefficients, exponent, sums[0]);
            state.advance(b.recurrence + 3 * i + 3);
            add_band<true>(state, coefficients + stride, exponent, sums[1]);
        }
        state.store_values(b, row);
        in_range = raise();
        state.load_values(b, row);
    }
    for (; l < bands; l += kBlock, next_block(b)) {
        state.begin_block(b, row);
        for (std::size_t i = 0; i < kBlock; i += 2, coefficients += 2 * stride) {
            state.advance(b.recurrence + 3 * i);
            add_band<false>(state, coefficients, nullptr, sums[0]);
            state.advance(b.recurrence + 3 * i + 3);
            add_band<false>(state, coefficients + stride, nullptr, sums[1]);
        }
    }
    for (int v = 0; v < kVectors; ++v) {
        for (int c = 0; c < kComponents; ++c) {
            const std::size_t at = c * b.folded_stride + row + v * lanes;
            hn::Store(sums[0][v][c], d, even + at);
            hn::Store(sums[1][v][c], d, odd + at);
        }
    }
}

// Calls body(count, first) for groups of 6, 4 and 2 components that make up all, an even number.
template <class Body>
HWY_INLINE void for_component_groups(std::size_t components, const Body& body) {
    std::size_t c = 0;
    for (; c + 6 <= components; c += 6) body(std::integral_constant<int, 6>(), c);
    if (c + 4 <= components) {
        body(std::integral_constant<int, 4>(), c);
        c += 4;
    }
    if (c + 2 <= components) body(std::integral_constant<int, 2>(), c);
}

// `count` rows from `first` on.
template <class T>
Block<T> part(Block<T> b, std::size_t first, std::size_t count) {
    b.variable += first;
    b.versine += first;
    b.value += first;
    b.step += first;
    b.exponent += first;
    b.rows = count;
    return b;
}

// Runs over all blocks of bands of one m, for some of its rows.
template <class T>
HWY_ATTR void analyze_part(Block<T> b, std::size_t bands, std::size_t components, const T* even,
                           const T* odd, T* coefficients) {
    std::size_t in_range = 0;
    for (std::size_t l = 0; l < bands; l += kBlock, next_block(b)) {
        const std::size_t usable = generate(b, &in_range);
        for_component_groups(components, [&](auto count, std::size_t c) HWY_ATTR {
            analyze_block<decltype(count)::value>(b, usable, components, even + c * b.folded_stride,
                                                  odd + c * b.folded_stride,
                                                  coefficients + l * components + c);
        });
    }
}

// All rows and bands of one m.
template <int kComponents, class T>
HWY_ATTR void synthesize_components(const Block<T>& b, std::size_t bands, std::size_t stride,
                                    const T* coefficients, T* even, T* odd) {
    if constexpr (!kSumsFit) {
        for (std::size_t row = 0; row < b.rows; row += kSynthesisRows) {
            synthesize_part<kComponents>(part(b, row, std::min(kSynthesisRows, b.rows - row)),
                                         bands, stride, coefficients, even + row, odd + row);
        }
    } else {
        constexpr int kVectors = kComponents > 2 ? 2 : 4;
        const std::size_t lanes = hn::Lanes(Tag<T>());
        std::size_t row = 0;
        for (; row + kVectors * lanes <= b.rows; row += kVectors * lanes) {
            synthesize_rows<kComponents, kVectors>(b, row, bands, stride, coefficients, even, odd);
        }
        for (; row < b.rows; row += lanes) {
            synthesize_rows<kComponents, 1>(b, row, bands, stride, coefficients, even, odd);
        }
    }
}

template <class T>
void rewind(const Block<T>& b) {
    std::fill_n(b.value, b.rows, T(0));
    std::copy_n(b.seed, b.rows, b.step);
    std::copy_n(b.seed_exponent, b.rows, b.exponent);
}

template <class T>
HWY_ATTR void run_analysis(const Block<T>& b, std::size_t bands, std::size_t components,
                           const T* even, const T* odd, T* coefficients) {
    rewind(b);
    for (std::size_t row = 0; row < b.rows; row += kAnalysisRows) {
        analyze_part(part(b, row, std::min(kAnalysisRows, b.rows - row)), bands, components,
                     even + row, odd + row, coefficients);
    }
}

template <class T>
HWY_ATTR void run_synthesis(const Block<T>& b, std::size_t bands, std::size_t components,
                            const T* coefficients, T* even, T* odd) {
    for_component_groups(components, [&](auto count, std::size_t c) HWY_ATTR {
        rewind(b);
        synthesize_components<decltype(count)::value>(b, bands, components, coefficients + c,
                                                      even + c * b.folded_stride,
                                                      odd + c * b.folded_stride);
    });
}

HWY_ATTR void analyze_float(const LegendreRecurrence<float>& r, std::size_t bands,
                            std::size_t components, const float* even, const float* odd,
                            float* coefficients) {
    run_analysis(r, bands, components, even, odd, coefficients);
}

HWY_ATTR void analyze_double(const LegendreRecurrence<double>& r, std::size_t bands,
                             std::size_t components, const double* even, const double* odd,
                             double* coefficients) {
    run_analysis(r, bands, components, even, odd, coefficients);
}

HWY_ATTR void synthesize_float(const LegendreRecurrence<float>& r, std::size_t bands,
                               std::size_t components, const float* coefficients, float* even,
                               float* odd) {
    run_synthesis(r, bands, components, coefficients, even, odd);
}

HWY_ATTR void synthesize_double(const LegendreRecurrence<double>& r, std::size_t bands,
                                std::size_t components, const double* coefficients, double* even,
                                double* odd) {
    run_synthesis(r, bands, components, coefficients, even, odd);
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {

HWY_EXPORT(analyze_float);
HWY_EXPORT(analyze_double);
HWY_EXPORT(synthesize_float);
HWY_EXPORT(synthesize_double);

void legendre_analyze(const LegendreRecurrence<float>& r, std::size_t bands, std::size_t components,
                      const float* even, const float* odd, float* coefficients) {
    HWY_DYNAMIC_DISPATCH(analyze_float)(r, bands, components, even, odd, coefficients);
}

void legendre_analyze(const LegendreRecurrence<double>& r, std::size_t bands,
                      std::size_t components, const double* even, const double* odd,
                      double* coefficients) {
    HWY_DYNAMIC_DISPATCH(analyze_double)(r, bands, components, even, odd, coefficients);
}

void legendre_synthesize(const LegendreRecurrence<float>& r, std::size_t bands,
                         std::size_t components, const float* coefficients, float* even,
                         float* odd) {
    HWY_DYNAMIC_DISPATCH(synthesize_float)(r, bands, components, coefficients, even, odd);
}

void legendre_synthesize(const LegendreRecurrence<double>& r, std::size_t bands,
                         std::size_t components, const double* coefficients, double* even,
                         double* odd) {
    HWY_DYNAMIC_DISPATCH(synthesize_double)(r, bands, components, coefficients, even, odd);
}

}  // namespace airlight
#endif
