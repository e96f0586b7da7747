// SPDX-License-Identifier: Apache-2.0
#include "medium/surface_radiance_method.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "core/constants.h"
#include "core/error.h"
#include "medium/surface_radiance.h"
#include "medium/surface_sets.h"
#include "tests/medium/reference_rows.h"

namespace airlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

SurfaceEvaluator evaluator(SurfaceMethod method, double exponent, int size = 0) {
    SurfaceOptions options;
    options.method = method;
    options.exponent = exponent;
    options.table_size = size;
    return SurfaceEvaluator(options);
}

TEST(SurfaceMethod, NamesAndMethodsAnswerEachOther) {
    std::set<std::string_view> names;
    for (const NamedMethod<SurfaceMethod>& info : kSurfaceMethods) {
        EXPECT_EQ(method_name(kSurfaceMethods, info.method), info.name);
        EXPECT_EQ(method_from_name(kSurfaceMethods, info.name), info.method);
        names.insert(info.name);
    }
    EXPECT_EQ(names.size(), std::size(kSurfaceMethods));
    EXPECT_EQ(names.size(), static_cast<std::size_t>(SurfaceMethod::exact) + 1);
    EXPECT_FALSE(method_from_name(kSurfaceMethods, "table"));
    EXPECT_FALSE(method_from_name(kSurfaceMethods, ""));
    EXPECT_EQ(SurfaceOptions{}.method, SurfaceMethod::exact);
}

struct Bound {
    SurfaceMethod method;
    double exponent;
    double max;  // a third above what was measured
};

TEST(SurfaceMethod, EveryRungKeepsItsErrorBound) {
    const Bound bounds[] = {
        {SurfaceMethod::raw_table_nearest, 1, 0.56},
        {SurfaceMethod::raw_table_nearest, 20, 0.6},
        {SurfaceMethod::raw_table_bilinear, 1, 0.16},
        {SurfaceMethod::raw_table_bilinear, 20, 0.17},
        {SurfaceMethod::warped_table, 1, 2.9e-3},
        {SurfaceMethod::warped_table, 20, 3.4e-3},
        {SurfaceMethod::warped_table, 1000, 1.9e-2},
        {SurfaceMethod::cubic_table, 1, 1.3e-6},
        {SurfaceMethod::cubic_table, 20, 9e-6},
        {SurfaceMethod::cubic_table, 1000, 1.3e-4},
        {SurfaceMethod::exact, 1, 0},
        {SurfaceMethod::exact, 20, 0},
    };
    for (const Bound& bound : bounds) {
        const SurfaceSet set('A', bound.exponent, 4000);
        const RelativeErrors errors = set.errors(evaluator(bound.method, bound.exponent));
        EXPECT_LE(errors.max, bound.max)
            << method_name(kSurfaceMethods, bound.method) << bound.exponent;
        // A bound far above the error would guard nothing.
        EXPECT_GE(errors.max, 0.3 * bound.max)
            << method_name(kSurfaceMethods, bound.method) << bound.exponent;
    }
}

TEST(SurfaceMethod, WarpedTablesHoldTheirBoundsOverTheirWholeDomain) {
    // Set B reaches to the end of the tables and crowds where they bend.
    for (const auto& [exponent, linear, cubic] :
         {std::array{1.0, 3.4e-3, 5.1e-6}, std::array{2.0, 2.9e-3, 4.5e-6},
          std::array{5.99, 8e-3, 8.3e-6}, std::array{200.0, 9.5e-3, 4.7e-5}}) {
        const SurfaceSet set('B', exponent, 8000);
        EXPECT_LT(set.errors(evaluator(SurfaceMethod::warped_table, exponent)).max, linear)
            << exponent;
        EXPECT_LT(set.errors(evaluator(SurfaceMethod::cubic_table, exponent)).max, cubic)
            << exponent;
    }
}

