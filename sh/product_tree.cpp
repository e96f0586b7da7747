// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sh/product_tree.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <array>
#include <cassert>
#include <type_traits>
#include <utility>

#include "sh/index.h"
#include "sh/product_lanes-inl.h"
#include "sh/product_tree.h"

// Once for all targets: which pairs of slots meet in which degrees.
#ifndef AIRLIGHT_SH_PRODUCT_TREE_STEPS
#define AIRLIGHT_SH_PRODUCT_TREE_STEPS
namespace airlight::detail {

// Slots (l1, m1) <= (l2, m2), m1, m2 >= 0, which contribute to m >= 0 of the degrees first, first +
// 2
// ... last.
struct TreeStep {
    int l1 = 0, m1 = 0, l2 = 0, m2 = 0, first = 0, last = 0;
};

// Calls visit(step) for all steps towards m of an order.
template <class Visit>
constexpr void for_each_step(int order, int m, const Visit& visit) {
    for (int l1 = 1; l1 < order; ++l1) {
        for (int m1 = 0; m1 <= l1; ++m1) {
            for (int l2 = l1; l2 < order; ++l2) {
                for (int m2 = l2 == l1 ? m1 : 0; m2 <= l2; ++m2) {
                    const int apart = m1 > m2 ? m1 - m2 : m2 - m1;
                    if (m1 + m2 != m && apart != m) continue;
                    int first = l2 - l1;
                    while (first < m) first += 2;
                    int last = l1 + l2;
                    while (last >= order) last -= 2;
                    if (first <= last) visit(TreeStep{l1, m1, l2, m2, first, last});
                }
            }
        }
    }
}

constexpr std::size_t step_count(int order, int m) {
    std::size_t count = 0;
    for_each_step(order, m, [&](const TreeStep&) { ++count; });
    return count;
}

template <int kOrder, int kM>
constexpr auto tree_steps() {
    std::array<TreeStep, step_count(kOrder, kM)> steps{};
    std::size_t i = 0;
    for_each_step(kOrder, kM, [&](const TreeStep& step) { steps[i++] = step; });
    return steps;
}

}  // namespace airlight::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace airlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

struct TreeKernel {
    using D = hn::ScalableTag<float>;
    using V = hn::Vec<D>;
    static constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));

    static constexpr float kMean = 0.282094791774f;  // Y_00

    const detail::ProductTree<float>& tree;

    std::size_t scratch(std::size_t) const { return 0; }

    template <int kSize>
    static HWY_INLINE V at(const V (&f)[kSize], int l, int m) {
        return f[l * l + l + m];
    }

    // What one step adds: formed of both functions in both sequences, then sent to its degrees.
    template <int kOrder, int kM, std::size_t kStep>
    static HWY_INLINE void step(const V (&a)[kOrder * kOrder], const V (&b)[kOrder * kOrder],
                                const float* HWY_RESTRICT& value, V (&x)[kOrder], V (&y)[kOrder]) {
        constexpr detail::TreeStep s = detail::tree_steps<kOrder, kM>()[kStep];
        constexpr bool kSquare = s.l1 == s.l2 && s.m1 == s.m2;
        const V ax1 = at(a, s.l1, s.m1), bx1 = at(b, s.l1, s.m1);
        const V ax2 = at(a, s.l2, s.m2), bx2 = at(b, s.l2, s.m2);
        V to_x = hn::Mul(ax1, bx2), to_y = to_x;
        if constexpr (!kSquare) to_x = hn::MulAdd(ax2, bx1, to_x);
        if constexpr (s.m1 == 0 && s.m2 > 0) {
            to_y = hn::MulAdd(ax1, at(b, s.l2, -s.m2), hn::Mul(at(a, s.l2, -s.m2), bx1));
        } else if constexpr (s.m1 > 0 && s.m2 == 0) {
            to_y = hn::MulAdd(ax2, at(b, s.l1, -s.m1), hn::Mul(at(a, s.l1, -s.m1), bx2));
        } else if constexpr (s.m1 > 0) {
            const V ay1 = at(a, s.l1, -s.m1), by1 = at(b, s.l1, -s.m1);
            const V ay2 = at(a, s.l2, -s.m2), by2 = at(b, s.l2, -s.m2);
            if constexpr (s.m1 + s.m2 == kM) {
                to_x = hn::NegMulAdd(ay1, by2, to_x);
                to_y = hn::MulAdd(ax1, by2, hn::Mul(ay1, bx2));
                if constexpr (!kSquare) {
                    to_x = hn::NegMulAdd(ay2, by1, to_x);
                    to_y = hn::MulAdd(ax2, by1, to_y);
                    to_y = hn::MulAdd(ay2, bx1, to_y);
                }
            } else {
                to_x = hn::MulAdd(ay1, by2, to_x);
                if constexpr (!kSquare) to_x = hn::MulAdd(ay2, by1, to_x);
                if constexpr (s.m1 > s.m2) {
                    to_y = hn::NegMulAdd(ax1, by2, hn::Mul(ay1, bx2));
                    to_y = hn::NegMulAdd(ay2, bx1, to_y);
                    to_y = hn::MulAdd(ax2, by1, to_y);
                } else if constexpr (s.m1 < s.m2) {
                    to_y = hn::NegMulAdd(ax2, by1, hn::Mul(ay2, bx1));
                    to_y = hn::NegMulAdd(ay1, bx2, to_y);
                    to_y = hn::MulAdd(ax1, by2, to_y);
                }
            }
        }
        if constexpr (s.first == 0) x[0] = hn::Add(to_x, x[0]);
        for (int l = s.first == 0 ? 2 : s.first; l <= s.last; l += 2) {
            const V gamma = hn::Set(D(), *value++);
            x[l] = hn::MulAdd(gamma, to_x, x[l]);
            if constexpr (kM > 0) y[l] = hn::MulAdd(gamma, to_y, y[l]);
        }
    }

    template <int kOrder, int kM, class Stride, std::size_t... kSteps>
    static HWY_INLINE void steps(const V (&a)[kOrder * kOrder], const V (&b)[kOrder * kOrder],
                                 V mean_a, V mean_b, const float* HWY_RESTRICT& value,
                                 float* HWY_RESTRICT out, Stride stride,
                                 std::index_sequence<kSteps...>) {
        const D d;
        V x[kOrder], y[kOrder];
        if constexpr (kM == 0) x[0] = hn::Mul(a[0], b[0]);
        for (int l = kM == 0 ? 1 : kM; l < kOrder; ++l) {
            x[l] = hn::MulAdd(mean_a, at(b, l, kM), hn::Mul(at(a, l, kM), mean_b));
            y[l] = hn::MulAdd(mean_a, at(b, l, -kM), hn::Mul(at(a, l, -kM), mean_b));
        }
        (step<kOrder, kM, kSteps>(a, b, value, x, y), ...);
        if constexpr (kM == 0) x[0] = hn::Mul(x[0], hn::Set(d, kMean));
        for (int l = kM; l < kOrder; ++l) {
            hn::StoreU(x[l], d, out + sh_index(l, kM) * stride);
            if constexpr (kM > 0) hn::StoreU(y[l], d, out + sh_index(l, -kM) * stride);
        }
    }

    template <int kOrder, class Stride, int... kM>
    HWY_INLINE void run(const float* a, const float* b, Stride stride, float* out,
                        std::integer_sequence<int, kM...>) const {
        const D d;
        // Everything is read before anything is written.
        V in_a[kOrder * kOrder], in_b[kOrder * kOrder];
        for (int k = 0; k < kOrder * kOrder; ++k, a += stride, b += stride) {
            in_a[k] = hn::LoadU(d, a);
            in_b[k] = hn::LoadU(d, b);
        }
        const V mean_a = hn::Mul(in_a[0], hn::Set(d, kMean));
        const V mean_b = hn::Mul(in_b[0], hn::Set(d, kMean));
        const float* value = tree.values.data();
        (steps<kOrder, kM>(in_a, in_b, mean_a, mean_b, value, out, stride,
                           std::make_index_sequence<detail::step_count(kOrder, kM)>()),
         ...);
    }

    template <class Stride>
    HWY_INLINE void operator()(D, const float* a, const float* b, Stride stride, float* out,
                               float*) const {
        switch (tree.order) {
            case 2:
                return run<2>(a, b, stride, out, std::make_integer_sequence<int, 2>());
            case 3:
                return run<3>(a, b, stride, out, std::make_integer_sequence<int, 3>());
            case 4:
                return run<4>(a, b, stride, out, std::make_integer_sequence<int, 4>());
            case 5:
                return run<5>(a, b, stride, out, std::make_integer_sequence<int, 5>());
        }
    }
};

