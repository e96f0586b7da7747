// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sh/basis_project.cpp"
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

// After so many vectors the sums go to double.
constexpr std::size_t kFlush = 64;

// Sums of one call: per lane in Real, now and then added to those in double.
template <class Real>
class LaneSums {
  public:
    explicit LaneSums(std::size_t count) : count_(count), size_(count * hn::Lanes(TagOf<Real>())) {
        recent_.assign(size_, Real(0));
        total_.assign(size_, 0.0);
    }
    Real* recent() { return recent_.data(); }

    void flush() {
        Real* HWY_RESTRICT recent = recent_.data();
        double* HWY_RESTRICT total = total_.data();
        for (std::size_t k = 0; k < size_; ++k) {
            total[k] += recent[k];
            recent[k] = 0;
        }
    }
    void add_to(double* coefficients) {
        flush();
        const std::size_t lanes = size_ / count_;
        for (std::size_t k = 0; k < count_; ++k) {
            double sum = 0;
            for (std::size_t lane = 0; lane < lanes; ++lane) sum += total_[k * lanes + lane];
            coefficients[k] += sum;
        }
    }

  private:
    std::size_t count_, size_;
    AlignedVector<Real> recent_;
    AlignedVector<double> total_;
};

// c and s hold the weight.
template <class Real>
struct ProjectSink {
    Real* sums;  // (slots, lanes)

    HWY_INLINE void add(std::size_t slot, VecOf<Real> a, VecOf<Real> b) {
        const TagOf<Real> d;
        Real* sum = sums + slot * hn::Lanes(d);
        hn::Store(hn::MulAdd(a, b, hn::Load(d, sum)), d, sum);
    }
    HWY_INLINE void take(int l, int m, VecOf<Real> q, VecOf<Real> c, VecOf<Real> s) {
        add(sh_index(l, m), q, c);
        if (m > 0) add(sh_index(l, -m), q, s);
    }
    HWY_INLINE void end_column(int, VecOf<Real>, VecOf<Real>) {}
};

template <int kOrder, class Real>
HWY_NOINLINE void project_whole(const Directions<Real>& in, const Real* values,
                                LaneSums<Real>& sums) {
    const TagOf<Real> d;
    const std::size_t lanes = hn::Lanes(d);
    for (std::size_t i = 0; i < in.count;) {
        const std::size_t stop = std::min(in.count, i + kFlush * lanes);
        for (; i < stop; i += lanes) {
            const auto unit = load_unit(in, i);
            ProjectSink<Real> sink{sums.recent()};
            visit_basis<kOrder>(unit, hn::Mul(hn::LoadU(d, values + i), unit.one), sink);
        }
        sums.flush();
    }
}

template <int kOrder, class Real>
void project_one(const Directions<Real>& in, const Real* values, double* coefficients) {
    const std::size_t lanes = hn::Lanes(TagOf<Real>());
    const std::size_t whole = in.count - in.count % lanes;
    LaneSums<Real> sums(sh_count(kOrder));
    project_whole<kOrder>(in.from(0, whole), values, sums);
    if (whole < in.count) {
        const Tail<Real, kMaxLanes<Real>> tail(in, whole);
        HWY_ALIGN Real padded[kMaxLanes<Real>] = {};
        std::copy(values + whole, values + in.count, padded);
        project_whole<kOrder>(tail.directions(lanes), padded, sums);
    }
    sums.add_to(coefficients);
}

// kChannels of them at `values`, `count` apart; sums are (channels, slots, lanes).
template <std::size_t kChannels, class Real>
HWY_NOINLINE void project_block(std::size_t slots, const Real* basis, const Real* values,
                                std::size_t count, Real* sums) {
    const TagOf<Real> d;
    const std::size_t lanes = hn::Lanes(d);
    VecOf<Real> value[kChannels][kBlock];
    for (std::size_t c = 0; c < kChannels; ++c) {
        for (std::size_t v = 0; v < kBlock; ++v) {
            value[c][v] = hn::LoadU(d, values + c * count + v * lanes);
        }
    }
    for (std::size_t slot = 0; slot < slots; ++slot) {
        VecOf<Real> sum[kChannels];
        for (std::size_t c = 0; c < kChannels; ++c) {
            sum[c] = hn::Load(d, sums + (c * slots + slot) * lanes);
        }
        for (std::size_t v = 0; v < kBlock; ++v) {
            const VecOf<Real> y = hn::Load(d, basis + (slot * kBlock + v) * lanes);
            for (std::size_t c = 0; c < kChannels; ++c) {
                sum[c] = hn::MulAdd(value[c][v], y, sum[c]);
            }
        }
        for (std::size_t c = 0; c < kChannels; ++c) {
            hn::Store(sum[c], d, sums + (c * slots + slot) * lanes);
        }
    }
}

