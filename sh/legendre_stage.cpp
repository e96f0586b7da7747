// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sh/legendre_stage.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <type_traits>
#include <utility>

#include "sh/legendre_stage.h"

#ifndef AIRLIGHT_SH_LEGENDRE_BLOCK
#define AIRLIGHT_SH_LEGENDRE_BLOCK
namespace airlight {
namespace {

constexpr std::size_t kBlock = 8;       // bands generated at a time
constexpr std::size_t kRowPadding = 8;  // the widest vector in use, in doubles
constexpr int kStepLog2 = 192;          // rows far below the others are kept times 2^(192 k)
constexpr double kInverseStep = 0x1p-192, kTooLarge = 0x1p96;
constexpr double kNegligible = 75;  // |P_lm| < e^-75 = 2^-108 adds nothing
constexpr double kNever = -1e9;     // exponent of a padding row

// Rows at a time, so that the functions and the folded rows stay in the first-level cache.
constexpr std::size_t kAnalysisRows = 256, kSynthesisRows = 128;

// One m: rows with their recurrence state, and where block i of the bands goes.
struct Block {
    const double* versine;  // 1 - cos theta
    double* value;          // P_{l-1}, mantissas
    double* step;           // P_{l-1} - P_{l-2}, mantissas
    double* exponent;       // k of the factor 2^(192 k), per row: 0 is in range, below 0 negligible
    const double* recurrence;  // (bands, 3): a, b, a - b - 1
    double* functions;         // (kBlock, rows)
    std::size_t rows;
    std::size_t folded_stride;  // from one component of the folded rows to the next

    // `count` rows from `first` on.
    Block part(std::size_t first, std::size_t count) const {
        return {versine + first, value + first, step + first, exponent + first,
                recurrence,      functions,     count,        folded_stride};
    }
};

}  // namespace
}  // namespace airlight
#endif

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<double, kRowPadding>;
using Vec = hn::Vec<Tag>;

// Registers decide how much of a product stays in them.
#if HWY_TARGET <= HWY_AVX3
constexpr int kBandTile = 4, kRowTile = 4, kStreams = 8;
constexpr bool kSumsFit = true;
#else
constexpr int kBandTile = 2, kRowTile = 2, kStreams = 4;
constexpr bool kSumsFit = false;
#endif

template <int kVectors, bool kStore>
HWY_INLINE void advance(const Block& b, std::size_t row) {
    const Tag d;
    const std::size_t lanes = hn::Lanes(d);
    Vec versine[kVectors], value[kVectors], step[kVectors];
    for (int v = 0; v < kVectors; ++v) {
        versine[v] = hn::Load(d, b.versine + row + v * lanes);
        value[v] = hn::Load(d, b.value + row + v * lanes);
        step[v] = hn::Load(d, b.step + row + v * lanes);
    }
    for (std::size_t i = 0; i < kBlock; ++i) {
        const Vec a_l = hn::Set(d, b.recurrence[3 * i]);
        const Vec b_l = hn::Set(d, b.recurrence[3 * i + 1]);
        const Vec e_l = hn::Set(d, b.recurrence[3 * i + 2]);
        for (int v = 0; v < kVectors; ++v) {
            const Vec w = hn::NegMulAdd(a_l, versine[v], e_l);
            step[v] = hn::MulAdd(w, value[v], hn::Mul(b_l, step[v]));
            value[v] = hn::Add(value[v], step[v]);
            if (kStore) hn::Store(value[v], d, b.functions + i * b.rows + row + v * lanes);
        }
    }
    for (int v = 0; v < kVectors; ++v) {
        hn::Store(value[v], d, b.value + row + v * lanes);
        hn::Store(step[v], d, b.step + row + v * lanes);
    }
}

HWY_INLINE bool all_tiny(const Block& b, std::size_t row) {
    const Tag d;
    return hn::AllTrue(d, hn::Lt(hn::Load(d, b.exponent + row), hn::Zero(d)));
}

