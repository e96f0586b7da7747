// SPDX-License-Identifier: Apache-2.0
#include "medium/slab.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/constants.h"
#include "medium/airlight.h"
#include "medium/slab_integral.h"
#include "medium/slab_method.h"
#include "tests/medium/reference_rows.h"
#include "tests/medium/sweep.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Measured: 2e-15 on the golden rows, 2.4e-14 on the corners (an exponent of 460).
constexpr double kDoubleTolerance = 1e-13;
// Computed in double and rounded once.
constexpr double kFloatTolerance = 6.1e-8;
constexpr double kNormal = 1e-290;

struct Ray {
    double sigma_t, s, l, w_dot_n, wl_dot_n, w_dot_wl;
};

double near(const Ray& r) {
    return slab_near(r.sigma_t, r.s, r.l, r.w_dot_n, r.wl_dot_n, r.w_dot_wl);
}
double flat(const Ray& r) {
    return slab_near_flat(r.sigma_t, r.s, r.l, r.w_dot_n, r.wl_dot_n, r.w_dot_wl);
}
double thin(const Ray& r) {
    return slab_thin(r.sigma_t, r.s, r.l, r.w_dot_n, r.wl_dot_n, r.w_dot_wl);
}
double in_airlight(const Ray& r) {
    return 4 * kPi * r.sigma_t * airlight(std::acos(-r.w_dot_wl), r.sigma_t * r.l, r.sigma_t * r.s);
}

std::string report(const char* what, const Ray& r, double value) {
    return sweep_report(what, {r.sigma_t, r.s, r.l, r.w_dot_n, r.wl_dot_n, r.w_dot_wl}, value);
}

Ray from(const std::vector<double>& row) {
    return {row[0], row[1], row[2], row[3], row[4], row[5]};
}

std::vector<std::vector<double>> seed_rows() {
    return reference_rows("seed001.csv", 13, 189);
}

double cosine(SweepDraw& draw) {
    if (draw.chance(0.1)) return draw.decades(-323, 0);
    return draw.between(0, 1);
}

Ray any_ray(SweepDraw& draw) {
    Ray r = {draw.not_negative(), draw.not_negative(), draw.not_negative(),
             cosine(draw),        cosine(draw),        draw.between(-1, 1)};
    if (draw.chance(0.2)) r.s = r.l * (1 + draw.sign() * draw.decades(-16, 0));
    if (draw.chance(0.2)) r.s = r.l * draw.decades(-20, 20);
    if (draw.chance(0.2)) r.sigma_t = draw.decades(-5, 5) / r.l;
    if (!(r.sigma_t >= 0)) r.sigma_t = 1;
    if (!(r.s >= 0)) r.s = 1;
    return r;
}

// A ray and a light that exist, of ordinary size.
Ray real_ray(SweepDraw& draw) {
    const double a = draw.unit(), b = draw.unit();
    const double g = a * b + std::sqrt((1 - a * a) * (1 - b * b)) * std::cos(kPi * draw.unit());
    return {draw.decades(-2, 1), draw.decades(-2, 2), draw.decades(-2, 2), a, b, g};
}

TEST(Slab, MatchesEveryReferenceRow) {
    for (const auto& row : seed_rows()) {
        const Ray r = from(row);
        EXPECT_LT(relative_error(flat(r), row[6]), kDoubleTolerance) << report("flat", r, row[6]);
        EXPECT_LT(relative_error(near(r), row[7]), kDoubleTolerance) << report("near", r, row[7]);
        EXPECT_LT(relative_error(slab_distant(r.sigma_t, r.s, r.w_dot_n, r.wl_dot_n), row[10]),
                  1e-15);
        EXPECT_LT(relative_error(slab_falloff(r.s, r.l, r.w_dot_wl), row[11]), 1e-15);
        EXPECT_LT(relative_error(thin(r), row[12]), 2e-15);
        const auto f = [](double x) { return static_cast<float>(x); };
        const Ray rounded = {f(r.sigma_t), f(r.s),        f(r.l),
                             f(r.w_dot_n), f(r.wl_dot_n), f(r.w_dot_wl)};
        const float as_float =
            slab_near(f(r.sigma_t), f(r.s), f(r.l), f(r.w_dot_n), f(r.wl_dot_n), f(r.w_dot_wl));
        EXPECT_LT(relative_error(as_float, near(rounded)), kFloatTolerance);
        const float thin_float =
            slab_thin(f(r.sigma_t), f(r.s), f(r.l), f(r.w_dot_n), f(r.wl_dot_n), f(r.w_dot_wl));
        EXPECT_LT(relative_error(thin_float, thin(rounded)), kFloatTolerance);
    }
}

