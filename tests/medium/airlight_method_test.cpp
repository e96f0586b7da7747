// SPDX-License-Identifier: Apache-2.0
#include "medium/airlight_method.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <string>

#include "core/constants.h"
#include "medium/airlight_rungs.h"
#include "medium/airlight_sets.h"
#include "tests/medium/reference_rows.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

AirlightEvaluator evaluator(AirlightMethod method) {
    AirlightOptions options;
    options.method = method;
    return AirlightEvaluator(options);
}

TEST(AirlightMethod, NamesAndMethodsAnswerEachOther) {
    std::set<std::string_view> names;
    for (const NamedMethod<AirlightMethod>& info : kAirlightMethods) {
        EXPECT_EQ(method_name(kAirlightMethods, info.method), info.name);
        EXPECT_EQ(method_from_name(kAirlightMethods, info.name), info.method);
        names.insert(info.name);
    }
    EXPECT_EQ(names.size(), std::size(kAirlightMethods));
    EXPECT_EQ(names.size(), static_cast<std::size_t>(AirlightMethod::exact) + 1);
    EXPECT_FALSE(method_from_name(kAirlightMethods, "sinh-gl7"));
    EXPECT_FALSE(method_from_name(kAirlightMethods, ""));
    EXPECT_EQ(AirlightOptions{}.method, AirlightMethod::exact);
}

TEST(AirlightMethod, EveryRungKeepsItsErrorBound) {
    // Twice the largest relative errors measured on 20000 rays of each set. The F tables and the
    // march have no useful maximum (a ray that passes close to the light, a difference that
    // cancels), so theirs is only a guard against change.
    const std::map<std::string_view, std::pair<double, double>> bounds = {
        {"f-table-nearest", {160, 1.6e5}},  // measured 79, 7.7e4
        {"f-table-bilinear", {0.4, 8e9}},   // measured 0.20, 3.6e9
        {"warped-table", {1e-2, 8e-3}},     // measured 4.9e-3, 3.7e-3
        {"march64", {20, 9}},               // measured 9.4, 4.4
        {"sinh-gl6", {6e-3, 6e-3}},         // measured 2.9e-3, 3.1e-3
        {"sinh-gl8", {5e-4, 2e-3}},         // measured 2.2e-4, 8.8e-4
        {"sinh-gl12", {8e-6, 8e-6}},        // measured 4.0e-6, 4.0e-6
        {"sinh-gl16", {1.4e-7, 4e-7}},      // measured 6.7e-8, 1.8e-7
        {"sinh-gl24", {1.4e-11, 8e-11}},    // measured 6.7e-12, 3.7e-11
        {"sinh-gl32", {1e-13, 1e-13}},      // measured 3.4e-14, 2.2e-14
        {"e1", {5e-13, 5e-13}},             // measured 2.2e-13, 9.6e-14
        {"exact", {0, 0}},
    };
    const auto a = airlight_set('A', 20000), b = airlight_set('B', 20000);
    for (const NamedMethod<AirlightMethod>& info : kAirlightMethods) {
        const AirlightEvaluator rung = evaluator(info.method);
        const auto& [bound_a, bound_b] = bounds.at(info.name);
        EXPECT_LE(airlight_errors(a, rung).max, bound_a) << info.name;
        EXPECT_LE(airlight_errors(b, rung).max, bound_b) << info.name;
    }
}

TEST(AirlightMethod, MoreNodesAreMoreAccurate) {
    const auto b = airlight_set('B', 4000);
    double previous = 1;
    for (const int nodes : {6, 8, 12, 16, 24, 32}) {
        const double error = airlight_errors(b, [&](double g, double s, double v) {
                                 return airlight_sinh_gl(g, s, v, nodes);
                             }).max;
        EXPECT_LT(error, 0.5 * previous) << nodes;
        previous = error;
    }
}

