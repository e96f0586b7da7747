// SPDX-License-Identifier: Apache-2.0
#include "sh/psf_bands.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "sh/npsf.h"

namespace airlight {
namespace {

struct Exact {
    double thickness;
    std::vector<double> lambda;
};

std::vector<Exact> exact_bands(int order, std::vector<double> thicknesses, int more) {
    for (int i = 0; i < more; ++i) thicknesses.push_back(20 * std::pow((i + 0.37) / more, 4));
    std::vector<Exact> all;
    for (const double t : thicknesses) all.push_back({t, psf_eigenvalues_scaled(t, order)});
    return all;
}

double largest_error(const PsfBands& bands, const std::vector<Exact>& all) {
    double worst = 0;
    std::vector<float> values(static_cast<std::size_t>(bands.order()));
    for (const Exact& exact : all) {
        bands.eigenvalues_scaled(exact.thickness, values.data());
        for (std::size_t l = 0; l < values.size(); ++l) {
            worst = std::max(worst, std::abs(static_cast<double>(values[l]) / exact.lambda[l] - 1));
        }
    }
    return worst;
}

TEST(PsfBands, MeetTheirStatedErrorsAtEveryThickness) {
    struct Stated {
        PsfBandsMethod method;
        double error;
    };
    const std::vector<Exact> all =
        exact_bands(32, {0, 5e-324, 1e-300, 1e-8, 20, 20.000001, 745, 1e4}, 200);
    for (const Stated& stated :
         {Stated{PsfBandsMethod::cubic16, 4.2e-4}, Stated{PsfBandsMethod::cubic32, 2.6e-5},
          Stated{PsfBandsMethod::chebyshev20, 1e-6}, Stated{PsfBandsMethod::exact, 6e-8}}) {
        const double worst = largest_error(PsfBands(32, stated.method), all);
        EXPECT_LT(worst, stated.error) << method_name(kPsfBandsMethods, stated.method);
        // No pessimism either: a rung that got better should say so.
        if (stated.method != PsfBandsMethod::chebyshev20) {
            EXPECT_GT(worst, stated.error / 2) << method_name(kPsfBandsMethods, stated.method);
        }
    }
}

TEST(PsfBands, HoldForHighDegreesToo) {
    EXPECT_LT(largest_error(PsfBands(1024), exact_bands(1024, {0, 1e-4, 0.3, 3, 19.9}, 0)), 1e-6);
}

TEST(PsfBands, CarryTheScaleOfThePointSpreadFunction) {
    const PsfBands bands(4);
    float scaled[4], values[4];
    bands.eigenvalues_scaled(2, scaled);
    bands.eigenvalues(2, values);
    for (int l = 0; l < 4; ++l) EXPECT_NEAR(values[l], 2 * std::exp(-2.0) * scaled[l], 1e-7);
    for (const double nothing : {0.0, 800.0}) {
        bands.eigenvalues(nothing, values);
        for (const float value : values) EXPECT_EQ(value, 0) << nothing;
    }
}

TEST(PsfBands, RefuseWhatIsNoThickness) {
    const PsfBands bands(4);
    float out[4];
    for (const double bad : {-1e-9, std::numeric_limits<double>::quiet_NaN(), double(HUGE_VAL)}) {
        EXPECT_THROW(bands.eigenvalues_scaled(bad, out), Error) << bad;
        EXPECT_THROW(bands.eigenvalues(bad, out), Error) << bad;
    }
}

}  // namespace
}  // namespace airlight
