// SPDX-License-Identifier: Apache-2.0
#include "medium/height_density_batch.h"

#include <gtest/gtest.h>

#include <limits>

#include "medium/height_density.h"
#include "tests/medium/batch_check.h"

namespace airlight {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

void batch(std::size_t count, const std::array<const float*, 4>& in, float* out) {
    exponential_height_depth_batch(count, in[0], in[1], in[2], in[3], out);
}

std::array<float, 4> any_ray(SweepDraw& draw) {
    double falloff = draw.sign() * draw.decades(-6, 6);
    double height = draw.uniform(-90, 90) / falloff;
    double up = draw.between(-1, 1);
    double distance = draw.decades(-9, 9) / std::abs(falloff);
    switch (draw.bits() % 6) {
        case 0:
            falloff = draw.sign() * draw.not_negative(false);
            height = draw.sign() * draw.not_negative(false);
            distance = draw.not_negative();
            break;
        case 1:
            // From far up, ends near height 0.
            height = draw.decades(0, 6) / falloff;
            up = -draw.unit();
            distance = -(height / up) * (1 + draw.sign() * draw.decades(-8, 0));
            break;
        case 2:
            up = draw.sign() * draw.decades(-20, 0);
            break;
        case 3:
            distance = HUGE_VAL;
            break;
        default:
            break;
    }
    std::array<float, 4> x = {float(height), float(up), float(distance), float(falloff)};
    if (draw.chance(0.05)) {
        x[draw.bits() % 4] = static_cast<float>(
            draw.pick({kNan, kInfinity, -kInfinity, -1.0, 1.001, -1e-40, 0.0, -0.0, 1e-45}));
    }
    return x;
}

// 4.6e-7 was measured.
TEST(ExponentialHeightBatch, AgreesWithTheDoubleFunctionOverTheDomainOfFloat) {
    check_batch_accuracy<4>(
        any_ray, batch,
        [](const auto& x) { return exponential_height_depth(x[0], x[1], x[2], x[3]); }, 1e-6);
}

TEST(ExponentialHeightBatch, AnElementDependsOnItsOwnInputsAlone) {
    check_batch_places<4>(any_ray, batch);
}

}  // namespace
}  // namespace airlight