// Moves grown mantissas of negligible rows up one step; returns whether all rows are in range.
HWY_INLINE bool rescale(const Block& b, std::size_t row) {
    const Tag d;
    const Vec zero = hn::Zero(d), one = hn::Set(d, 1.0);
    const Vec exponent = hn::Load(d, b.exponent + row);
    const Vec value = hn::Load(d, b.value + row);
    const Vec step = hn::Load(d, b.step + row);
    const Vec size = hn::Max(hn::Abs(value), hn::Abs(step));
    const auto grown = hn::And(hn::Lt(exponent, zero), hn::Gt(size, hn::Set(d, kTooLarge)));
    const Vec factor = hn::IfThenElse(grown, hn::Set(d, kInverseStep), one);
    const Vec raised = hn::Add(exponent, hn::IfThenElseZero(grown, one));
    hn::Store(hn::Mul(value, factor), d, b.value + row);
    hn::Store(hn::Mul(step, factor), d, b.step + row);
    hn::Store(raised, d, b.exponent + row);
    return hn::AllTrue(d, hn::Ge(raised, zero));
}

// Generates bands from `row` on as long as `kVectors` vectors fit before `end`, then fewer. Several
// recurrences side by side hide the latency of each.
template <int kVectors, bool kStore>
HWY_INLINE void advance_rows(const Block& b, std::size_t row, std::size_t end) {
    const std::size_t step = kVectors * hn::Lanes(Tag());
    for (; row + step <= end; row += step) advance<kVectors, kStore>(b, row);
    if constexpr (kVectors > 1) advance_rows<kVectors / 2, kStore>(b, row, end);
}

// Generates kBlock bands; returns the number of rows (whole vectors) that hold usable values.
// `in_range` rows at the front need no scaling any more; it grows towards the pole.
HWY_ATTR std::size_t generate(const Block& b, std::size_t* in_range) {
    const Tag d;
    const std::size_t lanes = hn::Lanes(d);
    const Vec zero = hn::Zero(d);
    advance_rows<kStreams, true>(b, 0, *in_range);
    std::size_t tiny = b.rows;  // all rows from here on are negligible
    while (tiny > *in_range && all_tiny(b, tiny - lanes)) tiny -= lanes;
    advance_rows<kStreams, false>(b, tiny, b.rows);
    for (std::size_t row = *in_range; row < tiny; row += lanes) {
        advance<1, true>(b, row);
        const auto negligible = hn::Lt(hn::Load(d, b.exponent + row), zero);
        for (std::size_t i = 0; i < kBlock; ++i) {
            double* out = b.functions + i * b.rows + row;
            hn::Store(hn::IfThenZeroElse(negligible, hn::Load(d, out)), d, out);
        }
    }
    for (std::size_t row = *in_range; row < b.rows; row += lanes) {
        if (rescale(b, row) && row == *in_range) *in_range = row + lanes;
    }
    return tiny;
}

// coefficients[(first + 2 t) * stride + c] += sum over rows of functions * folded, t < kBandTile.
template <int kComponents>
HWY_ATTR void analyze_tile(const double* functions, std::size_t rows, std::size_t usable,
                           const double* folded, std::size_t folded_stride, double* coefficients,
                           std::size_t stride) {
    const Tag d;
    const std::size_t lanes = hn::Lanes(d);
    Vec sum[kBandTile][kComponents];
    for (int t = 0; t < kBandTile; ++t) {
        for (int c = 0; c < kComponents; ++c) sum[t][c] = hn::Zero(d);
    }
    for (std::size_t row = 0; row < usable; row += lanes) {
        Vec p[kBandTile];
        for (int t = 0; t < kBandTile; ++t) p[t] = hn::Load(d, functions + 2 * t * rows + row);
        for (int c = 0; c < kComponents; ++c) {
            const Vec f = hn::Load(d, folded + c * folded_stride + row);
            for (int t = 0; t < kBandTile; ++t) sum[t][c] = hn::MulAdd(p[t], f, sum[t][c]);
        }
    }
    for (int t = 0; t < kBandTile; ++t) {
        for (int c = 0; c < kComponents; ++c) {
            coefficients[2 * t * stride + c] += hn::GetLane(hn::SumOfLanes(d, sum[t][c]));
        }
    }
}

template <int kComponents>
HWY_ATTR void analyze_block(const Block& b, std::size_t usable, std::size_t stride,
                            const double* even, const double* odd, double* coefficients) {
    for (std::size_t i = 0; i < kBlock; i += 2 * kBandTile) {
        analyze_tile<kComponents>(b.functions + i * b.rows, b.rows, usable, even, b.folded_stride,
                                  coefficients + i * stride, stride);
        analyze_tile<kComponents>(b.functions + (i + 1) * b.rows, b.rows, usable, odd,
                                  b.folded_stride, coefficients + (i + 1) * stride, stride);
    }
}

