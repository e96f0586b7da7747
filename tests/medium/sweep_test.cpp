// SPDX-License-Identifier: Apache-2.0
// Sweeps over the functions of the uniform, isotropic medium.
#include "tests/medium/sweep.h"

#include "core/constants.h"
#include "medium/airlight.h"
#include "medium/psf.h"
#include "medium/special_f.h"

namespace airlight {
namespace {

bool no_radiance(double value) {
    return std::isnan(value) || std::signbit(value);
}

TEST(Sweep, AirlightIsARadianceAndGrowsWithTheRay) {
    sweep([](SweepDraw& draw) -> std::string {
        const double gamma = draw.angle(), t_sv = draw.not_negative();
        const double t_vp = draw.not_negative();
        const double value = airlight(gamma, t_sv, t_vp);
        const bool infinite = std::isinf(value) && gamma * t_sv > 1e-300;
        if (no_radiance(value) || infinite)
            return sweep_report("airlight", {gamma, t_sv, t_vp}, value);
        // Longer rays see more, up to the rounding of two values.
        const double longer = airlight(gamma, t_sv, t_vp + draw.not_negative());
        if (longer < value * (1 - 2e-13) && value > 1e-290) {
            return sweep_report("longer airlight", {gamma, t_sv, t_vp, value}, longer);
        }
        return {};
    });
}

TEST(Sweep, AirlightOfTwoSegmentsIsThatOfTheWhole) {
    sweep([](SweepDraw& draw) -> std::string {
        const double gamma = draw.between(1e-3, kPi), t_sv = draw.decades(-6, 1.5);
        const double whole = draw.decades(-6, 1.5), part = whole * draw.unit();
        // What remains after `part`, seen from there: the light at its own angle and distance.
        const double x = t_sv * std::cos(gamma) - part, y = t_sv * std::sin(gamma);
        const double rest = airlight(std::atan2(y, x), std::hypot(x, y), whole - part);
        const double sum = airlight(gamma, t_sv, part) + std::exp(-part) * rest;
        const double value = airlight(gamma, t_sv, whole);
        // The cosine rule as written here loses digits next to the light, where its rays diverge.
        const double nearest = gamma < kPi / 2 ? std::sin(gamma) : 1;
        return std::abs(sum - value) <= 1e-11 * value / nearest
                   ? std::string()
                   : sweep_report("airlight in parts", {gamma, t_sv, whole, part, value}, sum);
    });
}

TEST(Sweep, PsfIsARadianceAndFallsWithTheAngle) {
    sweep([](SweepDraw& draw) -> std::string {
        const double thickness = draw.not_negative(), gamma = draw.angle();
        const double value = psf(thickness, gamma), scaled = psf_scaled(thickness, gamma);
        if (no_radiance(value) || no_radiance(scaled)) {
            return sweep_report("psf", {thickness, gamma}, value);
        }
        const double wider = gamma + (kPi - gamma) * draw.unit();
        const double there = psf_scaled(thickness, wider);
        if (there > scaled * (1 + 2e-13)) {
            return sweep_report("psf_scaled at a wider angle", {thickness, gamma, wider, scaled},
                                there);
        }
        return {};
    });
}

TEST(Sweep, SpecialFIsAPositiveIncreasingIntegral) {
    sweep([](SweepDraw& draw) -> std::string {
        const double u = draw.not_negative(), a = draw.between(0, kPi / 2);
        const double b = draw.between(0, kPi / 2);
        const double value = special_f(u, a);
        if (no_radiance(value) || value > kPi / 2) return sweep_report("F", {u, a}, value);
        const double lo = std::min(a, b), hi = std::max(a, b);
        const double difference = special_f_difference(u, lo, hi);
        if (no_radiance(difference)) return sweep_report("F_diff", {u, lo, hi}, difference);
        // Each has 1e-13 of its own.
        if (std::abs(special_f(u, hi) - special_f(u, lo) - difference) > 1e-12 * special_f(u, hi)) {
            return sweep_report("F(hi) - F(lo) against F_diff", {u, lo, hi}, difference);
        }
        return {};
    });
}

}  // namespace
}  // namespace airlight