template <class Real>
void project_channels(int order, const Directions<Real>& in, std::size_t channels,
                      const Real* values, double* coefficients) {
    const std::size_t slots = sh_count(order), lanes = hn::Lanes(TagOf<Real>());
    const std::size_t size = block_size<Real>();
    Block<Real> block(order, in);
    LaneSums<Real> sums(channels * slots);
    AlignedVector<Real> padded;
    std::size_t vectors = 0;
    for (std::size_t first = 0; first < in.count; first += size) {
        const Real* basis = block.basis(first);
        const Real* own = values + first;
        std::size_t apart = in.count;
        if (first + size > in.count) {
            padded.assign(channels * size, Real(0));
            for (std::size_t c = 0; c < channels; ++c) {
                std::copy_n(own + c * in.count, in.count - first, padded.data() + c * size);
            }
            own = padded.data();
            apart = size;
        }
        std::size_t c = 0;
        for (; c + 2 <= channels; c += 2) {
            project_block<2>(slots, basis, own + c * apart, apart,
                             sums.recent() + c * slots * lanes);
        }
        if (c < channels) {
            project_block<1>(slots, basis, own + c * apart, apart,
                             sums.recent() + c * slots * lanes);
        }
        vectors += kBlock;
        if (vectors % kFlush == 0) sums.flush();
    }
    sums.add_to(coefficients);
}

template <int kOrder = kUnrolledOrder, class Real>
void project(int order, const Directions<Real>& in, int channels, const Real* values,
             double* coefficients) {
    if (channels != 1 || order > kOrder) {
        return project_channels(order, in, static_cast<std::size_t>(channels), values,
                                coefficients);
    }
    if (order == kOrder) return project_one<kOrder>(in, values, coefficients);
    if constexpr (kOrder > 1) project<kOrder - 1>(order, in, channels, values, coefficients);
}

void project_float(int order, const Directions<float>& in, int channels, const float* values,
                   double* coefficients) {
    project(order, in, channels, values, coefficients);
}
void project_double(int order, const Directions<double>& in, int channels, const double* values,
                    double* coefficients) {
    project(order, in, channels, values, coefficients);
}
}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {
namespace {

template <class Real>
void project_one_by_one(int order, const detail::Directions<Real>& in, int channels,
                        const Real* values, double* coefficients) {
    std::vector<Real> basis(sh_count(order));
    for (std::size_t i = 0; i < in.count; ++i) {
        evaluate_basis(order, in.x[i], in.y[i], in.z[i], basis.data());
        double* coefficient = coefficients;
        for (int c = 0; c < channels; ++c) {
            const double value = values[static_cast<std::size_t>(c) * in.count + i];
            for (const Real y : basis) *coefficient++ += value * y;
        }
    }
}

}  // namespace

HWY_EXPORT(project_float);
HWY_EXPORT(project_double);

void project_basis_batch(int order, std::size_t count, const float* x, const float* y,
                         const float* z, int channels, const float* values, double* coefficients) {
    assert(order >= 0 && channels >= 0);
    if (order == 0 || channels == 0) return;
    const detail::Directions<float> in{count, x, y, z};
    if (order > detail::kVectorOrder) {
        return project_one_by_one(order, in, channels, values, coefficients);
    }
    HWY_DYNAMIC_DISPATCH(project_float)(order, in, channels, values, coefficients);
}

void project_basis_batch(int order, std::size_t count, const double* x, const double* y,
                         const double* z, int channels, const double* values,
                         double* coefficients) {
    assert(order >= 0 && channels >= 0);
    if (order == 0 || channels == 0) return;
    const detail::Directions<double> in{count, x, y, z};
    if (order > detail::kVectorOrder) {
        return project_one_by_one(order, in, channels, values, coefficients);
    }
    HWY_DYNAMIC_DISPATCH(project_double)(order, in, channels, values, coefficients);
}

}  // namespace airlight
#endif