// folded += functions^T coefficients for the kBlock / 2 bands of one parity.
template <int kComponents, int kVectors>
HWY_INLINE void synthesize_tile(const double* functions, std::size_t rows, std::size_t row,
                                double* folded, std::size_t folded_stride,
                                const double* coefficients, std::size_t stride) {
    const Tag d;
    const std::size_t lanes = hn::Lanes(d);
    Vec sum[kVectors][kComponents];
    for (int v = 0; v < kVectors; ++v) {
        for (int c = 0; c < kComponents; ++c) {
            sum[v][c] = hn::Load(d, folded + c * folded_stride + row + v * lanes);
        }
    }
    for (std::size_t i = 0; i < kBlock; i += 2) {
        Vec p[kVectors];
        for (int v = 0; v < kVectors; ++v)
            p[v] = hn::Load(d, functions + i * rows + row + v * lanes);
        for (int c = 0; c < kComponents; ++c) {
            const Vec a = hn::Set(d, coefficients[i * stride + c]);
            for (int v = 0; v < kVectors; ++v) sum[v][c] = hn::MulAdd(p[v], a, sum[v][c]);
        }
    }
    for (int v = 0; v < kVectors; ++v) {
        for (int c = 0; c < kComponents; ++c) {
            hn::Store(sum[v][c], d, folded + c * folded_stride + row + v * lanes);
        }
    }
}

