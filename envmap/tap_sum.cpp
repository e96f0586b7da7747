// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "envmap/tap_sum.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "envmap/tap_sum.h"

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Accumulators kept in registers for each of the two output rows.
#if HWY_TARGET <= HWY_AVX3
constexpr int kVectors = 8;
#else
constexpr int kVectors = 4;
#endif
static_assert(kVectors * 16 <= kTapSlack, "a block may reach past the last column");

HWY_ATTR void sum_taps_block(const TapRow* rows, std::size_t row_count, std::size_t columns,
                             float* out_0, float* out_1) {
    const hn::CappedTag<float, 16> d;
    using Vec = hn::Vec<decltype(d)>;
    const std::size_t lanes = hn::Lanes(d);
    for (std::size_t x = 0; x < columns; x += kVectors * lanes) {
        Vec sum_0[kVectors], sum_1[kVectors];
        for (int v = 0; v < kVectors; ++v) sum_0[v] = sum_1[v] = hn::Zero(d);
        for (std::size_t r = 0; r < row_count; ++r) {
            const float* source = rows[r].source + x;
            const float* taps = rows[r].taps;
            const Vec centre_0 = hn::Set(d, taps[0]), centre_1 = hn::Set(d, taps[1]);
            for (int v = 0; v < kVectors; ++v) {
                const Vec value = hn::LoadU(d, source + v * lanes);
                sum_0[v] = hn::MulAdd(centre_0, value, sum_0[v]);
                sum_1[v] = hn::MulAdd(centre_1, value, sum_1[v]);
            }
            for (std::size_t k = 1; k < rows[r].count; ++k) {
                const Vec tap_0 = hn::Set(d, taps[2 * k]), tap_1 = hn::Set(d, taps[2 * k + 1]);
                for (int v = 0; v < kVectors; ++v) {
                    const float* at = source + v * lanes;
                    const Vec pair = hn::Add(hn::LoadU(d, at - k), hn::LoadU(d, at + k));
                    sum_0[v] = hn::MulAdd(tap_0, pair, sum_0[v]);
                    sum_1[v] = hn::MulAdd(tap_1, pair, sum_1[v]);
                }
            }
        }
        for (int v = 0; v < kVectors; ++v) {
            hn::StoreU(sum_0[v], d, out_0 + x + v * lanes);
            hn::StoreU(sum_1[v], d, out_1 + x + v * lanes);
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {

HWY_EXPORT(sum_taps_block);

void sum_taps(const TapRow* rows, std::size_t row_count, std::size_t columns, float* out_0,
              float* out_1) {
    HWY_DYNAMIC_DISPATCH(sum_taps_block)(rows, row_count, columns, out_0, out_1);
}

}  // namespace airlight
#endif
