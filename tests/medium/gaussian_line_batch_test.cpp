// SPDX-License-Identifier: Apache-2.0
#include "medium/gaussian_line_batch.h"

#include <gtest/gtest.h>

#include <limits>

#include "medium/gaussian_density.h"
#include "tests/medium/batch_check.h"

namespace airlight {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

void batch(std::size_t count, const std::array<const float*, 5>& in, float* out) {
    gaussian_line_batch(count, in[0], in[1], in[2], in[3], in[4], out);
}

std::array<float, 5> any_segment(SweepDraw& draw) {
    double a = draw.decades(-6, 6), c = draw.decades(-9, 9);
    double rho = draw.uniform(0, 12) / a, m = draw.uniform(-12, 12) / a;
    double dist = draw.chance(0.5) ? draw.uniform(0, 20) / a : draw.decades(-9, 9) / a;
    switch (draw.bits() % 6) {
        case 0:
            a = draw.not_negative(false);
            c = draw.not_negative(false);
            rho = draw.not_negative(false);
            m = draw.sign() * draw.not_negative(false);
            dist = draw.not_negative();
            break;
        case 1:
            // Ends next to the center.
            dist = m * (1 + draw.sign() * draw.decades(-8, 0));
            break;
        case 2:
            rho = draw.decades(-6, 1) / a;
            m = draw.sign() * draw.decades(-6, 1) / a;
            break;
        case 3:
            dist = draw.chance(0.5) ? HUGE_VAL : draw.decades(-3, 1) / a;
            break;
        default:
            break;
    }
    std::array<float, 5> x = {float(a), float(c), float(rho), float(m), float(dist)};
    if (draw.chance(0.05)) {
        x[draw.bits() % 5] = static_cast<float>(
            draw.pick({kNan, kInfinity, -kInfinity, -1.0, -1e-40, 0.0, -0.0, 1e-45}));
    }
    return x;
}

// 1.0e-6 was measured.
TEST(GaussianLineBatch, AgreesWithTheDoubleFunctionOverTheDomainOfFloat) {
    check_batch_accuracy<5>(
        any_segment, batch,
        [](const auto& x) { return gaussian_line(x[0], x[1], x[2], x[3], x[4]); }, 2e-6);
}

TEST(GaussianLineBatch, AnElementDependsOnItsOwnInputsAlone) {
    check_batch_places<5>(any_segment, batch);
}

}  // namespace
}  // namespace airlight