TEST(Slab, MatchesTheCornersComputedInManyDigits) {
    for (const auto& row : reference_rows("slab_corners.csv", 8, 400)) {
        const Ray r = from(row);
        EXPECT_LT(relative_error(flat(r), row[6]), kDoubleTolerance) << report("flat", r, row[6]);
        EXPECT_LT(relative_error(near(r), row[7]), kDoubleTolerance) << report("near", r, row[7]);
    }
}

// With the light in the surface all of its way is inside, [Slab] eq. 8.
TEST(Slab, IsTheAirlightWhereTheLightLiesInTheSurface) {
    int compared = 0;
    for (const auto& row : seed_rows()) {
        Ray r = from(row);
        r.wl_dot_n = 0;
        if (near(r) > kNormal) {
            EXPECT_LT(relative_error(in_airlight(r), near(r)), 1e-12) << report("", r, row[9]);
        }
        if (r.w_dot_wl == 1) {
            // h = l + x
            const double form =
                std::exp(-r.sigma_t * r.l) * -std::expm1(-2 * r.sigma_t * r.s) / (2 * r.sigma_t);
            EXPECT_NEAR(flat(r), form, kDoubleTolerance * form) << report("", r, form);
        }
        // These columns are off by up to 1e-8 where e^{-sigma_t l} is 1e-44: that closed form
        // tells so where it holds, and airlight() elsewhere.
        if (r.sigma_t * r.l > 50) continue;
        ++compared;
        EXPECT_LT(relative_error(flat(r), row[8]), kDoubleTolerance) << report("", r, row[8]);
        EXPECT_LT(relative_error(near(r), row[9]), kDoubleTolerance) << report("", r, row[9]);
    }
    EXPECT_GT(compared, 100);
}

TEST(Slab, PrintedAngleOfTheAirlightIsThatToTheOtherSide) {
    // [Slab] section 3.4 has gamma = arccos(w . w_l).
    const double sigma_t = 1, s = 10, l = 1, g = 0.7655541759927512;
    const double ours = slab_near(sigma_t, s, l, 0.7, 0, g);
    const double printed = 4 * kPi * airlight(std::acos(g), l, s);
    const double corrected = 4 * kPi * airlight(kPi - std::acos(g), l, s);
    EXPECT_LT(relative_error(corrected, ours), 1e-14);
    EXPECT_GT(relative_error(printed, ours), 1);
}

TEST(Slab, TendsToTheDistantLight) {
    sweep(
        [](SweepDraw& draw) -> std::string {
            Ray r = real_ray(draw);
            const double limit = slab_distant(r.sigma_t, r.s, r.w_dot_n, r.wl_dot_n);
            r.l = 1e12;
            // Relative corrections are (1 + c)^2 / (sigma_t l) at most, and c < 1e5 here.
            const double c = r.w_dot_n / r.wl_dot_n;
            const double bound = 1e-12 + 10 * (1 + c) * (r.s + 1 / r.sigma_t) / r.l;
            if (!(relative_error(flat(r), limit) < bound)) return report("flat", r, limit);
            if (!(relative_error(near(r) * r.l * r.l, limit) < bound))
                return report("near", r, limit);
            r.l = kInfinity;
            if (flat(r) != limit || near(r) != 0) return report("infinite", r, limit);
            return {};
        },
        20000);
    // [Slab] section 4.1: straight on and straight back, at any distance.
    for (const double l : {1e-8, 0.01, 1.0, 30.0, 1e8}) {
        EXPECT_LT(
            relative_error(slab_near_flat(1, 10, l, 1, 1, 1), slab_distant(1.0, 10.0, 1.0, 1.0)),
            1e-14);
    }
}