template <int kComponents>
HWY_ATTR void synthesize_block(const Block& b, std::size_t usable, std::size_t stride,
                               const double* coefficients, double* even, double* odd) {
    const Tag d;
    const std::size_t lanes = hn::Lanes(d);
    for (int parity = 0; parity < 2; ++parity) {
        const double* functions = b.functions + parity * b.rows;
        const double* bands = coefficients + parity * stride;
        double* folded = parity == 0 ? even : odd;
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
template <int kComponents>
HWY_ATTR void synthesize_part(Block b, std::size_t bands, std::size_t stride,
                              const double* coefficients, double* even, double* odd) {
    std::size_t in_range = 0;
    for (std::size_t l = 0; l < bands; l += kBlock, b.recurrence += 3 * kBlock) {
        const std::size_t usable = generate(b, &in_range);
        synthesize_block<kComponents>(b, usable, stride, coefficients + l * stride, even, odd);
    }
}

// The state of the recurrence in `kVectors` vectors of rows and the sums of all components there.
template <int kComponents, int kVectors>
struct RowSums {
    Vec versine[kVectors], value[kVectors], step[kVectors];
    Vec sums[2][kVectors][kComponents];  // of even and odd l - m
};

// Adds one band to the sums of its parity; with kMasked, where the exponent is 0 only.
template <int kParity, bool kMasked, int kComponents, int kVectors>
HWY_INLINE void add_band(RowSums<kComponents, kVectors>& rows, const double* recurrence,
                         const double* coefficients, const Vec* exponent) {
    const Tag d;
    const Vec a = hn::Set(d, recurrence[0]), b = hn::Set(d, recurrence[1]);
    const Vec e = hn::Set(d, recurrence[2]);
    Vec function[kVectors];
    for (int v = 0; v < kVectors; ++v) {
        const Vec w = hn::NegMulAdd(a, rows.versine[v], e);
        rows.step[v] = hn::MulAdd(w, rows.value[v], hn::Mul(b, rows.step[v]));
        rows.value[v] = hn::Add(rows.value[v], rows.step[v]);
        function[v] = rows.value[v];
        if (kMasked) {
            function[v] = hn::IfThenZeroElse(hn::Lt(exponent[v], hn::Zero(d)), function[v]);
        }
    }
    for (int c = 0; c < kComponents; ++c) {
        const Vec coefficient = hn::Set(d, coefficients[c]);
        for (int v = 0; v < kVectors; ++v) {
            rows.sums[kParity][v][c] =
                hn::MulAdd(function[v], coefficient, rows.sums[kParity][v][c]);
        }
    }
}

// All bands of kVectors vectors of rows from `row` on: rows far below the others first, then those
// where some are, then what is left, all in registers.
template <int kComponents, int kVectors>
HWY_ATTR void synthesize_rows(Block b, std::size_t row, std::size_t bands, std::size_t stride,
                              const double* coefficients, double* even, double* odd) {
    const Tag d;
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
    for (; l < bands && all_negligible(); l += kBlock, b.recurrence += 3 * kBlock) {
        advance<kVectors, false>(b, row);
        in_range = raise();
    }
    if (l >= bands) return;
    RowSums<kComponents, kVectors> rows;
    for (int v = 0; v < kVectors; ++v) {
        rows.versine[v] = hn::Load(d, b.versine + row + v * lanes);
        rows.value[v] = hn::Load(d, b.value + row + v * lanes);
        rows.step[v] = hn::Load(d, b.step + row + v * lanes);
        for (int c = 0; c < kComponents; ++c) {
            rows.sums[0][v][c] = rows.sums[1][v][c] = hn::Zero(d);
        }
    }
    coefficients += l * stride;
    for (; l < bands && !in_range; l += kBlock) {
        Vec exponent[kVectors];
        for (int v = 0; v < kVectors; ++v) {
            exponent[v] = hn::Load(d, b.exponent + row + v * lanes);
        }
        for (std::size_t i = 0; i < kBlock; i += 2) {
            add_band<0, true>(rows, b.recurrence, coefficients, exponent);
            add_band<1, true>(rows, b.recurrence + 3, coefficients + stride, exponent);
            b.recurrence += 6;
            coefficients += 2 * stride;
        }
        for (int v = 0; v < kVectors; ++v) {
            hn::Store(rows.value[v], d, b.value + row + v * lanes);
            hn::Store(rows.step[v], d, b.step + row + v * lanes);
        }
        in_range = raise();
        for (int v = 0; v < kVectors; ++v) {
            rows.value[v] = hn::Load(d, b.value + row + v * lanes);
            rows.step[v] = hn::Load(d, b.step + row + v * lanes);
        }
    }
    for (; l < bands; l += 2) {
        add_band<0, false>(rows, b.recurrence, coefficients, nullptr);
        add_band<1, false>(rows, b.recurrence + 3, coefficients + stride, nullptr);
        b.recurrence += 6;
        coefficients += 2 * stride;
    }
    for (int v = 0; v < kVectors; ++v) {
        for (int c = 0; c < kComponents; ++c) {
            hn::Store(rows.sums[0][v][c], d, even + c * b.folded_stride + row + v * lanes);
            hn::Store(rows.sums[1][v][c], d, odd + c * b.folded_stride + row + v * lanes);
        }
    }
}

template <int kComponents>
void dispatch_analysis(const Block& b, std::size_t usable, int components, int first,
                       const double* even, const double* odd, double* coefficients) {
    analyze_block<kComponents>(b, usable, components, even + first * b.folded_stride,
                               odd + first * b.folded_stride, coefficients + first);
}

// Runs over all blocks of bands of one m, for some of its rows.
HWY_ATTR void analyze_part(Block b, std::size_t bands, int components, const double* even,
                           const double* odd, double* coefficients) {
    std::size_t in_range = 0;
    for (std::size_t l = 0; l < bands; l += kBlock, b.recurrence += 3 * kBlock) {
        const std::size_t usable = generate(b, &in_range);
        double* out = coefficients + l * components;
        int c = 0;
        for (; c + 6 <= components; c += 6) {
            dispatch_analysis<6>(b, usable, components, c, even, odd, out);
        }
        if (c + 4 <= components) {
            dispatch_analysis<4>(b, usable, components, c, even, odd, out);
            c += 4;
        }
        if (c + 2 <= components) dispatch_analysis<2>(b, usable, components, c, even, odd, out);
    }
}

// All rows and bands of one m.
template <int kComponents>
HWY_ATTR void synthesize_components(const Block& b, std::size_t bands, std::size_t stride,
                                    const double* coefficients, double* even, double* odd) {
    if constexpr (!kSumsFit) {
        for (std::size_t row = 0; row < b.rows; row += kSynthesisRows) {
            synthesize_part<kComponents>(b.part(row, std::min(kSynthesisRows, b.rows - row)), bands,
                                         stride, coefficients, even + row, odd + row);
        }
    } else {
        constexpr int kVectors = kComponents > 2 ? 2 : 4;
        const std::size_t lanes = hn::Lanes(Tag());
        std::size_t row = 0;
        for (; row + kVectors * lanes <= b.rows; row += kVectors * lanes) {
            synthesize_rows<kComponents, kVectors>(b, row, bands, stride, coefficients, even, odd);
        }
        for (; row < b.rows; row += lanes) {
            synthesize_rows<kComponents, 1>(b, row, bands, stride, coefficients, even, odd);
        }
    }
}

HWY_ATTR void run_analysis(const Block& b, std::size_t bands, int components, const double* even,
                           const double* odd, double* coefficients) {
    for (std::size_t row = 0; row < b.rows; row += kAnalysisRows) {
        analyze_part(b.part(row, std::min(kAnalysisRows, b.rows - row)), bands, components,
                     even + row, odd + row, coefficients);
    }
}

HWY_ATTR void run_synthesis(const Block& b, std::size_t bands, int components, const double* seed,
                            const double* seed_exponent, const double* coefficients, double* even,
                            double* odd) {
    int c = 0;
    const auto run = [&](auto count) HWY_ATTR {
        constexpr int kComponents = decltype(count)::value;
        for (; c + kComponents <= components; c += kComponents) {
            std::fill_n(b.value, b.rows, 0.0);
            std::copy_n(seed, b.rows, b.step);
            std::copy_n(seed_exponent, b.rows, b.exponent);
            synthesize_components<kComponents>(b, bands, components, coefficients + c,
                                               even + c * b.folded_stride,
                                               odd + c * b.folded_stride);
        }
    };
    run(std::integral_constant<int, 6>());
    run(std::integral_constant<int, 4>());
    run(std::integral_constant<int, 2>());
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {

HWY_EXPORT(run_analysis);
HWY_EXPORT(run_synthesis);

LegendreStage::LegendreStage(const std::vector<double>& colatitude, int lmax)
    : lmax_(lmax), rows_(colatitude.size()) {
    assert(lmax >= 0);
    const std::size_t padded = (rows_ + kRowPadding - 1) / kRowPadding * kRowPadding;
    versine_.assign(padded, 1.0);
    log2_sin_.resize(rows_);
    for (std::size_t r = 0; r < rows_; ++r) {
        const long double theta = colatitude[r];
        const long double x = std::cos(theta);
        const long double half = std::sin(theta / 2);
        versine_[r] = static_cast<double>(2 * half * half);
        // log sin theta without cancellation on either side of 45 degrees.
        const long double log_sin =
            x < 0.7L ? 0.5L * std::log1p(-x * x) : std::log(std::sin(theta));
        log2_sin_[r] = log_sin * 1.44269504088896340735992468100189214L;
    }
    for (int l = 0; l <= lmax; ++l) root_.push_back(std::sqrt(2.0L * l + 1));
    seed_.resize(static_cast<std::size_t>(lmax) + 1);
    long double squared = 0.0795774715459476678844418816862571810L;  // 1 / (4 pi)
    for (int m = 0; m <= lmax; ++m) {
        if (m > 0) squared *= (2.0L * m + 1) / (2.0L * m);
        seed_[m] = static_cast<double>(std::sqrt(m > 0 ? 2 * squared : squared));
    }
}

// The recurrence P_l = a x P_{l-1} - b P_{l-2} with
//   a^2 = (4 l^2 - 1) / (l^2 - m^2),  b^2 = (2l+1) ((l-1)^2 - m^2) / ((2l-3) (l^2 - m^2))
// runs on the steps P_l - P_{l-1} = b (P_{l-1} - P_{l-2}) + (e - a (1 - x)) P_{l-1}, e = a - b - 1,
// since near a pole the rounding of x itself would cost l^2 eps. e is about 1/l^2: long double
// keeps its digits.
void LegendreStage::prepare(int m, Workspace& work) const {
    assert(m >= 0 && m <= lmax_);
    const std::size_t bands = static_cast<std::size_t>(lmax_ - m) + 1;
    work.m = m;
    work.recurrence.assign(3 * padded_bands(m), 0.0);
    work.recurrence[1] = 1.0;  // the first step, from 0, gives the seed itself
    const long double mm = static_cast<long double>(m) * m;
    long double root = 0;  // of l^2 - m^2, for the degree before
    for (std::size_t i = 1; i < bands; ++i) {
        const std::size_t l = static_cast<std::size_t>(m) + i;
        const long double square = static_cast<long double>(l) * static_cast<long double>(l) - mm;
        const long double inverse_root = 1 / std::sqrt(square);
        const long double a = root_[l] * root_[l - 1] * inverse_root;
        const long double b = i == 1 ? 0 : root_[l] / root_[l - 2] * inverse_root * root;
        root = square * inverse_root;
        work.recurrence[3 * i] = static_cast<double>(a);
        work.recurrence[3 * i + 1] = static_cast<double>(b);
        work.recurrence[3 * i + 2] = static_cast<double>(a - b - 1);
    }
    const std::size_t active = active_rows(m);
    work.rows = (active + kRowPadding - 1) / kRowPadding * kRowPadding;
    for (AlignedVector<double>* rows :
         {&work.seed, &work.seed_exponent, &work.value, &work.step, &work.exponent}) {
        rows->resize(padded_rows());
    }
    work.functions.resize(kBlock * std::min(padded_rows(), kAnalysisRows));
    for (std::size_t r = 0; r < active; ++r) {
        const long double exponent = m * log2_sin_[r];
        // Whole steps leave a mantissa in [2^-96, 2^96].
        const double steps =
            exponent < -kStepLog2 / 2
                ? -std::ceil((static_cast<double>(-exponent) - kStepLog2 / 2) / kStepLog2)
                : 0.0;
        work.seed_exponent[r] = steps;
        const long double rest = exponent - kStepLog2 * static_cast<long double>(steps);
        const double whole = std::floor(static_cast<double>(rest));
        const double fraction = static_cast<double>(rest - whole);
        work.seed[r] = std::ldexp(std::exp2(fraction) * seed_[m], static_cast<int>(whole));
    }
    std::fill(work.seed.begin() + active, work.seed.begin() + work.rows, 0.0);
    std::fill(work.seed_exponent.begin() + active, work.seed_exponent.begin() + work.rows, kNever);
}

// P_lm decays from its turning point sin theta_t = m / (l + 1/2) towards the pole like exp(-S),
// S = m acosh(m cot theta / c) - (l + 1/2) acosh((l + 1/2) cos theta / c) with
// c = sqrt((l + 1/2)^2 - m^2) (WKB), and grows with l.
std::size_t LegendreStage::active_rows(int m) const {
    const double degree = lmax_ + 0.5, c = std::sqrt((degree - m) * (degree + m));
    const auto negligible = [&](std::size_t r) {
        const double cosine = 1 - versine_[r], sine = std::sqrt(versine_[r] * (1 + cosine));
        if (degree * sine >= m) return false;
        const double decay =
            m * std::acosh(m * cosine / (sine * c)) - degree * std::acosh(degree * cosine / c);
        return decay > kNegligible;
    };
    std::size_t first = 0, last = rows_;
    while (first < last) {
        const std::size_t middle = (first + last) / 2;
        if (negligible(middle)) {
            last = middle;
        } else {
            first = middle + 1;
        }
    }
    return first;
}

namespace {

// Rewinds the recurrence of the prepared order to its first band.
Block rewind(const double* versine, std::size_t rows, LegendreStage::Workspace& work) {
    std::fill_n(work.value.data(), work.rows, 0.0);
    std::copy_n(work.seed.data(), work.rows, work.step.data());
    std::copy_n(work.seed_exponent.data(), work.rows, work.exponent.data());
    return {versine,
            work.value.data(),
            work.step.data(),
            work.exponent.data(),
            work.recurrence.data(),
            work.functions.data(),
            work.rows,
            rows};
}

}  // namespace

void LegendreStage::analyze(int components, const double* even, const double* odd,
                            double* coefficients, Workspace& work) const {
    assert(components > 0 && components % 2 == 0);
    const std::size_t bands = static_cast<std::size_t>(lmax_ - work.m) + 1;
    const Block block = rewind(versine_.data(), padded_rows(), work);
    std::fill_n(coefficients, padded_bands(work.m) * components, 0.0);
    HWY_DYNAMIC_DISPATCH(run_analysis)(block, bands, components, even, odd, coefficients);
}

void LegendreStage::synthesize(int components, double* coefficients, double* even, double* odd,
                               Workspace& work) const {
    assert(components > 0 && components % 2 == 0);
    const std::size_t bands = static_cast<std::size_t>(lmax_ - work.m) + 1;
    std::fill(coefficients + bands * components, coefficients + padded_bands(work.m) * components,
              0.0);
    std::fill(even, even + components * padded_rows(), 0.0);
    std::fill(odd, odd + components * padded_rows(), 0.0);
    const Block block = rewind(versine_.data(), padded_rows(), work);
    HWY_DYNAMIC_DISPATCH(run_synthesis)
    (block, bands, components, work.seed.data(), work.seed_exponent.data(), coefficients, even,
     odd);
}

std::size_t LegendreStage::padded_bands(int m) const {
    const std::size_t bands = static_cast<std::size_t>(lmax_ - m) + 1;
    return (bands + kBlock - 1) / kBlock * kBlock;
}

}  // namespace airlight
#endif
