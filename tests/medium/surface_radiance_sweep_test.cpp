// SPDX-License-Identifier: Apache-2.0
// Surface radiance at random and in all corners.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/constants.h"
#include "medium/surface_batch.h"
#include "medium/surface_radiance.h"
#include "medium/surface_radiance_tables.h"
#include "medium/surface_shading.h"
#include "tests/medium/batch_check.h"
#include "tests/medium/sweep.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Three values each: a million of the exact function in all.
constexpr std::size_t kExactInputs = kSweepInputs / 3;
// Twice the error of one value.
constexpr double kSlack = 2e-13;

double any_exponent(SweepDraw& draw) {
    switch (draw.bits() % 6) {
        case 0:
            return draw.pick({1, 2, 3, 5, 16, 20, 24, 100, 999, 1000});
        case 1:
            return draw.pick({1 + 1e-15, 1 + 1e-8, 1.5, 2.5, 3 - 1e-12, 16 - 1e-12, 20 - 1e-12,
                              24 + 1e-12, 999.5, 1000 - 1e-12});
        case 2:
            return draw.uniform(1, 1000);
        default:
            return draw.decades(0, 3);
    }
}

// Where G_n is finite, positive and falls: with the angle, as the convolution of two functions
// that fall; with the exponent; and G_n e^T with T.
TEST(SurfaceRadianceSweep, IsPositiveAndFallsWithEveryArgument) {
    sweep(
        [](SweepDraw& draw) -> std::string {
            const double t = draw.not_negative(), theta = draw.angle(), n = any_exponent(draw);
            const double value = surface_radiance_scaled(t, theta, n);
            const auto wrong = [&](const char* what, double a, double b, double c, double other) {
                return sweep_report("scaled", {t, theta, n}, value) + what +
                       sweep_report("scaled", {a, b, c}, other);
            };
            // 2 pi times the largest G_n there is, over T once it is thick.
            const bool positive = std::isinf(t) ? value == 0 : value > 0 && value < 8.1;
            if (!positive) return sweep_report("scaled", {t, theta, n}, value);
            const double plain = surface_radiance(t, theta, n);
            if (!(plain >= 0 && plain <= value)) {
                return sweep_report("surface_radiance", {t, theta, n}, plain);
            }
            double t2 = t, theta2 = theta, n2 = n;
            switch (draw.bits() % 3) {
                case 0:
                    t2 = t * (1 + draw.decades(-16, 2));
                    break;
                case 1:
                    theta2 = std::min(kPi, theta + draw.decades(-16, 0.5));
                    break;
                default:
                    n2 = std::min(1000.0, n + draw.decades(-15, 3));
                    break;
            }
            const double less = surface_radiance_scaled(t2, theta2, n2);
            return less <= value * (1 + kSlack) ? "" : wrong(" < ", t2, theta2, n2, less);
        },
        kExactInputs);
}

TEST(SurfaceRadianceSweep, NothingOutsideTheDomainHasAValue) {
    sweep([](SweepDraw& draw) -> std::string {
        double x[3] = {draw.not_negative(), draw.angle(), any_exponent(draw)};
        const std::size_t bad = draw.bits() % 3;
        const double nan = std::nan("");
        if (bad == 0) x[0] = draw.pick({nan, -5e-324, -1, -kInfinity});
        if (bad == 1) x[1] = draw.pick({nan, -5e-324, -1, 3.1415930, kInfinity, -kInfinity});
        if (bad == 2) x[2] = draw.pick({nan, 0, -1, 1 - 1e-15, 1000 + 1e-12, kInfinity, 5e-324});
        const double value = surface_radiance(x[0], x[1], x[2]);
        const bool nothing =
            std::isnan(value) && std::isnan(surface_radiance_scaled(x[0], x[1], x[2]));
        return nothing ? "" : sweep_report("surface_radiance", {x[0], x[1], x[2]}, value);
    });
}

// The error bounds of the tables against the exact function are in surface_radiance_method_test.
TEST(SurfaceRadianceSweep, TablesStayBetweenNothingAndTheirPeak) {
    for (const double n : {1.0, 20.0, 1000.0}) {
        const RawSurfaceTable raw(n, 32);
        const WarpedSurfaceTable linear(n, 32), cubic(n, 64, SurfaceInterpolation::cubic);
        const double peak = surface_radiance(0.0, 0.0, n) * (1 + 1e-3);
        sweep([&](SweepDraw& draw) -> std::string {
            const double t = draw.chance(0.5) ? draw.uniform(0, 106) : draw.not_negative();
            // Thicker ones call the exact function.
            const double thin = std::min(t, WarpedSurfaceTable::kThickest), theta = draw.angle();
            for (const double value :
                 {raw.radiance(t, theta, TableLookup::nearest),
                  raw.radiance(t, theta, TableLookup::bilinear), linear.radiance(thin, theta),
                  linear.radiance_scaled(thin, theta), cubic.radiance(thin, theta),
                  cubic.radiance_scaled(thin, theta)}) {
                if (!(value > 0 && value <= peak)) return sweep_report("table", {t, theta}, value);
            }
            return "";
        });
    }
}

std::array<float, 2> any_floats(SweepDraw& draw) {
    std::array<float, 2> x = {static_cast<float>(draw.not_negative()),
                              static_cast<float>(draw.angle())};
    if (draw.chance(0.5)) x[0] = static_cast<float>(draw.uniform(0, 108));
    if (draw.chance(0.1)) {
        x[draw.bits() % 2] = static_cast<float>(
            draw.pick({std::nan(""), kInfinity, -kInfinity, -1.0, -1e-40, -0.0, 3.15, 1e-45}));
    }
    return x;
}