TEST(AirlightMethod, NoRungGivesNanOrANegativeRadiance) {
    for (const NamedMethod<AirlightMethod>& info : kAirlightMethods) {
        const AirlightEvaluator rung = evaluator(info.method);
        std::mt19937_64 random(19);
        std::uniform_real_distribution<double> unit(0, 1);
        for (int i = 0; i < 30000; ++i) {
            double gamma = kPi * unit(random);
            if (i % 3 == 0) gamma = std::pow(10.0, -320 * unit(random));
            if (i % 3 == 1) gamma = kPi - std::pow(10.0, -17 * unit(random));
            if (i % 100 == 0) gamma = 0;
            const double s =
                std::pow(10.0, i % 2 ? -300 + 600 * unit(random) : -8 + 11 * unit(random));
            double v = s * std::pow(10.0, -17 + 20 * unit(random));
            if (i % 5 == 0) v = s;
            if (i % 5 == 1) v = i % 2 ? kInfinity : 0;
            const double value = rung(gamma, s, v);
            ASSERT_GE(value, 0) << info.name << ' ' << gamma << ' ' << s << ' ' << v;
            // An error of a rung may cross the largest double.
            if (airlight(gamma, s, v) < 1e300) {
                ASSERT_LT(value, kInfinity) << info.name << ' ' << gamma << ' ' << s << ' ' << v;
            }
        }
        EXPECT_TRUE(std::isnan(rung(std::nan(""), 1, 1))) << info.name;
        EXPECT_TRUE(std::isnan(rung(1, -1, 1))) << info.name;
        EXPECT_TRUE(std::isnan(rung(1, 1, -1))) << info.name;
        EXPECT_TRUE(std::isnan(rung(4, 1, 1))) << info.name;
    }
}

TEST(AirlightMethod, ClosedFormAndThirtyTwoNodesHoldTheReferenceRows) {
    for (const char* name : {"airlight.csv", "airlight_corners.csv"}) {
        const std::size_t columns = name == std::string("airlight.csv") ? 4 : 5;
        for (const auto& row : reference_rows(name, columns, 300)) {
            if (row[3] < 1e-290 || row[3] > 1e300) continue;
            EXPECT_LT(relative_error(airlight_e1(row[0], row[1], row[2]), row[3]), 1e-12)
                << row[0] << ' ' << row[1] << ' ' << row[2];
        }
    }
    for (const auto& row : reference_rows("airlight.csv", 4, 360)) {
        EXPECT_LT(relative_error(airlight_sinh_gl(row[0], row[1], row[2], 32), row[3]), 1e-12)
            << row[0] << ' ' << row[1] << ' ' << row[2];
    }
}

TEST(AirlightMethod, FloatQuadratureHoldsFloatTolerance) {
    for (const auto& row : reference_rows("airlight.csv", 4, 360)) {
        const float g = float(row[0]), s = float(row[1]), v = float(row[2]);
        const double exact = airlight(double{g}, double{s}, double{v});
        // The tolerance is that of the project for float.
        EXPECT_LT(relative_error(airlight_sinh_gl(g, s, v, 16), exact), 2e-5)
            << row[0] << ' ' << row[1] << ' ' << row[2];
        EXPECT_LT(relative_error(airlight_sinh_gl(g, s, v, 32), exact), 2e-6)
            << row[0] << ' ' << row[1] << ' ' << row[2];
    }
    std::mt19937_64 random(23);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 200000; ++i) {
        float g = float(3.1415926 * unit(random));
        if (i % 3 == 0) g = float(std::pow(10.0, -30 * unit(random)));
        if (i % 3 == 1) g = std::nextafter(3.14159274f, 0.0f);
        const float s = float(std::pow(10.0, -8 + 9.8 * unit(random)));
        float v = s * float(std::pow(10.0, -8 + 10 * unit(random)));
        if (i % 4 == 0) v = std::numeric_limits<float>::infinity();
        const double exact = airlight(double{g}, double{s}, double{v});
        if (exact < 1e-36 || exact > 1e38) continue;
        // Measured: 7.3e-7.
        ASSERT_LT(relative_error(airlight_sinh_gl(g, s, v, 32), exact), 2e-6)
            << g << ' ' << s << ' ' << v;
    }
}

TEST(AirlightMethod, MarchConvergesAtSecondOrder) {
    const double exact = airlight(1.0, 1.0, 2.0);
    const double coarse = std::abs(airlight_march(1.0, 1.0, 2.0, 64) / exact - 1);
    const double fine = std::abs(airlight_march(1.0, 1.0, 2.0, 128) / exact - 1);
    EXPECT_NEAR(coarse / fine, 4, 0.1);
    AirlightOptions options;
    options.method = AirlightMethod::march64;
    options.march_steps = 128;
    EXPECT_EQ(AirlightEvaluator(options)(1.0, 1.0, 2.0), airlight_march(1.0, 1.0, 2.0, 128));
}

}  // namespace
}  // namespace airlight