TEST(Slab, IsFiniteAndNotNegativeForAnyInput) {
    sweep([](SweepDraw& draw) -> std::string {
        const Ray r = any_ray(draw);
        const double value = near(r);
        if (!(value >= 0)) return report("near", r, value);
        // The falloff is the integral without extinction.
        const double most = slab_falloff(r.s, r.l, r.w_dot_wl);
        if (!(value <= most * (1 + 1e-14))) return report("near above falloff", r, value);
        const double even = flat(r);
        if (!(even >= 0 && even <= r.s * (1 + 1e-14))) return report("flat", r, even);
        const double rough = thin(r);
        if (!(rough >= 0 && rough <= most * (1 + 1e-14))) return report("thin", r, rough);
        return {};
    });
}

TEST(Slab, GrowsWithTheLengthAndFallsWithTheExtinction) {
    sweep(
        [](SweepDraw& draw) -> std::string {
            const Ray r = any_ray(draw);
            Ray longer = r, denser = r;
            longer.s *= 1 + draw.decades(-6, 3);
            denser.sigma_t *= 1 + draw.decades(-6, 3);
            // Each may be off by its own error, 1e-16 of an exponent up to 745 among it; denormal
            // results by their last digit.
            const double slack = 1 + 4e-13;
            for (const auto f : {near, flat}) {
                const double value = f(r);
                const double tiny = 1e-300;
                if (!(value <= f(longer) * slack + tiny)) return report("longer", r, value);
                if (!(f(denser) <= value * slack + tiny)) return report("denser", r, value);
            }
            return {};
        },
        kSweepInputs / 5);
}

// Twice the nodes on the same panels: what the rule leaves.
TEST(Slab, DoesNotDependOnTheRule) {
    sweep(
        [](SweepDraw& draw) -> std::string {
            const Ray r = any_ray(draw);
            for (const int power : {0, 2}) {
                const auto by = [&](int nodes) {
                    return detail::slab_near_by(r.sigma_t, r.s, r.l, r.w_dot_n, r.wl_dot_n,
                                                r.w_dot_wl, power, nodes);
                };
                const double value = by(16), fine = by(32);
                // Measured: 2e-13, without falloff next to the light.
                if (std::abs(value - fine) <= 4e-13 * fine + 1e-300 || value == fine) continue;
                return report(power == 2 ? "near" : "flat", r, value / fine - 1);
            }
            return {};
        },
        kSweepInputs / 5);
}

TEST(Slab, ScalesWithTheUnitOfLength) {
    sweep(
        [](SweepDraw& draw) -> std::string {
            const Ray r = real_ray(draw);
            const double unit = std::exp2(std::floor(draw.uniform(-300, 300)));
            const Ray scaled = {r.sigma_t / unit, r.s * unit, r.l * unit,
                                r.w_dot_n,        r.wl_dot_n, r.w_dot_wl};
            if (near(scaled) * unit != near(r)) return report("near", r, unit);
            if (flat(scaled) / unit != flat(r)) return report("flat", r, unit);
            return {};
        },
        20000);
}

TEST(Slab, IsTheFormulaAsPrinted) {
    sweep(
        [](SweepDraw& draw) -> std::string {
            Ray r = real_ray(draw);
            r.s = std::min(r.s, r.l);
            r.sigma_t = std::min(r.sigma_t, 1 / r.l);
            r.wl_dot_n = std::max(r.wl_dot_n, 0.3);
            const int steps = 20000;
            long double even = 0, falling = 0;
            for (int i = 0; i < steps; ++i) {
                const double x = (i + 0.5) * r.s / steps;
                const double h = std::sqrt(x * x + r.l * r.l + 2 * x * r.l * r.w_dot_wl);
                const double k = x * r.w_dot_n * h / (r.l * r.wl_dot_n + x * r.w_dot_n);
                const double t = std::exp(-r.sigma_t * (x + k));
                even += t;
                falling += t / (h * h);
            }
            // Midpoint: s^2 / (24 steps^2) of the second derivative, which 1 / h^2 has large near
            // the light.
            if (1 + r.w_dot_wl < 1e-2) return {};
            if (!(relative_error(double(even * r.s / steps), flat(r)) < 1e-6)) {
                return report("flat", r, double(even * r.s / steps));
            }
            if (!(relative_error(double(falling * r.s / steps), near(r)) < 1e-6)) {
                return report("near", r, double(falling * r.s / steps));
            }
            return {};
        },
        500);
}

