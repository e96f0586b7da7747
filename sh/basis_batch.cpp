// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sh/basis_batch.cpp"
#include "sh/basis_batch.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cassert>
#include <vector>

#include "sh/aligned.h"
#include "sh/basis.h"
#include "sh/basis_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {

template <class Real>
void evaluate(int order, const Directions<Real>& in, Real* out, std::size_t stride) {
    const std::size_t lanes = hn::Lanes(TagOf<Real>());
    const std::size_t rest = in.count % lanes;
    evaluate_whole(order, in.from(0, in.count - rest), out, stride);
    if (rest == 0) return;
    if (in.count > lanes) {
        // Once more the directions before the rest, to the same bits.
        const std::size_t first = in.count - lanes;
        return evaluate_whole(order, in.from(first, lanes), out + first, stride);
    }
    const Tail<Real, kMaxLanes<Real>> tail(in, 0);
    AlignedVector<Real> values(sh_count(order) * lanes);
    evaluate_whole(order, tail.directions(lanes), values.data(), lanes);
    for (std::size_t slot = 0; slot < sh_count(order); ++slot) {
        std::copy_n(values.data() + slot * lanes, rest, out + slot * stride);
    }
}

void evaluate_float(int order, const Directions<float>& in, float* out, std::size_t stride) {
    evaluate(order, in, out, stride);
}
void evaluate_double(int order, const Directions<double>& in, double* out, std::size_t stride) {
    evaluate(order, in, out, stride);
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {
namespace {

template <class Real>
void evaluate_one_by_one(int order, const detail::Directions<Real>& in, Real* out,
                         std::size_t stride) {
    std::vector<Real> basis(sh_count(order));
    for (std::size_t i = 0; i < in.count; ++i) {
        evaluate_basis(order, in.x[i], in.y[i], in.z[i], basis.data());
        for (std::size_t slot = 0; slot < basis.size(); ++slot) {
            out[slot * stride + i] = basis[slot];
        }
    }
}

}  // namespace

HWY_EXPORT(evaluate_float);
HWY_EXPORT(evaluate_double);

void evaluate_basis_batch(int order, std::size_t count, const float* x, const float* y,
                          const float* z, float* out, std::size_t stride) {
    assert(order >= 0 && stride >= count);
    if (order > detail::kVectorOrder) {
        return evaluate_one_by_one<float>(order, {count, x, y, z}, out, stride);
    }
    HWY_DYNAMIC_DISPATCH(evaluate_float)(order, {count, x, y, z}, out, stride);
}

void evaluate_basis_batch(int order, std::size_t count, const double* x, const double* y,
                          const double* z, double* out, std::size_t stride) {
    assert(order >= 0 && stride >= count);
    if (order > detail::kVectorOrder) {
        return evaluate_one_by_one<double>(order, {count, x, y, z}, out, stride);
    }
    HWY_DYNAMIC_DISPATCH(evaluate_double)(order, {count, x, y, z}, out, stride);
}

}  // namespace airlight
#endif