// 3.0e-6 was measured; against the exact function the table's own error comes on top, which
// SurfaceMethod.WarpedTablesHoldTheirBoundsOverTheirWholeDomain bounds.
TEST(SurfaceBatchTable, IsTheCubicTableInFloatOnEveryTarget) {
    for (const double n : {1.0, 20.0, 700.0}) {
        SCOPED_TRACE(n);
        const int size = 64;
        const SurfaceBatchTable table(n, size);
        const WarpedSurfaceTable in_double(n, size, SurfaceInterpolation::cubic);
        const auto batch = [&](std::size_t count, const std::array<const float*, 2>& in,
                               float* out) { table.surface_batch(count, in[0], in[1], out); };
        check_batch_accuracy<2>(
            any_floats, batch,
            [&](const std::array<double, 2>& x) {
                // No float is left beyond the table.
                const bool none = x[0] > 106 && x[1] >= 0 && x[1] <= 3.1415928;
                return none ? 0 : in_double.radiance(x[0], x[1]);
            },
            5e-6);
        check_batch_places<2>(any_floats, batch);
    }
}

// 4.0e-6 was measured.
TEST(SurfaceBatchTable, TakesChordsForAngles) {
    for (const double n : {1.0, 20.0, 700.0}) {
        SCOPED_TRACE(n);
        const SurfaceBatchTable table(n, 64);
        const WarpedSurfaceTable in_double(n, 64, SurfaceInterpolation::cubic);
        check_batch_accuracy<2>(
            [](SweepDraw& draw) -> std::array<float, 2> {
                const double sine =
                    draw.chance(0.2) ? draw.decades(-9, 0) : std::sin(0.5 * draw.angle());
                return {static_cast<float>(draw.uniform(0, 80)), static_cast<float>(sine * sine)};
            },
            [&](std::size_t count, const std::array<const float*, 2>& in, float* out) {
                table.surface_batch_by_chord(count, in[0], in[1], out);
            },
            [&](const std::array<double, 2>& x) {
                return in_double.radiance(x[0], 2 * std::asin(std::sqrt(x[1])));
            },
            1e-5);
    }
}

TEST(SurfaceBatchTable, AgreesWithTheExactFunction) {
    const SurfaceBatchTable lambert, phong(20);
    sweep(
        [&](SweepDraw& draw) -> std::string {
            const float t =
                static_cast<float>(draw.chance(0.5) ? draw.uniform(0, 80) : draw.not_negative());
            const float theta = static_cast<float>(draw.angle());
            for (const SurfaceBatchTable* table : {&lambert, &phong}) {
                float value;
                table->surface_batch(1, &t, &theta, &value);
                const double exact = surface_radiance(double{t}, double{theta}, table->exponent());
                if (!is_close(value, exact, 1.5e-5)) {
                    return sweep_report("batch", {t, theta, table->exponent()}, value);
                }
            }
            return "";
        },
        kExactInputs / 4);
}

glm::dvec3 any_direction(SweepDraw& draw) {
    if (draw.chance(0.3)) {
        const double s = draw.sign();
        return draw.pick({0, 1}) == 0 ? glm::dvec3(s, 0, 0) : glm::dvec3(0, 0, s);
    }
    const double z = draw.uniform(-1, 1), phi = draw.uniform(0, 2 * kPi);
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

TEST(SurfaceShadingSweep, IsNeverNegativeNorNanAndDimsWithAbsorption) {
    SurfaceOptions options;
    options.method = SurfaceMethod::warped_table;
    const SurfaceEvaluator lambert(options);
    options.exponent = 7;
    const SurfaceEvaluator phong(options);
    sweep([&](SweepDraw& draw) -> std::string {
        const auto coordinate = [&] {
            return draw.chance(0.2) ? draw.sign() * draw.decades(-300, 300) : draw.uniform(-3, 3);
        };
        const SurfacePoint point = {{coordinate(), coordinate(), coordinate()},
                                    any_direction(draw)};
        const SurfaceLight light = {{coordinate(), coordinate(), coordinate()},
                                    draw.chance(0.1) ? 0 : draw.decades(-20, 20)};
        const glm::dvec3 far = light.position - point.position;
        // Up to the end of the tables, so that no input costs an integral.
        const double distance = std::max({std::abs(far.x), std::abs(far.y), std::abs(far.z)}) * 1.8;
        if (distance == 0) return "";
        const double sigma_t =
            draw.pick({0.0, 1.0, draw.unit(), draw.decades(-300, 0)}) * 106 / distance;
        const SurfaceFog fog = {sigma_t, sigma_t * draw.pick({0, 0.5, 1})};
        const glm::dvec3 view = any_direction(draw);
        for (const bool is_phong : {false, true}) {
            const auto shade = [&](const SurfaceFog& in) {
                return is_phong ? phong_surface(point, view, light, in, 0.3, phong)
                                : lambert_surface(point, light, in, 0.3, lambert);
            };
            const SurfaceRadiance r = shade(fog);
            if (!(r.direct >= 0 && r.scattered >= 0)) {
                return sweep_report("radiance", {distance, sigma_t, light.intensity}, r.total());
            }
            if (fog.scattering == 0 && r.scattered != 0) return "light scattered by nothing";
            const SurfaceRadiance darker = shade({fog.extinction * 1.25, fog.scattering});
            // The table's own steps are not quite monotone.
            if (!(darker.direct <= r.direct * (1 + 1e-14) &&
                  (darker.scattered <= r.scattered * (1 + 1e-12) ||
                   fog.extinction * 1.25 * distance > 106))) {
                return sweep_report("darker", {distance, sigma_t, darker.scattered}, r.scattered);
            }
        }
        return "";
    });
}

}  // namespace
}  // namespace airlight
