// SPDX-License-Identifier: Apache-2.0
#include "medium/gaussian_density.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "medium/gaussian_line_method.h"
#include "tests/medium/reference_rows.h"
#include "tests/medium/sweep.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kRootPi = 1.7724538509055160273;

// Measured: 7.2e-16 on both tables.
constexpr double kTolerance = 3e-15;
// The golden inputs are doubles of any size; what a double cannot hold is not compared.
constexpr double kNormal = 1e-306;

struct Line {
    double a, c, rho, m, dist;
    double depth() const { return gaussian_line(a, c, rho, m, dist); }
};

// Lengths in units of 1 / a mostly, so that the blob is met, over all of a double's range.
Line random_line(SweepDraw& draw) {
    Line line;
    const bool ordinary = draw.chance(0.5);
    line.a = ordinary ? draw.decades(-3, 3) : draw.not_negative(false);
    line.c = ordinary ? draw.decades(-3, 3) : draw.not_negative(false);
    const double unit = line.a > 1e-300 ? 1 / line.a : 1;
    const auto length = [&] {
        return std::min(draw.chance(0.8) ? unit * draw.uniform(0, 8) : draw.not_negative(false),
                        std::numeric_limits<double>::max());
    };
    line.rho = length();
    line.m = draw.sign() * length();
    switch (draw.bits() % 4) {
        case 0:
            line.dist = length();
            break;
        case 1:
            line.dist = std::abs(line.m) * (1 + draw.sign() * draw.decades(-17, 0));
            break;
        case 2:
            line.dist = unit * draw.decades(-20, 1);
            break;
        default:
            line.dist = draw.not_negative();
    }
    return line;
}

TEST(GaussianLine, MatchesEveryReferenceRow) {
    int compared = 0;
    for (const char* file : {"gauss_line.csv", "gauss_line_corners.csv"}) {
        for (const auto& row : reference_rows(file, 6, 200)) {
            const double value = gaussian_line(row[0], row[1], row[2], row[3], row[4]);
            if (row[5] < kNormal) {
                EXPECT_LE(value, 2 * kNormal);
                continue;
            }
            ++compared;
            EXPECT_LT(relative_error(value, row[5]), kTolerance)
                << file << ' ' << row[0] << ' ' << row[1] << ' ' << row[2] << ' ' << row[3] << ' '
                << row[4];
        }
    }
    EXPECT_GT(compared, 560);
}

TEST(GaussianLine, FloatIsTheDoubleResultRounded) {
    for (const auto& row : reference_rows("gauss_line.csv", 6, 200)) {
        float x[5];
        for (int i = 0; i < 5; ++i) x[i] = static_cast<float>(row[i]);
        const double exact =
            gaussian_line(double{x[0]}, double{x[1]}, double{x[2]}, double{x[3]}, double{x[4]});
        EXPECT_EQ(gaussian_line(x[0], x[1], x[2], x[3], x[4]), static_cast<float>(exact));
    }
}

TEST(GaussianLine, SweepGivesNeitherNanNorNegativeAndAtMostTheWholeLine) {
    sweep([](SweepDraw& draw) -> std::string {
        const Line line = random_line(draw);
        const double depth = line.depth();
        const double whole = gaussian_line(line.a, line.c, line.rho, 0, kInfinity) * 2;
        const double uniform = line.c == 0 || line.dist == 0 ? 0 : line.c * line.dist;
        const bool holds = depth >= 0 && depth <= whole * (1 + 1e-14) + 1e-323 &&
                           depth <= uniform * (1 + 1e-14) + 1e-323;
        // +inf is the value only where the product overflows.
        const bool finite = depth < kInfinity || (whole == kInfinity && uniform == kInfinity);
        if (holds && finite) return "";
        return sweep_report("gaussian_line", {line.a, line.c, line.rho, line.m, line.dist}, depth);
    });
}