HWY_ATTR void tree_planes(const detail::ProductTree<float>& tree, std::size_t count,
                          std::size_t stride, const float* a, const float* b, float* out) {
    const TreeKernel kernel{tree};
    std::size_t done = 0;
    if (tree.order == 3) {
        // Finding 27 slots takes a tenth of the time; two vectors of lanes share it. The code of
        // higher orders would not fit twice.
        constexpr std::size_t kLanes = TreeKernel::kLanes;
        constexpr std::make_integer_sequence<int, 3> kOrders;
        for (; done + 2 * kLanes <= count; done += 2 * kLanes) {
            const std::size_t next = done + kLanes;
            kernel.run<3>(a + done, b + done, stride, out + done, kOrders);
            kernel.run<3>(a + next, b + next, stride, out + next, kOrders);
        }
    }
    multiply_planes(sh_count(tree.order), count - done, stride, a + done, b + done, out + done,
                    kernel);
}

HWY_ATTR void tree_vectors(const detail::ProductTree<float>& tree, std::size_t count,
                           const float* a, const float* b, float* out) {
    multiply_vectors(sh_count(tree.order), count, a, b, out, TreeKernel{tree});
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight {

HWY_EXPORT(tree_planes);
HWY_EXPORT(tree_vectors);

namespace detail {

template <class T>
ProductTree<T>::ProductTree(const TripleProducts& triples) : order(triples.order()) {
    assert(kFirst <= order && order <= kLast);
    for (int m = 0; m < order; ++m) {
        for_each_step(order, m, [&](const TreeStep& s) {
            for (int l = s.first == 0 ? 2 : s.first; l <= s.last; l += 2) {
                values.push_back(static_cast<T>(
                    triples.at(sh_index(s.l1, s.m1), sh_index(s.l2, s.m2), sh_index(l, m))));
            }
        });
    }
}

template struct ProductTree<float>;

void multiply_tree(const ProductTree<float>& tree, std::size_t count, std::size_t stride,
                   const float* a, const float* b, float* out) {
    HWY_DYNAMIC_DISPATCH(tree_planes)(tree, count, stride, a, b, out);
}

void multiply_tree(const ProductTree<float>& tree, std::size_t count, const float* a,
                   const float* b, float* out) {
    HWY_DYNAMIC_DISPATCH(tree_vectors)(tree, count, a, b, out);
}

}  // namespace detail
}  // namespace airlight
#endif
