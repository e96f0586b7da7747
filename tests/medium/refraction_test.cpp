// SPDX-License-Identifier: Apache-2.0
#include "medium/refraction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/medium/reference_rows.h"
#include "tests/medium/sweep.h"

namespace airlight {
namespace {

// Fresnel's equations as every textbook has them, in long double.
struct Textbook {
    long double cosine, reflectance;
};
Textbook textbook(long double c1, long double n1, long double n2) {
    const long double s2 = n1 / n2 * std::sqrt((1 - c1) * (1 + c1));
    const long double c2 = std::sqrt((1 - s2) * (1 + s2));
    const long double rs = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2);
    const long double rp = (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2);
    return {c2, (rs * rs + rp * rp) / 2};
}

TEST(Refraction, IsFresnelsAndSnells) {
    sweep([](SweepDraw& draw) -> std::string {
        const double c = draw.unit(), n1 = draw.uniform(0.5, 3), n2 = draw.uniform(0.5, 3);
        const SurfaceCrossing ours = surface_crossing(c, n1, n2);
        const double sine = n1 / n2 * std::sqrt((1 - c) * (1 + c));
        if (std::abs(sine - 1) < 1e-6 || std::abs(n1 / n2 - 1) < 1e-3) return {};
        if (ours.total != (sine > 1)) return sweep_report("total", {c, n1, n2}, ours.cosine);
        if (ours.total) {
            return ours.reflectance == 1 && ours.transmittance == 0 && ours.cosine == 0
                       ? ""
                       : sweep_report("total", {c, n1, n2}, ours.reflectance);
        }
        const Textbook book = textbook(c, n1, n2);
        // Conditioning: digits lost as the critical angle comes near; the textbook's own digits
        // in R are lost where the indices agree.
        const double ratio = n1 / n2 / double(book.cosine);
        const double slack = 1e-14 + 1e-15 * ratio * ratio;
        if (!(relative_error(ours.cosine, double(book.cosine)) < slack)) {
            return sweep_report("cosine", {c, n1, n2}, ours.cosine);
        }
        if (!(std::abs(ours.reflectance - double(book.reflectance)) <
              slack * double(book.reflectance) + 1e-19)) {
            return sweep_report("reflectance", {c, n1, n2}, ours.reflectance);
        }
        return {};
    });
}

TEST(Refraction, KeepsEnergyAndIsReciprocalForAnyInput) {
    sweep([](SweepDraw& draw) -> std::string {
        const double c = draw.chance(0.2) ? draw.decades(-323, 0) : draw.between(0, 1);
        const double n1 = draw.chance(0.1) ? draw.decades(-300, 300) : draw.uniform(0.5, 3);
        const double n2 = draw.chance(0.3) ? n1 * (1 + draw.sign() * draw.decades(-16, -1))
                                           : draw.uniform(0.5, 3);
        const SurfaceCrossing ours = surface_crossing(c, n1, n2);
        const auto wrong = [&](const char* what, double value) {
            return sweep_report(what, {c, n1, n2}, value);
        };
        if (!(ours.reflectance >= 0 && ours.reflectance <= 1)) return wrong("R", ours.reflectance);
        if (!(ours.transmittance >= 0 && ours.transmittance <= 1)) {
            return wrong("T", ours.transmittance);
        }
        // R divides by n2^2 what T does not.
        const double index = n1 < n2 ? 1 : n1 / n2;
        if (!(std::abs(ours.reflectance + ours.transmittance - 1) < 2e-15 * index * index)) {
            return wrong("R + T", ours.reflectance + ours.transmittance);
        }
        if (!(ours.cosine >= 0 && ours.cosine <= 1 && ours.beam >= 0 && ours.radiance >= 0)) {
            return wrong("cosine", ours.cosine);
        }
        if (ours.total || ours.cosine < 1e-6 || n1 < 1e-3 || n1 > 1e3) return {};
        const SurfaceCrossing back = surface_crossing(ours.cosine, n2, n1);
        // Coming back near the critical angle, an error in the cosine counts by its inverse.
        const double lever = (n2 / n1) * (n2 / n1) / (c * c + 1e-300);
        const double other = (n1 / n2) * (n1 / n2) / (ours.cosine * ours.cosine);
        const double slack = 1e-14 + 2e-15 * (lever + other);
        if (slack < 0.1 && !(relative_error(back.transmittance, ours.transmittance) < slack)) {
            return wrong("there and back", back.transmittance);
        }
        return {};
    });
}

TEST(Refraction, HoldsAtGrazingAndAtEqualIndices) {
    for (const double c : {0.0, 1e-300, 0.3, 1.0}) {
        const SurfaceCrossing same = surface_crossing(c, 1.3, 1.3);
        EXPECT_EQ(same.cosine, c);
        EXPECT_EQ(same.reflectance, 0);
        EXPECT_EQ(same.transmittance, 1);
        EXPECT_EQ(same.beam, 1);
    }
    // Indices that differ in the last digit: ((n2 - n1) / (n2 + n1))^2 straight on. The textbook's
    // difference of n c has no digit left at 30 degrees.
    const double n1 = 1.25, n2 = std::nextafter(1.25, 2);
    const double ratio = (n2 - n1) / (n2 + n1);
    EXPECT_LT(relative_error(surface_crossing(1, n1, n2).reflectance, ratio * ratio), 1e-15);
    // At 30 degrees, with n2 = n1 (1 + d): r_s = -d / (2 c^2), r_p = d (c^2 - s^2) / (2 c^2).
    const double d = (n2 - n1) / n1, c = std::sqrt(0.75);
    const double expected = d * d / 8 * (1 + 0.25) / (c * c * c * c);
    EXPECT_LT(relative_error(surface_crossing(c, n1, n2).reflectance, expected), 1e-14);
    // Grazing: T ~ 2 c (n^2 + 1) / ... is linear in c, and not a difference from 1.
    const double t1 = surface_crossing(1e-20, 1, 1.5).transmittance;
    EXPECT_LT(relative_error(surface_crossing(2e-20, 1, 1.5).transmittance, 2 * t1), 1e-14);
    EXPECT_GT(t1, 1e-20);
    EXPECT_EQ(surface_crossing(0, 1, 1.5).transmittance, 0);
    EXPECT_EQ(surface_crossing(0, 1, 1.5).reflectance, 1);
    // Brewster's angle: half of the light is not reflected at all.
    const double brewster = 1 / std::sqrt(1 + 1.5 * 1.5);
    const double rs = (1 - 1.5 * 1.5) / (1 + 1.5 * 1.5);
    EXPECT_LT(relative_error(surface_crossing(brewster, 1, 1.5).reflectance, rs * rs / 2), 1e-14);
    EXPECT_TRUE(surface_crossing(0.5, 1.5, 1).total);
    EXPECT_FALSE(surface_crossing(0.9, 1.5, 1).total);
}

TEST(Refraction, RefusesWhatIsOutsideItsDomainWithNan) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    for (const SurfaceCrossing& bad :
         {surface_crossing(nan, 1, 1), surface_crossing(-1e-9, 1, 1), surface_crossing(1.1, 1, 1),
          surface_crossing(1, 0, 1), surface_crossing(1, 1, infinity),
          surface_crossing(1, -1, 1)}) {
        EXPECT_TRUE(std::isnan(bad.cosine));
        EXPECT_TRUE(std::isnan(bad.transmittance));
    }
}

}  // namespace
}  // namespace airlight