TEST(Slab, HasItsLimits) {
    EXPECT_EQ(slab_near(1, 0, 1, 0.5, 0.5, 0), 0);
    EXPECT_EQ(slab_near(1, 0, 0, 0.5, 0.5, 0), 0);
    EXPECT_EQ(slab_near(kInfinity, 1, 1, 0.5, 0.5, 0), 0);
    EXPECT_EQ(slab_near(1, 1, 0, 0.5, 0.5, 0), kInfinity);
    EXPECT_EQ(slab_near(1, 1, kInfinity, 0.5, 0.5, 0), 0);
    EXPECT_EQ(slab_near(1, 1, 1, 0.5, 0.5, -1), kInfinity);
    EXPECT_LT(slab_near(1, 1 - 1e-15, 1, 0.5, 0.5, -1), kInfinity);
    // Through nothing to a light in the ray: x / (1 - x).
    EXPECT_LT(relative_error(slab_near(0, 1 - 0x1p-50, 1, 0.5, 0.5, -1), 0x1p50 - 1), 1e-15);
    EXPECT_EQ(slab_near(0, kInfinity, 2, 0.5, 0.5, 1), 0.5);
    EXPECT_LT(relative_error(slab_near(0, kInfinity, 2, 0.5, 0.5, 0), kPi / 4), 1e-15);
    EXPECT_LT(relative_error(slab_near(1e-300, kInfinity, 2, 0.5, 0.5, 0), kPi / 4), 1e-14);
    EXPECT_EQ(slab_near_flat(0, kInfinity, 2, 0.5, 0.5, 0), kInfinity);
    EXPECT_EQ(slab_near_flat(0, 3, 2, 0.5, 0.5, 0), 3);
    EXPECT_LT(relative_error(slab_near_flat(2, kInfinity, 0, 0.5, 0.5, 0), 0.25), 1e-14);
    // The ray runs along the surface: nothing on the light's way.
    EXPECT_LT(relative_error(slab_near_flat(2, 3, 1, 0, 0.5, 0.1), -std::expm1(-6) / 2), 1e-14);
    EXPECT_EQ(slab_distant(1, 3, 0.5, 0), 0);
    EXPECT_EQ(slab_distant(0, 3, 0.5, 0), 3);
    EXPECT_LT(relative_error(slab_distant(1, 3, 0, 0.5), -std::expm1(-3)), 1e-15);
    EXPECT_LT(relative_error(slab_distant(2, kInfinity, 0.5, 0.25), 1.0 / 6), 1e-15);
    EXPECT_LT(relative_error(slab_distant(1e-300, 1, 1, 5e-324), 5e-324 / 1e-300), 1e-15);
    EXPECT_EQ(slab_distant(1e-300, 1e10, 0.5, 0.5), 1e10);
    EXPECT_LT(relative_error(slab_near_flat(1, 1e-300, 1e20, 0.5, 0.5, 0), 1e-300), 1e-15);
    EXPECT_LT(relative_error(slab_near(1, 1e-290, 1e-10, 0.5, 0.5, 0), 1e-270), 1e-14);
    EXPECT_EQ(slab_thin(1, kInfinity, 1, 0.5, 0.5, 0), 0);
    EXPECT_EQ(slab_thin(1, 1, 1, 0.5, 0, 0), 0);
}

TEST(Slab, RefusesWhatIsOutsideItsDomainWithNan) {
    const double good[6] = {1, 1, 1, 0.5, 0.5, 0.5};
    for (int i = 0; i < 6; ++i) {
        for (const double bad : {kNan, i == 5 ? -1.00001 : -1e-300, i < 3 ? kNan : 1.00001}) {
            double v[6];
            std::copy(good, good + 6, v);
            v[i] = bad;
            EXPECT_TRUE(std::isnan(slab_near(v[0], v[1], v[2], v[3], v[4], v[5]))) << i;
            EXPECT_TRUE(std::isnan(slab_near_flat(v[0], v[1], v[2], v[3], v[4], v[5]))) << i;
            EXPECT_TRUE(std::isnan(slab_thin(v[0], v[1], v[2], v[3], v[4], v[5]))) << i;
            for (const NamedMethod<SlabMethod>& info : kSlabMethods) {
                EXPECT_TRUE(std::isnan(slab_near(info.method, v[0], v[1], v[2], v[3], v[4], v[5])))
                    << i << info.name;
            }
        }
    }
    EXPECT_TRUE(std::isnan(slab_distant(-1.0, 1.0, 1.0, 1.0)));
    EXPECT_TRUE(std::isnan(slab_falloff(1, kNan, 1)));
    EXPECT_EQ(slab_near(1, 1, 1, 1 + 1e-7, 1, 1), slab_near(1.0, 1, 1, 1, 1, 1));
}