TEST(GaussianLine, SweepIsTheSameFromEitherEnd) {
    sweep([](SweepDraw& draw) -> std::string {
        // Whole steps of a grid, so that the reversed segment is exactly the same one.
        const double grid = std::ldexp(1.0, static_cast<int>(draw.bits() % 40) - 20);
        const double m = grid * static_cast<double>(static_cast<int>(draw.bits() % 2001) - 1000);
        const double dist = grid * static_cast<double>(1 + draw.bits() % 1000);
        const double a = draw.decades(-3, 0) / grid, rho = draw.uniform(0, 20) / a;
        const double there = gaussian_line(a, 1, rho, m, dist);
        const double back = gaussian_line(a, 1, rho, dist - m, dist);
        if (std::abs(there - back) <= 2 * kTolerance * there) return "";
        return sweep_report("gaussian_line", {a, 1, rho, m, dist}, there);
    });
}

TEST(GaussianLine, SweepOfPartsAddsUpToTheWhole) {
    sweep([](SweepDraw& draw) -> std::string {
        const double grid = std::ldexp(1.0, static_cast<int>(draw.bits() % 40) - 20);
        const double m = grid * static_cast<double>(static_cast<int>(draw.bits() % 2001) - 1000);
        const double first = grid * static_cast<double>(1 + draw.bits() % 1000);
        const double second =
            draw.chance(0.2) ? kInfinity : grid * static_cast<double>(1 + draw.bits() % 1000);
        const double a = draw.decades(-4, 0) / grid, rho = draw.uniform(0, 20) / a;
        const double whole = gaussian_line(a, 1, rho, m, first + second);
        const double sum =
            gaussian_line(a, 1, rho, m, first) + gaussian_line(a, 1, rho, m - first, second);
        // Denormals are rounded to their own steps.
        if (std::abs(whole - sum) <= 1e-13 * whole + 1e-322) return "";
        return sweep_report("gaussian_line", {a, 1, rho, m, first, second}, sum / whole - 1);
    });
}

TEST(GaussianLine, GrowsWithItsLengthAndFallsWithTheDistanceFromTheCenter) {
    sweep(
        [](SweepDraw& draw) -> std::string {
            Line line = random_line(draw);
            const double depth = line.depth();
            Line longer = line, further = line;
            longer.dist *= 1 + draw.decades(-12, 1);
            further.rho *= 1 + draw.decades(-12, 1);
            if (!(further.rho < kInfinity)) further.rho = line.rho;
            const double rounding = 2 * kTolerance * depth + 1e-323;
            if (!(longer.depth() < depth - rounding) && !(further.depth() > depth + rounding))
                return "";
            return sweep_report("gaussian_line", {line.a, line.c, line.rho, line.m, line.dist},
                                depth);
        },
        kSweepInputs);
}

TEST(GaussianLine, CornersAreTheirLimits) {
    EXPECT_EQ(gaussian_line(0.0, 2.0, 3.0, 4.0, 5.0), 10);
    EXPECT_EQ(gaussian_line(0.0, 2.0, 3.0, 4.0, kInfinity), kInfinity);
    EXPECT_EQ(gaussian_line(0.0, 0.0, 3.0, 4.0, kInfinity), 0);
    EXPECT_EQ(gaussian_line(1.0, 0.0, 3.0, 4.0, kInfinity), 0);
    EXPECT_EQ(gaussian_line(1.0, 2.0, 3.0, 4.0, 0.0), 0);
    EXPECT_EQ(gaussian_line(1e-300, 2.0, 3.0, -4.0, 5.0), 10);
    EXPECT_DOUBLE_EQ(gaussian_line(1e-300, 1e-300, 0.0, 0.0, kInfinity), 0.5 * kRootPi);
    EXPECT_DOUBLE_EQ(gaussian_line(2.0, 3.0, 0.0, 0.0, kInfinity), 0.75 * kRootPi);
    EXPECT_EQ(gaussian_line(1.0, 1.0, 0.0, 0.0, 5e-324), 5e-324);
    // Neither factor can be held, their product can: exp(-900) and 1e300 / 1e-50.
    const double tail = gaussian_line(1e-50, 1e300, 3e51, 0.0, kInfinity);
    EXPECT_LT(std::abs(std::log(tail) - (350 * std::log(10.0) - 900 + std::log(0.5 * kRootPi))),
              1e-12);
}

