// SPDX-License-Identifier: Apache-2.0
#include "bench/basis_accuracy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <vector>

#include "core/constants.h"
#include "sh/basis.h"
#include "sh/basis_batch.h"
#include "sh/index.h"

namespace airlight {
namespace {

// The plain recurrence loses l^2 of its eps beside a pole: at l = 4095 that takes 113 bits.
#ifdef __SIZEOF_FLOAT128__
using Wide = __float128;
#else
using Wide = long double;
#endif

Wide square_root(Wide value) {
    if (value == 0) return 0;
    Wide root = std::sqrt(static_cast<double>(value));
    for (int i = 0; i < 3; ++i) root = (root + value / root) / 2;
    return root;
}

/// Calls visit(slot, Y_lm) for all l < order.
template <class Visit>
void visit_exact(int order, const std::array<double, 3>& direction, const Visit& visit) {
    Wide x = direction[0], y = direction[1], z = direction[2];
    const Wide length = square_root(x * x + y * y + z * z);
    x /= length;
    y /= length;
    z /= length;
    // pi to 120 bits.
    const Wide pi = static_cast<Wide>(3.141592653589793116) + 1.2246467991473531772e-16 -
                    static_cast<Wide>(2.9947698097183396659e-33);
    Wide cosine = 1, sine = 0, square = 1 / (4 * pi);
    for (int m = 0; m < order; ++m) {
        if (m > 0) square *= static_cast<Wide>(2 * m + 1) / (2 * m);
        Wide q = square_root(m > 0 ? 2 * square : square), before = 0, last = 1;
        for (int l = m; l < order; ++l) {
            if (l > m) {
                const Wide a = square_root(static_cast<Wide>(2 * l - 1) * (2 * l + 1) /
                                           (static_cast<Wide>(l - m) * (l + m)));
                const Wide next = a * z * q - a / last * before;
                last = a;
                before = q;
                q = next;
            }
            visit(sh_index(l, m), q * cosine);
            if (m > 0) visit(sh_index(l, -m), q * sine);
        }
        const Wide turned = x * cosine - y * sine;
        sine = x * sine + y * cosine;
        cosine = turned;
    }
}

/// Poles, equator and what is near them, axes, and at random, in turns.
std::vector<std::array<double, 3>> make_directions(int count) {
    std::mt19937_64 bits(1);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<std::array<double, 3>> directions = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}};
    for (int i = 0; static_cast<int>(directions.size()) < count; ++i) {
        const double phi = 2 * kPi * unit(bits), near = std::pow(10.0, -5 * unit(bits));
        double theta = std::acos(1 - 2 * unit(bits));
        if (i % 4 == 1) theta = near;
        if (i % 8 == 3) theta = kPi - near;
        if (i % 8 == 7) theta = kPi / 2 - near;
        directions.push_back(
            {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
    }
    return directions;
}

/// In units of eps sqrt((2l+1)/(4 pi)).
struct Errors {
    double worst = 0, squares = 0;
    std::size_t count = 0;

    void add(double error) {
        worst = std::max(worst, std::abs(error));
        squares += error * error;
        ++count;
    }
    void print() const {
        std::printf(" %.2g / %.2g |", worst, std::sqrt(squares / static_cast<double>(count)));
    }
};

template <class Real>
void measure(int order, const std::vector<std::array<double, 3>>& directions, Errors& single,
             Errors& batch) {
    std::vector<Real> one(sh_count(order)), many(sh_count(order));
    std::vector<double> scale(static_cast<std::size_t>(order));
    for (std::size_t l = 0; l < scale.size(); ++l) {
        scale[l] = std::numeric_limits<Real>::epsilon() *
                   std::sqrt((2 * static_cast<double>(l) + 1) / (4 * kPi));
    }
    for (const auto& direction : directions) {
        const Real x = static_cast<Real>(direction[0]), y = static_cast<Real>(direction[1]),
                   z = static_cast<Real>(direction[2]);
        evaluate_basis(order, x, y, z, one.data());
        evaluate_basis_batch(order, 1, &x, &y, &z, many.data(), 1);
        visit_exact(order, {x, y, z}, [&](std::size_t slot, Wide exact) {
            const double unit = scale[static_cast<std::size_t>(sh_degree(slot).l)];
            single.add(static_cast<double>(one[slot] - exact) / unit);
            batch.add(static_cast<double>(many[slot] - exact) / unit);
        });
    }
}

}  // namespace

void print_basis_accuracy() {
    std::printf(
        "# Accuracy of the spherical-harmonic basis\n\n"
        "Largest and root mean square error over all Y_lm of an order and over directions at the "
        "poles,\nthe equator, near them, on the axes and at random, in units of eps "
        "sqrt((2l+1)/(4 pi)): eps = 2^-52\nin double, 2^-23 in float, the root the root mean "
        "square of Y_lm itself. The direction is what the\nprecision holds, exactly; the reference "
        "runs in 113 bits. Batches change from unrolled code to loops\nafter order %d, and to "
        "`evaluate_basis` after %d; they ran with fused multiply-add.\n"
        "Generated by `sh_bench --accuracy > docs/BASIS_ACCURACY.md`.\n\n"
        "| order | directions | `evaluate_basis`, double | float | `evaluate_basis_batch`, double "
        "| "
        "float |\n| --- | --- | --- | --- | --- | --- |\n",
        8, 64);
    for (const int order :
         {1, 2, 3, 4, 5, 6, 7, 8, 9, 12, 16, 24, 32, 48, 64, 65, 128, 256, 512, 1024, 2048, 4096}) {
        const auto directions = make_directions(order <= 16    ? 4000
                                                : order <= 65  ? 1000
                                                : order <= 256 ? 100
                                                               : 12);
        Errors single[2], batch[2];
        measure<double>(order, directions, single[0], batch[0]);
        measure<float>(order, directions, single[1], batch[1]);
        std::printf("| %d | %zu |", order, directions.size());
        single[0].print();
        single[1].print();
        batch[0].print();
        batch[1].print();
        std::printf("\n");
        std::fflush(stdout);
    }
}

}  // namespace airlight