TEST(SurfaceMethod, FinerTablesAreMoreAccurate) {
    const SurfaceSet set('A', 20, 2000);
    for (const auto& [method, factor] : {std::pair{SurfaceMethod::raw_table_nearest, 0.6},
                                         std::pair{SurfaceMethod::raw_table_bilinear, 0.4},
                                         std::pair{SurfaceMethod::warped_table, 0.3},
                                         std::pair{SurfaceMethod::cubic_table, 0.12}}) {
        double previous = kInfinity;
        for (const int size : {16, 32, 64}) {
            const double error = set.errors(evaluator(method, 20, size)).rms;
            EXPECT_LT(error, factor * previous)
                << method_name(kSurfaceMethods, method) << ' ' << size;
            previous = error;
        }
    }
}

TEST(SurfaceMethod, TablesMeetTheirPoints) {
    const RawSurfaceTable raw(3, 9, 8);
    const WarpedSurfaceTable warped(3, 9), cubic(3, 9, SurfaceInterpolation::cubic);
    for (int i = 0; i < 9; ++i) {
        const double y = (i - 4) / 4.0, theta = 0.5 * kPi * (1 + y * std::abs(y));
        const double x = i / 8.0, t = WarpedSurfaceTable::kThickest * x * x * x * x;
        EXPECT_LT(relative_error(warped.radiance(t, theta), surface_radiance(t, theta, 3.0)),
                  1e-12);
        EXPECT_LT(
            relative_error(cubic.radiance_scaled(t, theta), surface_radiance_scaled(t, theta, 3.0)),
            1e-12);
        const double even = kPi * i / 8;
        for (const TableLookup how : {TableLookup::nearest, TableLookup::bilinear}) {
            EXPECT_LT(relative_error(raw.radiance(i, even, how), surface_radiance(i, even, 3.0)),
                      1e-12);
            // As the texture would: the paper's table has no more than its last column.
            EXPECT_EQ(raw.radiance(1e9, even, how), raw.radiance(8, even, how));
        }
    }
    EXPECT_EQ(warped.rows(), 9);
    EXPECT_EQ(WarpedSurfaceTable(20, 8).rows(), 9);
}

TEST(SurfaceMethod, HaveTheDomainOfTheExactOne) {
    for (const NamedMethod<SurfaceMethod>& info : kSurfaceMethods) {
        const SurfaceEvaluator rung = evaluator(info.method, 2.5);
        EXPECT_TRUE(std::isnan(rung(std::nan(""), 1))) << info.name;
        EXPECT_TRUE(std::isnan(rung(1, std::nan("")))) << info.name;
        EXPECT_TRUE(std::isnan(rung(-1e-300, 1))) << info.name;
        EXPECT_TRUE(std::isnan(rung(kInfinity, 3.15))) << info.name;
        EXPECT_EQ(rung(1, 3.1415927410125732), rung(1, kPi)) << info.name;
        const bool raw = info.method <= SurfaceMethod::raw_table_bilinear;
        if (raw) continue;
        EXPECT_EQ(rung(kInfinity, 1), 0) << info.name;
        // Past the end of the table the exact function goes on.
        EXPECT_LT(relative_error(rung(107, 1), surface_radiance(107.0, 1.0, 2.5)), 1e-12);
    }
    EXPECT_LT(relative_error(WarpedSurfaceTable(2.5).radiance_scaled(1e4, 1),
                             surface_radiance_scaled(1e4, 1.0, 2.5)),
              1e-12);
}

TEST(SurfaceMethod, OptionsOutsideTheirLimitsAreUsageErrors) {
    for (const NamedMethod<SurfaceMethod>& info : kSurfaceMethods) {
        for (const double exponent : {0.0, 0.999, 1000.5, -1.0, std::nan(""), kInfinity}) {
            EXPECT_THROW(evaluator(info.method, exponent), Error) << info.name << exponent;
        }
        if (info.method == SurfaceMethod::exact) continue;
        EXPECT_THROW(evaluator(info.method, 1, 1), Error);
        EXPECT_THROW(evaluator(info.method, 1, -5), Error);
        EXPECT_THROW(evaluator(info.method, 1, 5000), Error);
    }
    for (const double max_t : {0.0, -1.0, kInfinity, std::nan("")}) {
        EXPECT_THROW(RawSurfaceTable(1, 8, max_t), Error);
    }
    try {
        WarpedSurfaceTable(0.5);
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::usage);
        EXPECT_EQ(std::string(error.what()), "exponent = 0.500000 is not in [1, 1000]");
    }
}

}  // namespace
}  // namespace airlight
