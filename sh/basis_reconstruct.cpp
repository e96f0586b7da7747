// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sh/basis_reconstruct.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <vector>

#include "sh/aligned.h"
#include "sh/basis.h"
#include "sh/basis_batch.h"
#include "sh/basis_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {

template <class Real>
struct ReconstructSink {
    const Real* coefficients;
    VecOf<Real> sum, cosine, sine;

    HWY_INLINE VecOf<Real> factor(int l, int m) const {
        return hn::Set(TagOf<Real>(), coefficients[sh_index(l, m)]);
    }
    HWY_INLINE void take(int l, int m, VecOf<Real> q, VecOf<Real>, VecOf<Real>) {
        cosine = l == m ? hn::Mul(factor(l, m), q) : hn::MulAdd(factor(l, m), q, cosine);
        if (m > 0) sine = l == m ? hn::Mul(factor(l, -m), q) : hn::MulAdd(factor(l, -m), q, sine);
    }
    HWY_INLINE void end_column(int m, VecOf<Real> c, VecOf<Real> s) {
        sum = m == 0 ? hn::Mul(cosine, c) : hn::MulAdd(cosine, c, hn::MulAdd(sine, s, sum));
    }
};

template <int kOrder, class Real>
HWY_NOINLINE void reconstruct_whole(const Directions<Real>& in, const Real* coefficients,
                                    Real* out) {
    const TagOf<Real> d;
    const VecOf<Real> zero = hn::Zero(d);
    for (std::size_t i = 0; i < in.count; i += hn::Lanes(d)) {
        const auto unit = load_unit(in, i);
        ReconstructSink<Real> sink{coefficients, zero, zero, zero};
        visit_basis<kOrder>(unit, unit.one, sink);
        hn::StoreU(sink.sum, d, out + i);
    }
}

template <int kOrder, class Real>
void reconstruct_one(const Directions<Real>& in, const Real* coefficients, Real* out) {
    const std::size_t lanes = hn::Lanes(TagOf<Real>());
    const std::size_t whole = in.count - in.count % lanes;
    reconstruct_whole<kOrder>(in.from(0, whole), coefficients, out);
    if (whole == in.count) return;
    const Tail<Real, kMaxLanes<Real>> tail(in, whole);
    HWY_ALIGN Real values[kMaxLanes<Real>];
    reconstruct_whole<kOrder>(tail.directions(lanes), coefficients, values);
    std::copy_n(values, in.count - whole, out + whole);
}

// Into (kChannels, block_size) at `out`, rows `count` apart.
template <std::size_t kChannels, class Real>
HWY_NOINLINE void reconstruct_block(std::size_t slots, const Real* basis, const Real* coefficients,
                                    Real* out, std::size_t count) {
    const TagOf<Real> d;
    const std::size_t lanes = hn::Lanes(d);
    VecOf<Real> sum[kChannels][kBlock];
    for (std::size_t c = 0; c < kChannels; ++c) {
        for (std::size_t v = 0; v < kBlock; ++v) sum[c][v] = hn::Zero(d);
    }
    for (std::size_t slot = 0; slot < slots; ++slot) {
        VecOf<Real> factor[kChannels];
        for (std::size_t c = 0; c < kChannels; ++c) {
            factor[c] = hn::Set(d, coefficients[c * slots + slot]);
        }
        for (std::size_t v = 0; v < kBlock; ++v) {
            const VecOf<Real> y = hn::Load(d, basis + (slot * kBlock + v) * lanes);
            for (std::size_t c = 0; c < kChannels; ++c) {
                sum[c][v] = hn::MulAdd(factor[c], y, sum[c][v]);
            }
        }
    }
    for (std::size_t c = 0; c < kChannels; ++c) {
        for (std::size_t v = 0; v < kBlock; ++v) {
            hn::StoreU(sum[c][v], d, out + c * count + v * lanes);
        }
    }
}