TEST(GaussianLine, RefusesWhatIsOutsideItsDomainWithNan) {
    const double good[5] = {1, 1, 1, 1, 1};
    for (int i = 0; i < 5; ++i) {
        for (const double bad : {kNan, -1.0, -kInfinity, kInfinity}) {
            if (i == 3 && bad == -1) continue;
            if (i == 4 && bad == kInfinity) continue;
            double x[5];
            std::copy(good, good + 5, x);
            x[i] = bad;
            EXPECT_TRUE(std::isnan(gaussian_line(x[0], x[1], x[2], x[3], x[4]))) << i << ' ' << bad;
            EXPECT_TRUE(std::isnan(gaussian_line_inverse(x[0], x[1], x[2], x[3], x[4])));
            for (const NamedMethod<GaussianLineMethod>& info : kGaussianLineMethods) {
                EXPECT_TRUE(std::isnan(gaussian_line(info.method, x[0], x[1], x[2], x[3], x[4])));
            }
        }
    }
}

// [Zhou07] eq. 31 as printed, a difference of two error functions.
TEST(GaussianLine, ThePrintedDifferenceLosesTheSegmentsBesideTheBlob) {
    int rows = 0, printed_zero = 0, printed_wrong = 0, ours_wrong = 0;
    for (const auto& row : reference_rows("gauss_line.csv", 6, 200)) {
        if (row[5] < 1e-290) continue;
        ++rows;
        const double a = row[0], m = row[3];
        const double printed = row[1] * std::exp(-a * a * row[2] * row[2]) * kRootPi / (2 * a) *
                               (std::erf(a * (row[4] - m)) - std::erf(-a * m));
        printed_zero += printed == 0;
        printed_wrong += relative_error(printed, row[5]) > 1e-6;
        ours_wrong += relative_error(gaussian_line(a, row[1], row[2], m, row[4]), row[5]) > 1e-12;
        EXPECT_EQ(gaussian_line(GaussianLineMethod::exact, a, row[1], row[2], m, row[4]),
                  gaussian_line(a, row[1], row[2], m, row[4]));
        // The rung is that formula.
        EXPECT_NEAR(gaussian_line(GaussianLineMethod::erf, a, row[1], row[2], m, row[4]), printed,
                    1e-15 * row[1] / a);
    }
    EXPECT_GT(rows, 190);
    EXPECT_GE(printed_zero, 15);
    EXPECT_GE(printed_wrong, 18);
    EXPECT_EQ(ours_wrong, 0);
}

TEST(GaussianLineMethod, NamesComeBack) {
    for (const NamedMethod<GaussianLineMethod>& info : kGaussianLineMethods) {
        EXPECT_EQ(method_from_name(kGaussianLineMethods, info.name), info.method);
        EXPECT_EQ(method_name(kGaussianLineMethods, info.method), info.name);
    }
    EXPECT_FALSE(method_from_name(kGaussianLineMethods, "none").has_value());
}

TEST(GaussianLineMethod, FastErfErrsByItsSwitchAndNotByMore) {
    double within = 0, beyond = 0;
    for (int i = 0; i <= 400000; ++i) {
        const double x = 1e-5 * i;
        double& largest = x <= 2.629639 ? within : beyond;
        largest = std::max(largest, std::abs(fast_erf(x) - std::erf(x)));
        ASSERT_EQ(fast_erf(-x), -fast_erf(x));
        ASSERT_NEAR(fast_erf(static_cast<float>(x)), fast_erf(x), 3e-6);
    }
    EXPECT_LT(within, 1.3e-4);
    // 1 - erf(2.629639): the paper's "less than 2e-4" is missed by this switch alone.
    EXPECT_GT(beyond, 2.0e-4);
    EXPECT_LT(beyond, 2.0013e-4);
}