// [Slab] says that its approximation is good for thin media with a close light; the close light is
// where it is worst.
TEST(Slab, ThinApproximationIsWorstForTheCloseLight) {
    const auto error = [](double sigma_t, double l) {
        return thin({sigma_t, 0.5, l, 0.7, 0.7, 0.7655541759927512}) /
                   near({sigma_t, 0.5, l, 0.7, 0.7, 0.7655541759927512}) -
               1;
    };
    for (const double sigma_t : {0.1, 1.0, 10.0}) {
        double before = -1;
        for (const double l : {0.01, 0.1, 1.0, 10.0}) {
            EXPECT_GT(error(sigma_t, l), before);
            EXPECT_LT(error(sigma_t, l), 0);
            before = error(sigma_t, l);
        }
    }
    EXPECT_LT(error(1, 0.01), -0.3);
    EXPECT_GT(error(1, 10), -0.01);
}

TEST(SlabMethod, NamesAndMethodsAreOneToOne) {
    for (const NamedMethod<SlabMethod>& info : kSlabMethods) {
        EXPECT_EQ(method_name(kSlabMethods, info.method), info.name);
        EXPECT_EQ(method_from_name(kSlabMethods, info.name), info.method);
    }
    EXPECT_FALSE(method_from_name(kSlabMethods, "best").has_value());
}

TEST(SlabMethod, EachRungHasItsErrorAndNoneIsNegative) {
    const auto error_of = [](SlabMethod method) {
        double worst = 0;
        for (int i = 0; i < 2000; ++i) {
            SweepDraw draw(static_cast<std::uint64_t>(i));
            Ray r = real_ray(draw);
            r.s = std::min(r.s, 0.5);
            r.sigma_t = std::min(r.sigma_t, 1.0);
            r.l = std::max(r.l, 0.1);
            r.wl_dot_n = std::max(r.wl_dot_n, 0.1);
            r.w_dot_wl = std::max(r.w_dot_wl, -0.99);
            const double value =
                slab_near(method, r.sigma_t, r.s, r.l, r.w_dot_n, r.wl_dot_n, r.w_dot_wl);
            EXPECT_GE(value, 0);
            worst = std::max(worst, relative_error(value, near(r)));
        }
        return worst;
    };
    EXPECT_EQ(error_of(SlabMethod::exact), 0);
    EXPECT_LT(error_of(SlabMethod::panels_gl12), 1e-10);
    EXPECT_LT(error_of(SlabMethod::panels_gl8), 2e-6);
    EXPECT_GT(error_of(SlabMethod::panels_gl8), error_of(SlabMethod::panels_gl12));
    EXPECT_LT(error_of(SlabMethod::panels_gl6), 2e-4);
    EXPECT_LT(error_of(SlabMethod::equiangular_gl16), 1e-4);
    EXPECT_LT(error_of(SlabMethod::equiangular_gl8), 1e-2);
    EXPECT_LT(error_of(SlabMethod::march64), 0.05);
    EXPECT_LT(error_of(SlabMethod::thin), 0.9);
    EXPECT_GT(error_of(SlabMethod::thin), 0.1);
}

TEST(SlabMethod, EveryRungHoldsForAnyInput) {
    sweep(
        [](SweepDraw& draw) -> std::string {
            const Ray r = any_ray(draw);
            for (const NamedMethod<SlabMethod>& info : kSlabMethods) {
                const double value =
                    slab_near(info.method, r.sigma_t, r.s, r.l, r.w_dot_n, r.wl_dot_n, r.w_dot_wl);
                if (!(value >= 0)) return report(info.name.data(), r, value);
            }
            return {};
        },
        kSweepInputs / 5);
}

TEST(Slab, ThinFormOverflowsOnItsResultAlone) {
    // Against 400 digits.
    EXPECT_NEAR(slab_thin(1e300, 8.237425658376785e+112, 1e-300, 0, 7.392944760825106e-21,
                          -0.999999999999999) /
                    8.5313349047e-106,
                1, 1e-9);
    EXPECT_EQ(slab_thin(1, 2, 1, 0.5, 1, -1), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace airlight
