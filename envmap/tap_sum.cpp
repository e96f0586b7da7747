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

HWY_ATTR void sum_taps_block(const TapRow* rows, std::size_t row_count, std::size_t columns,
                             float* out) {
    const hn::CappedTag<float, 16> d;
    using Vec = hn::Vec<decltype(d)>;
    constexpr int kVectors = 8;  // accumulators kept in registers
    const std::size_t lanes = hn::Lanes(d);
    static_assert(kVectors * 16 <= kTapSlack, "a block may reach past the last column");
    for (std::size_t x = 0; x < columns; x += kVectors * lanes) {
        Vec sum[kVectors];
        for (int v = 0; v < kVectors; ++v) sum[v] = hn::Zero(d);
        for (std::size_t r = 0; r < row_count; ++r) {
            const float* source = rows[r].source + x;
            const float* taps = rows[r].taps;
            const Vec centre = hn::Set(d, taps[0]);
            for (int v = 0; v < kVectors; ++v) {
                sum[v] = hn::MulAdd(centre, hn::LoadU(d, source + v * lanes), sum[v]);
            }
            for (std::size_t k = 1; k < rows[r].count; ++k) {
                const Vec tap = hn::Set(d, taps[k]);
                for (int v = 0; v < kVectors; ++v) {
                    const float* at = source + v * lanes;
                    const Vec pair = hn::Add(hn::LoadU(d, at - k), hn::LoadU(d, at + k));
                    sum[v] = hn::MulAdd(tap, pair, sum[v]);
                }
            }
        }
        for (int v = 0; v < kVectors; ++v) hn::StoreU(sum[v], d, out + x + v * lanes);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {

HWY_EXPORT(sum_taps_block);

void sum_taps(const TapRow* rows, std::size_t row_count, std::size_t columns, float* out) {
    HWY_DYNAMIC_DISPATCH(sum_taps_block)(rows, row_count, columns, out);
}

}  // namespace airlight
#endif
