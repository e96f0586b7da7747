// SPDX-License-Identifier: Apache-2.0
#include "medium/airlight_batch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "medium/airlight.h"
#include "medium/airlight_rungs.h"
#include "medium/airlight_sets.h"
#include "tests/medium/batch_check.h"

namespace airlight {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

using Pointers = std::array<const float*, 3>;

void fitted(std::size_t count, const Pointers& in, float* out) {
    airlight_batch(count, in[0], in[1], in[2], out);
}

double exact(const std::array<double, 3>& x) {
    return airlight(x[0], x[1], x[2]);
}

// A third corners of the domain, a third rays of any size around the light, a third of pictures.
std::array<float, 3> any_ray(SweepDraw& draw) {
    double gamma = draw.angle(), t_sv = draw.not_negative(), t_vp = draw.not_negative();
    switch (draw.bits() % 6) {
        case 0:
            t_vp = t_sv * (1 + draw.sign() * draw.decades(-9, 0));
            break;
        case 1:
            gamma = draw.decades(-9, 0.49);
            t_sv = draw.decades(-12, 12);
            t_vp = t_sv * draw.decades(-12, 12);
            break;
        case 2:
            gamma = kPi - draw.decades(-7, 0);
            t_sv = draw.decades(-6, 3);
            t_vp = t_sv * draw.decades(-6, 3);
            break;
        case 3:
        case 4:
            gamma = draw.uniform(0, kPi);
            t_sv = draw.decades(-3, 2);
            t_vp = t_sv * draw.decades(-3, 3);
            break;
        default:
            break;
    }
    return {static_cast<float>(gamma), static_cast<float>(t_sv), static_cast<float>(t_vp)};
}

// Outside the domain too.
std::array<float, 3> any_floats(SweepDraw& draw) {
    std::array<float, 3> x = any_ray(draw);
    if (draw.chance(0.3)) {
        x[draw.bits() % 3] = static_cast<float>(
            draw.pick({kNan, kInfinity, -kInfinity, -1.0, -1e-40, 0.0, -0.0, 3.15, 1e-45}));
    }
    return x;
}

// 5.5e-6 was measured.
TEST(AirlightBatch, AgreesWithTheDoubleFunctionOverTheDomainOfFloat) {
    check_batch_accuracy<3>(any_ray, fitted, exact, 7e-6);
}

// A ray of a scene: where the lamp stands, where the part begins, and how long it is.
std::array<float, 4> any_part(SweepDraw& draw) {
    const double foot = draw.sign() * draw.decades(-4, 4), height = draw.decades(-5, 4);
    const double begin = draw.chance(0.5) ? 0 : draw.decades(-4, 2.5);
    double length = draw.chance(0.1) ? double(kInfinity) : draw.decades(-4, 4);
    if (draw.chance(0.3)) length = std::abs(foot) * (1 + draw.sign() * draw.decades(-6, 0));
    return {static_cast<float>(foot), static_cast<float>(height), static_cast<float>(begin),
            static_cast<float>(length)};
}

// 1.3e-5 was measured, where e^-80 is left: the thickness on the way is itself rounded.
TEST(AirlightBatch, PartsOfRaysAreTheDoubleFunctions) {
    for (const float extinction : {1e-4f, 0.05f, 2.0f}) {
        const double sigma = extinction;
        const auto parts = [&](std::size_t count, const std::array<const float*, 4>& in,
                               float* out) {
            airlight_parts_batch(count, extinction, in[0], in[1], in[2], in[3], out);
        };
        const auto exact_part = [&](const std::array<double, 4>& x) {
            return std::exp(-sigma * x[2]) *
                   airlight(std::atan2(x[1], x[0]), sigma * std::hypot(x[0], x[1]), sigma * x[3]);
        };
        check_batch_accuracy<4>(any_part, parts, exact_part, 1.6e-5);
    }
}

TEST(AirlightBatch, RefusesWhatIsOutsideItsDomainWithNan) {
    check_batch_accuracy<3>(any_floats, fitted, exact, 7e-6);
}

TEST(AirlightBatch, AnElementDependsOnItsOwnInputsAlone) {
    check_batch_places<3>(any_floats, fitted);
}

TEST(AirlightBatchTable, KeepsItsBoundOverTheDomainOfFloat) {
    const std::pair<int, double> bounds[] = {{32, 4e-3}, {64, 1.2e-3}, {128, 4e-4}};
    for (const auto& [size, bound] : bounds) {
        SCOPED_TRACE(size);
        const AirlightBatchTable table(size);
        const auto tabulated = [&](std::size_t count, const Pointers& in, float* out) {
            table.airlight_batch(count, in[0], in[1], in[2], out);
        };
        check_batch_accuracy<3>(any_floats, tabulated, exact, bound);
        if (size == 32) check_batch_places<3>(any_floats, tabulated);
    }
}

// The errors beside which bench/batch_bench.cpp sets the cost: no batch is worse than the march.
TEST(AirlightBatch, IsCloserThanARayMarch) {
    const AirlightBatchTable table;
    for (const char set : {'A', 'B'}) {
        const auto cases = airlight_set(set, 20000);
        const auto one = [](const auto& batch) {
            return [&batch](double gamma, double t_sv, double t_vp) {
                const float in[] = {float(gamma), float(t_sv), float(t_vp)};
                float out;
                batch(in, &out);
                return double{out};
            };
        };
        const auto by_fit = [](const float* in, float* out) {
            airlight_batch(1, in, in + 1, in + 2, out);
        };
        const auto by_table = [&](const float* in, float* out) {
            table.airlight_batch(1, in, in + 1, in + 2, out);
        };
        const RelativeErrors march = airlight_errors(
            cases, [](double g, double s, double v) { return airlight_march(g, s, v, 64); });
        // The inputs' rounding to float adds up to 3e-7 / gamma.
        EXPECT_LT(airlight_errors(cases, one(by_fit)).rms, 1e-4 * march.rms) << set;
        EXPECT_LT(airlight_errors(cases, one(by_table)).max, 1e-3 * march.max) << set;
    }
}

}  // namespace
}  // namespace airlight
