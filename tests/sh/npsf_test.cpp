// SPDX-License-Identifier: Apache-2.0
#include "sh/npsf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/constants.h"
#include "core/error.h"
#include "medium/psf.h"
#include "sh/quadrature.h"
#include "sh/zonal.h"
#include "tests/medium/reference_rows.h"

namespace airlight {
namespace {

// npsf.h states 1e-14; measured 2.3e-15.
constexpr double kAccuracy = 1e-14;

TEST(NpsfZonal, MatchesTheReference) {
    const std::vector<double> g = npsf_zonal(4096);
    for (const auto& row : reference_rows("npsf_sh.csv", 3, 32)) {
        const auto l = static_cast<std::size_t>(row[0]);
        EXPECT_LT(relative_error(g[l], row[1]), kAccuracy) << l;
        EXPECT_LT(relative_error(zonal_eigenvalue(static_cast<int>(l), g[l]), row[2]), kAccuracy);
    }
}

TEST(NpsfZonal, DiffersFromThePrintedListByItsKnownError) {
    // [Zhou07] sec. 4; ours are lower by 6e-6 ... 2.7e-5.
    const double printed[6] = {0.332818, 0.332488, 0.302428, 0.275773, 0.254051, 0.236333};
    const std::vector<double> g = npsf_zonal(6);
    for (std::size_t l = 0; l < 6; ++l) {
        // Half a digit of the print on either side.
        EXPECT_GT(printed[l] - g[l], 5.5e-6 - 5e-7) << l;
        EXPECT_LT(printed[l] - g[l], 2.75e-5 + 5e-7) << l;
    }
}

TEST(PsfZonal, MatchesTheReferenceForEveryThickness) {
    std::map<double, std::vector<double>> cached;
    for (const auto& row : reference_rows("psf_sh.csv", 4, 700)) {
        std::vector<double>& g = cached[row[0]];
        if (g.empty()) g = psf_zonal(row[0], 64);
        const auto l = static_cast<std::size_t>(row[1]);
        EXPECT_LT(relative_error(g[l], row[2]), kAccuracy) << row[0] << " " << l;
    }
    EXPECT_EQ(cached.size(), 12u);
}

TEST(PsfZonal, MatchesGoldenValuesAtTheEnds) {
    std::map<double, std::vector<double>> cached;
    for (const auto& row : reference_rows("psf_sh_extreme.csv", 3, 30)) {
        std::vector<double>& lambda = cached[row[0]];
        if (lambda.empty()) lambda = psf_eigenvalues_scaled(row[0], 4096);
        const auto l = static_cast<std::size_t>(row[1]);
        EXPECT_LT(relative_error(lambda[l], row[2]), kAccuracy) << row[0] << " " << l;
    }
}

// The slow way: panels in gamma, halving towards 0 and short enough for P_4095, with sampled PSF.
std::vector<double> by_quadrature(double optical_thickness, int order) {
    const PolarRule gauss = gauss_legendre(16);
    PolarRule rule;
    std::vector<double> values;
    double end = kPi;
    while (end > 1e-18) {
        const double begin = end > 1e-17 ? std::max(end / 2, end - 12.0 / order) : 0;
        for (std::size_t i = 0; i < gauss.weight.size(); ++i) {
            const double gamma = begin + (end - begin) * (1 + gauss.cosine[i]) / 2;
            rule.angle.push_back(gamma);
            rule.cosine.push_back(std::cos(gamma));
            rule.sine.push_back(std::sin(gamma));
            rule.weight.push_back(gauss.weight[i] * (end - begin) / 2 * std::sin(gamma));
            values.push_back(psf_scaled(optical_thickness, gamma));
        }
        end = begin;
    }
    return zonal_eigenvalues(rule, values, order);
}

TEST(PsfZonal, MatchesTheSampledPointSpreadFunction) {
    for (const double t : {0.0, 1e-8, 0.05, 1.0, 3.0, 50.0, 200.0}) {
        for (const int order : {12, 4096}) {
            const std::vector<double> slow = by_quadrature(t, order);
            const std::vector<double> fast = psf_eigenvalues_scaled(t, order);
            for (std::size_t l = 0; l < fast.size(); ++l) {
                // The sampled one rounds to about 1e-15 of lambda_0 in every degree.
                ASSERT_NEAR(fast[l], slow[l], 2e-14 * fast[0]) << t << " " << l;
            }
        }
    }
}

TEST(PsfZonal, OfNoThicknessObeysItsRecurrence) {
    // lambda_l = pi/4 (Gamma((l+1)/2) / Gamma(l/2+1))^2, so neighbours multiply to this.
    const std::vector<double> lambda = psf_eigenvalues_scaled(0, 16384);
    EXPECT_LT(relative_error(lambda[0], kPi * kPi / 4), kAccuracy);
    for (std::size_t l = 0; l + 1 < lambda.size(); ++l) {
        const double root = kPi / (2 * (static_cast<double>(l) + 1));
        EXPECT_LT(relative_error(lambda[l] * lambda[l + 1], root * root), 2 * kAccuracy) << l;
    }
    for (const double g : psf_zonal(0, 9)) EXPECT_EQ(g, 0);
}

TEST(PsfZonal, ApproachesItsAsymptoteLikeTheInverseCube) {
    for (const double t : {1e-8, 0.5, 1.0, 3.0}) {
        const std::vector<double> lambda = psf_eigenvalues_scaled(t, 4096);
        for (const int l : {64, 256, 1024, 4095}) {
            const double asymptote = kPi / (2.0 * l + 1) - t / (l * (l + 1.0));
            // The next term is pi/4 (T^2 - T/2 + 1/8...) / (l + 1/2)^3.
            EXPECT_NEAR(lambda[static_cast<std::size_t>(l)], asymptote,
                        (1 + 2 * t * t) / std::pow(l + 0.5, 3) + kAccuracy * asymptote)
                << t << " " << l;
        }
    }
}

TEST(PsfZonal, IsPositiveAndFallsForEveryThickness) {
    for (const double t : {0.0, 1e-300, 1e-8, 0.1, 1.0, 50.0, 745.0, 1e6, 1e300}) {
        const std::vector<double> lambda = psf_eigenvalues_scaled(t, 512);
        for (std::size_t l = 0; l < lambda.size(); ++l) {
            ASSERT_GT(lambda[l], 0) << t << " " << l;
            ASSERT_LT(lambda[l], l == 0 ? 2.4675 : lambda[l - 1]) << t << " " << l;
        }
    }
    const std::vector<double> underflown = psf_zonal(1e4, 4);
    EXPECT_EQ(underflown, std::vector<double>(4, 0.0));
}

TEST(PsfZonal, DoesNotDependOnTheOrderAskedFor) {
    const std::vector<double> all = psf_eigenvalues_scaled(2, 4096);
    for (const int order : {1, 2, 33, 700}) {
        const std::vector<double> some = psf_eigenvalues_scaled(2, order);
        ASSERT_EQ(some.size(), static_cast<std::size_t>(order));
        for (std::size_t l = 0; l < some.size(); ++l) {
            EXPECT_LT(relative_error(some[l], all[l]), kAccuracy) << order << " " << l;
        }
    }
    EXPECT_TRUE(psf_zonal(1, 0).empty());
}

TEST(PsfZonal, OfHugeThicknessIsItsAsymptote) {
    // T lambda_l e^T / T -> ln(2 T) + gamma - H_l; the next term is smaller by ln(T) / T.
    for (const double t : {1e20, 1e100, 1e300, 1e306, 1.7e308}) {
        const std::vector<double> lambda = psf_eigenvalues_scaled(t, 4);
        double harmonic = 0;
        for (int l = 0; l < 4; ++l) {
            if (l > 0) harmonic += 1.0 / l;
            const double limit = std::log(t) + std::log(2) + 0.57721566490153286 - harmonic;
            // Denormal nodes have fewer digits.
            EXPECT_NEAR(lambda[static_cast<std::size_t>(l)] * t / limit, 1,
                        t > 1e306 ? 1e-5 : 1e-12)
                << t << " " << l;
        }
    }
}

TEST(PsfZonal, TakesMinusZeroForZero) {
    EXPECT_EQ(psf_eigenvalues_scaled(-0.0, 5), psf_eigenvalues_scaled(0.0, 5));
    EXPECT_EQ(psf_zonal(-0.0, 5), std::vector<double>(5, 0.0));
}

TEST(PsfZonal, RefusesWhatIsNoThickness) {
    const double inf = std::numeric_limits<double>::infinity();
    for (const double t : {-1e-9, -1000.0, inf, -inf, std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_THROW(psf_eigenvalues_scaled(t, 4), Error) << t;
        EXPECT_THROW(psf_zonal(t, 4), Error) << t;
    }
}

}  // namespace
}  // namespace airlight