template <class Real>
void reconstruct_channels(int order, const Directions<Real>& in, std::size_t channels,
                          const Real* coefficients, Real* out) {
    const std::size_t slots = sh_count(order), size = block_size<Real>();
    Block<Real> block(order, in);
    AlignedVector<Real> padded;
    for (std::size_t first = 0; first < in.count; first += size) {
        const Real* basis = block.basis(first);
        const bool whole = first + size <= in.count;
        if (!whole) padded.resize(channels * size);
        Real* own = whole ? out + first : padded.data();
        const std::size_t apart = whole ? in.count : size;
        std::size_t c = 0;
        for (; c + 2 <= channels; c += 2) {
            reconstruct_block<2>(slots, basis, coefficients + c * slots, own + c * apart, apart);
        }
        if (c < channels) {
            reconstruct_block<1>(slots, basis, coefficients + c * slots, own + c * apart, apart);
        }
        for (c = 0; !whole && c < channels; ++c) {
            std::copy_n(own + c * size, in.count - first, out + c * in.count + first);
        }
    }
}

template <int kOrder = kUnrolledOrder, class Real>
void reconstruct(int order, const Directions<Real>& in, int channels, const Real* coefficients,
                 Real* out) {
    if (channels != 1 || order > kOrder) {
        return reconstruct_channels(order, in, static_cast<std::size_t>(channels), coefficients,
                                    out);
    }
    if (order == kOrder) return reconstruct_one<kOrder>(in, coefficients, out);
    if constexpr (kOrder > 1) reconstruct<kOrder - 1>(order, in, channels, coefficients, out);
}

void reconstruct_float(int order, const Directions<float>& in, int channels,
                       const float* coefficients, float* out) {
    reconstruct(order, in, channels, coefficients, out);
}
void reconstruct_double(int order, const Directions<double>& in, int channels,
                        const double* coefficients, double* out) {
    reconstruct(order, in, channels, coefficients, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {
namespace {

template <class Real>
void reconstruct_one_by_one(int order, const detail::Directions<Real>& in, int channels,
                            const Real* coefficients, Real* out) {
    std::vector<Real> basis(sh_count(order));
    for (std::size_t i = 0; i < in.count; ++i) {
        evaluate_basis(order, in.x[i], in.y[i], in.z[i], basis.data());
        const Real* coefficient = coefficients;
        for (int c = 0; c < channels; ++c) {
            double sum = 0;
            for (const Real y : basis) sum += static_cast<double>(*coefficient++) * y;
            out[static_cast<std::size_t>(c) * in.count + i] = static_cast<Real>(sum);
        }
    }
}

}  // namespace

HWY_EXPORT(reconstruct_float);
HWY_EXPORT(reconstruct_double);

void reconstruct_basis_batch(int order, std::size_t count, const float* x, const float* y,
                             const float* z, int channels, const float* coefficients, float* out) {
    assert(order >= 0 && channels >= 0);
    if (order == 0) std::fill_n(out, static_cast<std::size_t>(channels) * count, float(0));
    if (order == 0 || channels == 0) return;
    const detail::Directions<float> in{count, x, y, z};
    if (order > detail::kVectorOrder) {
        return reconstruct_one_by_one(order, in, channels, coefficients, out);
    }
    HWY_DYNAMIC_DISPATCH(reconstruct_float)(order, in, channels, coefficients, out);
}

void reconstruct_basis_batch(int order, std::size_t count, const double* x, const double* y,
                             const double* z, int channels, const double* coefficients,
                             double* out) {
    assert(order >= 0 && channels >= 0);
    if (order == 0) std::fill_n(out, static_cast<std::size_t>(channels) * count, double(0));
    if (order == 0 || channels == 0) return;
    const detail::Directions<double> in{count, x, y, z};
    if (order > detail::kVectorOrder) {
        return reconstruct_one_by_one(order, in, channels, coefficients, out);
    }
    HWY_DYNAMIC_DISPATCH(reconstruct_double)(order, in, channels, coefficients, out);
}

}  // namespace airlight
#endif
