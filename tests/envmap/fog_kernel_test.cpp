// SPDX-License-Identifier: Apache-2.0
#include "envmap/fog_kernel.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/constants.h"
#include "envmap/band_filter.h"
#include "envmap/chord.h"
#include "envmap/pixel_integral.h"
#include "medium/psf.h"
#include "sh/npsf.h"
#include "sh/quadrature.h"
#include "sh/zonal.h"

namespace airlight {
namespace {

TEST(SplitKernel, NearAndFarPartAddUpToThePsfWithinTheMeasuredError) {
    for (const double thickness : {0.0, 1e-8, 0.05, 1.0, 10.0, 50.0}) {
        for (const double tolerance : {1e-1, 1e-3, 1e-5}) {
            const int lmax = 300;
            const std::optional<SplitKernel> split = make_split_kernel(thickness, lmax, tolerance);
            ASSERT_TRUE(split.has_value());
            EXPECT_LE(split->error, tolerance);
            EXPECT_EQ(split->lmax(), lmax);
            // Energies of thin shells compare the near part without its singularity.
            const std::vector<double> smooth = split->eigenvalues;
            for (double angle = 1e-4; angle < 3.14; angle *= 1.07) {
                const double far = zonal_evaluate(smooth, angle);
                const double low = squared_chord(angle * 0.999),
                             high = squared_chord(angle * 1.001);
                const double near = 2 * (split->near(low) - split->near(high)) / (high - low);
                // A shell that straddles the near part's end sees a part of the jump there.
                if (low < split->radius * split->radius && high > split->radius * split->radius) {
                    continue;
                }
                const double exact = psf_scaled(thickness, angle);
                // 2e-6 is the curvature of 1/gamma over the shell, 1e-7 the table's difference.
                EXPECT_NEAR((near + far) / exact, 1, split->error + 3e-6)
                    << thickness << ' ' << angle;
            }
        }
    }
}

TEST(SplitKernel, KeepsTheEnergyOfTheWhole) {
    for (const double thickness : {0.0, 1.0, 20.0}) {
        const std::optional<SplitKernel> split = make_split_kernel(thickness, 200, 1e-2);
        ASSERT_TRUE(split.has_value());
        const double energy = split->eigenvalues[0] + 2 * kPi * split->near.total();
        EXPECT_NEAR(energy / psf_eigenvalues_scaled(thickness, 1)[0], 1, 1e-10);
    }
}

TEST(SplitKernel, RadiusTimesBandsIsTwiceTheLogarithmOfTheTolerance) {
    for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5}) {
        const std::optional<SplitKernel> split = make_split_kernel(1.0, 400, tolerance);
        ASSERT_TRUE(split.has_value());
        EXPECT_NEAR(split->radius * 400 / (2 * std::log(1 / tolerance)), 0.92, 0.12);
    }
}

TEST(SplitKernel, RefusesWhatItsBandsCannotHold) {
    EXPECT_FALSE(make_split_kernel(1.0, 8, 1e-5).has_value());
    EXPECT_FALSE(make_split_kernel(1e4, 100, 1e-2).has_value());
}

TEST(RemainderTable, AgreesWithQuadratureOverSixteenDecades) {
    for (const double thickness : {0.0, 1.0, 30.0}) {
        const RemainderTable table = whole_kernel(thickness);
        EXPECT_NEAR(2 * kPi * table.total() / psf_eigenvalues_scaled(thickness, 1)[0], 1, 1e-11);
        EXPECT_EQ(table(4.0), 0);
        const PolarRule rule = gauss_legendre(20);
        for (double chord = 1e-9; chord < 1.9; chord *= 3) {
            // The energy between chord and 1.3 chord: f s is smooth there.
            double sum = 0;
            for (std::size_t i = 0; i < rule.weight.size(); ++i) {
                const double s = chord * (1.15 + 0.15 * rule.cosine[i]);
                if (s >= 2) continue;
                sum += 0.15 * chord * rule.weight[i] * s *
                       psf_scaled(thickness, 2 * std::asin(0.5 * s));
            }
            if (1.3 * chord >= 2) break;
            const double shell = table(chord * chord) - table(1.69 * chord * chord);
            EXPECT_NEAR(shell, sum, 1e-12 * table.total() + 1e-9 * sum) << chord;
        }
        const double tiny = 1e-12;
        EXPECT_NEAR((table.total() - table(tiny * tiny)) / (tiny / 4), 1, 1e-3);
    }
}

TEST(PixelIntegrator, TapsOfAllPixelsSumToTheEnergyOfTheKernel) {
    const RemainderTable table = whole_kernel(1.0);
    for (const auto& [rows, columns] : {std::pair{1, 1}, {1, 2}, {5, 9}, {64, 128}, {33, 20}}) {
        const PixelIntegrator pixels(rows, columns);
        for (const int row : {0, rows / 3, rows / 2}) {
            double sum = 0;
            pixels.integrate_row(table, row, [&](int, std::size_t count, const double* taps) {
                for (std::size_t k = 0; k < count; ++k) {
                    const bool alone = k == 0 || 2 * k == static_cast<std::size_t>(columns);
                    sum += (alone ? 1 : 2) * taps[k];
                    EXPECT_GT(taps[k], 0);
                }
            });
            EXPECT_NEAR(sum / (2 * kPi * table.total()), 1, 1e-7) << rows << ' ' << columns;
        }
    }
}

TEST(RowAverageFilter, AveragesHarmonicsOverARow) {
    for (const auto& [rows, degree] : {std::pair{64, 20}, {64, 33}, {512, 300}, {100, 76}}) {
        const std::vector<double> taps = row_average_filter(rows, degree);
        for (int k = 0; k <= degree; ++k) {
            const double x = kPi * k / rows;
            double response = taps[0];
            for (std::size_t n = 1; n < taps.size(); ++n) response += 2 * taps[n] * std::cos(n * x);
            const double exact = k == 0 ? 1 : std::sin(0.5 * x) / (0.5 * x);
            EXPECT_NEAR(response, exact, 2e-11) << rows << ' ' << degree << ' ' << k;
        }
    }
}

}  // namespace
}  // namespace airlight
