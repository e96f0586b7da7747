// SPDX-License-Identifier: Apache-2.0
#include "medium/psf_batch.h"

#include <gtest/gtest.h>

#include <limits>

#include "medium/psf.h"
#include "tests/medium/batch_check.h"

namespace airlight {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

using Pointers = std::array<const float*, 2>;

void batch(std::size_t count, const Pointers& in, float* out) {
    psf_batch(count, in[0], in[1], out);
}

void scaled_batch(std::size_t count, const Pointers& in, float* out) {
    psf_scaled_batch(count, in[0], in[1], out);
}

std::array<float, 2> any_angle(SweepDraw& draw) {
    std::array<float, 2> x = {static_cast<float>(draw.not_negative()),
                              static_cast<float>(draw.angle())};
    if (draw.chance(0.5)) x[0] = static_cast<float>(draw.decades(-12, 3));
    if (draw.chance(0.1)) {
        x[draw.bits() % 2] = static_cast<float>(
            draw.pick({kNan, kInfinity, -kInfinity, -1.0, -1e-40, 0.0, -0.0, 3.15, 1e-45}));
    }
    return x;
}

// 3.9e-6 was measured.
TEST(PsfBatch, AgreesWithTheDoubleFunctionOverTheDomainOfFloat) {
    check_batch_accuracy<2>(
        any_angle, batch, [](const auto& x) { return psf(x[0], x[1]); }, 5e-6);
}

TEST(PsfBatch, ScaledFormAgreesWithTheDoubleFunctionOverTheDomainOfFloat) {
    check_batch_accuracy<2>(
        any_angle, scaled_batch, [](const auto& x) { return psf_scaled(x[0], x[1]); }, 5e-6);
}

TEST(PsfBatch, AnElementDependsOnItsOwnInputsAlone) {
    check_batch_places<2>(any_angle, batch);
    check_batch_places<2>(any_angle, scaled_batch);
}

}  // namespace
}  // namespace airlight