TEST(GaussianLineMethod, SweepRungsStayWithinTheirAbsoluteErrorAndAreNeverNegative) {
    sweep([](SweepDraw& draw) -> std::string {
        const Line line = random_line(draw);
        const double exact = line.depth();
        for (const NamedMethod<GaussianLineMethod>& info : kGaussianLineMethods) {
            const double value =
                gaussian_line(info.method, line.a, line.c, line.rho, line.m, line.dist);
            const double bound = info.method == GaussianLineMethod::fast_erf ? 3e-4 : 1e-15;
            const double size = line.a > 0 ? line.c / line.a : 0;
            // The rungs multiply as they come, and lose a denormal amplitude.
            if (line.c < 1e-290 && value >= 0) continue;
            if (!(value >= 0) || !(value == exact || std::abs(value - exact) <=
                                                         bound * size + 1e-14 * exact + 1e-305)) {
                return sweep_report(std::string(info.name).c_str(),
                                    {line.a, line.c, line.rho, line.m, line.dist, exact}, value);
            }
        }
        return "";
    });
}

TEST(GaussianLineInverse, SweepComesBackToTheOpticalDepth) {
    sweep(
        [](SweepDraw& draw) -> std::string {
            const double wide = draw.chance(0.5) ? 3 : 250;
            const double a = draw.decades(-wide, wide), c = draw.decades(-wide, wide);
            const double rho = draw.uniform(0, draw.chance(0.5) ? 3 : 25) / a;
            const double m =
                draw.sign() / a * (draw.chance(0.5) ? draw.uniform(0, 25) : draw.decades(-20, 1));
            const double total = gaussian_line(a, c, rho, m, kInfinity);
            const double part = draw.chance(0.5)   ? draw.unit()
                                : draw.chance(0.5) ? draw.decades(-300, 0)
                                                   : 1 - draw.decades(-16, 0);
            const double tau = total * part;
            if (!(tau > 1e-290 && tau < 1e300)) return "";
            const double dist = gaussian_line_inverse(a, c, rho, m, tau);
            const std::initializer_list<double> arguments = {a, c, rho, m, tau};
            if (tau >= total) {
                return dist == kInfinity ? "" : sweep_report("inverse", arguments, dist);
            }
            if (!(dist >= 0 && dist < kInfinity)) return sweep_report("inverse", arguments, dist);
            const double back = gaussian_line(a, c, rho, m, dist);
            // A distance among the denormals has too few neighbours.
            if (std::abs(back - tau) <= 1e-12 * tau || dist < 1e-295) return "";
            return sweep_report("line of inverse", arguments, back / tau - 1);
        },
        kSweepInputs);
}

TEST(GaussianLineInverse, SweepOfAnyInputHasAnAnswer) {
    sweep(
        [](SweepDraw& draw) -> std::string {
            const Line line = random_line(draw);
            const double tau =
                draw.chance(0.5) ? draw.not_negative() : line.depth() * draw.pick({1, 0.5, 2});
            const double dist = gaussian_line_inverse(line.a, line.c, line.rho, line.m, tau);
            if (dist >= 0 && (tau > 0 || dist == 0)) return "";
            return sweep_report("inverse", {line.a, line.c, line.rho, line.m, tau}, dist);
        },
        kSweepInputs);
}

TEST(GaussianLineInverse, CornersAreTheirLimits) {
    EXPECT_EQ(gaussian_line_inverse(1.0, 1.0, 0.0, 0.0, 0.0), 0);
    EXPECT_EQ(gaussian_line_inverse(1.0, 1.0, 0.0, 0.0, 0.9), kInfinity);
    EXPECT_EQ(gaussian_line_inverse(1.0, 0.0, 0.0, 0.0, 1e-9), kInfinity);
    EXPECT_EQ(gaussian_line_inverse(0.0, 2.0, 0.0, 0.0, 1.0), 0.5);
    EXPECT_EQ(gaussian_line_inverse(1.0f, 1.0f, 0.0f, 0.0f, 0.0f), 0);
    EXPECT_NEAR(gaussian_line_inverse(1.0f, 1.0f, 0.0f, 0.0f, 0.5f), 0.551039f, 1e-5);
}

TEST(GaussianPass, TakesUnitDirectionsAndRefusesOthers) {
    const GaussianPass pass = gaussian_pass({1, 2, 3}, {0, 0, 3}, {0, 1, 0});
    EXPECT_EQ(pass.rho_perp, 1);
    EXPECT_EQ(pass.m_proj, 2);
    // Rounded to float it is unit to 1e-7, and is normalised.
    const GaussianPass longer = gaussian_pass({1, 2, 3}, {0, 0, 3}, {0, 1 + 4e-6, 0});
    EXPECT_DOUBLE_EQ(longer.rho_perp, 1);
    EXPECT_DOUBLE_EQ(longer.m_proj, 2);
    for (const double length : {0.0, 0.99, 1.01, kNan, kInfinity}) {
        EXPECT_TRUE(std::isnan(gaussian_pass({1, 2, 3}, {0, 0, 3}, {0, length, 0}).m_proj));
    }
    const GaussianBlob blob{{1, 2, 3}, 1, 1};
    EXPECT_TRUE(std::isnan(gaussian_optical_depth(blob, {0, 0, 3}, {0, 2, 0}, 1.0)));
}

TEST(GaussianOpticalDepth, IsTheIntegralOfTheDensity) {
    const GaussianBlob blob{{1, -2, 0.5}, 1.3, 0.7};
    const glm::dvec3 from{-2, -1, 0}, to{3, -2.5, 1};
    const double dist = glm::length(to - from);
    // The trapezoidal rule of a smooth function that has all but vanished at both ends.
    const int steps = 400;
    double sum = 0;
    for (int i = 0; i <= steps; ++i) {
        const double weight = i == 0 || i == steps ? 0.5 : 1;
        sum += weight * gaussian_density(blob, from + (to - from) * (double(i) / steps));
    }
    EXPECT_NEAR(gaussian_optical_depth(blob, from, to), sum * dist / steps, 2e-6);
    EXPECT_DOUBLE_EQ(gaussian_optical_depth(blob, from, to),
                     gaussian_optical_depth(blob, to, from));
    EXPECT_DOUBLE_EQ(gaussian_optical_depth(blob, from, (to - from) / dist, dist),
                     gaussian_optical_depth(blob, from, to));
    EXPECT_EQ(gaussian_optical_depth(blob, from, from), 0);
}

TEST(GaussianDensity, PeaksAtTheCenterAndKnowsItsDomain) {
    const GaussianBlob blob{{1, 2, 3}, 2, 5};
    EXPECT_EQ(gaussian_density(blob, {1, 2, 3}), 5);
    EXPECT_DOUBLE_EQ(gaussian_density(blob, {1, 2.5, 3}), 5 * std::exp(-1.0));
    EXPECT_EQ(gaussian_density(blob, {1e200, 0, 0}), 0);
    EXPECT_EQ(gaussian_density({{0, 0, 0}, 0, 5}, {1e200, 0, 0}), 5);
    EXPECT_TRUE(std::isnan(gaussian_density(blob, {kNan, 0, 0})));
    EXPECT_TRUE(std::isnan(gaussian_density({{0, 0, 0}, -1, 1}, {0, 0, 0})));
    EXPECT_TRUE(std::isnan(gaussian_density({{0, 0, 0}, 1, -1}, {0, 0, 0})));
}

}  // namespace
}  // namespace airlight
